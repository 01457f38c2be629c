# SPDX-License-Identifier: MIT
"""The calls of examples/train.cpp write the bytes that `pinnquad train` writes; examples/train_logs.cpp has an input that
the program does not know, a column of the logs."""
import json
import math
import re
import shutil
from pathlib import Path

from conftest import SOURCE, Program, edited, no_partial_files, report_of, same_bytes
from made_logs import FLIGHT_MAPPING

EXTRA = """
[[extra]]
name = "pack_temperature"
unit = "degC"
column = "pack"
"""


def test_train_from_cpp(pinnquad, program, flown):
    train, flight = program("train"), flown("--seed 3 --samples 9000")
    shutil.copy(flight, "flight.csv")
    pinnquad("train flight.csv --out a --name MyModel --models structured --seeds 1 "
             "--epochs 20")
    said = train("b flight.csv").out
    for file in "model.block", "trust.hpp":
        same_bytes(f"a/{file}", f"b/{file}")
    # the program has flown the model too, and judged others: it alone says so above
    by_program, by_example = (Path(f"{folder}/model.hpp").read_text().split("#pragma once") for folder in "ab")
    assert by_program[1] == by_example[1] and re.search("// (fit for simulation|fly with care)", by_program[0])
    assert said.startswith("test rows: R^2 0.9") or "\ntest rows: R^2 0.9" in said, said

    # too few validation rows: limits of an earlier export do not stay
    Path("short.csv").write_text("".join(Path("flight.csv").read_text().splitlines(True)[:3001]))
    assert "no trust.hpp: " in train("b short.csv").out
    assert not Path("b/trust.hpp").exists()

    # all or nothing
    before = Path("b/model.hpp").read_bytes()
    Path("b/model.block").unlink()
    Path("b/model.block").mkdir()
    train.refused("b flight.csv", code=1, keyword="is a folder")
    assert Path("b/model.hpp").read_bytes() == before, "a header was written without its block"
    assert not Path("b/trust.hpp").exists()
    no_partial_files("b")


def warm(flight, log, seed):
    """A flight's CSV with the temperature of its pack, by which its commands go: colder cells, more command."""

    def change(line, cells):
        if line == 1:
            return [*cells, "pack"]
        temperature = 35 + 12 * math.sin(0.11 * float(cells[0]) + seed)
        commands = [float(cell) * (1 - 0.012 * (temperature - 35)) for cell in cells[-4:]]
        return [*cells[:-4], *commands, temperature]

    return edited(flight, log, change)


def test_column_of_ones_own(pinnquad, program, flown, compiler):
    """An [[extra]] column of any name, from the mapping to the flown header."""
    train = program("train_logs")
    Path("logs").mkdir()
    assert Path(flown("--seed 1 --samples 2500")).read_text().splitlines()[0].endswith("u1,u2,u3,u4")
    for seed in 1, 2, 3, 4:
        warm(flown(f"--seed {seed} --samples 2500"), f"logs/flight{seed}.csv", seed)
    Path("mine.toml").write_text(FLIGHT_MAPPING + EXTRA)
    Path("none.toml").write_text(FLIGHT_MAPPING)
    pinnquad("import logs --mapping mine.toml --airframe paper_quadrotor --lag 0 --out dataset")
    said = train("out dataset").out
    r2 = float(re.search(r"held out: R\^2 ([0-9.]+)", said).group(1))
    # the kinds of the program do not know it, and say so
    done = pinnquad("train dataset --airframe paper_quadrotor --hold-out flight4 --models constant,structured "
                    "--seeds 1 --epochs 60 --out without")
    assert re.search("warning: pack_temperature: no kind of model takes this column", done.err), done
    assert r2 > report_of("without")["models"]["structured"]["r2"]["mean"] + 0.03, (said, done)
    # the block asks for it by name; what the example says of its model the program says too
    assert "pack_temperature" in pinnquad("block out/model.block").out
    judged = json.loads(pinnquad("evaluate out/model.block --json dataset/flight4.csv").out)
    assert abs(judged["r2"] - r2) < 1e-3
    Path("fly.cpp").write_text("""
#include "pack_temperature.hpp"
#include "out/model.hpp"
int main() {
  const pinnquad::InverseDynamics<MyModel> inverse{};
  MyModel::Inputs in;  // the middle of what it was trained on
  pinnquad::Commands<MyModel::Scalar> warm{}, cold{};
  in.attitude.w = 1;
  const auto& names = MyModel::Features::names;
  const auto at = names.size() - 1;
  const auto lower = MyModel::envelope_lower[at], upper = MyModel::envelope_upper[at];
  in.column<PackTemperature>() = upper - (upper - lower) / 8;
  if (inverse.predict(in, warm) != pinnquad::Status::ok) return 2;
  in.column<PackTemperature>() = lower + (upper - lower) / 8;
  if (inverse.predict(in, cold) != pinnquad::Status::ok) return 3;
  in.column<PackTemperature>() = std::numeric_limits<float>::quiet_NaN();
  pinnquad::Commands<MyModel::Scalar> none{};
  if (inverse.predict(in, none) != pinnquad::Status::not_finite) return 4;
  return names[at] == std::string_view("pack_temperature") && cold[0] > warm[0] + 0.02f ? 0 : 1;
}
""")
    compiler("-O0", f"-I{SOURCE}/examples", "-I.", "fly.cpp", "-o", "fly")
    Program(Path("fly").resolve())()
    # logs that lack it
    pinnquad("import logs --mapping none.toml --airframe paper_quadrotor --lag 0 --out lacks")
    train.refused("none lacks", code=1, keyword="pack_temperature")
    assert not Path("none").exists()
    # straight from the logs
    assert train("again logs mine.toml").out
