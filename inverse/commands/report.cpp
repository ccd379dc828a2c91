#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "inverse/commands/commands.hpp"
#include "inverse/commands/draw_report.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string target, output;
};

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "report", "Write one self-contained HTML page about a calibration, a sweep, a study, a cut or bodies");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("target", options->target,
                   "directory of a calibration, sweep or study, the .h5 file of one cut, or the .json of bodies")
      ->required();
  command->add_option("-o,--output", options->output, "the page (default: DIR/report.html, or OUT.html beside OUT.h5)");
  command->callback([options, &exit_code] {
    if (!fs::exists(options->target))
      throw InputError(
          fmt::format("{}: no such file or directory; give the directory that `kerf calibrate -o`, `kerf sweep -o` "
                      "or `kerf study -o` wrote, or the file that `kerf simulate -o` wrote",
                      options->target));
    exit_code = static_cast<int>(draw_report(options->target, options->output));
  });
}

}  // namespace kerf::commands
