#include "forward/record/state_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "forward/mpm/window.hpp"
#include "forward/record/hdf5.hpp"

namespace kerf::forward {
namespace {

namespace fs = std::filesystem;

using namespace hdf5;

/// What two scenes have in common that can share a state.
std::vector<std::pair<const char*, double>> geometry(const Scene& s) {
  constexpr double none = 0.0;
  return {{"cut.depth", s.cut.depth},
          {"cut.speed", s.cut.speed},
          {"tool.rake", s.tool.rake},
          {"tool.clearance", s.tool.clearance},
          {"tool.tip_radius", s.tool.tip_radius},
          {"tool.separation_angle", s.tool.separation},
          {"tool.lead_in", s.tool.lead_in.value_or(none)},
          {"chip_breaker.distance", s.chip_breaker ? s.chip_breaker->distance : none},
          {"chip_breaker.angle", s.chip_breaker ? s.chip_breaker->angle : none},
          {"chip_breaker.land", s.chip_breaker ? s.chip_breaker->land : none},
          {"sole.opening", s.sole ? s.sole->opening : none},
          {"sole.corner_radius", s.sole ? s.sole->corner_radius : none},
          {"nose_bar.lead", s.nose_bar ? s.nose_bar->lead : none},
          {"nose_bar.radius", s.nose_bar ? s.nose_bar->radius : none},
          {"nose_bar.compression", s.nose_bar ? s.nose_bar->compression : none},
          {"edge_contact.press_in", s.edge_contact ? s.edge_contact->press_in : none},
          {"edge_contact.edge_radius", s.edge_contact ? s.edge_contact->edge_radius : none},
          {"window.ahead", s.window.ahead},
          {"window.behind", s.window.behind},
          {"window.below", s.window.below},
          {"window.above", s.window.above},
          {"resolution.cells_through_chip", s.resolution.cells_through_chip},
          {"resolution.particles_per_cell_side", s.resolution.particles_per_cell_side},
          {"resolution.single_particle_below", s.fine_base_height()},
          {"resolution.markers_per_cell", s.resolution.markers_per_cell},
          {"resolution.cell_stretch", s.resolution.cell_stretch}};
}

std::string law(const Scene& scene) {
  return std::visit([](const auto& law) { return law.block().variant; }, scene.material);
}

std::vector<std::pair<const char*, double*>> scalars(State& s) {
  return {{"tool x", &s.tool.x},
          {"tool y", &s.tool.y},
          {"tool speed", &s.tool.speed},
          {"tool vertical speed", &s.tool.vertical_speed},
          {"tool overlap", &s.tool.overlap},
          {"tool sink", &s.tool.sink},
          {"tip radius", &s.tool.tip_radius},
          {"tip growth", &s.tool.tip_growth},
          {"bottom force", &s.force.face[static_cast<std::size_t>(ToolFace::bottom)].normal},
          {"bottom overlap", &s.force.bottom_overlap},
          {"contact energy", &s.contact_energy},
          {"time", &s.time},
          {"fed to", &s.fed_to},
          {"next crossing", &s.next_crossing},
          {"grid origin x", &s.grid.origin_x},
          {"window left", &s.grid.left},
          {"crack front", &s.crack.front}};
}

enum class Owner { particles, pairs, top };

/// Calls visit(owner, name, array) for all that belongs to particles, marker pairs and markers of the outer surface.
template <class Visit>
void each_array(State& s, Visit&& visit) {
  for (const Particles::Field& field : s.particles.fields()) visit(Owner::particles, field.name, *field.values);
  constexpr const char* remembered[] = {"largest opening", "largest shear",  "largest share",
                                        "normal traction", "shear traction", "work taken"};
  visit(Owner::pairs, "reference position", s.crack.reference_x);
  const auto memory = s.crack.memory();
  for (std::size_t i = 0; i < memory.size(); ++i) visit(Owner::pairs, remembered[i], *memory[i]);
  const auto of_face = [&](Owner owner, const std::string& name, Face& face) {
    visit(owner, name + " x", face.x);
    visit(owner, name + " y", face.y);
    visit(owner, name + " velocity x", face.velocity_x);
    visit(owner, name + " velocity y", face.velocity_y);
    visit(owner, name + " inverse mass", face.inverse_mass);
    visit(owner, name + " moved mass", face.moved_mass);
    for (std::size_t i = 0; i < face.slip.size(); ++i) visit(owner, fmt::format("{} slip {}", name, i), face.slip[i]);
  };
  of_face(Owner::pairs, "lower face", s.crack.face[below]);
  of_face(Owner::pairs, "upper face", s.crack.face[above]);
  of_face(Owner::top, "top", s.top);
}

template <class Numbers>
std::vector<double> as_doubles(const Numbers& numbers) {
  return {numbers.begin(), numbers.end()};
}

std::vector<double> flat(const std::vector<VelocityField::Span>& spans) {
  std::vector<double> columns;
  for (const VelocityField::Span& span : spans) {
    columns.push_back(span.begin);
    columns.push_back(span.end);
  }
  return columns;
}

/// Throws Failure when the file does not hold a whole state of a scene that fits.
void fill(State& state, hid_t file) {
  const auto numbers = [&](const std::string& name, std::size_t size) {
    std::vector<double> read = read_numbers(file, name);
    if (read.size() != size || !std::all_of(read.begin(), read.end(), [](double v) { return std::isfinite(v); }))
      throw Failure{name};
    return read;
  };
  const auto scalar = scalars(state);
  const std::vector<double> values = numbers("scalars", scalar.size());
  for (std::size_t i = 0; i < scalar.size(); ++i) *scalar[i].second = values[i];

  const std::vector<double> begin = numbers("sides", 3);
  for (std::size_t i = 0; i < begin.size(); ++i) state.particles.begin[i] = static_cast<std::size_t>(begin[i]);
  const std::size_t pairs = read_numbers(file, "reference position").size();
  const std::array<std::size_t, 3> count{state.particles.begin[2], pairs, read_numbers(file, "top x").size()};
  each_array(state, [&](Owner owner, const std::string& name, auto& array) {
    const std::vector<double> read = numbers(name, count[static_cast<std::size_t>(owner)]);
    array.assign(read.begin(), read.end());
  });
  // What a step puts there before it asks.
  const auto clear = [](Face& face) {
    for (auto* values : {&face.force_x, &face.force_y, &face.offset_x, &face.offset_y})
      values->assign(face.size(), 0.0);
    face.node_column.assign(face.size(), 0);
    face.node_row.assign(face.size(), 0);
  };
  clear(state.crack.face[below]);
  clear(state.crack.face[above]);
  clear(state.top);
  const std::vector<double> intact = numbers("intact", pairs);
  state.crack.intact.assign(intact.size(), 0);
  for (std::size_t k = 0; k < pairs; ++k) state.crack.intact[k] = intact[k] != 0.0 ? 1 : 0;
}

void fill_spans(State& state, hid_t file) {
  for (VelocityField& field : state.grid.side) {
    const std::string name = &field == &state.grid.side[below] ? "spans below" : "spans above";
    const std::vector<double> columns = read_numbers(file, name);
    if (columns.size() != 2 * field.spans.size()) throw Failure{name};
    for (std::size_t row = 0; row < field.spans.size(); ++row) {
      field.spans[row] = {static_cast<int>(columns[2 * row]), static_cast<int>(columns[2 * row + 1])};
      if (field.spans[row].begin < 0 || field.spans[row].end > state.grid.stride) throw Failure{name};
    }
  }
}

void write(hid_t file, State& state, const Scene& scene) {
  write_attribute(file, "law", law(scene));
  for (const auto& [name, number] : geometry(scene)) write_numbers(file, name, std::span(&number, 1));
  std::vector<double> scalar;
  for (const auto& [name, value] : scalars(state)) scalar.push_back(*value);
  write_numbers(file, "scalars", scalar);
  write_numbers(file, "sides", as_doubles(state.particles.begin));
  each_array(state, [&](Owner, const std::string& name, const auto& array) { write_numbers(file, name, array); });
  write_numbers(file, "intact", as_doubles(state.crack.intact));
  write_numbers(file, "spans below", flat(state.grid.side[below].spans));
  write_numbers(file, "spans above", flat(state.grid.side[above].spans));
}

}  // namespace

void require_chainable(const Scene& scene, const std::string& name) {
  const auto refuse = [&](const char* why) {
    throw InputError(fmt::format("{}: the state of a scene with {} is not kept", name, why));
  };
  if (scene.grips) refuse("[grips]");
  if (scene.log) refuse("[log]");
  if (scene.thermostat) refuse("[thermostat]");
}

void write_state(const fs::path& h5, const State& state, const Scene& scene) {
  State copy = state;
  write_file(h5, [&](hid_t file) { write(file, copy, scene); });
}

State read_state(const fs::path& h5, const Scene& scene) {
  require_chainable(scene, h5.string());
  if (!fs::exists(h5)) throw InputError(fmt::format("{}: there is no such file", h5.string()));
  State state = lay_out(scene);
  const std::lock_guard lock(one_at_a_time);
  try {
    const QuietErrors quiet;
    const Handle file(H5Fopen(h5.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "not an HDF5 file");
    const auto unfit = [&](const std::string& what, const auto& kept, const auto& wanted) {
      throw InputError(fmt::format("{}: this state has {} = {}, the scene {}", h5.string(), what, kept, wanted));
    };
    if (const std::string kept = read_attribute(file, "law"); kept != law(scene))
      unfit("material.law", kept, law(scene));
    for (const auto& [name, wanted] : geometry(scene)) {
      const std::vector<double> kept = read_numbers(file, name);
      if (kept.size() != 1) throw Failure{name};
      if (kept[0] != wanted) unfit(name, kept[0], wanted);
    }
    fill(state, file);
    fill_spans(state, file);
  } catch (const Failure& failure) {
    throw InputError(
        fmt::format("{}: is not the state of a cut with this scene's effects (HDF5: {})", h5.string(), failure.what));
  }
  settle(state, scene);
  return state;
}

}  // namespace kerf::forward
