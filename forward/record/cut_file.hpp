#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "forward/run.hpp"
#include "models/base/document.hpp"

namespace kerf::forward {

/// Keeps a simulated cut in an HDF5 file, with NAME.xdmf beside it for ParaView.
///
/// - /history: one entry per cell crossing: travel, F_c, F_t, forces per tool face, crack_lead, ...; ledger/*
/// - /particles: position (n x 2), velocity (n x 3), equivalent_stress, pressure, plastic_strain; side: 1 chip, -1 base
/// - /faces: upper, lower (m x 2), the faces of the crack
/// - /tool: tip_x, tip_y, rake; depth, cell, particle_spacing: what a picture of the chip needs
/// - attributes: title, code_version, scene (canonical text), result (JSON, see forward/record/result_json.hpp)
///
/// Every dataset is in the solver's units (mm, MPa, N, tonne, s, rad) and says so in its attribute `unit`.
/// The file appears whole or not at all (temporary name, fsync, rename); missing parent folders are created. May be
/// called from several threads. Throws InputError when the place cannot be written or `scene` is not a scene.
void write_cut(const std::filesystem::path& h5, const Document& scene, const CutResult& result);

/// Gives a cut's file another name, and its XDMF description with it; missing parent folders are created.
void rename_cut(const std::filesystem::path& from, const std::filesystem::path& to);

/// The scene and the result (see forward/record/result_json.hpp) that a cut's file remembers.
struct KeptCut {
  Document scene;
  nlohmann::ordered_json result;
};
/// Throws InputError when the file is not there or not a cut's.
KeptCut read_cut(const std::filesystem::path& h5);

/// Where the XDMF description of `h5` stands: the same name, extension .xdmf.
std::filesystem::path xdmf_beside(const std::filesystem::path& h5);

}  // namespace kerf::forward
