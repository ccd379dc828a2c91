"""How pages of calibrations name and write what was estimated."""

from .page import finite, html, interval_text, large_unit, symbol, with_error

SYMBOLS = {"toughness": symbol("G", "c"), "yield_stress": symbol("σ", "y"), "friction": symbol("μ"),
           "edge_force": symbol("F", "b"), "strength": symbol("σ", "c"), "adhesion_toughness": symbol("G", "a"),
           "elastic_modulus": symbol("E"), "hardening_modulus": symbol("H")}
PLAIN = {"toughness": "G_c", "yield_stress": "σ_y", "friction": "μ", "edge_force": "F_b", "strength": "σ_c"}


def name_of(name):
    return html('<span style="white-space:nowrap">{} {}</span>', name.replace("_", " "), SYMBOLS.get(name, ""))


def value_text(p):
    if not finite(p.get("value")):
        return "–"
    factor, unit = large_unit(p["unit"], [p["value"]])
    error = p.get("se")
    return with_error(p["value"] * factor, error * factor if finite(error) else None, unit)


def interval_of(p, key="interval"):
    interval = p.get(key)
    if not interval:
        return "–"
    factor, unit = large_unit(p["unit"], [p.get("value")])
    return interval_text(interval, factor)


def estimates_of(result):
    return {**result["parameters"], **(result.get("derived") or {})}


def plain_name(name):
    return PLAIN.get(name, name.replace("_", " "))


def titled(name):
    return name.replace("_", " ") + (f" {PLAIN[name]}" if name in PLAIN else "")
