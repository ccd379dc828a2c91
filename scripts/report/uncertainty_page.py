"""The part of a calibration's page that says how far its estimates can be trusted."""

from . import uncertainty_figures
from .estimates import SYMBOLS, estimates_of, name_of, plain_name, titled
from .page import finite, html, integer, large_unit, number, pretty_unit, prose


def add_uncertainty(page, result):
    _profiles(page, result)
    _directions(page, result)
    _correlation(page, result)
    _posterior(page, result)
    _error_budget(page, result)


def _profiles(page, result):
    scale = result.get("error_scale") or 1
    quantile = (result.get("identifiability") or {}).get("interval_half_width_in_se") or 1.96
    allowed = (quantile * scale) ** 2
    estimates = [p | {"label": titled(name), "measured": str(p.get("verdict", "")).startswith("measured"),
                      "rise_per_se2": scale ** 2} for name, p in estimates_of(result).items() if finite(p.get("value"))]
    picture = finite(result.get("chi2")) and uncertainty_figures.profiles(estimates, result["chi2"], allowed)
    if not picture:
        return
    section = page.section("Profiles of the misfit", "profiles", "profiles")
    checked = any(finite((end or {}).get("chi2_simulated")) for p in estimates for end in p.get("ends") or ())
    section.figure(picture, html(
        "The least misfit with one quantity held and all others refitted on the quadratics fitted to the simulations; "
        "where it rises by {} the 95 % interval (shaded) ends. Dashed: the parabola of the standard error, from which a "
        "profile that leans or flattens departs.{}", number(allowed),
        " Squares: ends of intervals that were simulated." if checked else ""))


def _directions(page, result):
    seen = result.get("identifiability") or {}
    values = seen.get("singular_values")
    if not values:
        return
    section = page.section("What these cuts can tell apart", "directions", "directions")
    section.figure(uncertainty_figures.directions([plain_name(name) for name in seen["names"]], values,
                                                  seen["singular_vectors"]),
                   "Directions of logarithmic parameter space, best known first, and their components. A singular value is "
                   "the inverse of the relative error along its direction; below 2 (orange) the data do not determine it.")
    if finite(values[-1]) and values[-1] > 0:
        shares = sorted(zip(seen["names"], seen["singular_vectors"][-1]), key=lambda pair: -abs(pair[1] or 0))
        makers = [SYMBOLS.get(name, name.replace("_", " ")) for name, share in shares if abs(share or 0) > 0.3][:2]
        section.text(html("Least known is the direction of {} ({}). {}", html(" with ").join(makers),
                          uncertainty_figures.known_to(values[-1]), _verdicts(result)))


def _verdicts(result):
    """"Yield stress and friction: measured; toughness: bounded above and below." """
    by_verdict = {}
    for name, p in estimates_of(result).items():
        by_verdict.setdefault(p.get("verdict") or "not judged", []).append(name.replace("_", " "))
    text = "; ".join(f"{', '.join(names)}: {verdict}" for verdict, names in by_verdict.items())
    trades = [f"{name.replace('_', ' ')} with {p['trade_off']['with'].replace('_', ' ')} (known is {plain_name(name)} × "
              f"{plain_name(p['trade_off']['with'])}^{number(p['trade_off']['exponent'], digits=2)}, to "
              f"{number(100 * p['trade_off']['relative_error'], digits=2)} %)"
              for name, p in estimates_of(result).items() if p.get("trade_off")]
    return f"In words: {text}." + (f" It trades off: {'; '.join(trades)}." if trades else "")


def _correlation(page, result):
    seen = result.get("identifiability") or {}
    matrix = seen.get("correlation")
    picture = uncertainty_figures.correlation([plain_name(name) for name in seen["names"]], matrix) if matrix else None
    if not picture:
        return
    section = page.section("Correlation of the estimates", "correlation", "correlation")
    pairs = [(abs(matrix[i][j]), i, j) for i in range(len(matrix)) for j in range(i) if finite(matrix[i][j])]
    words = "No pair of estimates is seen by these data."
    if pairs:
        _, i, j = max(pairs)
        names = [SYMBOLS.get(seen["names"][k], seen["names"][k].replace("_", " ")) for k in (j, i)]
        words = html("Strongest between {} and {}: {}. {}", *names, f"{matrix[i][j]:+.2f}".replace("-", "−"),
                     "Beyond ±0.9 only a combination of both is known." if abs(matrix[i][j]) > 0.9 else
                     "Nowhere beyond ±0.9, from where on only a combination of both would be known.")
    section.figure(picture, words)


def _posterior(page, result):
    drawn = result.get("posterior")
    if not drawn:
        return
    estimates = [{"label": titled(name), "unit": p["unit"], "draws": drawn["sample"][name], "interval": p.get("interval"),
                  "credible": drawn["intervals"][name]} for name, p in estimates_of(result).items()
                 if name in drawn["sample"]]
    section = page.section("Posterior density", "posterior", "posterior")
    section.figure(uncertainty_figures.posterior(estimates), html(
        "A second opinion on every interval: {} draws ({} of them independent) from the density of the parameters given the "
        "data, uniform within the bounds of the search, over the quadratics fitted to the simulations. Solid lines: 95 % "
        "intervals by profile; dashed: by the draws. {} draws are shown.", integer(drawn["draws"]), integer(drawn["independent"]),
        integer(len(estimates[0]["draws"]))))


def _error_budget(page, result):
    budget = {name: shares for name, shares in (result.get("error_budget") or {}).items() if shares}
    if not budget:
        return
    section = page.section("Where the errors come from", "budget", "error budget")
    sources = uncertainty_figures.SOURCES
    largest = [f"{titled(name)}: {sources[source][0]} ({number(100 * share, digits=2)} %)"
               for name, shares in budget.items() for source, share in [max(shares.items(), key=lambda pair: pair[1])]]
    absent = [sources[source][0] for source in sources if all((shares.get(source) or 0) < 5e-4
                                                              for shares in budget.values())]
    section.figure(uncertainty_figures.error_budget([(plain_name(name), shares) for name, shares in budget.items()]),
                   prose("Each source's errors carried through the estimator, in per cent of the variance of every estimate. "
                         "Largest for " + ", ".join(largest) + "." +
                         (" Nothing from: " + ", ".join(absent) + "." if absent else "")))
    section.text(html("Cell size, tool speed and damping shift all estimates together and scatter nothing, so they are no "
                      "share of a variance: what is granted to them is the stated error of the model{}.",
                      ", and the table shows what they do" if result.get("numerics") else
                      html(", and a <code>[[numerics]]</code> in the job or <code>kerf study JOB.toml</code> measures "
                           "them")))
    if result.get("numerics"):
        section.table(["under other numerics"] + [name_of(name) for name in result["parameters"]] + ["χ²"],
                      [_shifts(check, result["parameters"]) for check in result["numerics"]])


def _shifts(check, parameters):
    """A row: what one [[numerics]] moves, in the parameters' units and in standard errors."""
    row = [html('{}<br><span class="why">{} cuts compared, {} new runs</span>', check["name"], integer(check["cuts"]),
                integer(check["runs"]))]
    for name, parameter in parameters.items():
        shift = check["shifts"].get(name)
        if not shift or not finite(shift["shift"]):
            row.append("–")
            continue
        factor, unit = large_unit(shift["unit"], [parameter.get("value")])
        by = number(abs(shift["shift"]) * factor, digits=2)
        row.append(html('{}{} {}<br><span class="why">{} standard errors</span>', "−" if shift["shift"] < 0 else "+", by,
                        pretty_unit(unit), number(abs(shift["standard_errors"]), digits=2)
                        if finite(shift["standard_errors"]) else "no"))
    return row + [number(check["chi2"])]
