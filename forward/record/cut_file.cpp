#include "forward/record/cut_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "forward/record/hdf5.hpp"
#include "forward/record/result_json.hpp"
#include "models/base/atomic_file.hpp"

namespace kerf::forward {
namespace {

namespace fs = std::filesystem;

using namespace hdf5;

/// A column of numbers with its unit: `rows` entries of `components` each, row by row.
struct Field {
  std::string name;
  const char* unit;
  hsize_t components;
  std::vector<double> values;
  hsize_t rows() const { return values.size() / components; }
};

std::vector<double> interlaced(std::initializer_list<const std::vector<double>*> columns, std::size_t components) {
  std::vector<double> rows((*columns.begin())->size() * components, 0.0);
  std::size_t component = 0;
  for (const std::vector<double>* column : columns) {
    for (std::size_t i = 0; i < column->size(); ++i) rows[i * components + component] = (*column)[i];
    ++component;
  }
  return rows;
}

std::vector<Field> particle_fields(const Snapshot& s) {
  std::vector<Field> fields{{"position", "mm", 2, interlaced({&s.x, &s.y}, 2)},
                            {"velocity", "mm/s", 3, interlaced({&s.velocity_x, &s.velocity_y}, 3)},
                            {"equivalent_stress", "MPa", 1, s.equivalent_stress},
                            {"pressure", "MPa", 1, s.pressure},
                            {"plastic_strain", "1", 1, s.plastic_strain},
                            {"side", "1", 1, {s.side.begin(), s.side.end()}}};
  if (!s.temperature.empty()) fields.push_back({"temperature", "K", 1, s.temperature});
  return fields;
}

std::vector<Field> face_fields(const Snapshot& s) {
  return {{"upper", "mm", 2, interlaced({&s.upper_face_x, &s.upper_face_y}, 2)},
          {"lower", "mm", 2, interlaced({&s.lower_face_x, &s.lower_face_y}, 2)}};
}

template <class Owner>
struct Column {
  const char* name;
  const char* unit;
  double Owner::*value;
};

constexpr std::array<Column<ForceSample>, 9> history_columns{
    {{"travel", "mm", &ForceSample::travel},
     {"F_c", "N/mm", &ForceSample::F_c},
     {"F_t", "N/mm", &ForceSample::F_t},
     {"crack_lead", "mm", &ForceSample::crack_lead},
     {"softening_lead", "mm", &ForceSample::softening_lead},
     {"penetration", "mm", &ForceSample::penetration},
     {"fracture_I", "N mm/mm", &ForceSample::fracture_I},
     {"broken_length", "mm", &ForceSample::broken_length},
     {"broken_energy", "N mm/mm", &ForceSample::broken_energy}}};

constexpr const char* energy_unit = "N mm/mm";
constexpr std::array<Column<Ledger>, 7> ledger_columns{{{"tool_work", energy_unit, &Ledger::tool_work},
                                                        {"fracture", energy_unit, &Ledger::fracture},
                                                        {"plastic", energy_unit, &Ledger::plastic},
                                                        {"elastic", energy_unit, &Ledger::elastic},
                                                        {"kinetic", energy_unit, &Ledger::kinetic},
                                                        {"friction", energy_unit, &Ledger::friction},
                                                        {"damping", energy_unit, &Ledger::damping}}};

template <class Value>
std::vector<double> over_history(const std::vector<ForceSample>& history, Value value) {
  std::vector<double> column(history.size());
  std::transform(history.begin(), history.end(), column.begin(), value);
  return column;
}

std::vector<Field> history_fields(const std::vector<ForceSample>& history, const std::vector<ToolFace>& faces) {
  std::vector<Field> fields;
  fields.reserve(std::size(history_columns) + 3 * faces.size());
  for (const auto& column : history_columns)
    fields.push_back({column.name, column.unit, 1,
                      over_history(history, [&](const ForceSample& sample) { return sample.*column.value; })});
  for (const ToolFace face : faces) {
    const auto add = [&](const char* what, const char* unit, double FaceForce::*value) {
      fields.push_back({std::string(name(face)) + what, unit, 1, over_history(history, [&](const ForceSample& sample) {
                          return sample.face[static_cast<std::size_t>(face)].*value;
                        })});
    };
    add("_normal", "N/mm", &FaceForce::normal);
    add("_tangential", "N/mm", &FaceForce::tangential);
    add("_contact_length", "mm", &FaceForce::contact_length);
  }
  return fields;
}

std::vector<Field> extension_fields(const std::vector<ForceSample>& history) {
  std::vector<Field> fields;
  const auto add = [&](const char* name, const char* unit, double Extension::*value) {
    fields.push_back(
        {name, unit, 1, over_history(history, [&](const ForceSample& sample) { return sample.extension.*value; })});
  };
  add("opening", "mm", &Extension::opening);
  add("extension", "mm", &Extension::crack);
  add("G_R", "N/mm", &Extension::release);
  add("notch_I", "N/mm", &Extension::at_notch_I);
  add("notch_II", "N/mm", &Extension::at_notch_II);
  return fields;
}

std::vector<Field> ledger_fields(const std::vector<ForceSample>& history) {
  std::vector<Field> fields;
  fields.reserve(std::size(ledger_columns) + 1);
  for (const auto& column : ledger_columns)
    fields.push_back({column.name, column.unit, 1,
                      over_history(history, [&](const ForceSample& sample) { return sample.ledger.*column.value; })});
  fields.push_back({"residue", energy_unit, 1,
                    over_history(history, [](const ForceSample& sample) { return sample.ledger.residue(); })});
  return fields;
}

std::vector<Field> tool_fields(const Scene& scene, const Snapshot& snapshot) {
  std::vector<Field> fields{{"tip_x", "mm", 1, {snapshot.tool_tip_x}},
                            {"tip_y", "mm", 1, {snapshot.tool_tip_y}},
                            {"tip_radius", "mm", 1, {snapshot.tip_radius}},
                            {"rake", "rad", 1, {scene.tool.rake}},
                            {"clearance", "rad", 1, {scene.tool.clearance}},
                            {"depth", "mm", 1, {scene.cut.depth}},
                            {"cell", "mm", 1, {snapshot.cell}},
                            {"particle_spacing", "mm", 1, {scene.cell() / scene.resolution.particles_per_cell_side}}};
  if (scene.chip_breaker) {
    fields.push_back({"breaker_distance", "mm", 1, {scene.chip_breaker->distance}});
    fields.push_back({"breaker_angle", "rad", 1, {scene.chip_breaker->angle}});
    fields.push_back({"breaker_land", "mm", 1, {scene.chip_breaker->land}});
  }
  if (scene.sole) {
    fields.push_back({"mouth", "mm", 1, {scene.sole->opening}});
    fields.push_back({"mouth_radius", "mm", 1, {scene.sole->corner_radius}});
  }
  return fields;
}

void write_group(hid_t parent, const char* name, const std::vector<Field>& fields) {
  const Handle group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group");
  for (const Field& field : fields) {
    const std::array<hsize_t, 2> extent{field.rows(), field.components};
    const Handle space(H5Screate_simple(field.components > 1 ? 2 : 1, extent.data(), nullptr), H5Sclose, "data space");
    const Handle set(
        H5Dcreate2(group, field.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
        "dataset");
    if (!field.values.empty())
      check(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.values.data()), "dataset");
    write_attribute(set, "unit", field.unit);
  }
}

void write_h5(hid_t h5, const Document& document, const Scene& scene, const CutResult& result) {
  write_attribute(h5, "title", scene.title);
  write_attribute(h5, "code_version", KERF_VERSION);
  write_attribute(h5, "scene", document.canonical());
  write_attribute(h5, "result", result_json(result).dump(2));
  write_group(h5, "history", history_fields(result.history, faces_of(scene)));
  write_group(h5, "history/ledger", ledger_fields(result.history));
  if (result.is_specimen) write_group(h5, "r_curve", extension_fields(result.history));
  write_group(h5, "particles", particle_fields(result.snapshot));
  write_group(h5, "faces", face_fields(result.snapshot));
  write_group(h5, "tool", tool_fields(scene, result.snapshot));
}

/// Points as ParaView's Polyvertex: the first field is the position, the others are attributes.
std::string xdmf_points(const char* grid, const std::string& group, const std::vector<Field>& fields) {
  const auto data_item = [&](const Field& field) {
    const std::string extent =
        field.components > 1 ? fmt::format("{} {}", field.rows(), field.components) : fmt::format("{}", field.rows());
    return fmt::format(R"(<DataItem Dimensions="{}" NumberType="Float" Precision="8" Format="HDF">{}/{}</DataItem>)",
                       extent, group, field.name);
  };
  const Field& position = fields.front();
  if (position.values.empty()) return {};
  std::string xml = fmt::format(R"(      <Grid Name="{}" GridType="Uniform">
        <Topology TopologyType="Polyvertex" NumberOfElements="{}" NodesPerElement="1"/>
        <Geometry GeometryType="XY">{}</Geometry>
)",
                                grid, position.rows(), data_item(position));
  for (auto field = fields.begin() + 1; field != fields.end(); ++field)
    xml += fmt::format(R"(        <Attribute Name="{}" AttributeType="{}" Center="Node">{}</Attribute>
)",
                       field->name, field->components > 1 ? "Vector" : "Scalar", data_item(*field));
  return xml + "      </Grid>\n";
}

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  return xml;
}

std::string xdmf(const std::string& h5_name, const Snapshot& snapshot) {
  const std::string file = escaped(h5_name) + ":";
  const std::vector<Field> faces = face_fields(snapshot);
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="cut" GridType="Collection" CollectionType="Spatial">
)" + xdmf_points("particles", file + "/particles", particle_fields(snapshot)) +
         xdmf_points("upper_face", file + "/faces", {faces[0]}) +
         xdmf_points("lower_face", file + "/faces", {faces[1]}) + R"(    </Grid>
  </Domain>
</Xdmf>
)";
}

}  // namespace

fs::path xdmf_beside(const fs::path& h5) {
  return fs::path(h5).replace_extension(".xdmf");
}

void rename_cut(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  fs::rename(from, to);
  const fs::path described = xdmf_beside(from);
  std::string text = read_file(described);
  const std::string old_name = from.filename().string(), new_name = to.filename().string();
  for (std::size_t at = text.find(old_name); at != std::string::npos; at = text.find(old_name, at + new_name.size()))
    text.replace(at, old_name.size(), new_name);
  write_atomically(xdmf_beside(to), text);
  fs::remove(described);
}

KeptCut read_cut(const fs::path& h5) {
  const std::lock_guard lock(one_at_a_time);
  if (!fs::exists(h5)) throw InputError(fmt::format("{}: there is no such file", h5.string()));
  try {
    const QuietErrors quiet;
    const Handle file(H5Fopen(h5.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "not an HDF5 file");
    return {.scene = Document::parse(read_attribute(file, "scene"), h5.string()),
            .result = nlohmann::ordered_json::parse(read_attribute(file, "result"))};
  } catch (const Failure& failure) {
    throw InputError(fmt::format("{}: is not the file of a cut (HDF5: {})", h5.string(), failure.what));
  } catch (const nlohmann::json::exception& failure) {
    throw InputError(fmt::format("{}: is not the file of a cut: {}", h5.string(), failure.what()));
  }
}

void write_cut(const fs::path& h5, const Document& document, const CutResult& result) {
  const Scene scene = read_scene(document);
  write_file(h5, [&](hid_t file) { write_h5(file, document, scene, result); });
  write_atomically(xdmf_beside(h5), xdmf(h5.filename().string(), result.snapshot));
}

}  // namespace kerf::forward
