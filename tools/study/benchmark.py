#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Public data sets of quadrotors: what `pinnquad` learns of them, and what other methods do on the same rows.

    tools/study/benchmark.py list
    tools/study/benchmark.py run neural_fly ~/neural-fly --out neural_fly     imports, identifies and trains
    tools/study/benchmark.py score neural_fly mine.csv --name "my method"     a row for other predictions
    tools/study/benchmark.py table neural_fly sih ...                         the rows of several as Markdown

A set is a file of tools/study/data_sets: where the data is, its licence, its flights, what is held out. The data is the
user's own copy. `run` goes on where it was stopped; OUT holds the dataset, the model, report.json and row.json.
Predictions are a CSV of the columns t, u1, u2, u3, u4 and, where several flights are held out, flight, for the rows of
OUT/dataset/FLIGHT.csv that report.json names as held out. A command's R^2 is over these rows; R^2 is the mean of the four. Exit code: 0; 2 bad input; what pinnquad says
where it refuses the flights.
"""
import argparse
import csv
import json
import math
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

SETS = Path(__file__).resolve().parent / "data_sets"
KINDS = ("structured_causal", "structured", "ridge_causal", "ridge", "linear", "physics_informed", "vanilla",
         "last_commands", "constant")
COMMANDS = ("u1", "u2", "u3", "u4")


class BadInput(Exception):
    """One line: `path: expected ..., found ...`."""


def known_sets():
    return sorted(path.stem for path in SETS.glob("*.toml"))


def read_set(name):
    path = Path(name) if name.endswith(".toml") else SETS / f"{name}.toml"
    try:
        said = tomllib.loads(path.read_text())
    except OSError:
        raise BadInput(f"{name}: expected a data set, one of {', '.join(known_sets())}, or a file .toml, found none") from None
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{path}: expected TOML, found {error}") from None
    for key in ("about", "url", "licence", "flights", "hold_out"):
        if key not in said:
            raise BadInput(f"{path}: expected the key `{key}`, found none")
    said["file"] = path
    return said


def flights_of(said, folder):
    """The files of the copy, in the set's order; two that hold the same bytes count once."""
    found, seen = [], {}
    for pattern in said["flights"]:
        for path in sorted(Path(folder).glob(pattern)):
            if path.name in said.get("leave_out", []):
                continue
            same = seen.setdefault(path.read_bytes() if path.is_file() else str(path), path)
            if same is not path:
                print(f"{path.name}: left out, holds the same bytes as {same.name}")
            else:
                found.append(path)
    if not found:
        raise BadInput(f"{folder}: expected flights {', '.join(said['flights'])} ({said['url']}), found none")
    return found


def run(words):
    print("$", " ".join(map(str, words)), flush=True)
    done = subprocess.run(list(map(str, words)))
    if done.returncode:
        sys.exit(done.returncode)


def airframe_of(said, out, program):
    """The options that name the airframe: estimated, of a file beside the set, or known by name."""
    if "airframe" in said:
        beside = said["file"].parent / said["airframe"]
        return ["--airframe", beside if beside.is_file() else said["airframe"]]
    if "estimate" not in said:
        return []
    path = out / f"{said['file'].stem}.toml"
    options = [word for key, value in said["estimate"].items() for word in (f"--{key}", value)]
    run([program, "airframe", "estimate", *options, "--out", path])
    if said.get("reversed_spins"):
        swap = {"clockwise": "counter_clockwise", "counter_clockwise": "clockwise"}
        text = path.read_text().split('spin = "')
        path.write_text(text[0] + "".join(
            f'spin = "{swap[part.split(chr(34))[0]]}"' + part.split('"', 1)[1] for part in text[1:]))
    return ["--airframe", path]


def run_set(name, folder, out, program, seeds):
    said = read_set(name)
    flights = flights_of(said, folder)
    out.mkdir(parents=True, exist_ok=True)
    airframe = airframe_of(said, out, program)
    mapping = said.get("mapping", "")
    beside = said["file"].parent / mapping
    mapped = ["--mapping", beside if beside.is_file() else mapping] if mapping else []
    if not (out / "dataset" / "dataset.json").is_file():
        run([program, "import", *flights, *mapped, *airframe, *said.get("import", []), "--out", out / "dataset"])
    else:
        print(f"{out / 'dataset'}: imported before; delete it to import again")
    run([program, "train", out / "dataset", *airframe, "--hold-out", said["hold_out"], "--seeds", seeds,
         *said.get("train", []), "--out", out / "model"])
    shutil.copy(out / "model" / "report.json", out / "report.json")
    row = row_of(said, out)
    (out / "row.json").write_text(json.dumps(row, indent=1) + "\n")
    print(table([row]))


def row_of(said, out):
    report = json.loads((out / "report.json").read_text())
    settings, vehicle = report["settings"], report["vehicle"]
    scores = {}
    for result in report["results"]:
        scores.setdefault(result["model"], []).append(result["r2"])
    return {"set": said["file"].stem, "about": said["about"], "url": said["url"], "licence": said["licence"],
            "flights": len(settings["flights"]), "rows": settings["rows"], "held_out": report["held_out"],
            "lag_s": settings["lag_removed_s"], "identified": vehicle["identified"],
            "numbers": {key: one["value"] for key, one in vehicle["numbers"].items() if one["excitation"] != "not told"},
            "why_not_identified": vehicle["not_identified_because"],
            "r2": {kind: sum(scores[kind]) / len(scores[kind]) for kind in KINDS if kind in scores},
            "exported": report["exported_model"], "verdict": report["verdict"]["in_words"],
            "warnings": report["warnings"], "others": {}}


def table(rows):
    """Markdown: a row for each set, R^2 of each kind on what is held out, the exported one in bold."""
    kinds = [kind for kind in KINDS if any(kind in row["r2"] for row in rows)]
    others = sorted({name for row in rows for name in row["others"]})
    lines = ["| set | flights, rows | held out | lag, ms | " + " | ".join((*kinds, *others)) + " |",
             "|" + "---|" * (4 + len(kinds) + len(others))]
    for row in rows:
        lag = "given" if row["lag_s"] is None else f"{1000 * row['lag_s']:.0f}"
        held_out = ", ".join(row["held_out"]) if len(row["held_out"]) < 3 else f"{len(row['held_out'])} flights"
        cells = [row["set"], f"{row['flights']}, {row['rows']}", held_out, lag]
        for kind in kinds:
            value = f"{row['r2'][kind]:.3f}" if kind in row["r2"] else ""
            cells.append(f"**{value}**" if kind == row["exported"] else value)
        cells += [f"{row['others'][name]['r2']:.3f}" if name in row["others"] else "" for name in others]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def read_columns(path, wanted):
    """Rows of a CSV as dictionaries of numbers; `flight` stays text."""
    rows = []
    try:
        with open(path, newline="") as file:
            reader = csv.DictReader(file)
            for column in wanted:
                if column not in (reader.fieldnames or []):
                    raise BadInput(f"{path}:1: expected a column {column}, found {', '.join(reader.fieldnames or [])}")
            for row in reader:
                one = {"flight": row.get("flight")}
                for column in wanted:
                    try:
                        one[column] = float(row[column])
                    except (TypeError, ValueError):
                        one[column] = math.nan
                    if not math.isfinite(one[column]):
                        raise BadInput(f"{path}:{reader.line_num}: expected a number in column {column}, "
                                       f"found {row[column]!r}")
                rows.append(one)
    except OSError as error:
        raise BadInput(f"{path}: expected a readable file, found {error.strerror}") from None
    return rows


def score(out, path, name):
    """R^2 and rms error of predictions on the rows held out. Each of these rows needs one."""
    try:
        row = json.loads((out / "row.json").read_text())
    except (OSError, ValueError):
        raise BadInput(f"{out}: expected a folder that `benchmark.py run` wrote, found none") from None
    given = {}
    for one in read_columns(path, ("t", *COMMANDS)):
        flight = one["flight"] or row["held_out"][0]
        given.setdefault(flight, {})[round(one["t"], 6)] = one
    truth, said, missing = [], [], 0
    for flight in row["held_out"]:
        for one in read_columns(out / "dataset" / f"{flight}.csv", ("t", *COMMANDS)):
            predicted = given.get(flight, {}).get(round(one["t"], 6))
            if predicted is None:
                missing += 1
            else:
                truth.append([one[u] for u in COMMANDS])
                said.append([predicted[u] for u in COMMANDS])
    if missing or not truth:
        raise BadInput(f"{path}: expected a prediction for each of the {missing + len(truth)} rows held out "
                       f"({', '.join(row['held_out'])}), found none for {missing}")
    r2, squares = [], 0.0
    for motor in range(4):
        mean = sum(u[motor] for u in truth) / len(truth)
        error = sum((u[motor] - v[motor]) ** 2 for u, v in zip(truth, said))
        squares += error
        r2.append(1 - error / sum((u[motor] - mean) ** 2 for u in truth))
    row["others"][name] = {"r2": sum(r2) / 4, "rmse": math.sqrt(squares / (4 * len(truth))), "rows": len(truth)}
    (out / "row.json").write_text(json.dumps(row, indent=1) + "\n")
    print(f"{name}: R^2 {sum(r2) / 4:.3f} ({', '.join(f'{one:.3f}' for one in r2)}), "
          f"rms error {1000 * row['others'][name]['rmse']:.1f}e-3 over {len(truth)} rows of {', '.join(row['held_out'])}")
    print(table([row]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="the sets")
    running = commands.add_parser("run", help="train on a copy of a set")
    running.add_argument("set", help=f"{', '.join(known_sets())}, or a file .toml of your own")
    running.add_argument("folder", type=Path, help="your copy of the data")
    running.add_argument("--out", type=Path, help="default: the set's name")
    running.add_argument("--program", default="pinnquad", help="the program pinnquad")
    running.add_argument("--seeds", type=int, default=1)
    scoring = commands.add_parser("score", help="R^2 of other predictions on the same rows")
    scoring.add_argument("out", type=Path, help="what `run` wrote")
    scoring.add_argument("predictions", type=Path)
    scoring.add_argument("--name", default="other")
    showing = commands.add_parser("table", help="rows of several sets as Markdown")
    showing.add_argument("out", type=Path, nargs="+", help="what `run` wrote")
    asked = parser.parse_args()
    try:
        if asked.command == "list":
            for name in known_sets():
                said = read_set(name)
                print(f"{name:16} {said['about']}\n{'':16} {said['url']}, {said['licence']}")
        elif asked.command == "run":
            run_set(asked.set, asked.folder, asked.out or Path(Path(asked.set).stem), asked.program, asked.seeds)
        elif asked.command == "score":
            score(asked.out, asked.predictions, asked.name)
        else:
            print(table([json.loads((one / "row.json").read_text()) for one in asked.out]))
    except BadInput as error:
        print(f"benchmark.py: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
