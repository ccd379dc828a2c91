#include "models/laws/hencky.hpp"

namespace kerf::laws {

template <class Hardening>
Block Hencky<Hardening>::block() {
  Block block = J2<Hardening>::block();
  block.variant = std::string("hencky") + Hardening::suffix;
  block.meaning = std::string("isotropic, hyperelastic in the logarithmic strain, von Mises plastic with ") +
                  Hardening::meaning + ", plane strain";
  return block;
}

template <class Hardening>
Hencky<Hardening> Hencky<Hardening>::from(const Values& values) {
  return {J2<Hardening>::from(values)};
}

template struct Hencky<LinearHardening>;
template struct Hencky<PowerHardening>;
template struct Hencky<SaturatingHardening>;

}  // namespace kerf::laws
