# SPDX-License-Identifier: MIT
# Looks at charts from outside: named, whole, inside their ground, legible in light and dark, true to their values.
# Luminance and contrast as WCAG 2.2 defines them.
#   check.py <folder of the pictures> <source folder>
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
require(len(pictures) == 3, f"pictures: {list(pictures)}")
for name in pictures:
    page = (folder / f"{name}.html").read_text(encoding="utf-8")
    require(page.count("<svg ") == page.count("<title>") - 1 == 2, f"{name}.html has not a chart for wide and one for narrow windows")

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

for word in ("target", "prediction", "target, 3 σ", "prediction, 3 σ", "a & b, roll", "dp/dt, std. dev."):
    require(word in words(pictures["ellipses"]), f"ellipses.svg does not name: {word}")
require("a & b" in pictures["ellipses"].find(svg + "desc").text, "the description of ellipses.svg lost a model's name")
