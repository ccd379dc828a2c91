#include "inverse/closed_form_reduction.hpp"

namespace kerf::inverse {

chip::Measurements measurements_of(const data::Curve& curve) {
  std::vector<chip::MeasuredCut> cuts;
  for (const auto& point : curve.points) {
    chip::MeasuredCut cut;
    cut.depth = point.depth;
    cut.rake = point.rake;
    cut.F_c = point.F_c.value;
    cut.F_c_error = point.F_c.standard_error();
    if (point.F_t) {
      cut.F_t = point.F_t->value;
      cut.F_t_error = point.F_t->standard_error();
    }
    if (point.chip_ratio) {
      cut.chip_ratio = point.chip_ratio->value;
      cut.chip_ratio_error = point.chip_ratio->standard_error();
    }
    cut.tool_radius = point.tool_radius;
    cut.repeats = point.F_c.repeats;
    cut.line = point.line;
    cuts.push_back(cut);
  }
  return chip::Measurements(std::move(cuts));
}

}  // namespace kerf::inverse
