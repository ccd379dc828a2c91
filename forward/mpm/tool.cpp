#include "forward/mpm/tool.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {
namespace {

/// Sharp: the half-plane through the tip with normal (cos alpha, sin alpha). Blunt: an arc tangent to it and to the
/// crack plane; the virtual sharp apex stays at the origin, so that the lowest point lies behind it. Below the
/// separation angle the work does not flow along the arc: what stands before it, a dead zone, carries on its tangent.
Outline rake_face(const Scene& scene, double tip_radius) {
  const double normal_x = std::cos(scene.tool.rake), normal_y = std::sin(scene.tool.rake);
  Outline outline;
  outline.add_plane(0.0, 0.0, normal_x, normal_y, ToolFace::rake);
  if (tip_radius > 0.0) {
    const double centre_x = scene.tool.lowest_point(tip_radius);
    outline.add_round(centre_x, tip_radius, tip_radius, ToolFace::tip);
    const double s = std::min(scene.tool.separation, 0.5 * std::numbers::pi + scene.tool.rake);
    const double wall_x = std::sin(s), wall_y = -std::cos(s);
    outline.add_plane(centre_x + tip_radius * wall_x, tip_radius + tip_radius * wall_y, wall_x, wall_y, ToolFace::tip);
  }
  return outline;
}

/// The clearance plane: behind the tip the lower face cannot rise into the tool, however strongly bonds that still hold
/// pull it. A blunt tip is round there too, up to 60 deg ahead of its lowest point; a sharp one may have a lead-in
/// plane ahead, up from the tip.
Outline underside(const Scene& scene, double tip_radius) {
  const double c = scene.tool.clearance;
  Outline outline;
  if (tip_radius > 0.0) {
    const double centre_x = scene.tool.lowest_point(tip_radius);
    constexpr double ahead_x = 0.8660254037844386, ahead_y = -0.5;
    outline.add_plane(centre_x + tip_radius * ahead_x, tip_radius + tip_radius * ahead_y, ahead_x, ahead_y,
                      ToolFace::tip);
    outline.add_round(centre_x, tip_radius, tip_radius, ToolFace::tip);
    outline.add_plane(centre_x - tip_radius * std::sin(c), tip_radius * (1.0 - std::cos(c)), -std::sin(c), -std::cos(c),
                      ToolFace::bottom);
  } else {
    if (scene.tool.lead_in) {
      outline.add_plane(0.0, 0.0, std::sin(*scene.tool.lead_in), -std::cos(*scene.tool.lead_in), ToolFace::lead_in);
      outline.add_round(0.0, 0.0, 0.0, ToolFace::bottom);
    } else {
      outline.end_at(0.0);
    }
    outline.add_plane(0.0, 0.0, -std::sin(c), -std::cos(c), ToolFace::bottom);
  }
  return outline;
}

/// A worn edge on the freshly cut face: an arc of radius R_L whose lowest point lies `press_in` below the tip of the
/// rake plane. It runs from the clearance angle to the separation angle theta_s = arccos(1 - press_in / R_L), each end
/// continued by its tangent.
Outline worn_edge(const Scene& scene, double) {
  const double radius = scene.edge_contact->edge_radius, press_in = scene.edge_contact->press_in;
  const double separation = std::acos(1.0 - press_in / radius), c = scene.tool.clearance;
  const double centre_x = -radius * std::sin(separation), centre_y = radius - press_in;
  const auto tangent = [&](Outline& outline, double angle) {  // from straight down, ahead positive
    const double normal_x = std::sin(angle), normal_y = -std::cos(angle);
    outline.add_plane(centre_x + radius * normal_x, centre_y + radius * normal_y, normal_x, normal_y, ToolFace::bottom);
  };
  Outline outline;
  tangent(outline, separation);
  outline.add_round(centre_x, centre_y, radius, ToolFace::bottom);
  tangent(outline, -c);
  return outline;
}

/// A second face across the rake face, at a distance up from the tip; it ends after its land.
Outline chip_breaker(const Scene& scene, double) {
  const ChipBreaker& breaker = *scene.chip_breaker;
  const double foot_x = -breaker.distance * std::sin(scene.tool.rake);
  const double foot_y = breaker.distance * std::cos(scene.tool.rake);
  const double normal_x = std::cos(breaker.angle), normal_y = std::sin(breaker.angle);
  const double end_x = foot_x - breaker.land * normal_y, end_y = foot_y + breaker.land * normal_x;
  Outline outline;
  outline.add_plane(foot_x, foot_y, normal_x, normal_y, ToolFace::chip_breaker);
  outline.add_round(end_x, end_y, 0.0, ToolFace::chip_breaker);
  outline.add_plane(end_x, end_y, -normal_y, normal_x, ToolFace::chip_breaker);
  return outline;
}

/// The plane's sole slides on the uncut surface; the mouth's front edge stands `opening` ahead of the tip.
Outline sole(const Scene& scene, double) {
  const Sole& sole = *scene.sole;
  const double height = scene.cut.depth;
  Outline outline;
  outline.add_plane(sole.opening, height, -1.0, 0.0, ToolFace::sole);
  outline.add_round(sole.opening + sole.corner_radius, height + sole.corner_radius, sole.corner_radius, ToolFace::sole);
  outline.add_plane(sole.opening, height, 0.0, -1.0, ToolFace::sole);
  return outline;
}

/// A round bar that presses the surface down ahead of the tip, as in veneer peeling.
Outline nose_bar(const Scene& scene, double) {
  const NoseBar& bar = *scene.nose_bar;
  const double low = scene.cut.depth - bar.compression, centre_y = low + bar.radius;
  Outline outline;
  outline.add_plane(bar.lead - bar.radius, centre_y, -1.0, 0.0, ToolFace::nose_bar);
  outline.add_round(bar.lead, centre_y, bar.radius, ToolFace::nose_bar);
  outline.add_plane(bar.lead, low, 0.0, -1.0, ToolFace::nose_bar);
  outline.add_round(bar.lead, centre_y, bar.radius, ToolFace::nose_bar);
  outline.add_plane(bar.lead + bar.radius, centre_y, 1.0, 0.0, ToolFace::nose_bar);
  return outline;
}

/// Pressure around each marker, averaged over a cell to either side.
std::vector<double> cell_mean(const std::vector<double>& pressure, std::size_t reach) {
  const std::size_t n = pressure.size();
  std::vector<double> sum(n + 1, 0.0), mean(n);
  for (std::size_t k = 0; k < n; ++k) sum[k + 1] = sum[k] + pressure[k];
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = k > reach ? k - reach : 0, to = std::min(n, k + reach + 1);
    mean[k] = (sum[to] - sum[from]) / static_cast<double>(to - from);
  }
  return mean;
}

/// Velocity of a part of the tool.
struct Motion {
  double x, y;
};

/// A force of the tool on marker k, N/mm, with the work the moving tool does through it.
void push(State& state, Face& face, std::size_t k, double x, double y, const Motion& motion) {
  face.force_x[k] += x;
  face.force_y[k] += y;
  state.force.on_work_x += x;
  state.force.on_work_y += y;
  state.work.tool += (x * motion.x + y * motion.y) * state.step;
}

}  // namespace

Face& surface(State& state, Surface which) {
  if (which == Surface::top) return state.top;
  return state.crack.face[which == Surface::upper_face ? above : below];
}

std::vector<Contact> contacts(const Scene& scene) {
  if (scene.grips) return {};
  const auto friction = [&](double Friction::*coefficient) {
    return scene.friction ? (*scene.friction).*coefficient : 0.0;
  };
  std::vector<Contact> all;
  all.push_back({"rake face", "the rake face presses on the upper side", Surface::upper_face, true,
                 friction(&Friction::coefficient), 0, rake_face});
  if (scene.chip_breaker)
    all.push_back({"chip breaker", "the chip breaker stands in the chip's way", Surface::upper_face, true,
                   friction(&Friction::chip_breaker), 0, chip_breaker});
  if (scene.edge_contact)
    all.push_back({"edge", "the worn edge presses on the lower side", Surface::lower_face, true,
                   scene.edge_contact->friction, 0, worn_edge});
  else
    all.push_back(
        {"underside", "the lower face cannot rise into the tool", Surface::lower_face, true, 0.0, 0, underside});
  if (scene.sole)
    all.push_back({"sole", "the sole holds down the uncut surface, its mouth's edge the chip", Surface::top, false,
                   friction(&Friction::sole), 0, sole});
  if (scene.nose_bar)
    all.push_back({"nose bar", "the nose bar presses on the uncut surface", Surface::top, false,
                   friction(&Friction::nose_bar), 0, nose_bar});
  std::array<std::size_t, 3> lists{};
  for (Contact& contact : all)
    if (contact.friction > 0.0) contact.slip = lists[static_cast<std::size_t>(contact.surface)]++;
  return all;
}

bool needs_top(const std::vector<Contact>& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.surface == Surface::top; });
}

void move_tool(State& state, const Scene& scene) {
  const Cut& cut = scene.cut;
  ToolState& tool = state.tool;
  tool.speed = state.time < cut.ramp ? cut.speed * state.time / cut.ramp : cut.speed;
  tool.x += state.step * tool.speed;
  if (scene.tool.tip_radius > 0.0) {
    // Grown from the start, a round tip never begins to cut.
    const double share = (tool.x / cut.depth - cut.notch) / scene.tool.blunting;
    const double radius = scene.tool.tip_radius * std::clamp(share, 0.02, 1.0);
    tool.tip_growth = radius - tool.tip_radius;
    tool.tip_radius = radius;
  }
  const double bottom = state.force.face[static_cast<std::size_t>(ToolFace::bottom)].normal;
  tool.overlap = bottom > 0.0 ? state.force.bottom_overlap / bottom : 0.0;
  state.force = {};
  state.contact_energy = 0.0;
}

void follow_face(State& state, double depth, double lift, bool sinks) {
  const Face& face = state.crack.face[below];
  ToolState& tool = state.tool;
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < state.crack.size(); ++k) {
    const double ahead = face.x[k] - tool.x;
    if (face.inverse_mass[k] == 0.0 || ahead < 0.1 * depth || ahead > 0.3 * depth) continue;
    if (std::abs(face.y[k] - tool.y) > depth) continue;  // the far side of a log
    sum += face.y[k];
    count += 1.0;
  }
  const double way = state.step * tool.speed / (0.3 * depth);
  if (sinks) tool.sink += way * (tool.overlap - tool.sink);
  const double height = count > 0.0 ? sum / count + lift - tool.sink : tool.y;
  tool.vertical_speed = tool.speed * (height - tool.y) / (0.3 * depth);
  tool.y += state.step * tool.vertical_speed;
}

namespace {

/// `rubbed(face, marker, work)` is told the work of friction at every marker that slides.
template <class Rubbed>
void press_with(State& state, const Contact& contact, const Scene& scene, const PressOptions& options,
                Rubbed&& rubbed) {
  Face& face = surface(state, contact.surface);
  const ToolState& tool = state.tool;
  const double length = state.crack.spacing;
  const double frame_y = contact.follows_tip ? tool.y : 0.0;
  const Motion motion{tool.speed, contact.follows_tip ? tool.vertical_speed : 0.0};
  const Outline outline = contact.outline(scene, tool.tip_radius);
  const bool rubs = contact.friction > 0.0, blunts = tool.tip_growth != 0.0;
  // The rake face is drawn without end; in a log what is still bonded lies beyond it, around the corner.
  const bool bounded = scene.log && contact.surface == Surface::upper_face;
  const Outline before = blunts ? contact.outline(scene, tool.tip_radius - tool.tip_growth) : outline;

  struct Hit {
    std::size_t k;
    double pressure, k_n;
    Touch touch;
  };
  std::vector<Hit> hits;
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (face.inverse_mass[k] == 0.0) continue;
    const double x = face.x[k] - tool.x, y = face.y[k] - frame_y;
    if (bounded && y < -scene.cut.depth) continue;
    const Touch touch = outline.touch(x, y);
    if (touch.distance >= 0.0) {
      if (rubs) face.slip[contact.slip][k] = 0.0;
      continue;
    }
    const double k_n = std::min(options.stiffness, stiffest_spring(state, face.moved_mass[k]));
    const double pressure = -k_n * touch.distance;
    hits.push_back({k, pressure, k_n, touch});
    push(state, face, k, pressure * length * touch.normal_x, pressure * length * touch.normal_y, motion);
    if (blunts)  // a surface that gives way takes work out of the spring
      state.work.tool += pressure * length * (before.touch(x, y).distance - touch.distance);
    state.contact_energy += 0.5 * pressure * -touch.distance * length;
    if (contact.surface == Surface::lower_face) state.force.bottom_overlap -= pressure * touch.distance * length;
    FaceForce& force = state.force.face[static_cast<std::size_t>(touch.face)];
    force.normal += pressure * length;
    force.contact_length += length;
    if (std::min(state.grid.top - face.y[k], face.x[k] - state.grid.left) < 0.5 * scene.cut.depth)
      state.force.at_edge += pressure * length;
    state.force.penetration = std::max(state.force.penetration, -touch.distance);
  }
  if (!rubs || hits.empty()) return;

  std::vector<double> pressure(face.size(), 0.0);
  for (const Hit& hit : hits) pressure[hit.k] = hit.pressure;
  const auto reach = static_cast<std::size_t>(std::lround(state.grid.cell_x / length));
  const std::vector<double> mean = cell_mean(pressure, reach);
  const double way = contact.surface == Surface::upper_face ? 1.0 : -1.0;  // the way the work slides past the tool
  for (const Hit& hit : hits) {
    double& slip = face.slip[contact.slip][hit.k];
    const double along_x = -way * hit.touch.normal_y, along_y = way * hit.touch.normal_x;
    const double ratio = std::min(contact.friction, options.shear_cap / mean[hit.k]);
    const double k_n = hit.k_n, longest = ratio * hit.pressure / k_n;
    const double sliding =
        state.step * ((face.velocity_x[hit.k] - motion.x) * along_x + (face.velocity_y[hit.k] - motion.y) * along_y);
    const double trial = slip + sliding;
    slip = std::clamp(trial, -longest, longest);
    const double shear = -k_n * slip;  // on the work
    push(state, face, hit.k, shear * length * along_x, shear * length * along_y, motion);
    const double rubbing = -shear * (trial - slip) * length;
    state.work.friction += rubbing;
    rubbed(face, hit.k, rubbing);
    state.contact_energy += 0.5 * k_n * slip * slip * length;
    FaceForce& force = state.force.face[static_cast<std::size_t>(hit.touch.face)];
    force.tangential -= shear * length;
    force.slip_limit += ratio * hit.pressure * length;
  }
}

}  // namespace

void press(State& state, const Contact& contact, const Scene& scene, const PressOptions& options) {
  press_with(state, contact, scene, options, [](const Face&, std::size_t, double) {});
}

void press_and_warm(State& state, const Contact& contact, const Scene& scene, const PressOptions& options) {
  std::vector<double>& heat = state.friction_heat[contact.surface == Surface::lower_face ? below : above];
  const auto give = [&](const Face& face, std::size_t k, double work) {
    const double stays = scene.thermal->friction_share * work;
    state.work.friction_heat += stays;
    const Spline x(face.node_column[k], face.offset_x[k]), y(face.node_row[k], face.offset_y[k]);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        heat[state.grid.node(x.base + i, y.base + j)] += stays * x.weight(i) * y.weight(j) * face.inverse_mass[k];
  };
  press_with(state, contact, scene, options, give);
}

}  // namespace kerf::forward
