# SPDX-License-Identifier: MIT
"""The pictures that gnuplot draws: named for a screen reader, colours of speed that only get lighter, dots that stand
out from their ground, bars that can be read. Luminance and contrast as WCAG 2.2 defines them."""
import re
import shutil

import pytest
from conftest import SOURCE, Program, needed

COLOUR = r"rgb\( *(\d+), *(\d+), *(\d+)\)"


@pytest.fixture(scope="module")
def drawn(program, tmp_path_factory):
    """drawn(name): the text of a picture."""
    needed("gnuplot")
    folder = tmp_path_factory.mktemp("drawn")
    program("pictures_driver")(".", cwd=folder)
    return {path.name: path for path in folder.glob("*.svg")}


def luminance(colour):
    r, g, b = (c / 255 / 12.92 if c / 255 <= 0.04045 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in map(int, colour))
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


def rising(colours, least):
    """From nearly black to nearly white without a step back."""
    lights = list(map(luminance, colours))
    return len(lights) >= least and lights == sorted(lights) and lights[0] <= 0.03 and lights[-1] >= 0.7


def plot(text, name):
    """What gnuplot drew as that curve."""
    part = text[text.index(f'<g id="gnuplot_plot_{name}"') + 1 :]
    return part[: part.find('<g id="gnuplot_plot_')]


def colour(text, name):
    """Of the curve that is read, not of its name in the key."""
    lines = "\n".join(line for line in plot(text, name).split("\n") if "<g transform" not in line)
    return re.search(rf"(?:stroke|fill|color) *= *[\"']{COLOUR}", lines).groups()


def test_words(drawn):
    assert len(drawn) >= 6, drawn
    for name, path in drawn.items():
        text = path.read_text()
        assert '<svg role="img"' in text, f"{name} is no image to a screen reader"
        assert len(re.search("^<title>(.*)</title>$", text, re.M).group(1)) > 15, name
        assert re.search("^<desc>.{60,}</desc>$", text, re.M), f"{name} has no description"
        assert not re.search(r"<title>(Gnuplot|gnuplot_plot_|\$)|Produced by GNUPLOT",
                             text), f"{name}: gnuplot's own names"
        assert re.search('<rect x="0" y="0" width="[0-9]*" height="[0-9]*" fill="#ffffff"/>',
                         text), f"{name} has no ground"
        if shutil.which("xmllint"):
            Program("xmllint")("--noout", path)
    assert re.search("^<desc>.*a &amp; b", drawn["ellipses.svg"].read_text(),
                     re.M), "the description lost a model's name"


@pytest.mark.parametrize("name, steps", [("trajectory.svg", 16), ("slow_trajectory.svg", 6)])
def test_speeds(drawn, name, steps):
    """Half a metre per second each, as lines and as the box that explains them."""
    text = drawn[name].read_text()
    lines = [colour(text, step + 5) for step in range(steps)]
    assert rising(lines, steps), lines
    box = re.findall(rf"<polygon fill = '{COLOUR}'", text)
    assert lines == [one for i, one in enumerate(box) if i == 0 or one != box[i - 1]]


def test_replay_page_has_the_same_colours():
    page = re.findall(r"^ *\[(\d+), (\d+), (\d+)\],$", (SOURCE / "tools/replay/src/ramp.js").read_text(), re.M)
    pictures = re.sub(r"\s", "", (SOURCE / "tools/pictures/viridis.hpp").read_text())
    assert rising(page, 8) and page == re.findall(r"\{(\d+),(\d+),(\d+)\}", pictures)


def test_path(drawn):
    """Two ends, three shadows; that on the floor is an ellipse about as wide as the box allows."""
    text = drawn["trajectory.svg"].read_text()
    for name in "start", "end", "shadows on floor and walls":
        assert f">{name}<" in text, name
    for shadow in 1, 2, 3:
        assert len(re.findall("[0-9.]+,[0-9.]+", plot(text, shadow))) > 300, f"shadow {shadow} is missing"


@pytest.mark.parametrize("name, curves", [("ellipses.svg", ["1a", "2a", "3a", "4a"]), ("prediction.svg", ["1", "2"])])
def test_stands_out(drawn, name, curves):
    """3:1 against white, as graphical objects need."""
    text = drawn[name].read_text()
    for curve in curves:
        assert 1.05 / (luminance(colour(text, curve)) + 0.05) >= 3, f"curve {curve} is too pale"


def test_bars(drawn):
    """Their heights in pixels are by the given errors, from zero in both panels: 54.9, 8.0, 7.3 | 8.0, 7.3."""

    def heights(text):
        points = re.findall(r"<polygon .*points = '[\d.]+,([\d.]+) [\d.]+,[\d.]+ [\d.]+,([\d.]+) ", text)
        return [float(foot) - float(top) for foot, top in points]

    even, errors = (drawn[name].read_text() for name in ("even_errors.svg", "errors.svg"))
    assert len(heights(even)) == 3 and "scale of its own" not in even, "bars are taken apart that can be compared"
    assert ">without linearized: scale of its own<" in errors
    a, b, c, d, e = heights(errors)
    assert [a / b, b / c, d / e] == [pytest.approx(54.9 / 8, rel=0.01),
                                     *2 * [pytest.approx(8 / 7.3, rel=0.01)]] and e > 200
