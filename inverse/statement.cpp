#include "inverse/statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

/// To the second digit of its error, so that no digit means nothing, but to two of its own at least; without an error
/// to three.
std::string number(double value, double error = 0.0) {
  if (!std::isfinite(value)) return "unknown";
  const auto exponent = [](double x) { return static_cast<int>(std::floor(std::log10(std::abs(x)))); };
  const bool known = error > 0.0 && std::isfinite(error);
  const int own = value == 0.0 ? 0 : exponent(value);
  const int last = known ? std::min(exponent(error) - 1, own - 1) : std::min(0, own - 2);
  const double one = std::pow(10.0, last), rounded = last > 0 ? std::round(value / one) * one : value;
  const double magnitude = std::abs(rounded);
  if (magnitude >= 1e6 || (magnitude > 0 && magnitude < 1e-3))
    return fmt::format("{:.{}e}", rounded, known ? std::clamp(exponent(rounded) - last, 0, 9) : 2);
  return fmt::format("{:.{}f}", rounded, std::max(0, -last));
}

std::string between(const Interval& interval, const std::string& unit, double error) {
  const double one = consistent_units_in(unit);
  return fmt::format("{} to {}{}", number(interval.lower / one, error / one), number(interval.upper / one, error / one),
                     unit == "1" ? "" : " " + unit);
}

std::string plain(const std::string& name) {
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string about(const ParameterEstimate& p, const Interval& all) {
  const std::string name = plain(p.name);
  const double one = consistent_units_in(p.unit);
  const double error = p.standard_error;
  const auto shown = [&](double value) { return show(value, p.unit, error); };
  switch (p.verdict) {
    case Verdict::measured:
      return fmt::format("{} is measured: {} with a standard error of {} (95 % interval {}).", name, shown(p.value),
                         shown(error), between(all, p.unit, error));
    case Verdict::bounded:
      return fmt::format("{} is only bounded: {} fits best, but anything from {} agrees with the data.", name,
                         shown(p.value), between(all, p.unit, error));
    case Verdict::bounded_above:
      return fmt::format(
          "{} is only bounded above: at most {} (best fit {}; the lower end of the search, {}, is not excluded).", name,
          shown(all.upper), shown(p.value), number(p.bounds.lower / one));
    case Verdict::bounded_below:
      return fmt::format(
          "{} is only bounded below: at least {} (best fit {}; the upper end of the search, {}, is not excluded).",
          name, shown(all.lower), shown(p.value), number(p.bounds.upper / one));
    case Verdict::not_measurable:
      break;
  }
  return fmt::format("{} is not measurable with these cuts: the whole range searched, {}, agrees with the data.", name,
                     between(p.bounds, p.unit, 0.0));
}

/// "trades off against sigma: only G sigma^0.7 is known (to 3 %)".
std::string words(const TradeOff& with, const std::string& name) {
  return fmt::format("trades off against {0}: best known is {1} * {0}^{2:.2g}, to {3:.2g} %", plain(with.partner),
                     plain(name), with.exponent, 100 * with.relative_error);
}

std::string about_the_priors(const Job& job) {
  std::string text;
  for (const FreeParameter& p : job.free)
    if (p.prior)
      text += fmt::format("Part of the data is what was known of {} beforehand: {} with a standard deviation of {}. ",
                          plain(p.name), show(p.prior->value, p.unit), show(p.prior->standard_error, p.unit));
  return text;
}

/// Whether the scatter about the fit is what the measured errors allow.
std::string about_the_fit(const Identifiability& identifiability) {
  const int freedom = identifiability.degrees_of_freedom;
  const double chi2 = identifiability.chi2;
  if (freedom <= 0)
    return fmt::format("There are no more data than parameters (chi2 = {}), so the fit cannot be judged.",
                       number(chi2));
  const double p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), chi2));
  std::string text = fmt::format("The fit leaves chi2 = {} with {} degree{} of freedom", number(chi2), freedom,
                                 freedom == 1 ? "" : "s");
  text += p < 0.01 ? fmt::format(
                         ", which measured errors alone would exceed in {} of cases only: the model misses "
                         "something that matters",
                         p < 1e-4 ? "less than 0.01 %" : fmt::format("{:.2g} %", 100 * p))
          : p < 0.05 ? ", which is more than measured errors usually leave"
                     : ", as the measured errors let expect";
  if (identifiability.error_scale > 1)
    text += fmt::format("; all errors are scaled up by {:.2f} for it", identifiability.error_scale);
  return text + ".";
}

std::string about_the_edge(const Calibration& calibration) {
  std::string text;
  const auto describe = [](const Fit& fit) {
    std::string values;
    for (const ParameterEstimate& p : fit.identifiability.parameters)
      values +=
          fmt::format("{}{} {}", values.empty() ? "" : ", ", plain(p.name), show(p.value, p.unit, p.standard_error));
    return fmt::format("{}: {} (chi2 {})", fit.assumption, values, number(fit.residuals.chi2));
  };
  for (const Fit& other : calibration.alternatives) {
    if (!other.model) continue;
    text += fmt::format(" What the tool's edge adds to the cutting force is an assumption, not a measurement. {}; {}.",
                        describe(calibration.fit), describe(other));
    if (!other.converged) text += fmt::format(" (The second fit did not converge: {}.)", other.reason);
  }
  if (!text.empty()) text += " The verdicts above hold over both.";
  return text;
}

/// What the estimates owe to the numerics, where it is worth a word: from half a standard error on.
std::string about_the_numerics(const Calibration& calibration) {
  std::string text;
  for (const NumericsShift& check : calibration.numerics) {
    if (check.shifts.empty()) {
      text += fmt::format(" Under the other numerics \"{}\" no cut could be compared.", check.name);
      continue;
    }
    std::string moved;
    auto shift = check.shifts.begin();
    for (const std::vector<ParameterEstimate>* all :
         {&calibration.fit.identifiability.parameters, &calibration.fit.identifiability.derived})
      for (const ParameterEstimate& p : *all) {
        const double by = *shift++;
        if (!(std::abs(by) > 0.5 * p.standard_error)) continue;
        moved += fmt::format("{}{} by {} ({:.1f} standard errors)", moved.empty() ? "" : ", ", plain(p.name),
                             show(by, p.unit, p.standard_error), std::abs(by) / p.standard_error);
      }
    text += moved.empty() ? fmt::format(" Under the other numerics \"{}\" no estimate moves by half a standard error.",
                                        check.name)
                          : fmt::format(" Under the other numerics \"{}\" estimates move: {}; no interval holds this.",
                                        check.name, moved);
  }
  return text;
}

/// Cuts that a step of a parameter, or parameters that the data allow, moved to the other branch.
std::string about_the_branches(const Job& job, const Fit& fit) {
  std::string cuts;
  for (std::size_t cut = 0; cut < fit.at_jump.size(); ++cut)
    if (fit.at_jump[cut])
      cuts += fmt::format("{}{} at {} ({})", cuts.empty() ? "" : ", ", show(job.cuts[cut].depth, "mm"),
                          show(job.cuts[cut].rake, "deg"), forward::name(fit.at.runs[cut].branch));
  if (cuts.empty()) return "";
  return " These data sit at the jump between a touching and a bending chip: within the intervals, or a step of one "
         "parameter away, the branch changes of " +
         cuts + ". Slopes are those of the branch named; across the jump the intervals promise nothing.";
}

/// Cuts that were left out because no simulation of them could be compared.
std::string about_the_failed(const Job& job, const Fit& fit) {
  std::string left_out;
  std::size_t count = 0;
  for (std::size_t cut = 0; cut < fit.at.usable.size(); ++cut) {
    if (fit.at.usable[cut]) continue;
    ++count;
    const MeasuredCut& measured = job.cuts[cut];
    const std::vector<std::string>& refusals = fit.at.runs[cut].refusals;
    left_out += fmt::format("{}{} {} ({})", left_out.empty() ? "" : ", ", measured.extension ? "extension" : "depth",
                            show(measured.extension.value_or(measured.depth), "mm"),
                            refusals.empty() ? "it could not be compared" : refusals.front());
  }
  if (count == 0) return "";
  return fmt::format("Of {} cuts {} {} left out: {}. ", fit.at.usable.size(), count, count == 1 ? "is" : "are",
                     left_out);
}

}  // namespace

std::string show(double value, const std::string& unit, double error) {
  const double one = consistent_units_in(unit);
  return number(value / one, error / one) + (unit == "1" ? "" : " " + unit);
}

std::string state(const Job& job, const Calibration& calibration) {
  const Fit& fit = calibration.fit;
  std::string text;
  if (calibration.exit_code == ExitCode::too_many_failed_runs) {
    text = fmt::format("Too many simulated cuts failed ({} of {}), so nothing is claimed.",
                       std::count(fit.at.usable.begin(), fit.at.usable.end(), false), fit.at.usable.size());
    for (std::size_t cut = 0; cut < fit.at.runs.size(); ++cut)
      for (const std::string& refusal : fit.at.runs[cut].refusals)
        text += fmt::format(" At depth {}: {}.", show(job.cuts[cut].depth, "mm"), refusal);
    return text;
  }
  if (calibration.partial && fit.converged) text = "Stopped before the other assumption about the edge was fitted. ";
  if (!fit.converged)
    text = fmt::format("The search did not converge: {}. What follows is where it stopped. ", fit.reason);
  if (!fit.model)
    return text +
           (calibration.partial ? "It was stopped before the differences that errors come from"
                                : "The budget did not cover the differences that errors come from") +
           ", so no parameter is judged.";
  text += about_the_failed(job, fit);
  for (const std::vector<ParameterEstimate>* all : {&fit.identifiability.parameters, &fit.identifiability.derived})
    for (const ParameterEstimate& p : *all) {
      std::string sentence = about(p, over_all_assumptions(calibration, p.name));
      if (p.trade_off) sentence += " It " + words(*p.trade_off, p.name) + ".";
      sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
      text += sentence + " ";
    }
  text += about_the_priors(job);
  text += about_the_fit(fit.identifiability);
  text += about_the_numerics(calibration);
  text += about_the_branches(job, fit);
  text += about_the_edge(calibration);
  if (!job.ties.empty()) {
    text += " All of this holds for the ties of the job:";
    for (const Tie& tie : job.ties) text += fmt::format(" {} = {:g} {};", tie.path, tie.factor, tie.of);
    text.back() = '.';
  }
  return text;
}

}  // namespace kerf::inverse
