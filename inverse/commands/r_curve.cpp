#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "data/r_curve.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/commands/commands.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"
#include "models/chip/bridged_arms.hpp"
#include "models/laws/trilinear.hpp"

namespace kerf::commands {
namespace {

/// The specimen of a scene with grips: its arms are as high as its depth of cut.
chip::Arms arms_of(const forward::Scene& scene, const std::string& file) {
  if (!scene.grips) throw InputError(file + ": a specimen has a [grips] block; see data/scenes/dcb_rcurve.toml");
  if (!scene.grips->both_arms || std::abs(scene.grips->lower_arm / scene.cut.depth - 1) > 1e-9)
    throw InputError(file +
                     ": the closed form is for two equal arms (grips.arms = \"both\", lower_arm = 1); for another "
                     "specimen use `kerf calibrate` (data/jobs/wood_tl_r_curve.toml)");
  chip::Arms arms{.modulus = 0,
                  .transverse_modulus = 0,
                  .shear_modulus = 0,
                  .height = scene.cut.depth,
                  .notch = scene.cut.notch * scene.cut.depth - scene.grips->position};
  if (!(arms.notch > 0)) throw InputError(file + ": the grips (grips.position) hold the specimen ahead of its notch");
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.elastic_modulus; }) {
          arms.modulus = arms.transverse_modulus = law.plane_strain_modulus();
          arms.shear_modulus = 0.5 * arms.modulus;
        } else {
          const auto& c = law.constants();
          const double xz = -c.poisson_xz / c.modulus_x, yz = -c.poisson_yz / c.modulus_y;  // compliances
          arms.modulus = 1 / (1 / c.modulus_x - xz * xz * c.modulus_z);
          arms.transverse_modulus = 1 / (1 / c.modulus_y - yz * yz * c.modulus_z);
          const double b_12 = -c.poisson_xy / c.modulus_x - xz * yz * c.modulus_z;
          arms.shear_modulus = 1 / (1 / c.shear_modulus_xy + 2 * b_12);
        }
      },
      scene.material);
  return arms;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// A fit that does not describe the curve measures nothing.
std::string verdict(const chip::Fit& fit, const chip::FittedParameter& parameter) {
  return fit.rejected() ? "fit rejected" : chip::in_words(parameter.verdict);
}

nlohmann::ordered_json to_json(const chip::Fit& fit) {
  nlohmann::ordered_json json{{"chi2", number(fit.chi2)},
                              {"degrees_of_freedom", fit.freedom},
                              {"rejected", fit.rejected()},
                              {"parameters", {}}};
  for (const chip::FittedParameter& p : fit.parameters) {
    const double one = consistent_units_in(p.unit);
    json["parameters"][p.name] = {{"value", number(p.value / one)},
                                  {"se", number(p.standard_error / one)},
                                  {"interval", {number(p.lower / one), number(p.upper / one)}},
                                  {"unit", p.unit},
                                  {"verdict", verdict(fit, p)}};
  }
  return json;
}

void print(const chip::Fit& fit) {
  for (const chip::FittedParameter& p : fit.parameters) {
    const double one = consistent_units_in(p.unit);
    fmt::print("{:<21}{:>9.4g} +- {:<8.3g}{:>9.4g} ... {:<9.4g}{:<7} {}\n", p.name, p.value / one,
               p.standard_error / one, p.lower / one, p.upper / one, p.unit, verdict(fit, p));
  }
  fmt::print("chi2 = {:.3g} with {} degrees of freedom{}\n", fit.chi2, fit.freedom,
             fit.rejected() ? ": the beams do not describe this curve" : "");
}

}  // namespace

void add_r_curve(CLI::App& app, int& exit_code) {
  struct Options {
    std::string curve, scene;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("r-curve", "Initiation and bridging toughness from a measured R-curve");
  command->add_option("CURVE", options->curve, "CSV file with crack_extension[mm], G[J/m^2], G_sd[J/m^2]")->required();
  command->add_option("--specimen", options->scene, "scene of the specimen (TOML with [grips])")->required();
  command->add_flag("--json", options->json, "machine-readable result");
  command->footer(
      "Two bridged arms as Timoshenko beams: the trilinear law's G_init, G_b and bridging stress; strength and peak "
      "are "
      "the\n"
      "scene's, and with another law the initiation happens in a point. Exit code 4: the beams do\n"
      "not describe this curve. 6: it does not measure one of the toughnesses.");
  command->callback([options, &exit_code] {
    std::vector<chip::ResistancePoint> points;
    for (const data::ResistanceRow& row : data::read_r_curve(options->curve))
      points.push_back({.extension = row.extension, .G_R = row.G, .standard_error = row.sd.value_or(0)});
    const forward::Scene scene = forward::read_scene(Document::parse(read_file(options->scene), options->scene));
    chip::BridgedCrack known;
    if (const auto* law = dynamic_cast<const laws::Trilinear*>(scene.cohesive.mode_I.get())) {
      known.strength = law->shape().strength;
      known.peak = law->shape().peak_opening / law->shape().knee_opening;
    }
    const chip::Fit fit = chip::fit_r_curve(arms_of(scene, options->scene), points, known);
    if (options->json)
      fmt::print("{}\n", to_json(fit).dump(2));
    else
      print(fit);
    exit_code = static_cast<int>(!fit.converged || fit.rejected() ? ExitCode::not_converged
                                 : fit.parameters[0].verdict == chip::Verdict::measured &&
                                         fit.parameters[1].verdict == chip::Verdict::measured
                                     ? ExitCode::success
                                     : ExitCode::not_identifiable);
  });
}

}  // namespace kerf::commands
