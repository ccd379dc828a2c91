#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Contact of bodies on the grid, where each has a velocity field of its own.
///
/// Two bodies touch at a node when everything that [contact] asks holds there: they fill enough of its cell
/// (screening), they come closer, (v_b - v_a).n < 0 (approach), and their surfaces overlap (overlap). The normal n
/// points from a to b and is found from the gradients g of the volumes that the nodes see: along the larger (MVG),
/// along V_b g_b - V_a g_a (AVG), or it is given (SN). Mean positions overlap when (x_b - x_a).n is less than what
/// surfaces that just touch show there: about 0.84 cells if they meet at the node, up to 1.5 beside it, told by how the
/// volume is shared. Displacements, of surfaces that touched at the start, need no such allowance.
///
/// The impulse on b is the one that ends the approach, I_n = -m w_n, m = m_a m_b/(m_a + m_b), and along the surface the
/// one that ends the sliding or, if that is more than Coulomb's mu |I_n|, that much of it. It acts twice in a step: on
/// the gathered velocities, so that strains see no approach, and on what the step's forces make of them. The points
/// are given both, or the work of the forces would not be what the strains take up.

/// Finds which bodies touch at which nodes, and takes the approach from the nodal velocities.
void meet(State& state, const Scene& scene);

/// The same for the velocities that the forces make; both become part of the changes, of velocities as gathered.
void touch(State& state, const Scene& scene);

/// Does friction warm a body? It does where one has a temperature.
bool friction_warms(const Scene& scene);

/// The heat that friction has made at a node in this step goes half and half into the two bodies, or whole into the one
/// that has a temperature; a body's points share it as they share the node's heat capacity.
void warm_by_friction(State& state, const Scene& scene);

/// Rigid bodies move with their velocity, which then follows its plan.
void move_rigids(State& state, const Scene& scene);

/// Distance, in cells, of the mean positions of two bodies that touch along a plane, as a node sees them that sees
/// `share` of their volume in one of them and this many points along a cell's side.
double distance_at_touch(double share, int points_per_cell);

}  // namespace kerf::forward::bodies
