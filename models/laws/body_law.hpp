#pragma once

#include <concepts>
#include <variant>
#include <vector>

#include "models/laws/hencky.hpp"
#include "models/laws/hill.hpp"
#include "models/laws/ideal_gas.hpp"
#include "models/laws/ideal_rubber.hpp"
#include "models/laws/j2.hpp"
#include "models/laws/mechanical.hpp"
#include "models/laws/mie_gruneisen.hpp"

namespace kerf::laws {

/// The laws that a body may follow: those of heat and stress, and those that a cut knows. A new one is one file and one
/// line here.
using BodyLaw = std::variant<IdealGas,                                 //
                             IdealRubber,                              //
                             MieGruneisen,                             //
                             Mechanical<J2<LinearHardening>>,          //
                             Mechanical<J2<PowerHardening>>,           //
                             Mechanical<J2<SaturatingHardening>>,      //
                             Mechanical<Hencky<LinearHardening>>,      //
                             Mechanical<Hencky<PowerHardening>>,       //
                             Mechanical<Hencky<SaturatingHardening>>,  //
                             Mechanical<Hill>>;

template <class Law>
concept LawOfBody = requires(const Law& law, const Values& values, const StrainIncrement& strain, BodyPoints& points) {
  { Law::name() } -> std::same_as<std::string>;
  { Law::meaning() } -> std::same_as<std::string>;
  { Law::parameters() } -> std::same_as<std::vector<Parameter>>;
  { Law::from(values) } -> std::same_as<Law>;
  { Law::memory() } -> std::same_as<std::vector<Memory>>;
  { Law::is_thermal } -> std::convertible_to<bool>;
  { law.mass_density() } -> std::same_as<double>;
  {law.deform(strain, points)};
  { law.find_stress(points) } -> std::same_as<bool>;
  { law.energy(points) } -> std::same_as<Lanes>;
  { law.wave_speed(points) } -> std::same_as<Lanes>;
};

/// What a law of heat and stress offers besides: S = c ln T + s(F), the part s that the deformation decides, and c.
template <class Law>
concept ThermalLaw = LawOfBody<Law> && Law::is_thermal && requires(const Law& law, const BodyPoints& points) {
  { law.heat_capacity() } -> std::same_as<double>;
  { law.configurational_entropy(points) } -> std::same_as<Lanes>;
};

/// c, N/(mm^2 K); zero of a law without a temperature.
double heat_capacity(const BodyLaw& law);
/// Where a body's temperature begins if nobody says, K.
double reference_temperature(const BodyLaw& law);
/// Is this a law of heat and stress, which exchanges heat with a bath?
bool is_thermal(const BodyLaw& law);

/// One [[body]] block per law, each beginning with `common`.
std::vector<Block> body_blocks(const std::vector<Parameter>& common);

/// The law that `values` names. Its variant was validated by the reader.
BodyLaw make_body_law(const Values& values);

}  // namespace kerf::laws
