#pragma once

#include "forward/bodies/run.hpp"

namespace kerf::forward::bodies {

/// What the scene asks to be read off its run, name to number. `measures` in the scene names them:
/// - cycle: four strokes, isothermal and adiabatic in turn. efficiency (work given off over heat taken in at the hotter
///   bath), carnot_efficiency 1 - T_c/T_h, net_entropy_ratio |Q_h/T_h + Q_c/T_c| / |Q_h/T_h|, closing_temperature_error
///   (temperature at the end over T_h, less one); of one ideal gas also pv_gamma_error, the largest relative departure
///   of p V^gamma from its value at the start of an adiabatic stroke; of a metal that yields also entropy_made, of the
///   body and the baths, and entropy_made_by_yielding, beta W_p over the mean temperature, and work_lost, T_c times it
/// - expansion: first_step_temperature_change, K, and what the law says, -gamma_0 T dJ, of one Mie-Grueneisen body
/// - rubber: of one ideal rubber, stroke 1 isothermal: heat_over_work, heat given off over work taken in (1: dq = -dw);
///   first adiabatic stroke: adiabatic_temperature_error against T exp((w - w_0)/(c T_0)) of an incompressible strip,
///   and adiabatic_over_isothermal_modulus, chords over its second half, with the closed form beside it
/// - sliding: acceleration (m/s^2) of the bodies' centre of mass along the lower side of the first rigid body, fitted
///   to the second half of the last stroke, that of a block on an incline, g (sin a - mu cos a), and
///   acceleration_error, their difference over g
/// - hertz: of a cylinder pressed on a flat or on another, force (N/mm), half_width (mm) from the second moment of the
///   nodal forces over the second half of the last stroke, peak_pressure (MPa) from their sum over the inner half, and
///   their errors against what the force makes of them in Hertz's contact
/// - rubbing: of two bodies that slide on each other until they have one velocity, friction_heat (N mm/mm) and warming
///   (K, mean over both) against m w^2/2 with the velocity w between them at the start and m = m_1 m_2/(m_1 + m_2), of
///   which either gets half
/// - wedge: of a rigid wedge (a slab) that moves into a body, forces along and across its way (N/mm), means over the
///   second half of the last stroke, and force_ratio, across over along, against Coulomb's cone about the normal of its
///   face, tan(a - atan mu) with the rake a; force_noise, the scatter of the force along about its trend over its mean
/// - modulus: effective_modulus along x of what lies in the box, and effective_modulus_error against layered_modulus()
/// - vibration: frequency (Hz) of a standing wave between walls, its error, and the energy that it lost
nlohmann::ordered_json measure(const BodiesResult& result, const Scene& scene);

}  // namespace kerf::forward::bodies
