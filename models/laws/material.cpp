#include "models/laws/material.hpp"

#include "models/base/error.hpp"

namespace kerf::laws {
namespace {

struct Kind {
  Block block;
  Material (*make)(const Values&);
};

template <MaterialLaw... Laws>
std::vector<Kind> kinds_of(const std::variant<Laws...>*) {
  return {Kind{.block = Laws::block(), .make = [](const Values& values) -> Material { return Laws::from(values); }}...};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = kinds_of(static_cast<const Material*>(nullptr));
  return all;
}

}  // namespace

const std::vector<Block>& material_blocks() {
  static const std::vector<Block> blocks = [] {
    std::vector<Block> all;
    for (const Kind& kind : kinds()) all.push_back(kind.block);
    return all;
  }();
  return blocks;
}

Material make_material(const Values& values) {
  for (const Kind& kind : kinds())
    if (kind.block.variant == values.variant()) return kind.make(values);
  throw InputError(values.where("law") + ": no material law is called '" + values.variant() + "'");
}

}  // namespace kerf::laws
