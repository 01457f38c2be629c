# SPDX-License-Identifier: MIT
"""pinnquad-study loop compares controllers under conditions: the rows of loop.json, the search for gains, a comparison
that is interrupted and goes on, a residual wrench, what it can't fly."""
import json
import signal
import sys
from pathlib import Path

import pytest
from conftest import SOURCE, Program, until

MODEL = SOURCE / "examples/models/structured_quadrotor.block"
ROW = {"controller", "condition", "trajectory", "gains", "seed", "rmse_cm", "worst_cm", "recovery_s", "crashed"}


def compared(study, *words, out="c", code=0):
    study("loop", MODEL, "--out", out, *words, code=code)
    return json.loads((Path(out) / "loop.json").read_text())


def without_times(rows):
    return [{key: value for key, value in row.items() if key != "step_ns"} for row in rows]


def errors_of(result, condition, **others):
    wanted = {"condition": condition, **others}
    return {row["controller"]: row["rmse_cm"] for row in result["rows"]
            if all(row[key] == value for key, value in wanted.items())}


def test_the_same_flights_whatever_the_threads(study):
    words = ("--controllers=adaptive,pid", "--conditions=gusts,parameters", "--gains=equal", "--seeds=2", "--duration=15")
    one = compared(study, *words, "--threads=1", out="one")
    two = compared(study, *words, "--threads=2", out="two")
    assert without_times(one["rows"]) == without_times(two["rows"])
    assert len({row["rmse_cm"] for row in one["rows"]}) == len(one["rows"]), "seeds and conditions differ"


def test_gains_are_searched_and_told(study):
    result = compared(study, "--controllers=pid,structured", "--conditions=calm,payload_half", "--trajectories=eight",
                      "--seeds=1", "--budget=8", "--duration=15")
    assert [found["tuned"] for found in result["tuning"]] == ["pid", "structured"]
    for found in result["tuning"]:
        assert found["evaluations"] == 8 and found["tuned_rmse_cm"] < found["equal_rmse_cm"], found
    assert result["tuning"][1]["learning"] == 1, "it learns nothing"
    tuned, equal = (errors_of(result, "payload_half", gains=gains)["pid"] for gains in ("tuned", "equal"))
    assert tuned < equal
    assert {(each["controller"], each["gains"]) for each in result["series"]} == {
        (name, gains) for name in ("pid", "structured") for gains in ("equal", "tuned")}
    report = Program(sys.executable, SOURCE / "tools/study/report.py")("c")
    assert "Ratio to pid, the same flights" in report.out
    ratios = [each for each in json.loads(Path("c/report.json").read_text())["summary"] if each["condition"] == "calm" and each["controller"] == "structured"]
    assert all(each["over_pid"]["lower"] <= each["over_pid"]["mean"] <= each["over_pid"]["upper"] for each in ratios)
    assert all(each["over_indi"] is None for each in ratios)
    assert all(ROW <= set(row) and not row["crashed"] for row in result["rows"])
    page = Path("c/report.html").read_text()
    assert "Equal gains" in page and "<svg" in page and "{{" not in page


def test_goes_on_where_it_was_stopped(study):
    words = ("--controllers=adaptive,indi", "--conditions=calm,payload", "--gains=equal", "--seeds=2", "--duration=15")
    whole = compared(study, *words, out="whole")
    process = study.start("loop", MODEL, "--out=stopped", *words, "--threads=1")
    journal = Path("stopped/loop.journal")
    until(lambda: journal.exists() and journal.read_text().count("\n") > 3, process)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130
    assert not Path("stopped/loop.json").exists()
    lines = journal.read_text().splitlines()
    assert 3 <= len(lines) - 1 < len(whole["rows"])
    journal.write_text("\n".join(lines) + '\n{"controller":"ada')  # the machine went down while it wrote
    again = compared(study, *words, out="stopped")
    assert without_times(again["rows"]) == without_times(whole["rows"])
    assert json.loads(lines[1]) in again["rows"], "what was flown is kept"
    study.refused("loop", MODEL, "--out=stopped", *words, "--noise=2", at="stopped/loop.journal", keyword="(noise)")


def test_harder_vehicle(study):
    easy, hard = (errors_of(compared(study, "--controllers=structured,adaptive", "--conditions=calm", "--gains=equal",
                                     "--trajectories=eight", "--seeds=1", "--duration=15", f"--vehicle={vehicle}",
                                     out=vehicle), "calm") for vehicle in ("nominal", "harder"))
    assert hard["structured"] > 2 * easy["structured"] and hard["adaptive"] < 0.5 * hard["structured"]


def test_a_residual_wrench_is_trained_and_flown(pinnquad, study):
    """From flight to block to loop: the full stack beside INDI, and beside itself without the network."""
    light = "--airframe=light_quadrotor"
    pinnquad("fly harder --interval=10 --samples=6000 --out=flight.csv", light)
    study("wrench flight.csv --seeds=1 --epochs=40 --out=w", light)
    report = json.loads(Path("w/wrench.json").read_text())
    assert all(report["test_r_squared"][f"force_{axis}"] > 0.8 for axis in "xyz"), report
    assert "struct TrainedWrench" in Path("w/wrench.hpp").read_text()
    result = compared(study, light, "--wrench=w/wrench.block", "--vehicle=harder", "--gains=equal", "--seeds=1",
                      "--controllers=indi,wrench_indi,full,full_nominal,full_bias,l1", "--conditions=calm,wind_4,payload",
                      "--trajectories=eight", "--duration=20")
    assert not any(row["crashed"] for row in result["rows"])
    calm, wind, payload = (errors_of(result, name) for name in ("calm", "wind_4", "payload"))
    for flown in calm, wind, payload:
        assert flown["full"] < 0.6 * flown["indi"] and flown["full"] < 0.6 * flown["full_bias"], result["rows"]
        assert flown["full"] < 0.85 * flown["full_nominal"] and flown["wrench_indi"] < 0.7 * flown["indi"], result["rows"]
    assert wind["full"] < wind["wrench_indi"], "the wind is found"
    assert payload["l1"] < 3 * calm["l1"], "a payload is found"
    flown = ("--controllers=full", "--seeds=1", "--out=d")
    study.refused("loop", MODEL, light, "--wrench", MODEL, *flown, at=MODEL.name)
    study.refused("loop", MODEL, "--wrench=w/wrench.block", *flown, at="w/wrench.block")
    study.refused("loop w/wrench.block", at="w/wrench.block")
    study.refused("loop", MODEL, *flown, keyword="--wrench")
    pinnquad("fly harder --samples=3000 --out=slow.csv", light)
    study.refused("wrench slow.csv --out=d", light, keyword="--interval")
    study.refused("wrench --out=d", light, keyword="FLIGHTS")
    study.refused("wrench --flight=slow.csv --out=d", light, keyword="wrench ... FLIGHTS")
    assert not Path("d").exists()


@pytest.mark.parametrize("words, keyword", [
    (("--controllers=autopilot", "--out=c"), "--controllers"),
    (("--conditions=snow", "--out=c"), "--conditions"),
    (("--controllers=pid",), "--out"),
    (("--seeds=0", "--out=c"), "--seeds"),
    (("--duration=5", "--out=c"), "--duration"),
    (("--delay=-1", "--out=c"), "--delay"),
])
def test_refused(study, words, keyword):
    study.refused("loop", MODEL, *words, keyword=keyword)
    assert not Path("c").exists()


def test_a_folder_that_is_a_file(study):
    Path("c").write_text("mine")
    study.refused("loop", MODEL, "--out=c", "--seeds=1", keyword="c")
    assert Path("c").read_text() == "mine"
