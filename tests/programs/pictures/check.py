# SPDX-License-Identifier: MIT
# Looks at charts from outside: files named, whole, inside their ground, legible in light and dark, true to their values; the chart
# of a page as the script that draws it reads it, and as the table that is there without.
# Luminance and contrast as WCAG 2.2 defines them.
#   check.py <folder of the pictures> <source folder>
import html
import json
import math
import pathlib
import re
import sys
import xml.etree.ElementTree as tree

folder, project = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
svg = "{http://www.w3.org/2000/svg}"


def require(holds, words):
    if not holds:
        sys.exit("FAILED: " + words)


def luminance(colour):
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    lighter, darker = sorted((luminance(one), luminance(other)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def rising(colours, least, what):
    light = [luminance(c) for c in colours]
    require(len(colours) >= least, f"{what}: {len(colours)} colours")
    require(light == sorted(light) and light[0] < 0.03 and light[-1] > 0.7, f"{what} does not get lighter all along: {colours}")


def palette_colour(element):
    """Its name, None for an element without one."""
    found = re.fullmatch(r"color:var\(--([a-z0-9-]+)\)", element.get("style", ""))
    return found and found.group(1)


def look(path):
    """Returns the picture after what holds for all of them."""
    text = path.read_text(encoding="utf-8")
    root = tree.fromstring(text)
    left, top, width, height = map(float, root.get("viewBox").split())
    name = path.name
    require(root.get("role") == "img", f"{name} is no image to a screen reader")
    require(len(root.find(svg + "title").text) > 15 and len(root.find(svg + "desc").text) > 60, f"{name} is not named")
    ground = root.find(svg + "rect")
    require([float(ground.get(k)) for k in ("x", "width", "height")] == [left, width, height], f"{name} has no ground")
    require(not re.search(r"\b(nan|inf)\b", text, re.I), f"{name} has a coordinate that is no number")
    light, dark = text.split("(prefers-color-scheme: dark)")[:2]
    palettes = [dict(re.findall(r"--([a-z0-9-]+): (#[0-9a-f]{6})", part)) for part in (light, dark.split("@media print")[0])]
    for element in root.iter():
        colour = palette_colour(element)
        if colour in palettes[0]:
            require(element.get("color") == palettes[0][colour], f"{name}: without variables {colour} is another colour")
        if element.tag == svg + "text":
            for palette in palettes:
                require(contrast(palette[colour], palette["background"]) >= 4.5, f"{name}: '{element.text}' is too pale")
            length = 6.9 * len(element.text) * float(element.get("font-size", 12)) / 12
            start = float(element.get("x")) - {"start": 0, "middle": length / 2, "end": length}[element.get("text-anchor")]
            require(start >= left and start + length <= left + width, f"{name}: '{element.text}' leaves the picture")
            require(top + 8 <= float(element.get("y")) <= height - 2, f"{name}: '{element.text}' leaves the picture")
    for palette in palettes:
        for colour in [c for c in palette if c.startswith("series-")]:
            require(contrast(palette[colour], palette["background"]) >= 3, f"{name}: {colour} is too pale")
    return root


def words(root):
    return [element.text for element in root.iter(svg + "text")]


pictures = {path.stem: look(path) for path in sorted(folder.glob("*.svg"))}
require(list(pictures) == ["slow_trajectory", "trajectory"], f"pictures: {list(pictures)}")

# half a metre per second each, as lines and as the scale that explains them
for name, steps in (("trajectory", 16), ("slow_trajectory", 6)):
    colours = [p.get("color") for p in pictures[name].iter(svg + "path") if palette_colour(p) is None]
    require(colours[:steps] == colours[steps:], f"{name}: the scale does not explain the path's colours")
    rising(colours[:steps], steps, name)
    for word in ("start", "end", "shadows on floor and walls", "east, m", "north, m", "height, m", "speed, m/s"):
        require(word in words(pictures[name]), f"{name} does not name: {word}")
anchors = re.compile(r"[\[{](\d+), (\d+), (\d+)[\]}]")
stops = [anchors.findall((project / f"tools/page/{f}").read_text()) for f in ("viridis.hpp", "watch/src/ramp.js")]
require(stops[0] == stops[1] and len(stops[0]) == 10, "charts and the page to watch a flight colour speed differently")

page = (folder / "ellipses.html").read_text(encoding="utf-8")
data, table = re.fullmatch('<div class="chart"><script type="application/json">([^<]*)</script>(.*)</div>', page, re.S).groups()
chart = json.loads(data)
require("a & b </script> pitch" in chart["description"], f"the description lost a model's name: {chart['description']}")
require(chart["columns"] == len(chart["panels"]) == 3, "not a panel an axis, beside each other")
roll = chart["panels"][0]
require(roll["title"] == "a & b </script>, roll" and roll["x"]["name"] == "dp/dt, std. dev." and roll["height"] == 0, f"{roll}"[:300])
require(roll["x"]["most"] == -roll["x"]["least"] == 4.9 and not roll["x"]["rows"] and roll["y"]["logarithmic"] is False, f"{roll['x']}")
shapes = {series["name"]: series["shape"] for series in roll["series"]}
require(shapes == {"target": "dots", "prediction": "pluses", "target, 3 σ": "line", "prediction, 3 σ": "line"}, f"{shapes}")
# the driver's own cloud, in standard deviations
cloud = [(0.05 * (i % 60), 0.61 * i) for i in range(400)]
for name, key, values in (("target", "x", [40 * r * math.cos(a) for r, a in cloud]),
                          ("target", "y", [0.1 * r * math.cos(a + 0.2) for r, a in cloud])):
    deviation = math.sqrt(sum((v - sum(values) / 400) ** 2 for v in values) / 400)
    drawn = next(series for series in roll["series"] if series["name"] == name)[key]
    require(len(drawn) == 400, f"{name}: {len(drawn)} points")
    require(all(abs(d - v / deviation) < 5e-3 for d, v in zip(drawn, values)), f"{name} {key} is not the driver's")
rows = re.findall("<tr><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td>" + 3 * '<td class="n">(.*?)</td>' + "</tr>", table)
wanted = [(panel, series) for panel in chart["panels"] for series in panel["series"]]
require(len(rows) == len(wanted), f"{len(rows)} rows for {len(wanted)} series")
for (title, quantity, name, *figures), (panel, series) in zip(rows, wanted):
    require([html.unescape(t) for t in (title, quantity, name)] == [panel["title"], panel["y"]["name"], series["name"]], f"{title} {name}")
    least, mean, most = (float(figure.replace("\u2212", "-")) for figure in figures)
    y = series["y"]
    require(all(abs(a - b) < 6e-4 for a, b in zip((least, mean, most), (min(y), sum(y) / len(y), max(y)))), f"{name}: {figures}")
