#include "inverse/sweep_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "forward/record/hdf5.hpp"
#include "inverse/scene_kind.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using namespace hdf5;

void write_column(hid_t group, const Column& column) {
  const hsize_t rows = column.cells.size();
  const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose, "data space");
  const bool words = std::any_of(column.cells.begin(), column.cells.end(), [](const Json& c) { return c.is_string(); });
  const Handle type(words ? string_type() : H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose, "type");
  const Handle set(H5Dcreate2(group, column.name.c_str(), words ? type : hid_t{H5T_IEEE_F64LE}, space, H5P_DEFAULT,
                              H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose, "dataset");
  if (words) {
    std::vector<std::string> texts;
    for (const Json& cell : column.cells)
      texts.push_back(cell.is_string() ? cell.get<std::string>() : cell.is_null() ? "" : cell.dump());
    std::vector<const char*> pointers;
    pointers.reserve(texts.size());
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "dataset");
  } else {
    std::vector<double> numbers;
    for (const Json& cell : column.cells)
      numbers.push_back(cell.is_number()    ? cell.get<double>()
                        : cell.is_boolean() ? (cell.get<bool>() ? 1.0 : 0.0)
                                            : std::nan(""));
    check(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "dataset");
  }
  write_attribute(set, "unit", column.unit);
}

/// Whatever the file of a cut calls its history: a field that is added there comes along by itself.
void copy_history(hid_t runs, const fs::path& cut_file, const std::string& name) {
  if (!fs::exists(cut_file)) return;
  const Handle cut(H5Fopen(cut_file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "file of a cut");
  check(H5Ocopy(cut, "history", runs, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "history");
}

void write_h5(hid_t h5, const Sweep& sweep, const std::vector<Column>& columns,
              const std::vector<fs::path>& cut_files) {
  write_attribute(h5, "title", SceneKind::of(sweep.scene).title(sweep.scene));
  write_attribute(h5, "code_version", KERF_VERSION);
  write_attribute(h5, "scene", sweep.scene.canonical());
  {
    const Handle group(H5Gcreate2(h5, "columns", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group");
    for (const Column& column : columns) write_column(group, column);
  }
  const Handle runs(H5Gcreate2(h5, "runs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group");
  for (std::size_t run = 0; run < cut_files.size(); ++run)
    copy_history(runs, cut_files[run], fmt::format("{:03}", run + 1));
}

}  // namespace

void write_sweep(const fs::path& h5, const Sweep& sweep, const std::vector<Column>& columns,
                 const std::vector<fs::path>& cut_files) {
  write_file(h5, [&](hid_t file) { write_h5(file, sweep, columns, cut_files); });
}

}  // namespace kerf::inverse
