#include "models/laws/body_law.hpp"

#include "models/base/error.hpp"

namespace kerf::laws {
namespace {

struct Kind {
  Block block;
  BodyLaw (*make)(const Values&);
};

template <LawOfBody... Laws>
std::vector<Kind> kinds_of(const std::variant<Laws...>*) {
  return {Kind{.block = {.path = "body",
                         .variant = Laws::name(),
                         .meaning = Laws::meaning(),
                         .parameters = Laws::parameters(),
                         .required = true,
                         .repeated = true},
               .make = [](const Values& values) -> BodyLaw { return Laws::from(values); }}...};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = kinds_of(static_cast<const BodyLaw*>(nullptr));
  return all;
}

}  // namespace

double heat_capacity(const BodyLaw& law) {
  return std::visit([](const auto& which) { return which.heat_capacity(); }, law);
}

double reference_temperature(const BodyLaw& law) {
  return std::visit([](const auto& which) { return which.reference; }, law);
}

bool is_thermal(const BodyLaw& law) {
  return std::visit([](const auto& which) { return std::decay_t<decltype(which)>::is_thermal; }, law);
}

std::vector<Block> body_blocks(const std::vector<Parameter>& common) {
  std::vector<Block> blocks;
  for (const Kind& kind : kinds()) {
    blocks.push_back(kind.block);
    blocks.back().parameters.insert(blocks.back().parameters.begin(), common.begin(), common.end());
  }
  return blocks;
}

BodyLaw make_body_law(const Values& values) {
  for (const Kind& kind : kinds())
    if (kind.block.variant == values.variant()) return kind.make(values);
  throw InputError(values.where("law") + ": no law of bodies is called '" + values.variant() + "'");
}

}  // namespace kerf::laws
