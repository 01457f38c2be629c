#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Public data sets of quadrotors: what `pinnquad` learns of them, and what other methods do on the same rows.

    tools/study/benchmark.py list
    tools/study/benchmark.py run neural_fly ~/neural-fly --out neural_fly     imports, identifies and trains

A set is a file of tools/study/data_sets: where the data is, its licence, its flights, what is held out. The data is the
user's own copy. `run` goes on where it was stopped; OUT holds dataset/ and model/, and `pinnquad benchmark OUT` is its row.
Exit code: 0; 2 bad input; what pinnquad says where it refuses the flights.
"""
import argparse
import subprocess
import sys
import tomllib
from pathlib import Path

SETS = Path(__file__).resolve().parent / "data_sets"


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


def run(words, good=(0,)):
    print("$", " ".join(map(str, words)), flush=True)
    done = subprocess.run(list(map(str, words)))
    if done.returncode not in good:
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
         *said.get("train", []), "--out", out / "model"], good=(0, 1))  # 1: nothing worth exporting
    run([program, "benchmark", out])


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
    asked = parser.parse_args()
    try:
        if asked.command == "list":
            for name in known_sets():
                said = read_set(name)
                print(f"{name:16} {said['about']}\n{'':16} {said['url']}, {said['licence']}")
        else:
            run_set(asked.set, asked.folder, asked.out or Path(Path(asked.set).stem), asked.program, asked.seeds)
    except BadInput as error:
        print(f"benchmark.py: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
