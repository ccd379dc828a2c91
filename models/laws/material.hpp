#pragma once

#include <concepts>
#include <variant>
#include <vector>

#include "models/laws/hencky.hpp"
#include "models/laws/hill.hpp"
#include "models/laws/j2.hpp"

namespace kerf::laws {

/// The registered material laws; a new one is one file and one line here. What a law must offer is `MaterialLaw` below;
/// the solver asks by std::visit once per call, not once per point.
using Material = std::variant<J2<LinearHardening>,          //
                              J2<PowerHardening>,           //
                              J2<SaturatingHardening>,      //
                              Hencky<LinearHardening>,      //
                              Hencky<PowerHardening>,       //
                              Hencky<SaturatingHardening>,  //
                              Hill>;

template <class Law>
concept MaterialLaw = requires(const Law& law, const Values& values, StressPoint stress, const StrainIncrement& strain,
                               MaterialPoints& points) {
  { Law::block() } -> std::same_as<Block>;
  { Law::from(values) } -> std::same_as<Law>;
  { Law::has_axes } -> std::convertible_to<bool>;
  { law.density } -> std::convertible_to<double>;
  { law.plane_strain_modulus() } -> std::same_as<double>;
  { law.wave_speed(1.0, 0.0) } -> std::same_as<double>;
  { law.shear_yield() } -> std::same_as<double>;
  { law.elastic_energy(stress) } -> std::same_as<double>;
  { law.plastic_work(0.0) } -> std::same_as<double>;
  { law.update(strain, points) } -> std::same_as<bool>;
};

inline double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}
inline double plane_strain_modulus(const Material& material) {
  return std::visit([](const auto& law) { return law.plane_strain_modulus(); }, material);
}
inline double shear_yield(const Material& material) {
  return std::visit([](const auto& law) { return law.shear_yield(); }, material);
}
inline bool has_axes(const Material& material) {
  return std::visit([](const auto& law) { return law.has_axes; }, material);
}

/// One [material] block per law.
const std::vector<Block>& material_blocks();

/// The law that `values` names. Its variant was validated by the reader.
Material make_material(const Values& values);

}  // namespace kerf::laws
