#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A picture of a run of bench/run: for each shape of network, the time of one prediction over the time that its
multiply-adds alone would take, a bar per instruction set. Needs matplotlib.

    bench/picture.py DIR OUT.svg MACHINE...
"""
import pathlib
import sys

import matplotlib
import table

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402

matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "pinnquad", "font.family": "sans-serif"})


def main():
    folder, out, machines = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
    figure, axes = pyplot.subplots(figsize=(9, 4.2))
    width = 0.8 / len(machines)
    for m, machine in enumerate(machines):
        context, found = table.medians(folder / f"{machine}.bench_inference.json")
        shapes = [("10 x 25\n(the paper's)", "Predict/paper_network", "Peak/fma")]
        for name in sorted((n for n in found if n.startswith("Shape/")), key=lambda n: found[n]["median"]):
            shape = name.removeprefix("Shape/")
            shapes.append((shape.replace("x", " x ").replace("_", "\n"), name, f"Peak/{shape}"))
        ratios = [found[of]["median"] / found[limit]["median"] for _, of, limit in shapes]
        places = [i + (m - (len(machines) - 1) / 2) * width for i in range(len(shapes))]
        bars = axes.bar(places, ratios, width * 0.92, label=context["instruction_set"])
        axes.bar_label(bars, fmt="%.1f", fontsize=8)
        axes.set_xticks(range(len(shapes)), [label for label, _, _ in shapes])
    axes.axhline(1, color="black", linewidth=1)
    axes.set_ylabel("time over that of the multiply-adds")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    figure.tight_layout()
    title = "One prediction over its limit, by shape and instruction set"
    figure.savefig(out, format="svg", metadata={"Date": None, "Title": title})


if __name__ == "__main__":
    main()
