# SPDX-License-Identifier: MIT
"""Ctrl-C in training keeps what is finished: the results are whole, the exit code says that it was interrupted."""
import re
import shutil
import signal
import time
from pathlib import Path

import pytest
from conftest import SOURCE, Program, ended, no_partial_files, replaced, report_of, said, same_bytes, until


@pytest.fixture(scope="module")
def flight(flown):
    return flown("--seed 1 --samples 2400")


def finished(done, of):
    """How many trainings the one line says were finished."""
    (line,) = [line for line in done.lines if not line.startswith("train: warning: ")]
    assert done.code == 130, done
    return int(re.search(rf"interrupted\b.* (\d+) of {of} (?:trainings|fits)", line).group(1))


def test_train(pinnquad, flight):
    """More work than any machine does in a test, in pieces small enough for any; taken up again."""
    shutil.copy(SOURCE / "examples/airframes/paper_quadrotor.toml", "own.toml")
    process = pinnquad.start("train --airframe own.toml --out out --seeds 500 --epochs 30 --threads 2", flight)
    until(lambda: len(list(Path("out").glob("fits/*-2-1.fit"))) == 3, process)
    pinnquad.refused("train --out out --seeds 1 --epochs 1", flight, at="out", keyword="another program")
    kept = finished(ended(process), 1501)
    assert kept >= 7 and len(list(Path("out/fits").iterdir())) == kept
    report = report_of("out")
    assert report["exported"] is False and "interrupted" in report["not_exported_because"]
    assert report["fits"] == {"finished": kept, "wanted": 1501}
    assert not Path("out/model.hpp").exists()
    no_partial_files("out")
    shutil.copytree("out", "other")
    replaced("own.toml", "other.toml", ("^drag_deadband_m_s = .*", "drag_deadband_m_s = 0.5"))
    assert "earlier run" not in pinnquad("train --airframe other.toml --out other --seeds 2 --epochs 30", flight).out
    said = pinnquad("train --airframe own.toml --out out --seeds 2 --epochs 30", flight).out
    assert "7 of 7 fits were finished by an earlier run" in said, said
    assert not Path("out/fits").exists()
    pinnquad("train --airframe own.toml --out whole --seeds 2 --epochs 30", flight)
    for file in "model.hpp", "model.block", "replay.txt":
        same_bytes(f"out/{file}", f"whole/{file}")


def test_hangup(study):
    """The terminal that closes is no other: a first signal keeps what is finished; under nohup it is none."""
    words = "paper --models 2 --flights 1 --seeds 500 --epochs 30 --threads 2 --out"
    process = study.start(words, "hung")
    until(lambda: " %" in said(), process)
    finished(ended(process, signal.SIGHUP), 500)
    no_partial_files("hung")
    process = Program("nohup", *study.words).start(words, "hung_nohup")
    until(lambda: " %" in said(), process)
    process.send_signal(signal.SIGHUP)
    time.sleep(0.5)
    assert process.poll() is None, said()
    finished(ended(process), 500)


def test_evaluate(pinnquad, made, flight):
    """It writes nothing that could be half there: it ends at once, however long the flight."""
    exported = made(f"train {flight} --out . --seeds 1 --epochs 4 --allow-poor")
    header, *rows = flight.read_text().splitlines()
    step = float(rows[1].split(",")[0]) - float(rows[0].split(",")[0])
    with open("long.csv", "w") as long:
        long.write(header + "\n")
        for i in range(80 * len(rows)):
            long.write(f"{step * i:.6g},{rows[i % len(rows)].split(',', 1)[1]}\n")
    process = pinnquad.start("evaluate", exported / "model.hpp", "long.csv", "--json")
    time.sleep(0.5)
    done = ended(process)
    assert done.code == 130 and not done.out, done
