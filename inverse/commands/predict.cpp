#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "inverse/commands/commands.hpp"
#include "models/base/document.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"
#include "models/chip/closed_form.hpp"

namespace kerf::commands {
namespace {

using nlohmann::ordered_json;

const chip::ClosedForm& find_model(const std::string& name) {
  if (const auto* model = chip::find_closed_form(name)) return *model;
  std::vector<std::string> names;
  for (const auto& form : chip::closed_forms()) names.push_back(form.name);
  const auto near = nearest(name, names);
  throw InputError(fmt::format("kerf predict: there is no model \"{}\"; {}the models are {}", name,
                               near ? fmt::format("did you mean \"{}\"? ", *near) : "", fmt::join(names, ", ")),
                   ExitCode::usage);
}

/// A value as a document spells it: pure numbers bare, everything else (quantities, words) quoted.
std::string document_value(const Parameter* parameter, const std::string& value) {
  if (parameter && parameter->kind == Parameter::Kind::number && parameter->unit == "1") {
    try {
      if (const auto quantity = split_quantity(value); quantity.unit.empty()) {
        return fmt::format("{}", quantity.number);
      }
    } catch (const std::invalid_argument&) {
      // Not a number: the reader says what is allowed.
    }
  }
  return ordered_json(value).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// The keys go through the same door as a scene file, one argument to a line: the same checks, units and messages.
Values read_arguments(const chip::ClosedForm& model, const std::vector<std::string>& arguments) {
  std::string toml;
  for (const auto& argument : arguments) {
    const auto equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(fmt::format("kerf predict: \"{}\" is not of the form key=value, as in depth=0.5mm", argument),
                       ExitCode::usage);
    }
    const std::string key = argument.substr(0, equals);
    const auto declared = std::find_if(model.parameters.begin(), model.parameters.end(),
                                       [&](const Parameter& parameter) { return parameter.key == key; });
    const auto* parameter = declared == model.parameters.end() ? nullptr : &*declared;
    const bool bare =
        key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
    toml += fmt::format("{} = {}\n", bare ? key : document_value(nullptr, key),
                        document_value(parameter, argument.substr(equals + 1)));
  }
  try {
    const Block keys{
        .path = "", .variant = "", .meaning = model.meaning, .parameters = model.parameters, .required = true};
    return Document::parse(toml, "kerf predict " + model.name).read({keys}).at("");
  } catch (const InputError& error) {
    throw InputError(error.what(), ExitCode::usage);
  }
}

/// Null stands for what does not exist: no solution, an infinite radius.
ordered_json in_unit(double value, const std::string& unit) {
  const double converted = value / consistent_units_in(unit);
  return {{"value", std::isfinite(converted) ? ordered_json(converted) : ordered_json(nullptr)}, {"unit", unit}};
}

ordered_json to_json(const chip::ClosedForm& model, const chip::ChipPrediction& prediction) {
  ordered_json json{
      {"model", model.name}, {"F_c", in_unit(prediction.F_c, "N/m")}, {"F_t", in_unit(prediction.F_t, "N/m")}};
  if (prediction.shear_angle) json["shear_angle"] = in_unit(*prediction.shear_angle, "deg");
  for (const auto& detail : prediction.details) json[detail.key] = in_unit(detail.value, detail.unit);
  if (prediction.touching) json["touching"] = *prediction.touching;
  json["valid"] = prediction.valid;
  if (!prediction.valid) json["reason"] = prediction.reason;
  return json;
}

void print_table(const chip::ClosedForm& model, const chip::ChipPrediction& prediction) {
  const auto row = [](const std::string& key, double value, const std::string& unit, const std::string& meaning) {
    fmt::print("  {:<15} {:>12.6g} {:<6} {}\n", key, value / consistent_units_in(unit), unit == "1" ? "" : unit,
               meaning);
  };
  fmt::print("{}: {}\n", model.name, model.meaning);
  row("F_c", prediction.F_c, "N/m", "cutting force per width");
  row("F_t", prediction.F_t, "N/m", "transverse force per width, positive pushes the tool away");
  if (prediction.shear_angle) row("shear_angle", *prediction.shear_angle, "deg", "shear plane to crack plane");
  for (const auto& detail : prediction.details) row(detail.key, detail.value, detail.unit, detail.meaning);
  if (prediction.touching) fmt::print("  {:<15} {:>12}\n", "touching", *prediction.touching ? "yes" : "no");
  if (!prediction.valid) fmt::print("  not valid: {}\n", prediction.reason);
}

std::string model_help() {
  std::string help = "Models and their keys (key=value; quantities carry a unit, as in depth=0.5mm):\n";
  for (const auto& form : chip::closed_forms()) {
    help += fmt::format("  {}: {}\n", form.name, form.meaning);
    for (const auto& parameter : form.parameters) {
      help += fmt::format("    {:<20} {}{}{}\n", parameter.key, parameter.meaning,
                          parameter.unit == "1" ? "" : fmt::format(" [{}]", parameter.unit),
                          parameter.fallback ? fmt::format(", default {}", *parameter.fallback) : "");
    }
  }
  return help;
}

}  // namespace

void add_predict(CLI::App& app, int& exit_code) {
  struct Options {
    std::string model;
    std::vector<std::string> arguments;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("predict", "Cutting force of a closed form");
  command->add_option("MODEL", options->model, "chip_force, shear_minimised, atkins, plastic_bending or cohesive_beam")
      ->required();
  command->add_option("KEYS", options->arguments, "key=value, quantities with their unit");
  command->add_flag("--json", options->json, "machine-readable result");
  command->footer(model_help);
  command->callback([options, &exit_code] {
    const auto& model = find_model(options->model);
    const auto prediction = model.predict(read_arguments(model, options->arguments));
    if (options->json) {
      fmt::print("{}\n", to_json(model, prediction).dump(2));
    } else {
      print_table(model, prediction);
    }
    exit_code = static_cast<int>(ExitCode::success);
  });
}

}  // namespace kerf::commands
