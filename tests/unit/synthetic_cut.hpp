#pragma once

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/run.hpp"
#include "inverse/calibration.hpp"
#include "inverse/job.hpp"
#include "inverse/journal.hpp"
#include "inverse/run_database.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/chip/rake_face.hpp"
#include "models/chip/shear_minimised.hpp"

// Calibrations of a cut that costs nothing: Williams' minimised shear plane, theory.md Eq. (4), answers in the place of
// the simulation. What the optimisers, the journal and the verdicts do does not depend on who answers.
namespace kerf::testing {

struct Truth {
  double yield_stress = 60, toughness = 2, friction = 0.3, edge_force = 0;  // MPa, N/mm, 1, N/mm
};

struct Forces {
  double F_c, F_t, chip_ratio;
};

inline Forces synthetic_forces(double depth, double rake, const Truth& truth) {
  const auto plane = chip::shear_minimised(depth, rake, truth.yield_stress, truth.toughness, truth.friction, 0.0);
  const double cot_phi = (plane.forces.F_c - truth.toughness) / (truth.yield_stress * depth);  // Eq. (4)
  return {plane.forces.F_c, plane.forces.F_t + truth.edge_force, std::cos(rake) * cot_phi + std::sin(rake)};
}

inline forward::CutResult synthetic_cut(const forward::Scene& scene) {
  const Forces forces = synthetic_forces(scene.cut.depth, scene.tool.rake,
                                         {.yield_stress = std::sqrt(3.0) * laws::shear_yield(scene.material),
                                          .toughness = scene.cohesive.mode_I->toughness(),
                                          .friction = scene.friction->coefficient});
  forward::CutResult result;
  result.F_c.value = forces.F_c;
  result.F_t.value = forces.F_t;
  result.chip_ratio.value = forces.chip_ratio;
  result.steady = result.accepted = true;
  return result;
}

/// A cut whose force halves from this flow stress (MPa) on, where the crack runs ahead of the tool.
inline inverse::Simulator jump_at(double flow_stress) {
  return [flow_stress](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    if (std::sqrt(3.0) * laws::shear_yield(scene.material) > flow_stress) {
      result.branch = forward::Branch::bending;
      result.F_c.value *= 0.5;
    }
    return result;
  };
}
inline forward::CutResult two_branches(const forward::Scene& scene) {
  return jump_at(61)(scene);
}

/// Refuses a fixed `share` of all scenes, picked by their numbers: the same scene fails every time.
inline inverse::Simulator failing(double share, inverse::Simulator simulate) {
  return [share, simulate = std::move(simulate)](const forward::Scene& scene) {
    forward::CutResult result = simulate(scene);
    const double mixed = std::sin(1e4 * result.F_c.value + 1e5 * result.F_t.value) * 1e4;
    if (mixed - std::floor(mixed) < share) {
      result.accepted = false;
      result.refusals = {"made to fail"};
      result.F_c.value = result.F_t.value = 1e9;  // what a blown-up run may leave behind
    }
    return result;
  };
}

/// A folder that is gone afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static std::atomic<int> count = 0;
    // In memory where possible: journals flush every line, which a disk answers slowly.
    const std::filesystem::path memory = "/dev/shm";
    const auto parent = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = parent / fmt::format("kerf_test_{}_{}", ::getpid(), count++);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline constexpr const char* scene_text = R"(title = "a cut to patch"
[material]
law = "j2"
elastic_modulus = "1000 MPa"
poisson_ratio = 0.33
density = "1 g/cm^3"
yield_stress = "40 MPa"
[cohesive]
[cohesive.mode_I]
law = "cubic"
strength = "40 MPa"
toughness = "1000 J/m^2"
[cohesive.mode_II]
law = "cubic"
strength = "40 MPa"
toughness = "1000 J/m^2"
[cut]
depth = "0.5 mm"
speed = "10 m/s"
travel = 6
[tool]
rake = "30 deg"
[friction]
coefficient = 0.2
[resolution]
cells_through_chip = 4
)";

inline constexpr const char* job_text = R"(title = "a twin"
scene = "scene.toml"
observables = ["F_c", "F_t", "chip_ratio"]
[[curve]]
file = "curve.csv"
[[free]]
path = "material.yield_stress"
lower = "10 MPa"
upper = "300 MPa"
key = true
[[free]]
path = "cohesive.mode_I.toughness"
lower = "100 J/m^2"
upper = "20 kJ/m^2"
[[free]]
path = "friction.coefficient"
lower = 0.02
upper = 1.5
[[tie]]
path = "cohesive.mode_II.toughness"
equals = 1
of = "cohesive.mode_I.toughness"
)";

/// `text` with one occurrence of `what` replaced; an unchanged text would test nothing, so that is an error.
inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("\"" + what + "\" is not there to replace");
  return text.replace(at, what.size(), with);
}

/// Rows of the measured twin: depths in mm, relative scatter of every value, and its seed (0: no scatter).
inline std::string curve_text(const Truth& truth, const std::vector<double>& depths, double scatter = 0.02,
                              unsigned seed = 0, double rake_degrees = 30) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::string text = fmt::format("#: rake = {} deg\n", rake_degrees) +
                     "depth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm],chip_ratio,chip_ratio_sd\n";
  for (const double depth : depths) {
    const Forces forces = synthetic_forces(depth, rake_degrees * std::acos(-1.0) / 180, truth);
    const double F_t_error = scatter * forces.F_c;
    const auto disturbed = [&](double value, double error) {
      return seed == 0 ? value : value + error * normal(random);
    };
    text +=
        fmt::format("{},{:.15g},{:.15g},{:.15g},{:.15g},{:.15g},{:.15g}\n", depth,
                    disturbed(forces.F_c, scatter * forces.F_c), scatter * forces.F_c, disturbed(forces.F_t, F_t_error),
                    F_t_error, disturbed(forces.chip_ratio, scatter * forces.chip_ratio), scatter * forces.chip_ratio);
  }
  return text;
}

/// Scene, curve and job in a folder.
inline inverse::Job write_job(const TemporaryFolder& folder, const std::string& job = job_text,
                              const std::string& curve = curve_text({}, {0.1, 0.2, 0.4, 0.8}),
                              const std::string& scene = scene_text) {
  write_atomically(folder / "scene.toml", scene);
  write_atomically(folder / "curve.csv", curve);
  write_atomically(folder / "job.toml", job);
  return inverse::read_job(folder / "job.toml");
}

struct Outcome {
  inverse::Calibration calibration;
  std::size_t runs, simulated;
};

inline Outcome calibrate(const inverse::Job& job, const std::filesystem::path& journal_file,
                         const inverse::Simulator& simulate = synthetic_cut, int parallel = 2) {
  inverse::Journal journal(journal_file);
  inverse::RunDatabase database(journal, "test", simulate, parallel);
  inverse::Calibration calibration = inverse::calibrate(job, database);
  return {std::move(calibration), database.runs(), database.simulated()};
}

inline double value(const inverse::Calibration& calibration, const std::string& name) {
  return calibration.fit.identifiability.find(name)->value;
}

}  // namespace kerf::testing
