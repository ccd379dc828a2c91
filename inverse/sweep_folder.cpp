#include "inverse/sweep_folder.hpp"

#include <fmt/format.h>

#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* request_name = "request.json";
constexpr const char* journal_name = "journal.jsonl";
constexpr const char* scene_copy = "inputs/scene.toml";
constexpr const char* where = "kerf sweep";

Json to_json(const SweepRequest& request, const std::string& scene_name, const std::string& scene_hash,
             const std::string& code) {
  return {{"kind", "sweep"},      {"scene", {{"name", scene_name}, {"copy", scene_copy}, {"sha256", scene_hash}}},
          {"axes", request.axes}, {"zip", request.zip},
          {"jobs", request.jobs}, {"keep_cuts", request.keep_cuts},
          {"code", code}};
}

Json read_request(const fs::path& folder) {
  const fs::path file = folder / request_name;
  Json json = Json::parse(read_file(file), nullptr, false);
  for (const char* key : {"kind", "scene", "axes", "zip", "jobs", "keep_cuts", "code"})
    if (json.is_discarded() || !json.contains(key))
      throw InputError(fmt::format("{}: is damaged; begin again in another folder", file.string()));
  return json;
}

void require_same_code(const fs::path& folder, const Json& request, const std::string& code) {
  if (request.at("code") == code) return;
  throw InputError(
      fmt::format("{}: its runs were made by another build of kerf and cannot be continued by this one; "
                  "begin again in another folder",
                  folder.string()));
}

void require_same_sweep(const fs::path& folder, const Json& kept, const SweepRequest& request,
                        const std::string& scene_hash) {
  const bool same = kept.at("scene").at("sha256") == scene_hash && kept.at("axes") == Json(request.axes) &&
                    kept.at("zip") == request.zip;
  if (!same)
    throw InputError(fmt::format("{}: holds another sweep; continue that one with `kerf resume {}`, or name another "
                                 "folder",
                                 folder.string(), folder.string()),
                     ExitCode::usage);
}

}  // namespace

SweepFolder::SweepFolder(fs::path path, Sweep sweep, SweepRequest request, std::string scene_name,
                         std::string scene_hash)
    : path_(std::move(path)),
      sweep_(std::move(sweep)),
      request_(std::move(request)),
      scene_name_(std::move(scene_name)),
      scene_hash_(std::move(scene_hash)),
      journal_(std::make_unique<Journal>(path_ / journal_name)) {}

bool SweepFolder::holds_one(const fs::path& folder) {
  return fs::is_regular_file(folder / request_name);
}

fs::path SweepFolder::cut_file(std::size_t run) const {
  return path_ / "cuts" / fmt::format("{:03}.h5", run + 1);
}

SweepFolder SweepFolder::create(const fs::path& folder, const fs::path& scene_file, const SweepRequest& request,
                                const std::string& code) {
  const std::string content = read_file(scene_file), hash = sha256(content);
  Sweep sweep = lay_out_sweep(Document::parse(content, scene_file.string()), request.axes, request.zip, where);
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file; name a folder for the sweep", folder.string()), ExitCode::usage);
  const bool begun = holds_one(folder);
  if (begun) {
    const Json kept = read_request(folder);
    require_same_sweep(folder, kept, request, hash);
    require_same_code(folder, kept, code);
  } else if (fs::exists(folder / journal_name)) {
    throw InputError(fmt::format("{}: holds something else than a sweep; name another folder", folder.string()),
                     ExitCode::usage);
  }
  write_atomically(folder / scene_copy, content);
  // The request comes last: a folder that has it has all that a resume needs.
  write_atomically(folder / request_name, to_json(request, scene_file.string(), hash, code).dump(2) + "\n");
  return {folder, std::move(sweep), request, scene_file.string(), hash};
}

SweepFolder SweepFolder::open(const fs::path& folder, int jobs, const std::string& code) {
  const Json kept = read_request(folder);
  require_same_code(folder, kept, code);
  const Json& scene = kept.at("scene");
  const fs::path copy = folder / scene.at("copy").get<std::string>();
  const std::string content = read_file(copy), hash = sha256(content);
  if (scene.at("sha256") != hash)
    throw InputError(fmt::format("{}: was changed since the sweep began; put it back, or begin again with `kerf sweep`",
                                 copy.string()));
  SweepRequest request{.axes = kept.at("axes").get<std::vector<std::string>>(),
                       .zip = kept.at("zip").get<bool>(),
                       .jobs = jobs > 0 ? jobs : kept.at("jobs").get<int>(),
                       .keep_cuts = kept.at("keep_cuts").get<bool>()};
  const auto name = scene.at("name").get<std::string>();
  Sweep sweep = lay_out_sweep(Document::parse(content, name), request.axes, request.zip, where);
  return {folder, std::move(sweep), std::move(request), name, hash};
}

}  // namespace kerf::inverse
