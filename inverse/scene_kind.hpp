#pragma once

#include <string>
#include <vector>

#include "models/base/document.hpp"

namespace kerf::inverse {

/// What commands that vary a scene must know of it: whether it is a cut or an experiment on bodies, and where things
/// stand in either.
struct SceneKind {
  bool has_bodies;

  static SceneKind of(const Document& scene);

  const std::vector<Block>& blocks() const;
  const char* cell_path() const { return has_bodies ? "box.cell" : "resolution.cells_through_chip"; }
  const char* courant_path() const { return has_bodies ? "box.courant_number" : "resolution.courant_number"; }
  /// Values of all blocks, those of a preset included.
  Contents read(const Document& scene) const;
  /// Throws InputError on what the scene's reader refuses.
  void check(const Document& scene) const;
  /// These three throw it too.
  std::string title(const Document& scene) const;
  double cell(const Document& scene) const;  ///< mm
  double courant_number(const Document& scene) const;
};

}  // namespace kerf::inverse
