# SPDX-License-Identifier: MIT
"""Hostile invocations of every program: texts, places, surroundings (hostile.py); numbers are in test_options.py."""
import itertools
import os
import shutil
import sys

import pytest
from conftest import SOURCE, Program
from hostile import DEEP, HERE, LONG, Case, accepted, left_alone, no_cut_pictures, refused, try_all

WHOLE_NUMBERS = ["", " ", "-1", "+1", "1.5", "0x10", "010", "1e3", "nan", "9" * 23, "many", "1 2", "\u0663", "\udcff",
                 "1\n", "1;2", "9" * 3000]
UNWRITABLE = [".", "/", "..", "/dev/null", "/dev/full", "/dev/stdout", "/proc/f.csv", "/dev/null/f.csv",
              "run/absent/f.csv", "in/short.csv/f.csv", "run/absent/", "run/folder", "run/fifo", "run/dangling",
              "run/loop", "", f"run/{LONG}", DEEP]
UNREADABLE = ["", ".", "/", "/dev/null", "/dev/zero", "/dev/random", "/proc/self/mem", "run/fifo", "run/folder",
              "run/dangling", "run/loop", "run/absent", "in/empty.csv", "in/binary.csv", "in/nul.csv",
              "in/one_line.csv", "in/short.csv/x", LONG, DEEP, "\udcff", "a\nb"]
NO_FOLDER = ["", "in/short.csv", "in/short.csv/x", "/dev/null", "/proc/x", "run/fifo", "run/dangling", "run/loop",
             f"run/{LONG}"]
NAMES = [" ", "a b", "it's", '"', "*", "$(touch x)", ";", "flüg ✈", "\udcff\udcfe", "line\nend", "\033[31m", "%s%n",
         "\\"]
NO_IDENTIFIER = ["", " ", "3rd", "\x9b31m", "a b", "a;b", "ü", "a\nb", "a::b", "9" * 3000]
DISKS = ["full_disk", "full_disk_signal"]
FEW = "fly --samples 20"
SHORT = "--seeds 1 --epochs 1"
PAGE_DOES_NOT_FIT = 240  # blocks that a file may have: header and replay fit, the report page does not
ONE = f"train in/flight.csv {SHORT}"
BLANK = {"TMPDIR": "/nonexistent", "HOME": "/nonexistent"}


@pytest.fixture(scope="module")
def given(pinnquad, flown, tmp_path_factory):
    """What the programs are given; copies of it are what they get to see."""
    folder = tmp_path_factory.mktemp("given")
    shutil.copy(flown("--samples 2200"), folder / "flight.csv")
    pinnquad("fly --samples 40 --record-sticks sticks.csv --out short.csv", cwd=folder)
    (folder / "empty.csv").touch()
    with open(pinnquad, "rb") as binary:
        (folder / "binary.csv").write_bytes(binary.read(3000))
    (folder / "nul.csv").write_bytes(b"time_s\0,v_north_m_s\n")
    (folder / "one_line.csv").write_text((folder / "sticks.csv").read_text().replace("\n", " "))
    for path in folder.iterdir():
        path.chmod(0o444)
    return folder


def unchanged(name, run_name):
    def check(run):
        assert (run / run_name).read_bytes() == (run / "../in" / name).read_bytes(), f"{run_name} was lost"

    return check


def fly_cases():
    for words in ["--seed 1 --seed 2", "--no-such-option", "-x", "d1 d2", "D1", "--airframe", "--seed",
                  "--ground-effect ?", "--seed 18446744073709551615", "--latency 5ms", "--out run/g.csv"]:
        yield refused(f"{FEW} --out run/f.csv {words}")
    for text in ["", " ", "d1\n", "\udcff", "\x9b31m", "\u202e1d", "D1", "d1,d2", "d" * 5000]:
        yield refused(FEW, text, "--out", "run/f.csv")
        yield refused(f"{FEW} --out run/f.csv --airframe", text)
        if text:
            yield refused(f"{FEW} --out run/f.csv --ground-effect", text)
    yield accepted(f"{FEW} --seed 9223372036854775807 --latency 0.5 --jitter 1e1 --gyro-noise .01 --out run/f.csv")

    for path in UNWRITABLE:
        yield left_alone(f"{FEW} --out", path)
        yield left_alone(f"{FEW} --record-sticks", path)
        yield left_alone("fly --statistics 1 --samples 5 --out", path)
        yield left_alone(f"{FEW} --out run/x.csv --watch", path)
    for path in ["", "/dev/null", "in/short.csv", "/proc/pictures", "run/absent/pictures", "run/fifo", "run/dangling",
                 "run/loop"]:
        yield left_alone(f"{FEW} --pictures", path)
    for path in ["in/sticks.csv", "./in/sticks.csv", f"{HERE}/in/sticks.csv", "in/../in//sticks.csv", "run/link",
                 "run/hard"]:
        yield left_alone(f"{FEW} --sticks in/sticks.csv --out", path)
        yield left_alone(f"{FEW} --sticks in/sticks.csv --record-sticks", path)
        yield left_alone(f"{FEW} --sticks {path} --out in/sticks.csv")
        yield left_alone(f"{FEW} --sticks {path} --watch in/sticks.csv")
    for words in ["--out run/x --record-sticks run/x", "--out run/x --record-sticks run/./x",
                  "--out run/trajectory.svg --pictures run", "--record-sticks run/wind.svg --pictures run",
                  "--out run/x --pictures run/x", "--out run/x --watch run/../run/x"]:
        yield refused(f"{FEW} {words}")
    yield Case(f"{FEW} --sticks run/mine.partial-1 --out run/mine", leaves=True,
               after=unchanged("sticks.csv", "mine.partial-1"), before=lambda run: shutil.copy(run / "../in/sticks.csv",
                                                                                               run / "mine.partial-1"))
    yield from (left_alone(f"{FEW} --sticks", path, "--out", "run/f.csv") for path in UNREADABLE)
    yield refused(f"{FEW} --sticks run/large.csv --out run/f.csv",
                  before=lambda run: (os.close(os.open(run / "large.csv", os.O_CREAT)),
                                      os.truncate(run / "large.csv", 9 << 30)))
    yield from (accepted(FEW, f"--out=run/{name}") for name in [*NAMES, "-x.csv", "n" * 240])
    yield accepted(f"{FEW} --out run/f.csv --record-sticks run/s.csv")

    def said_nothing(run):
        assert not (run / "said.txt").read_bytes(), "an output took the place of standard output"

    yield Case(f"{FEW} --out run/said.txt", around="into_a_file", leaves=True, after=said_nothing)
    for how in [{"around": "closed_stdin"}, {"around": "no_threads"}, {"around": "one_thread"},
                {"env": {"LC_ALL": "garbage"}}, {"env": {"LC_ALL": "tr_TR.UTF-8", "LANG": "xx"}},
                {"env": {"TERM": "x", "COLUMNS": "0"}}, {"env": BLANK}, {"env": {"HOME": ""}}]:
        yield accepted(f"{FEW} --out run/f.csv", **how)
        yield accepted("fly --statistics 3 --samples 5 --out run/t.csv", **how)

    # standard output that nobody can read: the files are whole, the exit code tells
    def whole(run):
        for path in run.iterdir():
            assert path.read_text().startswith(("t,vdot", "seed,rows")), "what is printed is in the file"

    for around in "closed_stdout", "full_stdout":
        for words in [f"{FEW} --out run/f.csv", "fly --statistics 2 --samples 5 --out run/f.csv", "fly --help",
                      "fly --version", "fly --list-airframes"]:
            yield Case(words, around=around, leaves=True, after=whole)
    yield Case("fly --statistics 100 --samples 2 --out run/f.csv", around="reader_left", leaves=True)
    yield accepted(f"{FEW} --out run/f.csv", around="closed_stderr")
    yield refused(f"{FEW} --out run/absent/f.csv", around="closed_stderr")
    yield refused(f"{FEW} --out run/absent/f.csv", around="all_closed")
    for disk in DISKS:
        yield refused("fly --samples 100 --out run/f.csv", around=disk)
        yield refused("fly --statistics 100 --samples 2 --out run/f.csv", around=disk)
        yield refused("fly --samples 40 --record-sticks run/s.csv", around=disk)
        for blocks in 1, 20, 30, 40:
            yield Case("fly d2 --samples 400 --pictures run", around=disk, blocks=blocks, leaves=True,
                       after=no_cut_pictures)
    yield refused(f"{FEW} --out run/f.csv", around="few_files")


def train_cases():
    for words in ["--no-such-option", "x", "in/short.csv", "--airframe", "--seed 18446744073709551615"]:
        yield refused(f"train in/flight.csv --out run/o {words}")
    yield from (refused(f"{ONE} --out run/o --name", text) for text in [*NO_IDENTIFIER, "\u202emodel"])
    yield from (left_alone("train", path, *SHORT.split(), "--out", "run/o")
                for path in [*UNREADABLE, "in/sticks.csv"])
    yield from (left_alone(f"{ONE} --out", path) for path in [*NO_FOLDER, "/dev/null/x"])
    for name in ["results.csv", "report.json", "report.html", "model.hpp", "model.block", "trust.hpp", "replay.txt"]:
        yield Case(f"train run/{name} {SHORT} --out run", leaves=True, after=unchanged("flight.csv", name),
                   before=lambda run, name=name: shutil.copy(run / "../in/flight.csv", run / name))
        yield refused(f"{ONE} --out run", before=lambda run, name=name: os.symlink("../in/flight.csv", run / name))
        yield refused(f"{ONE} --out run", before=lambda run, name=name: (run / name).mkdir())
    for name in ["it's *.csv", '"quoted".csv', "flüg ✈.csv", "\udcff\udcfe.csv", "line\nend.csv", "\\"]:
        yield accepted("train", f"run/{name}", *SHORT.split(), "--out", f"run/out of {name}",
                       before=lambda run, name=name: shutil.copy(run / "../in/flight.csv", run / name))
    for how in [{"around": "closed_stdin"}, {"around": "no_threads"}, {"around": "one_thread"},
                {"env": {"LC_ALL": "garbage"}}, {"env": BLANK}]:
        yield accepted(f"{ONE} --out run/o", **how)

    def exported(run):
        for name in "model.hpp", "model.block", "replay.txt", "results.csv":
            assert (run / "o" / name).stat().st_size, f"{name} was lost"
        assert not any(b"[3/5]" in path.read_bytes() for path in (run / "o").iterdir()), "what is printed is in a file"

    for around in "closed_stdout", "full_stdout", "reader_left":
        yield Case(f"{ONE} --out run/o", around=around, leaves=True, after=exported)

    def header_but_no_page(run):
        for name in "model.hpp", "replay.txt":
            assert (run / "o" / name).stat().st_size, f"{name} was lost to the page"
        assert not (run / "o/report.html").exists(), "the page fits: this check needs fewer blocks"

    for disk, blocks in itertools.product(DISKS, (1, 8, 60, PAGE_DOES_NOT_FIT)):
        yield Case(f"{ONE} --out run/o", around=disk, blocks=blocks, leaves=True,
                   after=header_but_no_page if blocks == PAGE_DOES_NOT_FIT else None)
    yield refused(f"{ONE} --out run/o", around="few_files")


def study_cases():
    yield from (refused("study paper --models 1 --epochs 1 --out run/o --seeds", value) for value in WHOLE_NUMBERS)
    for words in ["--models 0", "--models 15", "--models 1,", "--models 1-", "--models 010", "--models +1",
                  "--weights worst", "x", "ablation", "--no-such-option"]:
        yield refused(f"study paper --out run/o {words}")
    for words in ["", "x", "--seeds 1", "paper", "ablation",
                  "ablation --out run/o --variants none", "--out run/o paper"]:
        yield refused(f"study {words}")
    yield from (refused(f"report {words}") for words in ["", "absent", "in/short.csv", "in x", "--out in"])
    for path in NO_FOLDER:
        yield left_alone(f"study paper --models 1 {SHORT} --out", path)
        yield left_alone("report", path)
    yield from (refused("study --help", around=around) for around in ("closed_stdout", "full_stdout"))


def demo_cases():
    """Refused before anything is built."""
    for option in "--seeds", "--epochs", "--seed":
        yield from (refused(f"demo --out run/o {option}", value) for value in WHOLE_NUMBERS)
    for words in ["--seeds 0", "--seeds 501", "--epochs 0", "--epochs 100001", "--seed", "--no-such-option", "x",
                  "in/flight.csv", "--out"]:
        yield refused(f"demo {words}")
    for path in NO_FOLDER:
        yield left_alone("demo --out", path)


@pytest.mark.parametrize("cases", [fly_cases, train_cases, demo_cases])
def test_hostile(cases, pinnquad, given, work):
    programs = {name: Program(pinnquad, name) for name in ("fly", "train")}
    programs.update(demo=Program(SOURCE / "scripts/demo"))
    assert try_all(cases(), programs, given, work) >= 60


def test_hostile_study(study, given, work):
    report = Program(sys.executable, SOURCE / "tools/study/report.py")
    assert try_all(study_cases(), {"study": study, "report": report}, given, work) >= 50
