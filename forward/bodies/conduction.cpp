#include "forward/bodies/conduction.hpp"

#include <algorithm>
#include <limits>

#include "forward/bodies/batch.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/each_node.hpp"

namespace kerf::forward::bodies {

void Conductor::operator()(State& state) {
  const Grid& grid = state.grid;
  for (auto* values : {&capacity_, &content_, &temperature_, &rate_}) values->assign(grid.nodes(), 0.0);
  const auto held = [&](Edge edge) { return scene_.conduction->wall_temperature[edge]; };

  for (const Body& body : state.bodies) {
    if (!body.is_thermal()) continue;
    const Points& p = body.points;
    const double c = laws::heat_capacity(body.law);
    const Array T = temperatures(body);
    for (std::size_t i = 0; i < p.size(); ++i)
      each_node(grid, p.reference_x[i], p.reference_y[i], [&](std::size_t node, double w, double, double) {
        capacity_[node] += w * p.volume[i] * c;
        content_[node] += w * p.volume[i] * c * T[i];
      });
  }
  for (const std::size_t normal : {1u, 0u})
    each_mirror(grid, scene_, normal, [&](const Mirror& m, Edge edge) {
      const double share = capacity_[m.behind];
      capacity_[m.before] += share;
      content_[m.before] += held(edge) ? 2.0 * share * *held(edge) - content_[m.behind] : content_[m.behind];
      if (normal == 1) capacity_[m.behind] = content_[m.behind] = 0.0;
    });
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    if (capacity_[node] > 0.0) temperature_[node] = content_[node] / capacity_[node];
  for (const std::size_t normal : {0u, 1u})
    each_mirror(grid, scene_, normal, [&](const Mirror& m, Edge edge) {
      temperature_[m.behind] = held(edge) ? 2.0 * *held(edge) - temperature_[m.before] : temperature_[m.before];
    });

  for (const Body& body : state.bodies) {
    if (!body.is_thermal()) continue;
    const Points& p = body.points;
    for (std::size_t i = 0; i < p.size(); ++i) {
      double along = 0.0, up = 0.0;
      each_node(grid, p.reference_x[i], p.reference_y[i], [&](std::size_t node, double, double dx, double dy) {
        along += dx * temperature_[node];
        up += dy * temperature_[node];
      });
      const double conductance = p.volume[i] * scene_.conduction->conductivity;
      each_node(grid, p.reference_x[i], p.reference_y[i], [&](std::size_t node, double, double dx, double dy) {
        rate_[node] -= conductance * (along * dx + up * dy);
      });
    }
  }
  for (const std::size_t normal : {1u, 0u})
    each_mirror(grid, scene_, normal, [&](const Mirror& m, Edge edge) {
      const double behind = rate_[m.behind];
      if (held(edge) && capacity_[m.before] > 0.0) {
        // As the force of a wall: what the change of the content leaves over.
        const double share = capacity_[m.behind] / capacity_[m.before];
        const double heat =
            state.step * ((1.0 - 2.0 * share) * (rate_[m.before] - behind) - (rate_[m.before] + behind));
        state.bath.heat += heat;
        state.bath.entropy += heat / *held(edge);
      }
      rate_[m.before] += held(edge) ? -behind : behind;
      if (normal == 1) rate_[m.behind] = 0.0;
    });
  std::vector<double>& change = content_;
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    change[node] = capacity_[node] > 0.0 ? state.step * rate_[node] / capacity_[node] : 0.0;
  for (const std::size_t normal : {0u, 1u})
    each_mirror(grid, scene_, normal, [&](const Mirror& m, Edge edge) {
      change[m.behind] = held(edge) ? -change[m.before] : change[m.before];
    });
  for (Body& body : state.bodies) {
    if (!body.is_thermal()) continue;
    Points& p = body.points;
    for (std::size_t i = 0; i < p.size(); ++i)
      each_node(grid, p.reference_x[i], p.reference_y[i],
                [&](std::size_t node, double w, double, double) { p.temperature[i] += w * change[node]; });
  }
}

double longest_conduction_step(const State& state, const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : state.bodies)
    if (body.is_thermal()) least = std::min(least, laws::heat_capacity(body.law));
  const double cell = std::min(state.grid.cell_x, state.grid.cell_y);
  return 0.25 * cell * cell * least / scene.conduction->conductivity;
}

}  // namespace kerf::forward::bodies
