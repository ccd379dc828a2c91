#include "forward/bodies/numerics.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/base/error.hpp"

namespace kerf::forward::bodies {
namespace {

/// The names of the alternatives of a variant.
template <class... Members>
std::vector<std::string> names_of(const std::variant<Members...>&) {
  return {Members::name...};
}
/// The alternative of this name, as `make` makes it of a default one.
template <class... Members, class Make>
std::variant<Members...> chosen(const std::string& name, const std::variant<Members...>&, const Make& make) {
  std::variant<Members...> found;
  ((name == Members::name ? void(found = make(static_cast<Members*>(nullptr))) : void()), ...);
  return found;
}

std::string name_of(const auto& member) {
  return std::visit([](const auto& one) -> std::string { return one.name; }, member);
}

}  // namespace

Block numerics_block() {
  return {.path = "numerics",
          .variant = "",
          .meaning = "how it is solved; absent: quadratic splines, FLIP, stresses first",
          .parameters = {
              text("shape", "shape functions of the nodes: quadratic B-splines, uniform GIMP, or linear",
                   names_of(ShapeFunction{}))
                  .or_else("spline"),
              text("transfer",
                   "what points take from the nodes: changes (FLIP), velocities (PIC), these with gradients "
                   "(APIC), or filtered ones (XPIC)",
                   names_of(Transfer{}))
                  .or_else("FLIP"),
              number("xpic_order", "1", 1, 20, "m of XPIC(m): 1 is PIC, more damps less; absent: 2")
                  .in_whole_numbers()
                  .if_given(),
              text("stress_update",
                   "stresses before forces (USF), after the motion from nodal velocities (USL) or from "
                   "regathered ones (MUSL), or half before and half after (USAVG)",
                   {stress_update_names.begin(), stress_update_names.end()})
                  .or_else("USF"),
              text("frame", "configuration that the grid lies in; absent: current with a [contact], else reference",
                   {"reference", "current"})
                  .if_given()}};
}

Numerics read_numerics(const Values* values, int particles_per_cell_side, bool has_contact) {
  Numerics numerics{.shape = {}, .transfer = {}, .frame = has_contact ? Frame::current : Frame::reference};
  if (!values) return numerics;
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError(fmt::format("{}: [numerics] {}", values->where(key), why));
  };
  numerics.shape = chosen(values->text("shape"), ShapeFunction{}, [&](auto* member) {
    return std::remove_pointer_t<decltype(member)>::of(particles_per_cell_side);
  });
  numerics.transfer = chosen(values->text("transfer"), Transfer{},
                             [](auto* member) { return std::remove_pointer_t<decltype(member)>{}; });
  auto* xpic = std::get_if<Xpic>(&numerics.transfer);
  if (values->has("xpic_order")) {
    if (!xpic)
      refuse("xpic_order", fmt::format("is for transfer = \"XPIC\" (found: \"{}\")", values->text("transfer")));
    xpic->order = static_cast<int>(values->number("xpic_order"));
  }
  const std::string& update = values->text("stress_update");
  numerics.stress_update = static_cast<StressUpdate>(
      std::find(stress_update_names.begin(), stress_update_names.end(), update) - stress_update_names.begin());
  if (values->has("frame")) numerics.frame = values->text("frame") == "current" ? Frame::current : Frame::reference;
  if (numerics.frame == Frame::current && numerics.stress_update > StressUpdate::last)
    refuse("stress_update",
           fmt::format("= \"{}\" regathers velocities where the points were, which a grid in the current "
                       "configuration no longer knows (allowed: USF, USL)",
                       update));
  if (numerics.frame == Frame::current && std::holds_alternative<Linear>(numerics.shape) &&
      (std::holds_alternative<Apic>(numerics.transfer) || numerics.stress_update == StressUpdate::last))
    refuse(
        "shape",
        fmt::format("= \"linear\" gives a node that a point has just reached all of its force and hardly any mass, and "
                    "{} sees how fast that node is (allowed: spline, uGIMP; or FLIP, PIC, XPIC with USF)",
                    std::holds_alternative<Apic>(numerics.transfer) ? "APIC" : "USL"));
  if (!has_contact) return numerics;
  if (numerics.frame == Frame::reference)
    refuse("frame", "= \"reference\", but [contact] needs the current configuration");
  if (numerics.shape.index() != 0) refuse("shape", "of a scene with [contact] is \"spline\"");
  if (numerics.stress_update != StressUpdate::first) refuse("stress_update", "of a scene with [contact] is \"USF\"");
  return numerics;
}

std::string describe(const Numerics& numerics) {
  const auto* xpic = std::get_if<Xpic>(&numerics.transfer);
  return fmt::format("{} shape functions, {}{}, {}, grid in the {} configuration", name_of(numerics.shape),
                     name_of(numerics.transfer), xpic ? fmt::format("({})", xpic->order) : "",
                     stress_update_names.at(static_cast<std::size_t>(numerics.stress_update)),
                     numerics.frame == Frame::current ? "current" : "reference");
}

}  // namespace kerf::forward::bodies
