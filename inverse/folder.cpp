#include "inverse/folder.hpp"

#include <fmt/format.h>

#include <map>

#include "forward/scene/preset.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* manifest_name = "calibration.json";
constexpr const char* journal_name = "journal.jsonl";

std::string copy_name(std::size_t index, const std::string& original) {
  return fmt::format("inputs/{}_{}", index, fs::path(original).filename().string());
}

/// The inputs in a fixed order: job, scene, curves with their own scenes.
std::vector<const InputFile*> inputs(const Job& job) {
  std::vector<const InputFile*> all{&job.source, &job.scene_file};
  for (const MeasuredCurve& curve : job.curves) {
    all.push_back(&curve.file);
    if (curve.specimen_file) all.push_back(&*curve.specimen_file);
  }
  return all;
}

void apply(const JobOverride& override, Job& job) {
  if (override.max_runs > 0) job.budget.max_runs = override.max_runs;
  if (override.parallel > 0) job.budget.parallel = override.parallel;
  if (!override.backend.empty()) job.budget.backend = override.backend;
  if (!override.shared_runs.empty()) job.budget.shared_runs = fs::absolute(override.shared_runs).string();
  if (override.preset.empty()) return;
  forward::impose_preset(job.scene, override.preset, job.source.name);
  for (MeasuredCurve& curve : job.curves)
    if (curve.specimen) forward::impose_preset(*curve.specimen, override.preset, job.source.name);
}

std::unique_ptr<Journal> open_journal(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: cannot create this folder: {}", folder.string(), error.message()));
  return std::make_unique<Journal>(folder / journal_name);
}

/// A job under another preset is another job.
std::string identity(const Job& job, const std::string& preset) {
  return preset.empty() ? job.identity() : sha256(job.identity() + preset);
}

void write_inputs(const fs::path& folder, const Job& job, const std::string& preset, const std::string& code) {
  Json files = Json::array();
  const std::vector<const InputFile*> all = inputs(job);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string copy = copy_name(i, all[i]->name);
    write_atomically(folder / copy, all[i]->content);
    files.push_back({{"name", all[i]->name}, {"copy", copy}, {"sha256", all[i]->hash()}});
  }
  const Json manifest{{"job", identity(job, preset)},
                      {"preset", preset},
                      {"code", code},
                      {"inputs", std::move(files)},
                      {"max_runs", job.budget.max_runs},
                      {"parallel", job.budget.parallel},
                      {"backend", job.budget.backend},
                      {"shared_runs", job.budget.shared_runs}};
  write_atomically(folder / manifest_name, manifest.dump(2) + "\n");
}

Json read_manifest(const fs::path& folder) {
  const fs::path file = folder / manifest_name;
  if (!fs::exists(file))
    throw InputError(
        fmt::format("{}: holds no calibration (there is no {}); `kerf calibrate JOB.toml -o {}` begins one",
                    folder.string(), manifest_name, folder.string()));
  Json manifest = Json::parse(read_file(file), nullptr, false);
  for (const char* key : {"job", "preset", "code", "inputs", "max_runs", "parallel"})
    if (manifest.is_discarded() || !manifest.contains(key))
      throw InputError(fmt::format("{}: is damaged; begin again in another folder", file.string()));
  return manifest;
}

void require_same_code(const fs::path& folder, const Json& manifest, const std::string& code) {
  if (manifest.at("code") == code) return;
  throw InputError(
      fmt::format("{}: its runs were made by another build of kerf and cannot be continued by this one; "
                  "begin again in another folder",
                  folder.string()));
}

/// The job as it was when the folder was created.
Job read_copies(const fs::path& folder, const Json& manifest) {
  std::map<std::string, fs::path> copies;
  for (const Json& input : manifest.at("inputs")) {
    const fs::path copy = folder / input.at("copy").get<std::string>();
    if (sha256(read_file(copy)) != input.at("sha256").get<std::string>())
      throw InputError(
          fmt::format("{}: was changed since the calibration began; put it back, or begin again with "
                      "`kerf calibrate`",
                      copy.string()));
    copies[input.at("name").get<std::string>()] = copy;
  }
  const Json& job = manifest.at("inputs").at(0);
  const auto name = job.at("name").get<std::string>();
  return read_job(copies.at(name), name, [&](const std::string& wanted) { return copies.at(wanted); });
}

}  // namespace

Folder Folder::create(const fs::path& folder, const fs::path& job_file, const JobOverride& override,
                      const std::string& code) {
  Job job = read_job(job_file);
  apply(override, job);
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file; name a folder for the calibration", folder.string()), ExitCode::usage);
  if (fs::exists(folder / manifest_name)) {
    const Json manifest = read_manifest(folder);
    if (manifest.at("job") != identity(job, override.preset))
      throw InputError(fmt::format("{}: holds the calibration of another job; continue that one with `kerf resume {}`, "
                                   "or name another folder",
                                   folder.string(), folder.string()),
                       ExitCode::usage);
    require_same_code(folder, manifest, code);
  }
  std::unique_ptr<Journal> journal = open_journal(folder);
  if (!fs::exists(folder / manifest_name) && !journal->lines().empty())
    throw InputError(
        fmt::format("{}: holds a journal without {}; name another folder", folder.string(), manifest_name));
  write_inputs(folder, job, override.preset, code);
  return {folder, std::move(job), std::move(journal)};
}

bool Folder::holds_one(const fs::path& folder) {
  return fs::is_regular_file(folder / manifest_name);
}

Folder Folder::open(const fs::path& folder, const JobOverride& override, const std::string& code) {
  const Json manifest = read_manifest(folder);
  require_same_code(folder, manifest, code);
  Job job = read_copies(folder, manifest);
  apply({.max_runs = manifest.at("max_runs").get<std::size_t>(),
         .parallel = manifest.at("parallel").get<int>(),
         .preset = manifest.at("preset").get<std::string>(),
         .backend = manifest.value("backend", ""),
         .shared_runs = manifest.value("shared_runs", "")},
        job);
  apply(override, job);
  return {folder, std::move(job), open_journal(folder)};
}

std::string code_identity() {
  return sha256(read_file("/proc/self/exe"));
}

}  // namespace kerf::inverse
