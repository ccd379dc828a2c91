#include "inverse/manifest.hpp"

#include <H5public.h>
#include <ceres/version.h>
#include <fmt/format.h>
#include <nlopt.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <Eigen/Core>
#include <ctime>
#include <fstream>

#include "models/base/document.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json libraries() {
  int major = 0, minor = 0, bugfix = 0;
  nlopt_version(&major, &minor, &bugfix);
  return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"Ceres", CERES_VERSION_STRING},
          {"NLopt", fmt::format("{}.{}.{}", major, minor, bugfix)},
          {"HDF5", fmt::format("{}.{}.{}", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)}};
}

Json input(const InputFile& file) {
  return {{"name", file.name}, {"sha256", file.hash()}};
}

}  // namespace

double processor_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Json code_and_machine(const std::string& code) {
  utsname system{};
  ::uname(&system);
  return {{"version", KERF_VERSION},
          {"executable_sha256", code},
          {"compiler", fmt::format("GCC-compatible {}", __VERSION__)},
          {"libraries", libraries()},
          {"machine",
           {{"processor", processor()},
            {"cores", ::sysconf(_SC_NPROCESSORS_ONLN)},
            {"system", fmt::format("{} {}", system.sysname, system.release)}}}};
}

Json manifest(const Job& job, const std::string& code, double wall_seconds) {
  Json inputs = Json::array({input(job.source), input(job.scene_file)});
  for (const MeasuredCurve& curve : job.curves) {
    inputs.push_back(input(curve.file));
    if (curve.specimen_file) inputs.push_back(input(*curve.specimen_file));
  }
  Json manifest = code_and_machine(code);
  manifest["inputs"] = std::move(inputs);
  manifest["job"] = Document::parse(job.source.content, job.source.name).canonical();
  manifest["scene"] = job.scene.canonical();
  manifest["max_runs"] = job.budget.max_runs;
  manifest["parallel"] = job.budget.parallel;
  manifest["wall_s"] = wall_seconds;
  manifest["processor_s_of_last_session"] = processor_seconds();
  return manifest;
}

}  // namespace kerf::inverse
