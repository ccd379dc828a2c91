#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "inverse/job.hpp"
#include "inverse/journal.hpp"

namespace kerf::inverse {

/// What a command that simulates variants of one scene was asked for, apart from where the scene lies.
struct SceneRequest {
  std::string kind;              ///< "sweep" or "study"
  nlohmann::ordered_json asked;  ///< an object: all that decides which variants are simulated
  int jobs = 1;                  ///< simulations at a time
  bool keep_cuts = true;         ///< keep every run in full, in cuts/NNN.h5
};

/// The folder that variants of one scene are simulated in; it can be resumed from itself alone:
///   request.json    what was asked for, name and SHA-256 of the scene, the build of kerf that runs it
///   inputs/         the scene, byte for byte
///   journal.jsonl   every simulated cut (see Journal); locked while a process works in the folder
///   cuts/NNN.h5     the cuts in full, if they are kept
class SceneFolder {
 public:
  /// Creates the folder, or reopens one that holds the same request. Throws InputError when it holds anything else or
  /// the runs of another build of kerf. Whether `scene` can be read is found out before.
  static SceneFolder create(const std::filesystem::path& folder, const InputFile& scene, SceneRequest request,
                            const std::string& code);
  /// For `kerf resume`; `jobs` 0 takes the number the command began with.
  static SceneFolder open(const std::filesystem::path& folder, int jobs, const std::string& code);
  /// "sweep", "study", or empty when the folder holds no such thing.
  static std::string kind_of(const std::filesystem::path& folder);

  const InputFile& scene() const { return scene_; }
  const SceneRequest& request() const { return request_; }
  Journal& journal() { return *journal_; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path cut_file(std::size_t run) const;  ///< of the run with this index, from 0

 private:
  SceneFolder(std::filesystem::path path, InputFile scene, SceneRequest request);

  std::filesystem::path path_;
  InputFile scene_;
  SceneRequest request_;
  std::unique_ptr<Journal> journal_;
};

}  // namespace kerf::inverse
