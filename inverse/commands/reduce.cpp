#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "data/curve.hpp"
#include "inverse/closed_form_reduction.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/reduction_json.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"
#include "models/chip/reduction.hpp"

namespace kerf::commands {
namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& method : chip::fit_methods()) names.push_back(method.name);
  return names;
}

void check_method(const std::string& name) {
  if (chip::find_fit_method(name)) return;
  const auto names = method_names();
  const auto near = nearest(name, names);
  throw InputError(fmt::format("kerf reduce: there is no method \"{}\"; {}the methods are {}", name,
                               near ? fmt::format("did you mean \"{}\"? ", *near) : "", fmt::join(names, ", ")),
                   ExitCode::usage);
}

double modulus_from(const std::string& text) {
  try {
    const auto quantity = split_quantity(text);
    if (quantity.unit.empty()) throw std::invalid_argument("has no unit");
    if (!same_dimension(quantity.unit, "MPa")) throw std::invalid_argument("is no stress");
    if (quantity.number <= 0.0) throw std::invalid_argument("is not above zero");
    return quantity.number * consistent_units_in(quantity.unit);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("kerf reduce: --elastic-modulus \"{}\" is refused: {}; write for example \"114 GPa\"",
                                 text, error.what()),
                     ExitCode::usage);
  }
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

/// Zero instead of the rounding error of a minimum that lies there.
double rounded(const chip::FittedParameter& parameter) {
  return std::abs(parameter.value) < 1e-6 * parameter.standard_error ? 0 : parameter.value;
}

void print_method(const chip::MethodResult& result) {
  fmt::print("\n{}: {}\n", result.method, result.meaning);
  if (!result.not_applied.empty()) {
    fmt::print("  not applied: {}\n", result.not_applied);
    return;
  }
  for (const auto& parameter : result.fit.parameters) {
    const double scale = consistent_units_in(parameter.unit);
    fmt::print("  {:<19} {:>10} +- {:<9} {:>10} ... {:<10} {:<7} {}\n", parameter.name,
               number(rounded(parameter) / scale), number(parameter.standard_error / scale),
               number(parameter.lower / scale), number(parameter.upper / scale),
               parameter.unit == "1" ? "" : parameter.unit, inverse::verdict_of(result, parameter));
  }
  fmt::print("  {}{}\n", inverse::verdict_of(result),
             result.fit.aicc ? fmt::format(", AICc = {:.4g} ({} forces)", *result.fit.aicc, result.fit.data) : "");
}

void print_tables(const data::Curve& curve, const chip::Reduction& reduction) {
  fmt::print("{}: {} cuts. Value, standard error, 95 % interval (-: no limit), verdict.\n", curve.name,
             curve.points.size());
  for (const auto& result : reduction.methods) print_method(result);
  for (const auto& line : reduction.friction_lines) {
    fmt::print("\nfriction line at rake {:.3g} deg: F_t = Z F_c + c over {} cuts\n",
               line.rake / consistent_units_in("deg"), line.points);
    fmt::print("  Z = {:.4g} +- {:.2g} (friction {:.3g} +- {:.2g}), c = {:.4g} +- {:.2g} N/mm, scatter {:.3g} N/mm\n",
               line.slope.value, line.slope.standard_error, line.friction.value, line.friction.standard_error,
               line.intercept.value, line.intercept.standard_error, line.scatter);
  }
  if (!reduction.warnings.empty()) fmt::print("\n");
  for (const auto& warning : reduction.warnings) fmt::print("warning: {}\n", warning);
}

}  // namespace

void add_reduce(CLI::App& app, int& exit_code) {
  struct Options {
    std::string curve;
    std::vector<std::string> methods;
    std::string elastic_modulus;
    chip::FitOptions fit;
    bool plane_stress = false;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("reduce", "Toughness from a measured curve by closed forms and intercepts");
  command->add_option("CURVE", options->curve, "CSV file with units in its header")->required();
  command->add_option("--method", options->methods, "only these methods (default: all that suit the data)");
  command->add_option("--elastic-modulus", options->elastic_modulus, "with its unit; lets plastic_bending take part");
  command->add_option("--poisson-ratio", options->fit.poisson_ratio, "for plastic_bending")
      ->check(CLI::Range(-0.99, 0.5))
      ->capture_default_str();
  command->add_option("--hardening-ratio", options->fit.hardening_ratio, "E_t/E, for plastic_bending")
      ->check(CLI::Range(0.0, 0.999))
      ->capture_default_str();
  command->add_option("--root-rotation", options->fit.root_rotation, "chi, for plastic_bending")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_flag("--plane-stress", options->plane_stress, "for plastic_bending; default plane strain");
  command->add_flag("--json", options->json, "machine-readable result");
  command->footer([] { return fmt::format("Methods: {}", fmt::join(method_names(), ", ")); });
  command->callback([options, &exit_code] {
    for (const auto& method : options->methods) check_method(method);
    auto fit = options->fit;
    fit.plane_strain = !options->plane_stress;
    if (!options->elastic_modulus.empty()) fit.elastic_modulus = modulus_from(options->elastic_modulus);

    const auto curve = data::read_curve(options->curve);
    const auto measurements = inverse::measurements_of(curve);
    auto reduction = chip::reduce(measurements, options->methods, fit);
    reduction.warnings.insert(reduction.warnings.begin(), curve.notes.begin(), curve.notes.end());
    if (options->json) {
      fmt::print("{}\n", inverse::to_json(reduction, measurements).dump(2));
    } else {
      print_tables(curve, reduction);
    }
    exit_code = static_cast<int>(ExitCode::success);
  });
}

}  // namespace kerf::commands
