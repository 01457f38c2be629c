#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The Markdown tables of a run of bench/run: one column per instruction set, figures over their limit of the same run and
what limits them, the other ratios that matter, and medians of CPU time in ns.

    bench/table.py DIR MACHINE...
"""
import json
import pathlib
import sys

PROGRAMS = ["bench_inference", "bench_rollout", "bench_model", "bench_training", "bench_fit", "bench_simulation",
            "bench_peers", "bench_torch"]
READ = "Peak/read_64_kib"
OURS = {"Predict": "Predict/paper_network", "TrainEpoch": "TrainEpoch/vanilla"}  # in bench_peers, beside the peers


def weight_bytes(inputs, layers, width, number=4):
    return number * (inputs * width + width + (layers - 1) * (width + 1) * width + 4 * (width + 1))


# (what, its time, its limit, program, the same without latency or None, bytes of weights)
LIMITS = [
    *((f"prediction, paper's network{words}", f"Predict/paper_network{suffix}", f"Peak/fma{suffix}", "bench_inference",
       f"PredictThroughput/paper_network{suffix}", weight_bytes(16, 10, 25, number))
      for words, suffix, number in (("", "", 4), (" in double", "_double", 8))),
    *((f"prediction, {shape}", f"Shape/{name}", f"Peak/{name}", "bench_inference", f"ShapeThroughput/{name}",
       weight_bytes(inputs, layers, width))
      for shape, name, inputs, layers, width in (
          ("2 layers of 32", "2x32", 16, 2, 32), ("3 of 25", "3x25", 16, 3, 25), ("3 of 64", "3x64", 16, 3, 64),
          ("2 of 128", "2x128", 16, 2, 128), ("2 of 32, 60 inputs", "2x32_windowed", 60, 2, 32),
          ("structured model with 2 of 32", "2x32_structured", 16, 2, 32))),
    ("a sample of a batch of 256", "Batched/paper_network/256", "Peak/fma", "bench_rollout", None, 0),
    ("training epoch", "TrainEpoch/vanilla", "Peak/TrainEpoch", "bench_training", None, 0),
    ("bare simulation step in lanes, over its divisions", "SimulationStep/lanes_bare", "Peak/step_divisions",
     "bench_simulation", None, 0),
]
# (what, numerator, denominator, program): a ratio of two medians of one run; "fastest:a|b" takes the smaller
RATIOS = [
    ("prediction in double, over one in float", "Predict/paper_network_double", "Predict/paper_network",
     "bench_inference"),
    ("naive Eigen (fastest order), over ours", "fastest:Predict/naive_eigen|Predict/naive_eigen_rowmajor",
     "Predict/paper_network", "bench_inference"),
    ("batch of 256, Eigen over ours", "Batched/naive_eigen/256", "Batched/paper_network/256", "bench_rollout"),
    ("value and Jacobian, over one prediction", "Jacobian/paper_network", "Predict/paper_network", "bench_rollout"),
    ("predict() with named inputs, over predict_features()", "Model/predict", "Model/predict_features",
     "bench_model"),
    ("predict() of a block's view, over a header's", "Block/predict_view", "Model/predict", "bench_model"),
    ("training epoch, naive Eigen over ours", "TrainEpoch/naive_eigen", "TrainEpoch/vanilla", "bench_training"),
    ("training epoch, physics-informed over vanilla", "TrainEpoch/physics_informed", "TrainEpoch/vanilla",
     "bench_training"),
    ("training epoch, with batch norm over vanilla", "TrainEpoch/batch_norm", "TrainEpoch/vanilla", "bench_training"),
    ("1 kHz simulation step, over one naive Eigen prediction", "SimulationStep/full", "Predict/naive_eigen",
     "bench_simulation"),
    ("libtorch, frozen, over ours", "Predict/libtorch_frozen", "Predict/paper_network", "bench_torch"),
]
NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def medians(path):
    """Name -> (median, relative deviation) in ns; per sample or per pass where a benchmark counts that."""
    data = json.loads(path.read_text())
    found = {}
    for row in data["benchmarks"]:
        unit = NANOSECONDS[row["time_unit"]]
        name = row["run_name"]
        counted = next((row[c] for c in ("per_sample_ns", "forward_pass_ns") if c in row), None)
        if row["aggregate_name"] == "median":
            found.setdefault(name, {})["median"] = counted if counted is not None else row["cpu_time"] * unit
        if row["aggregate_name"] == "stddev":
            found.setdefault(name, {})["deviation"] = counted if counted is not None else row["cpu_time"] * unit
    return data["context"], found


def pick(found, name):
    if name.startswith("fastest:"):
        return min(found[n]["median"] for n in name[8:].split("|"))
    return found[name]["median"]


def limited_by(over, without_latency, weights, cache, limit):
    """What keeps a figure, at `over` times its limit, from it: "units", the limit itself, within a quarter; "memory",
    weights that the nearest cache does not hold; "latency", if the same work without it is faster by a seventh; else
    "others": instructions beside those that are counted."""
    if over < 1.25:
        return "divisions" if "divisions" in limit else "units"
    if cache and weights > cache:
        return "memory"
    return "latency" if without_latency and without_latency < over / 1.15 else "others"


def nearest_cache(context):
    """Bytes of the data cache nearest to the processor, 0 where the run does not say."""
    return min((c["size"] for c in context.get("caches", []) if c["level"] == 1 and c["type"] != "Instruction"), default=0)


def against_limits(runs, machines):
    """Rows of the table of limits: the words, and a cell per machine."""
    for what, time, limit, program, throughput, weights in LIMITS:
        cells = []
        for machine in machines:
            context, found = runs.get((machine, program), ({}, {}))
            if time not in found or limit not in found:
                cells.append("")
                continue
            peak = found[limit]["median"]
            over = found[time]["median"] / peak
            free = found[throughput]["median"] / peak if throughput in found else None
            limiting = limited_by(over, free, weights, nearest_cache(context), limit)
            if limiting == "memory" and READ in found:
                limiting += f" ({found[time]['median'] / (found[READ]['median'] * weights / 65536):.2f})"
            cells.append(f"{over:.2f} {limiting}")
        yield what, cells


def of_peers(runs):
    """A ratio for each benchmark of a peer: its time over ours, of the same run."""
    names = sorted({name for (_, program), (_, found) in runs.items() if program == "bench_peers" for name in found})
    words = {"Predict": "prediction", "TrainEpoch": "training epoch"}
    kinds = [(name, *name.split("/", 1)) for name in names]
    return [(f"{words[kind]}, {peer} over ours", name, OURS[kind], "bench_peers") for name, kind, peer in kinds
            if kind in OURS and name != OURS[kind]]


def text(value):
    return f"{value:,.0f}" if value >= 1000 else (f"{value:.0f}" if value >= 100 else f"{value:.1f}")


def main():
    folder, machines = pathlib.Path(sys.argv[1]), sys.argv[2:]
    runs = {(m, p): medians(folder / f"{m}.{p}.json") for m in machines for p in PROGRAMS
            if (folder / f"{m}.{p}.json").exists()}
    if not runs:
        sys.exit(f"table.py: {folder}: no results of bench/run")
    context = next(iter(runs.values()))[0]
    kinds = {m: runs[m, "bench_inference"][0]["instruction_set"] for m in machines}
    print(f"{context['compiler']}, {context['flags']}; {context.get('cpu', 'CPU not stated')}; medians of "
          f"CPU time.\n")
    head = "| | " + " | ".join(f"{kinds[m]} (`-march={m}`)" for m in machines) + " |\n" + "|---" * (1 + len(machines)) + "|"

    print("Over the multiply-adds alone, or over what is named, each within one run, and what limits it: units (the limit "
          "itself,\nwithin a quarter), divisions (the same), latency (independent inputs are faster), memory (weights "
          "exceed the nearest\ncache; over reading them alone), others (instructions beside those that are counted).\n\n" + head)
    for what, cells in against_limits(runs, machines):
        if any(cells):
            print(f"| {what} | " + " | ".join(cells) + " |")

    print("\nOther ratios, each within one run:\n\n" + head)
    for what, above, below, program in RATIOS + of_peers(runs):
        cells = []
        for machine in machines:
            try:
                found = runs[machine, program][1]
                cells.append(f"{pick(found, above) / pick(found, below):.2f}")
            except KeyError:
                cells.append("")
        if any(cells):
            print(f"| {what} | " + " | ".join(cells) + " |")

    print("\nTimes, ns (relative deviation):\n\n" + head)
    seen = set()
    for program in PROGRAMS:
        names = []
        for machine in machines:
            if (machine, program) in runs:
                names += [n for n in runs[machine, program][1] if n not in names]
        for name in sorted(names):
            if name in seen:
                continue
            seen.add(name)
            cells = []
            for machine in machines:
                row = runs[machine, program][1].get(name) if (machine, program) in runs else None
                cells.append(f"{text(row['median'])} ({100 * row['deviation'] / row['median']:.0f} %)" if row else "")
            print(f"| {name} | " + " | ".join(cells) + " |")

    compile_time = folder / "compile_time.json"
    if compile_time.exists():
        data = json.loads(compile_time.read_text())
        print(f"\nCompiling one unit with `flight.hpp`, an exported model, `predict()` and `self_test()`, {data['compiler']}:\n")
        print("| flags | Eigen/Core alone, s | with the model, s | ratio |\n|---|---|---|---|")
        for row in data["rows"]:
            print(f"| `{row['flags']}` | {row['eigen_s']:.2f} | {row['model_s']:.2f} | {row['ratio']:.2f} |")


if __name__ == "__main__":
    main()
