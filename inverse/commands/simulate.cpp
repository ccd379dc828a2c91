#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "forward/bodies/run.hpp"
#include "forward/record/cut_file.hpp"
#include "forward/record/result_json.hpp"
#include "forward/record/state_file.hpp"
#include "forward/run.hpp"
#include "forward/scene/preset.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/job_study_session.hpp"
#include "inverse/sweep_axis.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;

/// One refreshed line on a terminal; elsewhere a plain line now and then.
class ProgressLine {
 public:
  void show(const forward::Progress& progress) {
    const auto now = Clock::now();
    if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10))) return;
    last_ = now;
    const double to_go = progress.wall_seconds * (progress.length - progress.travel) / progress.travel;
    fmt::print(stderr, "{}cut {:.2f} of {:.2f} mm   F_c {:.0f} N/m   {:.0f} s, at most {:.0f} s to go{}",
               terminal_ ? "\r\033[K" : "", progress.travel, progress.length, newton_per_metre(progress.F_c),
               progress.wall_seconds, to_go, terminal_ ? "" : "\n");
    std::fflush(stderr);
  }
  void clear() const {
    if (terminal_) fmt::print(stderr, "\r\033[K");
  }
  static double newton_per_metre(double force) { return force / consistent_units_in("N/m"); }

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  Clock::time_point last_ = Clock::now();
};

/// Refuses, before hours are spent, a place where the result could not be put afterwards.
void require_writable(const fs::path& file, const char* extension = ".h5") {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}", file.string(), why), ExitCode::usage);
  };
  if (file.extension() != extension) refuse(fmt::format("the name of the result's file ends in {}", extension));
  if (fs::is_directory(file)) refuse("is a directory; name a file to write");
  fs::path parent = fs::absolute(file).parent_path();
  while (!fs::exists(parent)) parent = parent.parent_path();
  if (!fs::is_directory(parent)) refuse(parent.string() + " is not a directory");
  // By trying: permissions alone do not say that a file system takes no files.
  std::string trial = (parent / ".kerf.XXXXXX").string();
  const int descriptor = ::mkstemp(trial.data());
  if (descriptor < 0) {
    const std::string why = std::generic_category().message(errno);
    refuse("cannot write in " + parent.string() + ": " + why);
  }
  ::close(descriptor);
  ::unlink(trial.c_str());
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string all;
  for (const std::string& reason : reasons) all += (all.empty() ? "" : "; ") + reason;
  return all;
}

std::string force(const Estimate& estimate) {
  const double one = consistent_units_in("N/m");
  return fmt::format("{:.0f} ± {:.0f} N/m", estimate.value / one, estimate.standard_error / one);
}

std::string verdict(const forward::CutResult& result) {
  if (!result.accepted) return "not accepted: " + joined(result.refusals);
  return fmt::format("accepted: F_c = {}, F_t = {}, steady from {:.2f} mm, {}", force(result.F_c), force(result.F_t),
                     result.steady_from, forward::name(result.branch));
}

void print_table(const forward::CutResult& r) {
  const auto row = [](const char* name, const std::string& value, const char* meaning) {
    fmt::print("{:<22}{:>24}   {}\n", name, value, meaning);
  };
  const auto number = [](const Estimate& estimate, const char* unit) {
    return fmt::format("{:.3g} ± {:.1g}{}{}", estimate.value, estimate.standard_error, *unit ? " " : "", unit);
  };
  row("F_c", force(r.F_c), "cutting force per width");
  row("F_t", force(r.F_t), "transverse force per width, positive pushes the tool away");
  for (const forward::FaceResult& face : r.faces) {
    const std::string face_name = forward::name(face.face);
    row(("  " + face_name).c_str(), force(face.normal), "normal force");
    if (face.tangential.value != 0.0) row("", force(face.tangential), "friction");
    if (face.contact_length.value > 0.0) row("", number(face.contact_length, "mm"), "in contact");
  }
  row("steady", r.steady ? fmt::format("from {:.2f} mm", r.steady_from) : "no", "");
  row("branch", forward::name(r.branch), "does the tool touch the crack tip?");
  row("crack lead", number(r.crack_lead, "mm"), "foremost broken bond ahead of the tool tip");
  row("softening lead", number(r.softening_lead, "mm"), "foremost bond past its peak ahead of the tool tip");
  row("mode I fraction", fmt::format("{:.3f}", r.mode_I_fraction), "of the energy spent in separation");
  row("fracture energy ratio", fmt::format("{:.4f}", r.fracture_energy_ratio),
      "booked per new area, over what broken bonds had used");
  row("chip ratio", number(r.chip_ratio, ""), "chip thickness over depth of cut");
  row("chip curvature", number(r.chip_curvature, "1/mm"), "positive curls away from the tool");
  if (r.heat)
    row("temperature", fmt::format("{:.1f} K", r.heat->chip),
        fmt::format("mean of the chip; hottest point {:.1f} K", r.heat->highest).c_str());
  if (r.heat && r.heat->friction)
    row("heat of friction", fmt::format("{:.4g} J/m", *r.heat->friction / consistent_units_in("J/m")),
        "that has stayed in the work");
  row("inertia", fmt::format("{:.1f} %", 100 * r.inertia_share), "of F_c, to set the chip in motion (rho d v^2)");
  row("deepest penetration", fmt::format("{:.3f} cells", r.deepest_penetration), "of a crack face into the tool");
  fmt::print("\nenergy per width          J/m   share of the tool's work\n");
  const auto book = [&](const char* name, double energy) {
    fmt::print("{:<18}{:>11.4g}{:>10.2f} %\n", name, energy / consistent_units_in("J/m"),
               100 * energy / r.ledger.tool_work);
  };
  book("tool work", r.ledger.tool_work);
  book("  fracture", r.ledger.fracture);
  book("  plastic", r.ledger.plastic);
  book("  elastic", r.ledger.elastic);
  book("  kinetic", r.ledger.kinetic);
  book("  friction", r.ledger.friction);
  book("  damping", r.ledger.damping);
  book("  residue", r.ledger.residue());
  fmt::print("\n{:.1f} s, {} steps, {:.3g} particle-steps ({:.3g} per second)\n", r.cost.wall_seconds, r.cost.steps,
             static_cast<double>(r.cost.particle_steps),
             static_cast<double>(r.cost.particle_steps) / r.cost.wall_seconds);
}

struct Options {
  std::string scene, output, preset, start_from, save_state;
  std::vector<std::string> settings;
  bool json = false;
};

/// An experiment on bodies instead of a cut.
ExitCode simulate_bodies(const Options& options, Document document) {
  if (!options.preset.empty()) throw InputError("--preset is about cuts; this scene holds bodies", ExitCode::usage);
  if (!options.start_from.empty() || !options.save_state.empty())
    throw InputError("--start-from and --save-state are about cuts; this scene holds bodies", ExitCode::usage);
  inverse::apply_settings(options.settings, document, forward::bodies::scene_blocks(), "kerf simulate --set");
  const forward::bodies::Scene scene = forward::bodies::read_scene(document);
  if (!options.output.empty()) require_writable(options.output, ".json");
  const StopOnInterrupt guard;
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const forward::bodies::BodiesResult result = forward::bodies::run(scene, [&](std::size_t stroke, double stretch) {
    if (terminal)
      fmt::print(stderr, "\r\033[Kstroke {} of {}, stretch {:.4f}", stroke + 1, scene.strokes.size(), stretch);
    return !StopOnInterrupt::asked();
  });
  if (terminal) fmt::print(stderr, "\r\033[K");
  nlohmann::ordered_json json = forward::bodies::result_json(result, scene);
  json["title"] = scene.title;
  json["scene"] = document.canonical();
  json["code_version"] = KERF_VERSION;
  if (!options.output.empty()) write_atomically(options.output, json.dump(2) + "\n");
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    for (const auto& [name, value] : result.measures.items())
      fmt::print("{:<46}{:>14.6g}\n", name, value.get<double>());
    fmt::print("\n{:.1f} s, {} steps, {} particles\n", result.wall_seconds, result.steps, result.particles);
  }
  std::fflush(stdout);
  fmt::print(stderr, "{}\n", result.accepted ? "accepted" : "not accepted: " + joined(result.refusals));
  if (StopOnInterrupt::asked()) return ExitCode::interrupted;
  return result.accepted ? ExitCode::success : ExitCode::not_converged;
}

ExitCode simulate(const Options& options) {
  Document document = Document::load(options.scene);
  if (is_job(document))
    throw InputError(options.scene +
                     ": is a job; `kerf calibrate` runs it, and `kerf simulate` the scene that it names");
  if (forward::bodies::has_bodies(document)) return simulate_bodies(options, std::move(document));
  if (!options.preset.empty()) forward::impose_preset(document, options.preset, "kerf simulate --preset");
  inverse::apply_settings(options.settings, document, forward::scene_blocks(), "kerf simulate --set");
  const forward::Scene scene = forward::read_scene(document);
  if (!options.output.empty()) require_writable(options.output);
  if (!options.save_state.empty()) {
    require_writable(options.save_state);
    forward::require_chainable(scene, options.scene);
  }
  std::optional<forward::State> start;
  if (!options.start_from.empty()) start = forward::read_state(options.start_from, scene);
  forward::State end;

  const StopOnInterrupt guard;
  ProgressLine line;
  const auto show = [&](const forward::Progress& progress) {
    line.show(progress);
    return !StopOnInterrupt::asked();
  };
  const forward::CutResult result =
      forward::run(scene, show, {.from = start ? &*start : nullptr, .to = options.save_state.empty() ? nullptr : &end});
  line.clear();

  if (!options.output.empty()) forward::write_cut(options.output, document, result);
  if (end.step > 0.0) forward::write_state(options.save_state, end, scene);
  if (options.json)
    fmt::print("{}\n", forward::result_json(result).dump(2));
  else
    print_table(result);
  std::fflush(stdout);
  fmt::print(stderr, "{}\n", verdict(result));
  if (StopOnInterrupt::asked()) return ExitCode::interrupted;
  return result.accepted ? ExitCode::success : ExitCode::not_converged;
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("simulate", "Simulate one cut and judge it");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", options->output,
                      "keep the cut in this HDF5 file, with .xdmf for ParaView beside; of bodies, a .json");
  command->add_option("--preset", options->preset,
                      "draft, standard or reference: over what the scene says (see `kerf list preset`)");
  command->add_option("--set", options->settings, "PATH=VALUE, as in tool.rake=30deg: another value than the scene's")
      ->allow_extra_args(false);
  command->add_option("--save-state", options->save_state,
                      "keep the cut's last state in this HDF5 file, for other cuts to begin with");
  command->add_option("--start-from", options->start_from,
                      "begin with the state of a cut of the same mesh and tool instead of unbroken material");
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer("Exit code 0: accepted. 4: finished, but a test of the result failed (said on stderr). 130: Ctrl-C.");
  command->callback([options, &exit_code] { exit_code = static_cast<int>(simulate(*options)); });
}

}  // namespace kerf::commands
