# SPDX-License-Identifier: MIT
"""What the tests of the programs share. A test runs in an empty folder of its own. CTest passes the paths; without them
`python3 -m pytest tests/programs/test_airframe.py` takes what the preset dev built.

Tests pin exit codes, places (file:line:column) and one word of a complaint, not its sentence."""
import csv
import hashlib
import json
import lzma
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2]
PATIENCE_S = 300  # no program of a test works as long
# as a run of several seconds prints them, a line each where nobody watches
PROGRESS = re.compile(r"[^:]+: [ \d]{3} %(, \d+ (s|min) left)?")


def pytest_addoption(parser):
    group = parser.getgroup("pinnquad")
    group.addoption("--program", action="append", default=[], metavar="PATH",
                    help="a program that was built; its name finds it")
    group.addoption("--compiler", default="c++", help="what compiles exports (default: c++)")
    group.addoption("--flags", default="", help="with these flags, as the build")
    group.addoption("--werror", default="-Werror", help="-Werror, or nothing where warnings are no errors")
    group.addoption("--reference", default=SOURCE.parent / "shared/reference", type=Path,
                    help="logs that others recorded")


os.environ.setdefault("PINNQUAD_PYTHON", sys.executable)  # by which `pinnquad convert` reads networks


def pytest_sessionfinish(session, exitstatus):
    """77, which CTest calls skipped, where nothing but skips was to report."""
    outcomes = session.config.pluginmanager.get_plugin("terminalreporter").stats
    if exitstatus == 0 and outcomes.get("skipped") and not outcomes.get("passed"):
        session.exitstatus = 77


class Done:
    """What a program left behind: exit code, standard output, and the lines on standard error that are no progress."""

    def __init__(self, words, code, out, err):
        self.words, self.code = words, code
        self.out, self.err = (text.decode(errors="surrogateescape") for text in (out, err))
        self.lines = [line for line in re.split(r"\n", self.err)[:-1] if not PROGRESS.fullmatch(line)]
        shares = [int(share) for share in re.findall(r"^fitting [^:]*: +(\d+) %", self.err, re.M)]
        assert shares == sorted(shares), f"progress runs backwards: {shares}"
        if self.err and not self.err.endswith("\n"):
            self.lines.append(self.err[self.err.rfind("\n") + 1 :])

    @property
    def flat(self):
        """Standard output without the breaks of its lines."""
        return " ".join(self.out.split())

    def __repr__(self):
        return f"{self.words}: exit code {self.code}; said: {self.out[-2000:]}{self.err[-2000:]}"


class Program:
    """A program and the words that every call of it begins with. The first word of a call is split at its blanks."""

    def __init__(self, *words):
        self.words = [os.fspath(word) for word in words]

    def __fspath__(self):
        return self.words[0]

    __str__ = __fspath__

    @property
    def name(self):
        return " ".join([Path(self.words[0]).name, *self.words[1:]])

    def _command(self, words):
        first, *others = words or ("",)
        first = first.split() if isinstance(first, str) else [first]
        return self.words + [word if isinstance(word, bytes) else str(word) for word in first + others]

    def run(self, *words, timeout=PATIENCE_S, stdout=subprocess.PIPE, **how):
        command = self._command(words)
        done = subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, timeout=timeout,
                              **how)
        return Done(command, done.returncode, done.stdout or b"", done.stderr)

    def __call__(self, *words, code=0, **how):
        """Runs it; the exit code is `code`, or one of them, or any where that is None."""
        done = self.run(*words, **how)
        assert code is None or done.code in (code if isinstance(code, tuple) else (code,)), done
        return done

    def refused(self, *words, at="", keyword="", code=2, **how):
        """Runs it; it says one line, of that place and with that word, and a command to type next. A * in the place is
        any number."""
        done = self(*words, code=code, **how)
        assert len(done.lines) == 1, done
        name = Path(done.words[0]).name
        if name in ("pinnquad", "pinnquad-study"):
            assert done.lines[0].split(":")[0] in (name, *done.words[1:]), done
            assert code != 2 or re.search("pinnquad(-study)? ", done.lines[0]), ("names no command to type next", done)
        place = re.escape(at).replace(r"\*", r"\d+")
        assert re.search(rf"(^|[ /]){place}(?![\w.])" if at else "", done.lines[0]), (at, done)
        assert keyword in done.lines[0], (keyword, done)
        return done

    def start(self, *words, **how):
        """Runs it in the background, in a session of its own; ended() waits for it."""
        with open("stdout.txt", "wb") as out, open("stderr.txt", "wb") as err:
            process = subprocess.Popen(self._command(words), stdout=out, stderr=err, stdin=subprocess.DEVNULL,
                                       start_new_session=True, preexec_fn=deaf_to_nothing, **how)
        return process


class Compiler(Program):
    """A compiler, to which warnings are errors where the build says so."""

    def __init__(self, werror, *words):
        super().__init__(*words)
        self.werror = werror

    def _command(self, words):
        return [word for word in super()._command(words) if word != "-Werror" or self.werror]


def deaf_to_nothing():
    """As from a terminal: whoever runs the tests may ignore signals, which is inherited."""
    for number in signal.SIGINT, signal.SIGHUP, signal.SIGTERM:
        signal.signal(number, signal.SIG_DFL)


def until(condition, process, seconds=240):
    """Waits until that holds, or the process is over."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and process.poll() is None and not condition():
        time.sleep(0.02)


def said(file="stderr.txt"):
    return Path(file).read_text(errors="surrogateescape") if Path(file).exists() else ""


def ended(process, signal_number=signal.SIGINT, whole_group=False):
    """Sends the signal to a process that start() began, and waits for its end."""
    if whole_group:
        os.killpg(process.pid, signal_number)
    else:
        process.send_signal(signal_number)
    code = process.wait(PATIENCE_S)
    return Done(process.args, code, Path("stdout.txt").read_bytes(), Path("stderr.txt").read_bytes())


def on_terminal(command, stream="stdout"):
    """A program whose standard output, or other stream, is a terminal: exit code, and what it prints there."""
    master, terminal = pty.openpty()
    attributes = termios.tcgetattr(terminal)
    attributes[1] &= ~termios.OPOST  # line feeds as they are
    termios.tcsetattr(terminal, termios.TCSANOW, attributes)
    process = subprocess.Popen(list(map(str, command)), stdin=subprocess.DEVNULL,
                               **{"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stream: terminal})
    os.close(terminal)
    out = b""
    try:
        while part := os.read(master, 65536):
            out += part
    except OSError:  # the other end is closed
        pass
    os.close(master)
    return process.wait(), out.decode()


@pytest.fixture(scope="session")
def program(request):
    """program(name): one that was built."""
    built = {Path(path).name: Path(path).resolve() for path in request.config.getoption("--program")}

    def find(name):
        # named folders, not a search: other tests make and delete folders below them
        dev = SOURCE / "build/dev"
        folders = [dev / place for place in ("bin", "examples", "tests/programs", "tests/flight_stacks")]
        for path in [built[name]] if name in built else [folder / name for folder in folders]:
            if path.is_file() and os.access(path, os.X_OK):
                return Program(path)
        pytest.skip(f"no program {name} was built")

    return find


@pytest.fixture(scope="session")
def pinnquad(program):
    return program("pinnquad")


@pytest.fixture(scope="session")
def study(program):
    return program("pinnquad-study")


@pytest.fixture(scope="session")
def commands(pinnquad):
    """Every command of the program, and its help: the program itself first, then what its help names, and what theirs
    does."""
    return commands_of(pinnquad)


def commands_of(program):
    def below(command):
        text = command("--help").out
        names = re.search(r"^Commands:\n(.*?)\n\n", text, re.M | re.S)
        found = [(command, text)]
        for name in re.findall(r"^  ([a-z]+)  ", names.group(1), re.M) if names else ():
            found += below(Program(*command.words, name))
        return found

    return below(program)


@pytest.fixture(autouse=True)
def work(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    return tmp_path


@pytest.fixture(scope="session")
def made(pinnquad, tmp_path_factory):
    """made(words...): the folder in which that command of the program has worked, once for all topics. Nobody writes
    there."""
    facts = os.stat(str(pinnquad))
    home = tmp_path_factory.getbasetemp().parent / "products"
    shelf = home / f"{facts.st_mtime_ns}-{facts.st_size}"
    for old in home.glob("*"):
        if old != shelf:
            shutil.rmtree(old, ignore_errors=True)

    def make(*words):
        folder = shelf / hashlib.sha1(repr(words).encode()).hexdigest()
        if not folder.exists():
            making = shelf / f"{folder.name}-{os.getpid()}"
            making.mkdir(parents=True)
            (making / "stderr.txt").write_text(pinnquad(*words, cwd=making).err, errors="surrogateescape")
            try:
                making.rename(folder)
            except OSError:  # another topic was faster
                shutil.rmtree(making)
        return folder

    return make


@pytest.fixture(scope="session")
def flown(made):
    """flown(words of fly): a flight's CSV."""
    return lambda words: made(f"fly {words} --out flight.csv") / "flight.csv"


@pytest.fixture
def dataset():
    """dataset(folder, {name: CSV}): flights of the simulator as import would leave them."""

    def write(folder, flights):
        listed = []
        Path(folder).mkdir()
        for name, path in flights.items():
            shutil.copy(path, Path(folder, f"{name}.csv"))
            rows = len(Path(path).read_text().splitlines()) - 1
            listed.append({"name": name, "file": f"{name}.csv", "trajectory": "", "rows": rows, "source": "simulator"})
        facts = {"format": 1, "sample_period_s": 0.05, "lag_removed_s": 0, "absent": [], "flights": listed, "steps": []}
        Path(folder, "dataset.json").write_text(json.dumps(facts))

    return write


@pytest.fixture(scope="session")
def flags(request):
    return request.config.getoption("--flags").split()


@pytest.fixture(scope="session")
def compiler(request):
    """The compiler of exports, which finds library and Eigen."""
    name = needed(request.config.getoption("--compiler"))
    try:
        found = subprocess.run(["pkg-config", "--variable=includedir", "eigen3"], capture_output=True,
                               text=True).stdout.strip()
    except FileNotFoundError:
        found = ""
    eigen = next((path for path in (f"{found}/eigen3", "/usr/include/eigen3") if os.path.isdir(f"{path}/Eigen")), None)
    return Compiler(request.config.getoption("--werror"), name, "-std=c++17", f"-I{SOURCE}/include", "-isystem", eigen or pytest.skip("no Eigen"))


@pytest.fixture(scope="session")
def recorded(request):
    """recorded(path): a log of the reference folder."""

    def find(path):
        there = request.config.getoption("--reference") / path
        return there if there.exists() else pytest.skip(f"{path} is not here")

    return find


@pytest.fixture(scope="session")
def nanobench(recorded, made):
    """A Crazyflie's flights as import leaves them: five types of trajectory, a row every 20 ms."""
    log = recorded("flight_logs/nanobench_subset_50hz.csv")
    return made(f"import {log} --mapping nanobench --out nano") / "nano"


@pytest.fixture(scope="session")
def unpacked(recorded, tmp_path_factory):
    """unpacked(name...): a folder with these logs of PX4's simulation, once."""
    folders = {}

    def find(*names):
        if names not in folders:
            folders[names] = tmp_path_factory.mktemp("sih")
            for name in names:
                with lzma.open(recorded(f"sih/{name}.ulg.xz")) as packed:
                    Path(folders[names], f"{name}.ulg").write_bytes(packed.read())
        return folders[names]

    return find


def needed(name):
    """The path of a program of the machine; the test is skipped where it is not installed."""
    return shutil.which(name) or pytest.skip(f"{name} is not installed")


def edited(source, target, change, separator=","):
    """Writes a table with other rows. change(line, cells) edits the cells of that line, from 1, or returns those to
    write: False for none of it."""
    with open(source) as rows, open(target, "w") as out:
        for line, row in enumerate(rows, start=1):
            cells = row.rstrip("\n").split(",")
            result = change(line, cells)
            if result is not False:
                out.write(separator.join(map(str, cells if result is None else result)) + "\n")
    return target


def cell(line, column, value):
    """A change: one cell, both from 1."""

    def change(at, cells):
        if at == line:
            cells[column - 1] = value

    return change


def column(*columns, to):
    """A change: these columns in every row; `to` is a value, or makes one of the number that was there."""

    def change(line, cells):
        for at in columns if line > 1 else ():
            cells[at - 1] = repr(to(float(cells[at - 1]))) if callable(to) else to

    return change


def replaced(source, target, *pairs):
    """Writes a text with each pattern (of lines) replaced; each must be there."""
    text = Path(source).read_text()
    for pattern, new in pairs:
        text, count = re.subn(pattern, new, text, flags=re.M)
        assert count, f"{source}: no {pattern}"
    Path(target).write_text(text)
    return target


def table(path):
    """The rows of a CSV, each a dict."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def report_of(folder):
    return json.loads(Path(folder, "report.json").read_text())


def no_partial_files(folder="."):
    found = [path for path in Path(folder).rglob("*.partial*")]
    assert not found, found


def same_bytes(one, other):
    assert Path(one).read_bytes() == Path(other).read_bytes(), f"{one} and {other} differ"


def listing(folder):
    return sorted(os.listdir(folder))
