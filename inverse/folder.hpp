#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "inverse/job.hpp"
#include "inverse/journal.hpp"

namespace kerf::inverse {

/// What a caller may change about a job; 0 and empty leave it as the job says.
struct JobOverride {
  std::size_t max_runs = 0;
  int parallel = 0;
  std::string preset = {};       ///< written over all scenes (see forward/scene/preset.hpp)
  std::string backend = {};      ///< see find_backend
  std::string shared_runs = {};  ///< a folder (see SharedRuns)
};

/// The folder a calibration lives in. It holds copies of all inputs, so that it can be resumed from itself alone:
///   calibration.json   names and SHA-256 of the inputs, the budget, the build of kerf that runs it
///   inputs/            the job, its scene, its curves, byte for byte
///   journal.jsonl      every simulated cut (see Journal); locked while a process works in the folder
class Folder {
 public:
  /// For `kerf calibrate`: creates the folder, or reopens one that holds the same job. Throws InputError when it holds
  /// another job or the runs of another build of kerf.
  static Folder create(const std::filesystem::path& folder, const std::filesystem::path& job_file,
                       const JobOverride& override, const std::string& code);
  /// Is there a calibration in this folder?
  static bool holds_one(const std::filesystem::path& folder);
  /// For `kerf resume`: nothing but the folder is needed. Throws InputError when its inputs were changed.
  static Folder open(const std::filesystem::path& folder, const JobOverride& override, const std::string& code);

  const Job& job() const { return job_; }
  Journal& journal() { return *journal_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  Folder(std::filesystem::path path, Job job, std::unique_ptr<Journal> journal)
      : path_(std::move(path)), job_(std::move(job)), journal_(std::move(journal)) {}

  std::filesystem::path path_;
  Job job_;
  std::unique_ptr<Journal> journal_;
};

/// SHA-256 of the running executable: runs of one build are never mixed with those of another.
std::string code_identity();

}  // namespace kerf::inverse
