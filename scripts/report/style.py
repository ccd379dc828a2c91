"""The look of the figures, and their way into the page as inline SVG."""

import io
import itertools
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap  # noqa: E402

INK = "#1b2629"
QUIET = "#5f7076"
RULE = "#cfd8d9"
ACCENT = "#1d6b73"
ACCENT_LIGHT = "#7fb3b3"
ACCENT_PALE = "#e3eeee"
WARM = "#b9572a"
WARM_LIGHT = "#e0a884"
SAND = "#c9b78f"

# From paper to deep water: lightness falls steadily, so that it survives a grey printer.
STRAIN = LinearSegmentedColormap.from_list("strain", ["#e9eeec", "#b5d3d0", "#5fa3a5", "#1d6b73", "#0d3a44", "#071c26"])

BALANCE = LinearSegmentedColormap.from_list("balance", ["#b9572a", "#eec9b2", "#f7f8f7", "#b5d3d0", "#1d6b73"])

FONTS = "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"

plt.rcParams.update({
    "svg.fonttype": "none",  # text stays text: searchable, and in the page's own font
    "font.family": "DejaVu Sans",  # ships with matplotlib: layouts do not depend on the machine
    "font.size": 12,
    "text.color": INK,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.labelsize": 12,
    "axes.labelpad": 8,
    "axes.titlesize": 12.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 10,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelsize": 11.5,
    "ytick.labelsize": 11.5,
    "xtick.major.size": 4,
    "ytick.major.size": 4,
    "grid.color": RULE,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 11.5,
    "legend.handlelength": 2.2,
    "lines.linewidth": 2,
    "lines.solid_capstyle": "round",
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "none",
    "savefig.dpi": 220,
})

_numbers = itertools.count(1)


def figure(width, height, rows=1, columns=1, **options):
    """A figure measured in the page's pixels, and its axes."""
    return plt.subplots(rows, columns, figsize=(width / 72, height / 72), layout="constrained", **options)


def light_grid(axes, axis="y"):
    axes.grid(True, axis=axis)
    axes.tick_params(axis=axis, length=0)
    if axis == "y":
        axes.spines["left"].set_visible(False)


def svg(fig, description):
    """Inline SVG that scales with the column, is named for screen readers, and shares no ids with other figures."""
    target = io.StringIO()
    fig.savefig(target, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    plt.close(fig)
    text = target.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.S)
    head, rest = text.split(">", 1)
    view_box = re.search(r'viewBox="[^"]*"', head).group(0)
    width = float(re.search(r'viewBox="\S+ \S+ (\S+) ', head).group(1))
    prefix = f"f{next(_numbers)}-"
    rest = re.sub(r'\bid="', f'id="{prefix}', rest)
    rest = rest.replace('"#', f'"#{prefix}').replace("url(#", f"url(#{prefix}")
    rest = re.sub(r"'DejaVu Sans'(, [^;\"]*)?", FONTS, rest)
    rest = re.sub(r"(<text[^>]*>)([^<]*)(</text>)", lambda m: m[1] + _symbols(m[2]) + m[3], rest)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {view_box} '
            f'role="img" aria-label="{_escape(description)}" style="max-width:{width:.0f}px">{rest}')


def _escape(text):
    return text.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")


def _symbols(text):
    """F_c becomes an italic letter with a subscript, as in the text of the page."""
    down = '<tspan dy="0.28em" font-size="75%">{}</tspan><tspan dy="-0.21em">\u200b</tspan>'
    return re.sub(r"\b([A-Za-zσμχ])_([A-Za-z]+)\b",
                  lambda m: f'<tspan font-style="italic">{m[1]}</tspan>' + down.format(m[2]), text)
