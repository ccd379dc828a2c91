#include <memory>
#include <string>

#include "forward/bodies/run.hpp"
#include "forward/record/cut_file.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/run_record.hpp"
#include "models/base/atomic_file.hpp"

namespace kerf::commands {

void add_run(CLI::App& app, int&) {
  struct Options {
    std::string scene, record, cut;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("run", "One run of a calibration, in a process of its own");
  command->group("");  // for kerf itself and for the queue of a cluster
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("record", options->record, "what a calibration remembers of the run (JSON)")->required();
  command->add_option("cut", options->cut, "the whole cut (HDF5)")->required();
  command->callback([options] {
    if (std::filesystem::exists(options->record)) return;  // a requeued job whose work is done
    const Document document = Document::load(options->scene);
    if (forward::bodies::has_bodies(document)) {
      const forward::bodies::BodiesResult result = forward::bodies::run(forward::bodies::read_scene(document));
      write_atomically(options->record, inverse::to_json(inverse::summarise(result)).dump() + "\n");
      return;
    }
    const forward::CutResult result = forward::run(forward::read_scene(document));
    // The record first: HDF5 does not survive a full disk, and a run is known by its record.
    write_atomically(options->record, inverse::to_json(inverse::summarise(result)).dump() + "\n");
    forward::write_cut(options->cut, document, result);
  });
}

}  // namespace kerf::commands
