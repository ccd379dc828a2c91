#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/run_database.hpp"
#include "models/base/document.hpp"

namespace kerf::inverse {

/// A key of the scene, or several, whose price and precision are studied.
struct StudyKnob {
  std::vector<std::string> paths;
  std::string short_name;  ///< "speed"; distinct within a study
  std::string unit = "1";  ///< in which values are shown
};

struct StudyRun {
  std::optional<std::size_t> knob;  ///< which one was turned; none: the reference, or the scene as it is
  std::string value;                ///< as it is shown: "5", "x 0.75", "draft"
  std::optional<double> number;     ///< in the knob's unit; of several keys the factor
  Document scene;
  std::string label;  ///< "speed = 5 m/s"
};

/// What accuracy costs: a scene, one knob at a time turned, against a reference.
struct Study {
  static constexpr std::size_t reference = 0, as_it_is = 1;  ///< indices of runs

  Document scene;
  std::vector<StudyKnob> knobs;
  std::string result;          ///< of bodies: what is looked at, as the user named it; may be empty
  std::vector<StudyRun> runs;  ///< the reference, the scene as it is, then every value of every knob

  /// Runs that differ in the cell size alone, the scene as it is among them.
  std::vector<std::size_t> resolutions() const;
};

/// What is studied and what counts as exact when the command line does not say.
const std::vector<std::string>& default_knobs(const Document& scene);
const std::vector<std::string>& default_reference(const Document& scene);

/// Lays out a study of `scene`. A knob is written like an axis of a sweep (see parse_axis), or as factors of what the
/// scene has, rounded where only whole numbers are allowed: window.ahead+window.behind=x0.75,x1.5. Values that the
/// scene has already are left out. `reference` holds one value per key. Throws InputError (usage) that begins with
/// `where`, and what the scene's reader says to a value that was asked for; an unreadable default value becomes a
/// refused run, and a default knob of a table that the scene lacks is left out.
Study lay_out_study(const Document& scene, const std::vector<std::string>& knobs,
                    const std::vector<std::string>& reference, std::string_view where);

std::vector<RunRequest> requests_of(const Study& study);

}  // namespace kerf::inverse
