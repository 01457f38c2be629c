# SPDX-License-Identifier: MIT
"""The drawings of a study's report, as SVG for its page: Figs. 2, 3, 7, 8 and 9 of the paper, and every seed's change.
Matplotlib draws in the light colours of tools/page/palette.css; in the SVG they become its names, so that a drawing is
dark where the page is."""
import html
import io
import itertools
import logging
import math
import re
from pathlib import Path

import numpy as np

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # no word of a font cache or of a home that can't be written
from matplotlib import rcParams  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.patches import PathPatch  # noqa: E402
from matplotlib.path import Path as Line  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402

from report_claims import ERROR, TABLE_2, TABLE_3, mean_and_deviation, model_words, paper_change  # noqa: E402
from report_rows import AXES  # noqa: E402

LIGHT = (Path(__file__).resolve().parent.parent / "page/palette.css").read_text().split("@media")[0]
PALETTE = dict(re.findall(r"--([\w-]+): (#\w{6});", LIGHT))
TEXT, MUTED, GRID = PALETTE["text"], PALETTE["muted"], PALETTE["line"]
BLUE, ORANGE, GREEN, AMBER, RED, VIOLET = (PALETTE[f"series-{number}"] for number in range(1, 7))
rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "pinnquad", "font.size": 9, "axes.titlesize": 9, "axes.unicode_minus": True,
    "text.color": TEXT, "axes.labelcolor": MUTED, "xtick.color": MUTED, "ytick.color": MUTED, "axes.edgecolor": GRID,
    "grid.color": GRID, "axes.grid": True, "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
    "legend.frameon": False, "figure.facecolor": "none", "axes.facecolor": "none", "lines.linewidth": 1.4})
WIDE, NARROW = 7.8, 3.7  # inches: a window's width, and a phone's
MOST_POINTS = 450  # more only darken a cloud
RATES = ("dp/dt", "dq/dt", "dr/dt")
number = itertools.count(1)


def svg(title, description, draw):
    """draw(width) makes a figure; the page shows that for wide or that for narrow windows."""
    both = ""
    for width, name in (WIDE, "wide-chart"), (NARROW, "narrow-chart"):
        figure, content = draw(width), io.StringIO()
        canvas = FigureCanvasSVG(figure)
        figure.tight_layout()
        canvas.print_svg(content, metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
        text = content.getvalue().partition("<svg")[2]
        text = re.sub(r"<metadata>.*?</metadata>|<defs>\s*<style.*?</defs>|<!--.*?-->", "", text, flags=re.S)
        used = set(re.findall(r'(?:href="|url\()#([\w-]+)', text))
        prefix = f"drawing-{next(number)}-"  # ids of all drawings share the page
        text = re.sub(r' id="([\w.-]+)"', lambda m: f' id="{prefix}{m[1]}"' if m[1] in used else "", text)
        text = re.sub(r'(href="|url\()#', rf"\1#{prefix}", text).replace("xlink:href", "href")
        text = re.sub(r"font: ([\d.]+px) [^;\"]*", r"font-size: \1", text)
        text = re.sub('"[^"]*"', lambda all: re.sub(r"-?\d+\.\d{3,}", lambda m: f"{float(m[0]):.2f}", all[0]), text)
        for word, colour in PALETTE.items():
            text = text.replace(colour, f"var(--{word})")
        box = re.search(r'viewBox="[^"]*"', text)[0]
        both += (f'<svg class="{name}" role="img" {box} font-family="Inter,Helvetica Neue,Helvetica,Arial,Liberation '
                 f'Sans,DejaVu Sans,sans-serif"><title>{html.escape(title)}</title>'
                 f"<desc>{html.escape(description)}</desc>" + re.sub(r"\n\s*", "\n", text.partition(">")[2]))
    return both


def points(axes, x, y, colour, size, opacity=1.0, mark=((0, 0),)):
    """One path for a cloud: strokes through `mark`, offsets in the axes' units; (0, 0) alone is a dot."""
    strokes = [(0, 0), (0, 0)] if len(mark) == 1 else mark
    corners = [(a + dx, b + dy) for a, b in zip(x, y) for dx, dy in strokes]
    line = Line(corners, [Line.MOVETO, Line.LINETO] * (len(corners) // 2))
    line.should_simplify = False
    axes.add_artist(PathPatch(line, edgecolor=colour, facecolor="none", linewidth=size, capstyle="round",
                              alpha=opacity))
    axes.update_datalim(corners)


def rows_of(axes, names):
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", length=0)


def marks(title, description, label, rows, series, line=None, styled=None):
    """A line for each of `rows`, a mark for each series ({name: {row: value}}) on it; a logarithmic axis. Nothing where
    there is no value. `styled`: names in the order of their marks, where drawings share them."""
    if not series:
        return ""
    styles = dict(zip(styled or series, zip(itertools.cycle((ORANGE, BLUE, GREEN, AMBER, RED, VIOLET)),
                                            itertools.cycle("osD^P"))))

    def draw(width):
        columns = 4 if width == WIDE else 2
        figure = Figure((width, 0.8 + 0.24 * -(-len(series) // columns) + 0.36 * len(rows)))
        axes = figure.subplots()
        if line is not None:
            axes.axvline(line, color=MUTED)
        for at, name in enumerate(series):
            colour, mark = styles[name]
            levels = [rows.index(row) + 0.6 * ((at + 0.5) / len(series) - 0.5) for row in series[name]]
            axes.plot(list(series[name].values()), levels, mark, color=colour, markersize=5, label=name, alpha=0.8)
        rows_of(axes, rows)
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(lambda value, at: f"{value:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel(label, loc="right")
        axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=columns)
        return figure
    return svg(title, f"{description}.", draw)


def lines(title, description, across, up, panels):
    """{panel: {name: (x, y)}}, one panel beside the other, below each other where the window is narrow."""
    names = list(dict.fromkeys(name for panel in panels.values() for name in panel))
    colours = dict(zip(names, itertools.cycle((BLUE, ORANGE, GREEN, AMBER, RED, VIOLET))))

    def draw(width):
        wide = width == WIDE
        figure = Figure((width, 3.2 if wide else 3 * len(panels)))
        grid = figure.subplots(*((1, len(panels)) if wide else (len(panels), 1)), squeeze=False)
        for axes, (panel, shown) in zip(grid.flat, panels.items()):
            for name, (x, y) in shown.items():
                axes.plot(x, y, "-" if names.index(name) < 6 else "--", color=colours[name], label=name)
            axes.set(title=panel, xlabel=across, ylabel=up)
            axes.legend(fontsize=8)
        return figure
    return svg(title, f"{description}.", draw)


def bars(title, label, values, most):
    """{name: value}; a bar that is longer than `most` is broken there."""
    if not values:
        return ""
    end = min(most, 1.15 * max(values.values()))

    def draw(width):
        figure = Figure((width, 0.7 + 0.28 * len(values)))
        axes = figure.subplots()
        for row, value in enumerate(values.values()):
            axes.barh(row, value, 0.6, color=BLUE)
            inside = value > 0.9 * end
            axes.annotate(f"{value:.2f}", (min(value, end), row), xytext=(-4 if inside else 4, 0), va="center",
                          ha="right" if inside else "left", textcoords="offset points",
                          color=PALETTE["background"] if inside else TEXT)
        axes.axvline(1, color=MUTED, linewidth=1)
        rows_of(axes, list(values))
        axes.set_xlim(0, end)
        axes.set_xlabel(label, loc="right")
        return figure
    return svg(title, f"{label}: " + ", ".join(f"{name} {value:.2f}" for name, value in values.items()) + ".", draw)


def schedule(settings, epochs):
    """Fig. 3: the weight of the physics term over the epochs, Eq. (6)."""
    period = (epochs - 1) // settings.cycles + 1
    phase = np.arange(epochs) % period / period
    falls = (1 - phase) / (1 - settings.hold) if settings.hold < 1 else np.ones(epochs)
    weight = settings.lambda_max * np.where(phase <= settings.hold, 1, falls)

    def draw(width):
        figure = Figure((width, 1.9))
        axes = figure.subplots()
        axes.plot(weight, color=BLUE)
        axes.set(xlabel="epoch", ylabel="weight λ", ylim=(0, 1.15 * settings.lambda_max))
        return figure
    return svg("Weight of the physics term", f"The weight λ over the epochs of a training: {settings.cycles} cycles, "
               f"each a hold at {settings.lambda_max:.3f} and a fall to 0.", draw)


def errors(study, models, title):
    """Figs. 7 and 9: mean absolute errors beside the paper's. The axis is that of the networks: the linearized model's
    bar, many times as long, is broken where it leaves it."""
    ours = {model: [1e3 * value for value in mean_and_deviation(study.values(model, ERROR.column))] for model in models}
    paper = {model: [1e3 * value for value in TABLE_3[model][ERROR]] for model in models}
    most = 1.04 * max(value[0] + (value[1] if value[1] > 0 else 0) for entries in (ours, paper)
                      for model, value in entries.items() if model > 1 and math.isfinite(value[0]))
    means = {model: f"{mean:.2f}" if math.isfinite(mean) else "no figure" for model, (mean, _) in ours.items()}
    names = [f"M{model}  {model_words(model)}  {mean}" for model, mean in means.items()]

    def draw(width):
        figure = Figure((width, 0.9 + 0.34 * len(models)))
        axes = figure.subplots()
        for row, model in enumerate(models):
            (mean, deviation), (reference, spread) = ours[model], paper[model]
            colour = MUTED if model == 1 else (RED, GREEN, AMBER, ORANGE, VIOLET, BLUE)[max(0, (model - 3) // 2)]
            axes.barh(row - 0.14, mean, 0.42, color=colour, alpha=0.62 if model > 1 and not TABLE_2[model].term else 1)
            if mean > most:
                axes.annotate(f"{mean:.2f}; the paper {reference:.2f}", (most, row - 0.14), xytext=(-6, 0), va="center",
                              ha="right", textcoords="offset points", color=PALETTE["background"])
            elif deviation > 0:
                axes.errorbar(mean, row - 0.14, xerr=deviation, color=TEXT, linewidth=1, capsize=2)
            if reference <= most:
                axes.errorbar(reference, row + 0.24, xerr=spread, fmt="D", color=ORANGE, markersize=4, linewidth=1)
        rows_of(axes, names)
        axes.set_xlim(0, most)
        axes.set_xlabel(f"{ERROR.label} of the commands, 10⁻³", loc="right")
        return figure
    return svg(title, f"{ERROR.label} of the commands, 10⁻³: {', '.join(names)}.", draw)


def changes(comparisons):
    """Every seed's relative change of the error, per pair; a stroke is the mean, a diamond the paper's."""
    shown = [c for c in comparisons if c.measure == ERROR and math.isfinite(c.result.change)]
    if not shown:
        return ""
    names = [f"M{c.pair[1]} against M{c.pair[0]}" for c in shown]

    def draw(width):
        figure = Figure((width, 1.1 + 0.36 * len(shown)))
        axes = figure.subplots()
        axes.axvline(0, color=MUTED)
        for row, c in enumerate(shown):
            levels = row + 0.12 * (np.arange(len(c.changes)) * 2 % 5 - 2)  # five keep near seeds apart
            axes.plot(100 * np.array(c.changes), levels, "o", color=BLUE, markersize=3, alpha=0.65, label="a seed")
            axes.plot([100 * c.result.change] * 2, [row - 0.34, row + 0.34], color=TEXT, linewidth=2.4, label="mean")
            if (paper := paper_change(c.pair, ERROR)) is not None:
                axes.plot(100 * paper, row, "D", color=ORANGE, markersize=5, label="the paper")
        rows_of(axes, [f"{name}, {TABLE_2[c.pair[1]].data}" for name, c in zip(names, shown)])
        axes.set_xlabel("change of the mean absolute error, %", loc="right")
        labels = dict(zip(*axes.get_legend_handles_labels()[::-1]))
        axes.legend(labels.values(), labels, loc="lower right", bbox_to_anchor=(1, 1), ncol=3)
        return figure
    told = ", ".join(f"{name} {100 * c.result.change:+.1f} %" for name, c in zip(names, shown))
    return svg("Relative change of the error by pair and seed", f"Mean change of the mean absolute error: {told}.",
               draw)


def signed_sums(series):
    """By axis: angular acceleration, flown and predicted sum of the commands with the signs of the rotors' torques,
    which all airframes of the paper's rotor order share (Eq. (2))."""
    flown, predicted = (np.array([series[f"{kind}{motor}"] for motor in range(1, 5)]) for kind in "up")
    signs = np.array([[-1, 1, 1, -1], [1, -1, 1, -1], [1, 1, -1, -1]])
    return [(np.array(series[f"wdot_{name}"]), s @ flown, s @ predicted) for name, s in zip("xyz", signs)]


def correlation(series):
    """Fig. 2 of the test block."""
    time, first = np.array(series["time_s"]), slice(0, 200)
    step = slice(None, None, -(-len(time) // MOST_POINTS))

    def draw(width):
        wide = width == WIDE
        figure = Figure((width, 6.2 if wide else 11))
        columns = [2, 1] if wide else [1]
        grid = figure.subplots(6 // len(columns), len(columns), gridspec_kw={"width_ratios": columns})
        pairs = np.reshape(grid, (3, 2))
        for axis, (motion, flown, _), (over_time, cloud) in zip(range(3), signed_sums(series), pairs):
            lines = over_time.plot(time[first], motion[first], color=BLUE, linewidth=2.4, alpha=0.75)
            right = over_time.twinx()
            lines += right.plot(time[first], flown[first], color=ORANGE, linewidth=1.1)
            right.grid(False)
            for axes, values in (over_time, motion[first]), (right, flown[first]):
                if most := 1.1 * np.abs(values).max():
                    axes.set_ylim(-most, most)
            over_time.set(title=AXES[axis], ylabel=f"{RATES[axis]}, rad/s²", xlabel="time, s")
            right.set_ylabel("S")
            if axis == 0:
                over_time.legend(lines, ["angular acceleration", "command sum S"], loc="upper right")
            with np.errstate(invalid="ignore"):
                pearson = np.corrcoef(motion, flown)[0, 1]
            cloud.set(title=f"PCC {pearson:.3f}", xlabel=f"{RATES[axis]}, rad/s²", ylabel="S")
            points(cloud, motion[step], flown[step], BLUE, 2.4, 0.6)
            cloud.autoscale_view()
        return figure
    return svg("Angular acceleration and signed command sum, by axis", "Both over some seconds for roll, pitch and yaw,"
               " acceleration in blue, command sum in orange; beside it over each other, with the Pearson correlation "
               "of all rows.", draw)


def ellipse(x, y):
    """Of the points' covariance at 3 sigma: the angle of the major axis in degrees; the outline from its tip."""
    (xx, xy), (_, yy) = np.cov(x, y)
    root = math.hypot((xx - yy) / 2, xy)
    major = 3 * math.sqrt((xx + yy) / 2 + root)
    minor = 3 * math.sqrt(max((xx + yy) / 2 - root, 0))
    angle, turn = math.atan2(xy, (xx - yy) / 2) / 2, np.linspace(0, 2 * math.pi, 91)
    across, along = major * np.cos(turn), minor * np.sin(turn)
    return math.degrees(angle), (np.mean(x) + across * math.cos(angle) - along * math.sin(angle),
                                 np.mean(y) + across * math.sin(angle) + along * math.cos(angle))


def ellipses(series):
    """Fig. 8, by model and axis: signed command sum over angular acceleration in units of the target's deviations."""
    panels = []
    for model, of_model in series.items():
        for axis, (motion, flown, predicted) in zip(AXES, signed_sums(of_model)):
            slope = np.cov(motion, flown)[0, 1]
            error = abs(np.cov(motion, predicted)[0, 1] / slope - 1) if slope else math.nan
            units = np.std(motion, ddof=1), np.std(flown, ddof=1)
            if not min(units) > 0:
                continue
            x, y, p = motion / units[0], flown / units[1], predicted / units[1]
            target, found = ellipse(x, y), ellipse(x, p)
            angle = abs(math.remainder(target[0] - found[0], 180))
            panels.append((f"M{model}, {axis}", angle, error, x, y, p, target[1], found[1], RATES[AXES.index(axis)]))
    if not panels:
        return ""

    def draw(width):
        columns = 3 if width == WIDE else 1
        lines = -(-len(panels) // columns)
        figure = Figure((width, lines * width / columns * 1.12))
        grid = figure.subplots(lines, columns, squeeze=False)
        for axes, (name, angle, error, x, y, p, target, found, rate) in zip(grid.flat, panels):
            step = slice(None, None, len(x) // MOST_POINTS + 1)
            points(axes, x[step], y[step], BLUE, 1.8, 0.55)
            points(axes, x[step], p[step], ORANGE, 0.7, 0.7, [(-0.06, 0), (0.06, 0), (0, -0.06), (0, 0.06)])
            for (across, up), colour in (target, BLUE), (found, ORANGE):
                axes.plot(across, up, color=colour)
                axes.plot(across[[0, 45]], up[[0, 45]], "--", color=colour)
            axes.set(xlim=(-4.9, 4.9), ylim=(-4.9, 4.9), xlabel=f"{rate}, std. dev.", ylabel="S, std. dev.",
                     aspect="equal")
            axes.set_title(f"{name}\nΔm {angle:.2f}°, slope error {100 * error:.1f} %", color=TEXT)
        return figure
    told = "; ".join(f"{panel[0]}: angle difference {panel[1]:.2f}°" for panel in panels)
    return svg("Confidence ellipses of target and prediction, by model and axis", "Signed command sum S over angular "
               "acceleration in roll, pitch and yaw, in standard deviations of the target: dots and plus signs, "
               f"ellipses, dashed their major axes; the closer the two ellipses, the better; {told}.", draw)
