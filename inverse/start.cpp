#include "inverse/start.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "models/chip/fit_method.hpp"

namespace kerf::inverse {
namespace {

// What the closed form calls the scene's numbers.
const std::map<std::string, std::string>& closed_form_names() {
  static const std::map<std::string, std::string> names{{"material.yield_stress", "yield_stress"},
                                                        {"cohesive.mode_I.toughness", "toughness"},
                                                        {"friction.coefficient", "friction"}};
  return names;
}

std::optional<double> positive(double value) {
  return value > 0 ? std::optional(value) : std::nullopt;
}

chip::Measurements measurements(const Job& job) {
  std::vector<chip::MeasuredCut> cuts;
  for (const MeasuredCut& cut : job.cuts) {
    const std::optional<Estimate>&F_c = cut.measured[0], &F_t = cut.measured[1];
    if (!F_c) continue;
    chip::MeasuredCut measured;
    measured.depth = cut.depth;
    measured.rake = cut.rake;
    measured.F_c = F_c->value;
    measured.F_c_error = positive(F_c->standard_error);
    if (F_t) {
      measured.F_t = F_t->value;
      measured.F_t_error = positive(F_t->standard_error);
    }
    cuts.push_back(measured);
  }
  return chip::Measurements(std::move(cuts));
}

std::string method_for(const Job& job) {
  if (!job.edge_force) return "shear_minimised_coulomb";
  return job.edge_force->cutting_share == CuttingShare::friction ? "shear_minimised_edge"
                                                                 : "shear_minimised_edge_no_drag";
}

}  // namespace

Start find_start(const Job& job, const ParameterSpace& space) {
  Start start{.point = 0.5 * (space.lower() + space.upper()), .origin = ""};
  const bool all_given =
      std::all_of(job.free.begin(), job.free.end(), [](const FreeParameter& p) { return p.start.has_value(); });
  chip::MethodResult closed_form;
  const auto has_F_c = [](const MeasuredCut& cut) { return cut.measured[0].has_value(); };
  if (!all_given && std::any_of(job.cuts.begin(), job.cuts.end(), has_F_c))
    closed_form = chip::apply(*chip::find_fit_method(method_for(job)), measurements(job), {});

  const auto add_origin = [&](const FreeParameter& parameter, const std::string& from) {
    start.origin += (start.origin.empty() ? "" : ", ") + parameter.name + " " + from;
  };
  for (Eigen::Index j = 0; j < space.dimension(); ++j) {
    const FreeParameter& parameter = job.free[static_cast<std::size_t>(j)];
    if (parameter.start) {
      start.point[j] = space.coordinate(j, *parameter.start);
      add_origin(parameter, "as given");
      continue;
    }
    const auto name = closed_form_names().find(parameter.path);
    const chip::FittedParameter* fitted =
        closed_form.fit.converged && name != closed_form_names().end() ? closed_form.fit.find(name->second) : nullptr;
    if (!fitted || !std::isfinite(fitted->value)) {
      add_origin(parameter, "from the middle of its range");
      continue;
    }
    // A start on a bound leaves differences only one side and the trust region half of its room.
    const double margin = 0.1 * (space.upper()[j] - space.lower()[j]);
    const double wanted =
        parameter.logarithmic && fitted->value <= 0 ? space.lower()[j] : space.coordinate(j, fitted->value);
    start.point[j] = std::clamp(wanted, space.lower()[j] + margin, space.upper()[j] - margin);
    add_origin(parameter, "from the closed form");
  }
  return start;
}

}  // namespace kerf::inverse
