#include "forward/scene/preset.hpp"
#include "inverse/backend.hpp"
#include "inverse/job.hpp"
#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

std::vector<std::string> observables() {
  return {observable_names.begin(), observable_names.end()};
}

std::vector<Block> declare() {
  return {
      {.path = "",
       .variant = "",
       .meaning = "the calibration itself",
       .parameters = {text("title", "what this calibration is about"),
                      text("scene", "base scene whose parameters are to be found, a path relative to this file"),
                      text("preset", "what accuracy may cost: written over the scenes' own keys (`kerf list preset`)",
                           {forward::preset_names.begin(), forward::preset_names.end()})
                          .if_given(),
                      list("observables", "what simulated and measured cuts are compared by; R-curves always by G_R",
                           observables())},
       .required = true},
      {.path = "curve",
       .variant = "",
       .meaning = "measured points; each one becomes a simulated cut of its depth and rake",
       .parameters = {text("file", "CSV file with a unit in every column's header, a path relative to this file"),
                      text("scene",
                           "the file is an R-curve (crack_extension, G) of this specimen, a scene with [grips], a path "
                           "relative to this file; free parameters stand in it under the same paths")
                          .if_given(),
                      number("shallowest", "mm", 0, 1e3, "points at smaller depths are left out").if_given(),
                      number("deepest", "mm", 0, 1e3, "points at greater depths are left out").if_given(),
                      list("changes",
                           "what differs from the scene in this curve's cuts, written PATH=VALUE, such as "
                           "\"bridging.tool=ignores\"")
                          .if_given(),
                      text("specimen", "only the points of this specimen").if_given(),
                      number("specimen_error", "1", 0, 1,
                             "share by which all that was measured on one specimen is off together (its own toughness, "
                             "its width); a specimen is a label of the file, or the whole file")
                          .or_else("0")},
       .required = true,
       .repeated = true},
      {.path = "free",
       .variant = "",
       .meaning = "a number of the scene that is to be found",
       .parameters =
           {text("path", "where it stands in the scene, such as \"material.yield_stress\""),
            quantity("lower", "smallest value searched"), quantity("upper", "largest value searched"),
            text("scale", "how the search steps: by factors, or by differences", {"log", "linear"}).or_else("log"),
            quantity("start", "first value tried; without it a closed form is asked").if_given(),
            quantity("prior", "what is known of it beforehand: the mean of a normal distribution").if_given(),
            quantity("prior_error", "the standard deviation of that knowledge").if_given(),
            text("name", "its name in results; the last part of the path if absent").if_given(),
            flag("key", "exit with code 6 when the data cannot tell this parameter").or_else("false")},
       .required = true,
       .repeated = true},
      {.path = "tie",
       .variant = "",
       .meaning = "a number of the scene that follows another one: path = equals * of",
       .parameters = {text("path", "the number that follows"), number("equals", "1", 0, 1e9, "the factor"),
                      text("of", "the number that leads")},
       .repeated = true},
      {.path = "derived",
       .variant = "",
       .meaning = "a quantity that follows from the parameters, reported with its own interval",
       .parameters = {text("name", "its name in results"),
                      text("expression",
                           "a sum of products of powers of names or paths, such as \"elastic_modulus * toughness / "
                           "strength^2\""),
                      text("unit", "unit in which it is shown")},
       .repeated = true},
      {.path = "uncertainty",
       .variant = "",
       .meaning = "what is spent on intervals beyond the slopes",
       .parameters =
           {flag("verify",
                 "simulate the ends of the 95 % intervals where max_runs covers them, once for the slopes towards "
                 "them and once for their chi2")
                .or_else("false"),
            number(
                "posterior_moves", "1", 0, 1e6,
                "moves of each walker that samples the posterior density, for a second opinion on every interval; 0: "
                "none. 2000 take about a second")
                .or_else("0")},
       .required = true},
      {.path = "edge_force",
       .variant = "",
       .meaning = "a force per width on the edge of the real tool that the simulated one, being sharp, does not feel; "
                  "found along with the free parameters at no cost in runs",
       .parameters = {text("cutting_share", "its part in the cutting force: none, or its friction mu F_b",
                           {"none", "friction"})
                          .or_else("friction"),
                      number("lower", "N/mm", -1e6, 1e6, "smallest edge force").or_else("0 N/mm"),
                      number("upper", "N/mm", -1e6, 1e6, "largest edge force").or_else("1000 N/mm"),
                      flag("compare", "fit the other share as well and report both").or_else("true")}},
      {.path = "budget",
       .variant = "",
       .meaning = "what the answer may cost",
       .parameters = {number("max_runs", "1", 1, 1e7, "simulated cuts at most").or_else("100"),
                      number("parallel", "1", 1, 4096, "simulations at a time").or_else("2"),
                      number("tolerance", "1", 1e-9, 10, "stop when chi^2 is not expected to fall by more than this")
                          .or_else("0.02"),
                      number("failing_share", "1", 0, 1,
                             "share of the cuts whose simulation may fail at the estimate (above it: exit code 5)")
                          .or_else("0.34"),
                      number("time_out", "1", 1.5, 1e6,
                             "a run is given up after this many medians of the finished runs of its cut")
                          .or_else("10"),
                      number("shortest_time_out", "s", 0.1, 1e7,
                             "but never before this much of the processor's time, or as long without any")
                          .or_else("60 s"),
                      number("first_time_out", "s", 0.1, 1e7,
                             "a run's processor time while none of its job has finished")
                          .or_else("3600 s"),
                      text("backend", "where runs live: processes of this machine, or jobs of a Slurm cluster",
                           backend_names())
                          .or_else("local")},
       .required = true},
      {.path = "optimiser",
       .variant = "",
       .meaning = "how the minimum is looked for",
       .parameters = {text("method", "the search", optimiser_names()).or_else("gauss_newton"),
                      number("step", "1", 1e-8, 0.5,
                             "difference step: change of ln(value), or share of a linear range; the audit finds it, "
                             "without one it is 0.04")
                          .if_given(),
                      number("noise", "1", 0, 0.5,
                             "relative roughness of a simulated force; smaller gains are not believed; the audit finds "
                             "it, without one it is 0.001")
                          .if_given(),
                      flag("central", "two-sided differences, for twice the runs").or_else("false"),
                      flag("audit", "measure the simulation's noise first; true unless step and noise are both given")
                          .if_given()},
       .required = true},
      {.path = "coarse",
       .variant = "",
       .meaning = "what a search by several fidelities looks at first; without this block: half the cells",
       .parameters = {text("model", "who answers: the simulation, or Williams' minimised shear plane at no cost",
                           {"simulation", "closed_form"})
                          .or_else("simulation"),
                      list("changes",
                           "what differs from the scene in a coarse run, written PATH=VALUE, such as "
                           "\"resolution.cells_through_chip=3\"; without any half the cells")
                          .if_given()}},
      {.path = "numerics",
       .variant = "",
       .meaning = "another numerical choice under which the cuts at the estimate are simulated once more: what the "
                  "estimates owe to it is reported",
       .parameters = {text("name", "its name in results, such as \"mesh\""),
                      list("changes",
                           "what differs from the scene, written PATH=VALUE, such as "
                           "\"resolution.cells_through_chip=12\"")},
       .repeated = true},
      {.path = "discrepancy",
       .variant = "",
       .meaning = "error granted to the model itself, added to the measured standard errors",
       .parameters = {number("relative", "1", 0, 1, "share of every measured value")}},
  };
}

}  // namespace

const std::vector<Block>& job_blocks() {
  static const std::vector<Block> blocks = declare();
  return blocks;
}

}  // namespace kerf::inverse
