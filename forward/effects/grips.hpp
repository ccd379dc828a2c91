#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// A cracked specimen instead of a cut: the arms' ends are pulled apart (or one of them away from the clamped rest) in
/// the direction of y. A grip holds the markers of a short stretch of its arm's crack face by springs to an anchor that
/// moves; the arm may turn there and slide along. Nothing but the pull acts there, so that with P the pull per width
/// and theta the rotation of the arm at the grip the energy release rate of crack tip and bridging zone together is
///     J = sum over the arms of P sin(theta)                        (J-integral around the specimen)
/// whatever the law of the zone (Paris & Paris 1988; Andersson & Stigh 2004). When one arm alone is pulled, a
/// section of the uncracked end takes away its own P sin(theta) and the energy of bending that it stores.

/// Moves the anchors with the speed ramp and clears the step's forces.
void move_grips(State& state, const Scene& scene);

/// Pulls the arms; `stiffness` in MPa/mm per length of face.
void pull_arms(State& state, const Scene& scene, double stiffness);

}  // namespace kerf::forward
