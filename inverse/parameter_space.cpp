#include "inverse/parameter_space.hpp"

#include <algorithm>
#include <cmath>

#include "forward/scene/scene.hpp"
#include "inverse/sweep_axis.hpp"

namespace kerf::inverse {
namespace {

constexpr const char* friction_path = "friction.coefficient";

std::string table_of(const std::string& path) {
  return path.substr(0, path.rfind('.'));
}

double read_number(const Contents& contents, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return contents.at(path.substr(0, dot)).number(path.substr(dot + 1));
}

}  // namespace

ParameterSpace::ParameterSpace(const Job& job)
    : base_(job.scene),
      curves_(job.curves),
      free_(job.free),
      ties_(job.ties),
      lower_(dimension()),
      upper_(dimension()) {
  for (Eigen::Index j = 0; j < dimension(); ++j) {
    const FreeParameter& parameter = free_[static_cast<std::size_t>(j)];
    lower_[j] = coordinate(j, parameter.lower);
    upper_[j] = coordinate(j, parameter.upper);
    if (parameter.path == friction_path) friction_index_ = j;
  }
  const Contents contents = base_.read(forward::scene_blocks());
  if (contents.has("friction")) fixed_friction_ = read_number(contents, friction_path);
}

double ParameterSpace::coordinate(Eigen::Index j, double value) const {
  const FreeParameter& p = free_[static_cast<std::size_t>(j)];
  return p.logarithmic ? std::log(value) : value / (p.upper - p.lower);
}

double ParameterSpace::value(Eigen::Index j, double coordinate) const {
  const FreeParameter& p = free_[static_cast<std::size_t>(j)];
  return p.logarithmic ? std::exp(coordinate) : coordinate * (p.upper - p.lower);
}

double ParameterSpace::slope(Eigen::Index j, double coordinate) const {
  const FreeParameter& p = free_[static_cast<std::size_t>(j)];
  return p.logarithmic ? std::exp(coordinate) : p.upper - p.lower;
}

Eigen::VectorXd ParameterSpace::values(const Eigen::VectorXd& point) const {
  Eigen::VectorXd result(point.size());
  for (Eigen::Index j = 0; j < point.size(); ++j) result[j] = value(j, point[j]);
  return result;
}

Eigen::VectorXd ParameterSpace::clamp(const Eigen::VectorXd& point) const {
  return point.cwiseMax(lower_).cwiseMin(upper_);
}

Document ParameterSpace::scene(const Eigen::VectorXd& point, const MeasuredCut& cut) const {
  const std::vector<Block>& blocks = forward::scene_blocks();
  const bool specimen = cut.extension.has_value();
  Document patched = specimen ? *curves_[cut.curve].specimen : base_;
  if (!specimen) {
    if (cut.curve < curves_.size()) apply_settings(curves_[cut.curve].changes, patched, blocks, "[[curve]] changes");
    patched.set_number("cut.depth", cut.depth, blocks);
    patched.set_number("tool.rake", cut.rake, blocks);
  }
  const auto absent = [&](const std::string& path) { return specimen && !patched.has(table_of(path)); };
  for (Eigen::Index j = 0; j < dimension(); ++j) {
    // exp(log(bound)) may miss the bound by a rounding; the physical range of the parameter would then refuse it.
    const FreeParameter& parameter = free_[static_cast<std::size_t>(j)];
    if (absent(parameter.path)) continue;
    const double inside = std::clamp(value(j, point[j]), parameter.lower, parameter.upper);
    patched.set_number(parameter.path, inside, blocks);
  }
  for (const Tie& tie : ties_)
    if (!absent(tie.path) && !absent(tie.of))
      patched.set_number(tie.path, tie.factor * read_number(patched.read(blocks), tie.of), blocks);
  return patched;
}

double ParameterSpace::friction(const Eigen::VectorXd& point) const {
  return friction_index_ < 0 ? fixed_friction_ : value(friction_index_, point[friction_index_]);
}

}  // namespace kerf::inverse
