# SPDX-License-Identifier: MIT
"""Hostile invocations: each has its exit code, at most one line on stderr, leaves no partial file, and what it was
given is untouched. All of a list are tried, some at a time; a failure names those that went wrong."""
import hashlib
import os
import re
import shutil
import subprocess
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from conftest import Done

HERE = "@HERE@"  # in a word: the folder in which it runs; given are the files of in/, outputs go to run/
# as bash begins a program; what is left open there is 0, 1, 2
SURROUNDINGS = {
    "": 'exec "$@"',
    "closed_stdin": 'exec "$@" <&-',
    "closed_stdout": 'exec "$@" >&-',
    "closed_stderr": 'exec "$@" 2>&-',
    "all_closed": 'exec "$@" <&- >&- 2>&-',
    "full_stdout": 'exec "$@" >/dev/full',
    "into_a_file": 'exec "$@" >run/said.txt',
    "full_disk": 'trap "" XFSZ; ulimit -f {blocks}; exec "$@"',
    "full_disk_signal": 'ulimit -f {blocks}; exec "$@"',
    "no_threads": 'ulimit -s 4000000 && ulimit -v 3500000 && exec "$@"',
    "one_thread": 'ulimit -s 1500000 && ulimit -v 2800000 && exec "$@"',
    "few_files": 'ulimit -n 4; exec "$@"',
    "reader_left": 'exec "$@"',  # a pipe that nobody reads
}
STEERS = re.compile("[\0-\x08\x0b\x0c\x0e-\x1f\x7f\x80-\x9f\u2028-\u202e]")  # a terminal; text direction
LONG = "n" * 256
DEEP = "run/" * 1500 + "f.csv"
PLACED = {"hard", "flight_hard", "large.csv", "mine.partial-1"}  # before the program began


class Case:
    """Words of an invocation; the first is split at its blanks and begins with a program's name. `leaves` whether files
    may stay in run/; `places` whether run/ holds a folder, a pipe, links; before(run) prepares it, after(run) looks at
    it."""

    def __init__(self, *words, code=2, leaves=False, places=False, around="", blocks=1, env=None, before=None,
                 after=None):
        self.program, *first = words[0].split()
        self.words = [*first, *words[1:]]
        self.code, self.leaves, self.places, self.env = code, leaves, places, env or {}
        self.around, self.shell = around, SURROUNDINGS[around].format(blocks=blocks)
        self.before, self.after = before, after


def refused(*words, **how):
    return Case(*words, **how)


def left_alone(*words, **how):
    return Case(*words, places=True, **how)


def accepted(*words, **how):
    return Case(*words, code=0, leaves=True, **how)


def make_places(run):
    (run / "folder").mkdir()
    os.mkfifo(run / "fifo")
    for name, target in ("dangling", "nowhere"), ("loop", "loop"), ("link", "../in/sticks.csv"), ("flight_link",
                                                                                                  "../in/flight.csv"):
        os.symlink(target, run / name)
    for name, target in ("hard", "sticks.csv"), ("flight_hard", "flight.csv"):
        if (run / "../in" / target).exists():
            os.link(run / "../in" / target, run / name)


def contents(folder):
    return {path.name: hashlib.blake2b(path.read_bytes()).digest() for path in folder.iterdir()}


class Sandbox:
    """A folder with in/ and run/, for one case at a time."""

    def __init__(self, folder, given):
        self.folder, self.given = folder, given
        self.run = folder / "run"
        folder.mkdir()
        shutil.copytree(given, folder / "in")
        self.intact = contents(folder / "in")

    def faults(self, case, programs):
        shutil.rmtree(self.run, ignore_errors=True)
        self.run.mkdir()
        if case.places:
            make_places(self.run)
        if case.before:
            case.before(self.run)
        words = programs[case.program].words + [str(word).replace(HERE, str(self.folder)) for word in case.words]
        command = ["bash", "-c", case.shell, "bash", *words] if case.around else words
        reading, out = os.pipe() if case.around == "reader_left" else (None, subprocess.PIPE)
        if reading:
            os.close(reading)
        try:
            done = subprocess.run(command, cwd=self.folder, env={**os.environ, **case.env}, stdin=subprocess.DEVNULL,
                                  stdout=out, stderr=subprocess.PIPE, timeout=20)
        except subprocess.TimeoutExpired:
            return f"{words}: nobody waits for ever"
        finally:
            if reading:
                os.close(out)
        done = Done(words, done.returncode, done.stdout or b"", done.stderr)
        found = list(self._faults_of(case, done))
        return f"{', '.join(found)}: {case.around} {case.env} {done!r:.700}" if found else None

    def _faults_of(self, case, done):
        # a poor network is warned of: one epoch makes no other
        lines = [line for line in done.lines if not line.startswith("train: warning: ")]
        if done.code != case.code:
            yield f"exit code {done.code} instead of {case.code}"
        if len(lines) != (case.code != 0 and case.around not in ("closed_stderr", "all_closed")):
            yield f"{len(lines)} lines on stderr"
        if STEERS.search(done.err.replace("\n", "")):
            yield "steers the terminal"
        left = [path for path in self.run.rglob("*") if path.is_file() and not path.is_symlink()
                and path.name not in PLACED]
        if left and not case.leaves:
            yield f"left {left}"
        if case.code == 0 and not left:
            yield "left nothing"
        if any(".partial-" in str(path) for path in [*left, *self.folder.iterdir()]):
            yield "left a partial file"
        if contents(self.folder / "in") != self.intact:
            yield "an input was changed"
            shutil.rmtree(self.folder / "in")
            shutil.copytree(self.given, self.folder / "in")
        if case.after:
            try:
                case.after(self.run)
            except (AssertionError, OSError) as fault:
                yield str(fault) or "what it left"


def no_cut_pictures(run):
    for picture in run.rglob("*.svg"):
        assert picture.read_bytes()[-8:].strip().endswith(b"</svg>"), f"{picture} is cut"


def try_all(cases, programs, given, work):
    """programs: by the name that a case begins with; given: the folder of which in/ is a copy."""
    own, wrong, count, lock = threading.local(), [], 0, threading.Lock()

    def one(case):
        nonlocal count
        if not hasattr(own, "sandbox"):
            with lock:
                count += 1
            own.sandbox = Sandbox(Path(work, f"sandbox{count}-{threading.get_ident()}"), given)
        return own.sandbox.faults(case, programs)

    cases = list(cases)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [fault for fault in pool.map(one, cases) if fault]
    assert not wrong, f"{len(wrong)} of {len(cases)} went wrong:\n" + "\n".join(wrong)
    return len(cases)
