#include "inverse/scene_folder.hpp"

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

Json to_json(const SceneRequest& request, const InputFile& scene, const std::string& code) {
  return {{"kind", request.kind},
          {"scene", {{"name", scene.name}, {"copy", scene_copy}, {"sha256", scene.hash()}}},
          {"asked", request.asked},
          {"jobs", request.jobs},
          {"keep_cuts", request.keep_cuts},
          {"code", code}};
}

Json read_request(const fs::path& folder) {
  const fs::path file = folder / request_name;
  Json json = Json::parse(read_file(file), nullptr, false);
  for (const char* key : {"kind", "scene", "asked", "jobs", "keep_cuts", "code"})
    if (json.is_discarded() || !json.contains(key))
      throw InputError(fmt::format("{}: is damaged; begin again in another folder", file.string()));
  return json;
}

void require_same_code(const fs::path& folder, const Json& kept, const std::string& code) {
  if (kept.at("code") == code) return;
  throw InputError(
      fmt::format("{}: its runs were made by another build of kerf and cannot be continued by this one; "
                  "begin again in another folder",
                  folder.string()));
}

void require_same_request(const fs::path& folder, const Json& kept, const SceneRequest& request,
                          const std::string& scene_hash) {
  const bool same = kept.at("kind") == request.kind && kept.at("scene").at("sha256") == scene_hash &&
                    kept.at("asked") == request.asked;
  if (!same)
    throw InputError(fmt::format("{}: holds another {}; continue that one with `kerf resume {}`, or name another "
                                 "folder",
                                 folder.string(), kept.at("kind").get<std::string>(), folder.string()),
                     ExitCode::usage);
}

}  // namespace

SceneFolder::SceneFolder(fs::path path, InputFile scene, SceneRequest request)
    : path_(std::move(path)),
      scene_(std::move(scene)),
      request_(std::move(request)),
      journal_(std::make_unique<Journal>(path_ / journal_name)) {}

std::string SceneFolder::kind_of(const fs::path& folder) {
  if (!fs::is_regular_file(folder / request_name)) return "";
  return read_request(folder).at("kind").get<std::string>();
}

fs::path SceneFolder::cut_file(std::size_t run) const {
  return path_ / "cuts" / fmt::format("{:03}.h5", run + 1);
}

SceneFolder SceneFolder::create(const fs::path& folder, const InputFile& scene, SceneRequest request,
                                const std::string& code) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file; name a folder for the {}", folder.string(), request.kind),
                     ExitCode::usage);
  if (fs::is_regular_file(folder / request_name)) {
    const Json kept = read_request(folder);
    require_same_request(folder, kept, request, scene.hash());
    require_same_code(folder, kept, code);
  } else if (fs::exists(folder / journal_name)) {
    throw InputError(
        fmt::format("{}: holds something else than a {}; name another folder", folder.string(), request.kind),
        ExitCode::usage);
  }
  write_atomically(folder / scene_copy, scene.content);
  // The request comes last: a folder that has it has all that a resume needs.
  write_atomically(folder / request_name, to_json(request, scene, code).dump(2) + "\n");
  return {folder, scene, std::move(request)};
}

SceneFolder SceneFolder::open(const fs::path& folder, int jobs, const std::string& code) {
  const Json kept = read_request(folder);
  require_same_code(folder, kept, code);
  const Json& scene = kept.at("scene");
  const fs::path copy = folder / scene.at("copy").get<std::string>();
  InputFile file{.name = scene.at("name").get<std::string>(), .content = read_file(copy)};
  const auto kind = kept.at("kind").get<std::string>();
  if (scene.at("sha256") != file.hash())
    throw InputError(fmt::format("{}: was changed since the {} began; put it back, or begin again with `kerf {}`",
                                 copy.string(), kind, kind));
  return {folder,
          std::move(file),
          {.kind = kind,
           .asked = kept.at("asked"),
           .jobs = jobs > 0 ? jobs : kept.at("jobs").get<int>(),
           .keep_cuts = kept.at("keep_cuts").get<bool>()}};
}

}  // namespace kerf::inverse
