#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "models/base/document.hpp"
#include "models/base/error.hpp"
#include "models/chip/cohesive_beam.hpp"
#include "models/chip/plastic_bending.hpp"
#include "models/chip/rake_face.hpp"
#include "models/chip/root_rotation.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::chip {

namespace {

/// What a law may ask for beside its strength and toughness.
constexpr std::array<const char*, 3> shape_keys{"peak", "bridging_stress", "bridging_toughness"};

std::vector<std::string> shapes() {
  std::vector<std::string> names;
  for (const auto& kind : laws::traction_laws()) names.push_back(kind.name);
  return names;
}

/// The registered law of one mode, read through the same door as that of a scene. Its keys are the law's own after
/// `prefix`.
std::unique_ptr<laws::TractionLaw> make_law(const Values& cut, const std::string& prefix) {
  const std::string& shape = cut.text(prefix + "shape");
  const auto& kinds = laws::traction_laws();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const auto& law) { return law.name == shape; });
  std::vector<std::string> keys{"strength", "toughness"};
  for (const char* key : shape_keys) {
    if (!cut.has(prefix + key)) continue;
    const auto takes = [&](const Parameter& parameter) { return parameter.key == key; };
    if (std::none_of(kind->parameters.begin(), kind->parameters.end(), takes)) {
      throw InputError(fmt::format("{}: the {} law takes no {}", cut.where(prefix + key), shape, key), ExitCode::usage);
    }
    keys.emplace_back(key);
  }
  std::string toml = fmt::format("[mode]\nlaw = \"{}\"\n", shape);
  for (const auto& key : keys) {
    const double value = cut.number(prefix + key);
    if (key == "peak") {
      toml += fmt::format("{} = {}\n", key, value);
    } else {
      toml += fmt::format("{} = \"{} {}\"\n", key, value, key.ends_with("toughness") ? "N/mm" : "MPa");
    }
  }
  std::vector<Block> blocks;
  blocks.reserve(kinds.size());
  for (const auto& law : kinds)
    blocks.push_back({.path = "mode", .variant = law.name, .meaning = law.meaning, .parameters = law.parameters});
  try {
    return laws::make_traction_law(Document::parse(toml, "law").read(blocks).at("mode"));
  } catch (const InputError& error) {  // stands at a place of the text above: say where the user wrote the shape
    const std::string message = error.what();
    throw InputError(cut.where(prefix + "shape") + message.substr(message.find(": ")), ExitCode::usage);
  }
}

std::string out_of_range(const CohesiveBeam& beam, const CohesiveBeamSolution& chip) {
  if (chip.touching) {
    return fmt::format(
        "touching: the contact is {:.3g} mm of chip behind the crack front and the tool's tip {:.3g} mm, on a chip "
        "{:.3g} "
        "mm thick: the tool works at the crack tip, where a beam resolves nothing, and the force is that of shearing",
        chip.contact_length, chip.front_gap, beam.depth);
  }
  if (beam.depth * chip.root_curvature > 1.0) {
    return fmt::format("the chip bends to a radius of {:.3g} mm, less than its thickness: no beam",
                       1.0 / chip.root_curvature);
  }
  const auto least = std::min_element(chip.sections.begin(), chip.sections.end(),
                                      [](const auto& a, const auto& b) { return a.curvature < b.curvature; });
  if (least->curvature < -beam.yield_curvature()) {
    return "the layer ahead of the crack yields in reverse, which the model leaves out";
  }
  return {};
}

ChipPrediction predict(const Values& cut) {
  const bool plane_strain = cut.text("plane") == "strain";
  const double along = cut.number("elastic_modulus");
  const double poisson = cut.number("poisson_ratio");
  const double across = cut.has("modulus_across") ? cut.number("modulus_across") : along;
  const double shear = cut.has("shear_modulus") ? cut.number("shear_modulus") : 0.5 * along / (1.0 + poisson);
  const double depth = cut.number("depth");
  const double modulus = plane_modulus(along, poisson, plane_strain);

  const bool sheared = cut.has("shear_strength") || cut.has("shear_toughness");
  if (sheared && !(cut.has("shear_strength") && cut.has("shear_toughness"))) {
    throw InputError(cut.where("shear_strength") + ": shear_strength and shear_toughness go together", ExitCode::usage);
  }
  const auto mode_I = make_law(cut, "");
  const auto mode_II = sheared ? make_law(cut, "shear_") : nullptr;
  const CohesiveBeam beam{
      .depth = depth,
      .rake = cut.number("rake"),
      .friction = cut.number("friction"),
      .modulus = modulus,
      .yield_stress = cut.number("yield_stress") * plane_yield_stress_factor(plane_strain),
      .hardening = cut.number("hardening_ratio"),
      .normal_stiffness = foundation_stiffness(modulus, orthotropic_root_rotation(along, across, shear), depth),
      .shear_stiffness = shear_foundation_stiffness(shear, depth),
      .mode_I = mode_I.get(),
      .mode_II = mode_II.get(),
      .exponent_n = cut.number("exponent_n"),
      .exponent_m = cut.number("exponent_m"),
      .tool_cuts_bridging = cut.text("bridging") == "cut"};
  const auto outcome = solve(beam);
  if (!outcome.solution) {
    auto refused = no_solution(outcome.reason);
    if (outcome.touching) refused.touching = true;
    return refused;
  }
  const auto& chip = *outcome.solution;
  const auto forces =
      with_bottom_force(ToolForces<double>{chip.F_c, chip.F_t}, cut.number("bottom_force"), beam.friction);

  ChipPrediction prediction;
  prediction.F_c = forces.F_c;
  prediction.F_t = forces.F_t;
  prediction.reason = out_of_range(beam, chip);
  prediction.valid = prediction.reason.empty();
  prediction.touching = chip.touching;
  prediction.details = {
      {"normal_force", chip.normal_force, "N/m", "force N per width on the rake face"},
      {"crack_lead", chip.tip_gap, "mm", "lead of the crack tip, nothing carried behind it, over the tool's tip"},
      {"front_lead", chip.front_gap, "mm", "lead of the crack front, the largest traction, over the tool's tip"},
      {"process_zone", chip.process_zone, "mm", "from crack front to crack tip"},
      {"contact_length", chip.contact_length, "mm", "arc from crack front to tool contact"},
      {"root_curvature", chip.root_curvature / beam.yield_curvature(), "1",
       "largest curvature / first-yield curvature, k_0"},
      {"root_angle", chip.crack_tip.rotation, "deg", "rotation of the chip at the crack tip"},
      {"curl_radius", chip.curl_radius, "mm", "radius of the chip after unloading"},
      {"fracture_work", chip.work_I + chip.work_II, "J/m^2", "work of the tractions per area up to failure"},
      {"mode_I_share", chip.area_I / (chip.area_I + chip.area_II), "1", "G_I / (G_I + G_II) at failure"},
      {"plastic_work", chip.plastic_work, "J/m^2", "plastic work W_p per area"},
      {"energy_residue", chip.imbalance, "1", "how far F_c - mu N = G + W_p is missed, relative"},
  };
  return prediction;
}

}  // namespace

ClosedForm cohesive_beam_model() {
  auto shear_shapes = shapes();
  std::erase(shear_shapes, "trilinear");  // five numbers, and nobody measures bridging in shear
  return {
      "cohesive_beam",
      "elastic-plastic beam on its cohesive foundation, solved as a boundary-value problem; needs no root rotation",
      {keys::depth(),
       keys::rake(),
       keys::yield_stress(),
       keys::friction(),
       number("elastic_modulus", "MPa", 1e-3, 1e7, "Young's modulus E_x along the cut"),
       number("modulus_across", "MPa", 1e-3, 1e7, "Young's modulus E_y across the crack plane; absent: isotropic")
           .if_given(),
       number("shear_modulus", "MPa", 1e-3, 1e7, "shear modulus G_xy; absent: isotropic").if_given(),
       number("poisson_ratio", "1", -0.99, 0.5, "Poisson's ratio nu; orthotropic: sqrt(nu_xz nu_zx)").or_else("0.33"),
       number("hardening_ratio", "1", 0, 0.999, "tangent modulus over Young's modulus, a = E_t/E").or_else("0"),
       text("plane", "plane strain or plane stress; stress where the yield stress already holds for the plane",
            {"strain", "stress"})
           .or_else("strain"),
       text("shape", "cohesive law of mode I", shapes()).or_else("cubic"),
       number("strength", "MPa", 1e-4, 1e5, "largest cohesive traction sigma_c of mode I"),
       number("toughness", "J/m^2", 1e-3, 1e7, "area under the law of mode I, bridging included"),
       number("peak", "1", 1e-3, 0.999, "sawtooth: delta_1/delta_c; trilinear: delta_1/delta_2").if_given(),
       number("bridging_stress", "MPa", 1e-6, 1e5, "trilinear: traction sigma_b at which bridging sets in").if_given(),
       number("bridging_toughness", "J/m^2", 1e-3, 1e7, "trilinear: share G_b of the toughness").if_given(),
       text("shear_shape", "cohesive law of mode II", std::move(shear_shapes)).or_else("cubic"),
       number("shear_strength", "MPa", 1e-4, 1e5, "largest cohesive traction of mode II; absent: no shear carried")
           .if_given(),
       number("shear_toughness", "J/m^2", 1e-3, 1e7, "area under the law of mode II").if_given(),
       number("shear_peak", "1", 1e-3, 0.999, "sawtooth of mode II: delta_1/delta_c").if_given(),
       number("exponent_n", "1", 0.1, 10, "mixed-mode exponent n of mode I").or_else("1"),
       number("exponent_m", "1", 0.1, 10, "mixed-mode exponent m of mode II").or_else("1"),
       text("bridging", "does the tool's tip cut what still bridges the crack, or ignore it?", {"ignore", "cut"})
           .or_else("ignore"),
       keys::bottom_force()},
      predict};
}

}  // namespace kerf::chip
