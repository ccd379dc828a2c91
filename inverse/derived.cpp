#include "inverse/derived.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "forward/scene/scene.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

/// A number of the scene as the factor of a free parameter (or of nothing).
struct Factor {
  double number = 1;
  std::optional<std::size_t> free;
  std::string unit = "1";
};

class Reader {
 public:
  Reader(const Values& values, const Job& job)
      : values_(values), job_(job), contents_(job.scene.read(forward::scene_blocks())) {}

  DerivedQuantity read() {
    DerivedQuantity derived{.name = values_.text("name"),
                            .unit = values_.text("unit"),
                            .expression = values_.text("expression"),
                            .terms = {}};
    text_ = derived.expression;
    for (bool negative = false;;) {
      derived.terms.push_back(term(negative ? -1 : 1, derived.unit));
      const char sign = next();
      if (sign == 0) break;
      if (sign != '+' && sign != '-') refuse("expected +, -, *, / or ^");
      negative = sign == '-';
      ++at_;
    }
    return derived;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("{}: [[derived]] expression = \"{}\": {}", values_.where("expression"), text_, why));
  }

  /// The next character that is no space, 0 at the end.
  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  DerivedQuantity::Term term(double sign, const std::string& unit) {
    DerivedQuantity::Term term{.factor = sign, .powers = std::vector<double>(job_.free.size(), 0)};
    std::string measures = "1";
    bool whole = true;
    for (bool divides = false;;) {
      const Factor factor = operand();
      double power = 1;
      if (next() == '^') {
        ++at_;
        power = number();
      }
      if (divides) power = -power;
      term.factor *= std::pow(factor.number, power);
      if (factor.free) term.powers[*factor.free] += power;
      whole = whole && (factor.unit == "1" || power == std::round(power));
      for (int i = 0; factor.unit != "1" && i < std::min(std::abs(power), 20.0); ++i)
        measures += fmt::format("{}({})", power > 0 ? "." : "/", factor.unit);
      const char sign_of = next();
      if (sign_of != '*' && sign_of != '/') break;
      divides = sign_of == '/';
      ++at_;
    }
    if (measures.starts_with("1.")) measures.erase(0, 2);
    check(unit, measures, whole);
    return term;
  }

  void check(const std::string& unit, const std::string& measures, bool whole) const {
    try {
      if (!whole) return static_cast<void>(consistent_units_in(unit));  // UDUNITS knows no broken powers
      if (same_dimension(unit, measures)) return;
    } catch (const std::invalid_argument& error) {
      throw InputError(fmt::format("{}: [[derived]] {}", values_.where("unit"), error.what()));
    }
    throw InputError(fmt::format("{}: [[derived]] unit = \"{}\", but a term of \"{}\" is measured in {}",
                                 values_.where("unit"), unit, text_, measures));
  }

  double number() {
    next();
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{}) refuse("a number is missing");
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  Factor operand() {
    const char first = next();
    if (std::isdigit(static_cast<unsigned char>(first))) return {.number = number(), .free = {}};
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == '.'))
      ++at_;
    if (at_ == begin) refuse("a name or a number is missing");
    return resolve(text_.substr(begin, at_ - begin));
  }

  /// A name of a free parameter or a path of the scene, through the ties.
  Factor resolve(const std::string& name) const {
    for (std::size_t j = 0; j < job_.free.size(); ++j)
      if (job_.free[j].name == name || job_.free[j].path == name)
        return {.number = 1, .free = j, .unit = job_.free[j].unit};
    const Parameter& parameter = Document::find_number(name, forward::scene_blocks(), values_.where("expression"));
    for (auto tie = job_.ties.rbegin(); tie != job_.ties.rend(); ++tie)
      if (tie->path == name) {
        Factor factor = resolve(tie->of);
        factor.number *= tie->factor;
        return factor;
      }
    const std::size_t dot = name.rfind('.');
    const std::string block = name.substr(0, dot), key = name.substr(dot + 1);
    if (!contents_.has(block) || !contents_.at(block).has(key))
      refuse(fmt::format("{} does not give \"{}\"", job_.scene.name(), name));
    return {.number = contents_.at(block).number(key), .free = {}, .unit = parameter.unit};
  }

  const Values& values_;
  const Job& job_;
  Contents contents_;
  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace

DerivedQuantity read_derived(const Values& values, const Job& job) {
  for (const FreeParameter& parameter : job.free)
    if (parameter.name == values.text("name"))
      throw InputError(
          fmt::format("{}: the name \"{}\" is taken by a free parameter", values.where("name"), parameter.name));
  return Reader(values, job).read();
}

}  // namespace kerf::inverse
