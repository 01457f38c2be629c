# SPDX-License-Identifier: MIT
"""A program shipped in builds for several instruction sets goes on as the best that runs here, or as the one that
PINNQUAD_INSTRUCTION_SET names. The shipped program itself is asked where PINNQUAD_INSTRUCTION_SETS built it so."""
import json
import os
import platform
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import SOURCE, Program

SETS = {"x86-64": "baseline x86-64 (SSE2)", "x86-64-v3": "AVX2 + FMA", "x86-64-v4": "AVX-512"}
FLAGS = set(next((line for line in Path("/proc/cpuinfo").open() if line.startswith("flags")), "").split())
RUN = ["x86-64"] + ["x86-64-v3"] * ({"avx2", "fma"} <= FLAGS) + ["x86-64-v4"] * ("avx512vl" in FLAGS)
pytestmark = pytest.mark.skipif(platform.machine() != "x86_64", reason="instruction sets of x86-64")


@pytest.fixture(scope="module")
def driver(request, tmp_path_factory):
    """In three builds, in a tree that was moved."""
    built = tmp_path_factory.mktemp("best_build") / "built"
    for name in SETS:
        path = built / ("bin/driver" if name == "x86-64" else f"libexec/driver-{name}")
        path.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([request.config.getoption("--compiler"), "-std=c++17", f"-march={name}", "-I", SOURCE / "include",
                        "-I", SOURCE / "tools", SOURCE / "tests/programs/best_build/driver.cpp", "-o", path], check=True)
    return Program(built.rename(built.parent / "moved") / "bin/driver")


def asked(program, wanted, *words, before=()):
    env = {key: value for key, value in os.environ.items() if key != "PINNQUAD_INSTRUCTION_SET"}
    if wanted is not None:
        env["PINNQUAD_INSTRUCTION_SET"] = wanted
    return Program(*before, program).run(*words, env=env)


@pytest.mark.parametrize("wanted", [None, ""])
def test_the_best_is_taken(driver, wanted):
    done = asked(driver, wanted, "a b", "--flag")
    assert done.out.split("\n") == [SETS[RUN[-1]], str(driver), "a", "b", "--flag", ""]


@pytest.mark.parametrize("wanted", SETS)
def test_one_is_asked_for(driver, wanted):
    if wanted not in RUN:
        pytest.skip(f"this processor does not run {wanted}")
    done = asked(driver, wanted)
    assert (done.code, done.out.split("\n")[0]) == (3 * (wanted == "x86-64"), SETS[wanted])


def test_one_that_is_not_there_is_refused(driver, tmp_path):
    done = asked(driver, "x86-64-v9")
    assert done.code == 2 and done.lines == [
        f"driver: PINNQUAD_INSTRUCTION_SET is 'x86-64-v9'; here run: {', '.join(reversed(RUN))}; see driver --help"]
    alone = shutil.copy(driver, tmp_path)
    assert asked(alone, None).out.startswith(SETS["x86-64"])
    assert asked(alone, "x86-64-v3").lines == [
        "driver: PINNQUAD_INSTRUCTION_SET is 'x86-64-v3'; here run: x86-64; see driver --help"]


@pytest.mark.parametrize("processor, best", [("Nehalem", "x86-64"), ("Haswell", "x86-64-v3")])
def test_older_processors(driver, processor, best):
    """The emulator answers cpuid; what is executed then runs on this processor."""
    if shutil.which("qemu-x86_64") is None:
        pytest.skip("no qemu-x86_64 (Debian: qemu-user)")
    if best not in RUN:
        pytest.skip(f"this processor does not run {best}")
    emulated = ["qemu-x86_64", "-cpu", processor]
    assert asked(driver, None, before=emulated).out.startswith(SETS[best])
    assert "'x86-64-v4'" in asked(driver, "x86-64-v4", before=emulated).err


@pytest.fixture(scope="module")
def shipped(pinnquad):
    """The program and the sets it was built for, of those that run here."""
    libexec = Path(pinnquad).parent.parent / "libexec"
    built = [name for name in RUN if name == "x86-64" or (libexec / f"pinnquad-{name}").exists()]
    return pinnquad, built if len(built) > 1 else pytest.skip("the program is built for one set (preset release)")


@pytest.fixture(scope="module")
def answers(shipped, tmp_path_factory):
    """Of each set: what it says it is, a flight, the answers of the same model about it, a training on it."""
    program, built = shipped
    found = {}
    for name in [*built, None]:
        folder = tmp_path_factory.mktemp("set")
        flight = folder / "d1.csv"

        def say(*words):
            done = asked(program, name, *words)
            assert done.code == 0, done
            return done.out

        say("fly d1 --seed 1 --samples 2400 --out", flight)
        say("train --models small_physics_informed --epochs 20 --seeds 1 --threads 1", flight, "--out", folder / "model")
        evaluated = [json.loads(say("evaluate --json", model, flight))
                     for model in (SOURCE / "examples/models/demo_quadrotor.block", folder / "model/model.block")]
        found[name] = say("--version").split("\n")[1], flight.read_bytes(), *evaluated
    return found


def test_sets_of_the_shipped_program(answers):
    *built, best = answers
    assert [answers[name][0] for name in built] == [f"instruction set: {SETS[name]}" for name in built]
    assert answers[best][0] == answers[built[-1]][0], "the best is taken"


def test_answers_of_the_shipped_program(answers):
    _, flight, model, trained = answers["x86-64"]
    for name, (_, same_flight, same_model, like_trained) in answers.items():
        assert same_flight == flight, f"{name}: the bits of a flight"
        assert same_model["figures"] == pytest.approx(model["figures"], rel=1e-4, abs=1e-6), name
        assert same_model["golden_difference"] <= 1e-5, name  # golden_tolerance
        assert like_trained["figures"]["rmse"] == pytest.approx(trained["figures"]["rmse"], rel=1e-3), name
