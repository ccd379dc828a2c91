"""A page as a list of sections, each a list of parts; the template turns it into HTML."""

import math
import re
from dataclasses import dataclass, field
from pathlib import Path

import jinja2
from markupsafe import Markup, escape

from . import style


@dataclass
class Section:
    title: str
    parts: list = field(default_factory=list)
    anchor: str = ""
    short: str = ""  # its name in the list of contents

    def text(self, body):
        return self._add("text", body)

    def table(self, heads, rows, numeric=()):
        return self._add("table", {"heads": heads, "rows": rows, "numeric": set(numeric)})

    def facts(self, facts):
        """(name, value, remark) three by three."""
        return self._add("facts", facts)

    def figure(self, svg, caption=""):
        return self._add("figure", {"svg": Markup(svg), "caption": caption})

    def warnings(self, lines):
        return self._add("warnings", lines) if lines else self

    def missing(self, body):
        return self._add("missing", body)

    def source(self, summary, text):
        return self._add("source", {"summary": summary, "text": text})

    def paste(self, text):
        """A paragraph that one click selects as a whole."""
        return self._add("paste", text)

    def fold(self, summary):
        """Parts that stay folded until they are asked for: fill what is returned."""
        inside = Section(summary)
        self._add("fold", inside)
        return inside

    def _add(self, kind, body):
        self.parts.append({"kind": kind, "body": body})
        return self


@dataclass
class Page:
    kicker: str
    title: str
    headline: list
    code_version: str
    sections: list = field(default_factory=list)

    def section(self, title, anchor="", short=""):
        self.sections.append(Section(title, anchor=anchor, short=short))
        return self.sections[-1]

    def html(self):
        loader = jinja2.FileSystemLoader(Path(__file__).parent)
        environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                         undefined=jinja2.StrictUndefined)
        return environment.get_template("page.html.j2").render(page=self, style=style)


def symbol(letter, index=""):
    """A quantity's letter as the papers print it."""
    down = Markup("<sub>{}</sub>").format(index) if index else ""
    return Markup('<i class="s">{}</i>{}').format(letter, down)


def chip(text, kind=""):
    return Markup('<span class="chip {}">{}</span>').format(kind, text)


def html(template, *values):
    """Template text is trusted, values are escaped."""
    return Markup(template).format(*(value if isinstance(value, Markup) else escape(value) for value in values))


def finite(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def number(value, error=None, digits=3):
    """Rounded to what its standard error (two digits) or `digits` significant digits support; thousands grouped."""
    if not finite(value):
        return "–"
    reference = error if finite(error) and error > 0 else None
    if reference is None:
        decimals = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    else:
        decimals = 1 - math.floor(math.log10(reference))
    decimals = min(decimals, 6)
    rounded = round(value, decimals)
    return f"{rounded:,.{max(decimals, 0)}f}".replace("-", "−").replace(",", "\u202f")


def integer(value):
    return f"{round(value):,}".replace("-", "−").replace(",", "\u202f") if finite(value) else "–"


def interval_text(interval, factor=1.0, digits=3):
    """"7.8 … 25"; an end that is not there is infinite."""
    lower, upper = interval
    return (f"{number(lower * factor, digits=digits) if finite(lower) else '−∞'} … "
            f"{number(upper * factor, digits=digits) if finite(upper) else '∞'}")


def prose(text):
    """Plain text from a result, with its symbols set as symbols."""
    text = re.sub(r"\b\d(\.\d+)?e\+\d+\b", lambda m: integer(float(m[0])), text)
    text = text.replace("J/m^2", "J/m²").replace("+-", "±")
    parts = re.split(r"\b([FGσ])_([a-zA-Z])\b|(chi2)", text)
    out = Markup("")
    ends = [None]
    for plain, letter, index, square in zip(parts[0::4], parts[1::4] + ends, parts[2::4] + ends, parts[3::4] + ends):
        out += escape(plain)
        out += symbol(letter, index) if letter else escape("χ²" if square else "")
    return out


def with_error(value, error, unit=""):
    text = number(value, error)
    if finite(error) and finite(value):
        text += f" ± {number(error, error)}"
    return text + (f" {pretty_unit(unit)}" if unit and unit != "1" else "")


def pretty_unit(unit):
    return unit.replace("^2", "²").replace("^3", "³").replace("um", "µm") if unit != "1" else ""


def large_unit(unit, values):
    """(factor, unit) that keeps the numbers of an axis short: kN/m and kJ/m² from twenty thousand on."""
    largest = max((abs(v) for v in values if finite(v)), default=0)
    if unit in ("N/m", "J/m^2") and largest >= 2e4:
        return 1e-3, "k" + unit
    return 1.0, unit
