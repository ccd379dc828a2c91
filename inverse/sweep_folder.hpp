#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "inverse/journal.hpp"
#include "inverse/sweep.hpp"

namespace kerf::inverse {

/// What `kerf sweep` was asked for, apart from where the scene lies.
struct SweepRequest {
  std::vector<std::string> axes;  ///< as on the command line
  bool zip = false;
  int jobs = 1;           ///< simulations at a time
  bool keep_cuts = true;  ///< keep every run in full, in cuts/NNN.h5
};

/// The folder a sweep lives in; it can be resumed from itself alone:
///   request.json    what was asked for, name and SHA-256 of the scene, the build of kerf that runs it
///   inputs/         the scene, byte for byte
///   journal.jsonl   every simulated cut (see Journal); locked while a process works in the folder
///   cuts/NNN.h5     the cuts in full, if they are kept
class SweepFolder {
 public:
  /// For `kerf sweep`: creates the folder, or reopens one that holds the same sweep. Throws InputError when it holds
  /// anything else or the runs of another build of kerf.
  static SweepFolder create(const std::filesystem::path& folder, const std::filesystem::path& scene_file,
                            const SweepRequest& request, const std::string& code);
  /// For `kerf resume`; `jobs` 0 takes the number the sweep began with.
  static SweepFolder open(const std::filesystem::path& folder, int jobs, const std::string& code);
  /// Is there a sweep in this folder?
  static bool holds_one(const std::filesystem::path& folder);

  const Sweep& sweep() const { return sweep_; }
  const SweepRequest& request() const { return request_; }
  const std::string& scene_name() const { return scene_name_; }
  const std::string& scene_hash() const { return scene_hash_; }
  Journal& journal() { return *journal_; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path cut_file(std::size_t run) const;  ///< of the run with this index, from 0

 private:
  SweepFolder(std::filesystem::path path, Sweep sweep, SweepRequest request, std::string scene_name,
              std::string scene_hash);

  std::filesystem::path path_;
  Sweep sweep_;
  SweepRequest request_;
  std::string scene_name_, scene_hash_;
  std::unique_ptr<Journal> journal_;
};

}  // namespace kerf::inverse
