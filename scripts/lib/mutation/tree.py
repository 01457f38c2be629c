# SPDX-License-Identifier: MIT
"""A copy of the tree, built; with a mutant in it for as long as a block lasts, and then as it was, file times too."""
import contextlib
import functools
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import time

HEADERS = "include/pinnquad"


class Failed(Exception):
    """What the machine or the tree lacks for a run: one line."""


class TimedOut(Exception):
    pass


running = set()


@contextlib.contextmanager
def started(command, cwd, **how):
    """A process whose output is read; it and what it started are gone when the block ends, however it ends."""
    with subprocess.Popen(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          start_new_session=True, text=True, errors="replace", **how) as process:
        running.add(process.pid)
        try:
            yield process
        except BaseException:
            end_session(process.pid)
            raise
        finally:
            running.discard(process.pid)


def end_all():
    for pid in list(running):
        end_session(pid)


def end_session(leader):
    """Ends all that a process started by started() has started: ninja gives each compiler a group of its own, so that only the
    session says which they are."""
    alive = True
    while alive:
        alive = False
        for entry in os.listdir("/proc"):
            with contextlib.suppress(OSError, ValueError, IndexError):
                words = pathlib.Path("/proc", entry, "stat").read_text().rpartition(")")[2].split()
                if int(words[3]) == leader and words[0] != "Z":
                    os.kill(int(entry), signal.SIGKILL)
                    alive = True
        time.sleep(0.01 if alive else 0)


def run(command, cwd, limit_s=None):
    """(exit code, all that it said)"""
    try:
        with started(command, cwd) as process:
            said, _ = process.communicate(timeout=limit_s)
            return process.returncode, said
    except subprocess.TimeoutExpired:
        raise TimedOut from None


def digest(*parts):
    whole = hashlib.sha256()
    for part in parts:
        part = part.encode() if isinstance(part, str) else part
        whole.update(len(part).to_bytes(8, "little") + part)
    return whole.hexdigest()[:20]


def write_whole(path, text):
    """The file appears whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text)
    os.replace(partial, path)


def files_of(root):
    """The tree's own files, relative: what git tracks or would, else all but build folders."""
    if (root / ".git").exists() and shutil.which("git"):
        code, said = run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"], root)
        if code == 0:
            return sorted({name for name in said.split("\0") if name and (root / name).is_file()})
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if name not in (".git", "build", "demo_out", "node_modules")]
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names]
    return sorted(found)


def copy_file(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    if os.path.islink(source):
        target.unlink(missing_ok=True)
    shutil.copy2(source, target, follow_symlinks=False)


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else "it said nothing"


def minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


class Tree:
    def __init__(self, root, work, preset, jobs, say):
        self.root, self.work, self.preset, self.jobs, self.say = root, work, preset, jobs, say
        self.folder, self.build, self.kept = work / "tree", work / "build", work / "kept"
        self.index, self.digests = {}, {}

    def copy(self):
        """Brings the copy up to the tree. A file whose content is the same is not touched: its objects stay."""
        names = [name for name in files_of(self.root) if self.work not in (self.root / name).parents]
        self.digests = {}
        for name in names:
            content = (self.root / name).read_bytes()
            self.digests[name] = digest(content)
            target = self.folder / name
            if not target.is_file() or target.read_bytes() != content:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
                shutil.copymode(self.root / name, target)
        for folder, _, found in os.walk(self.folder):
            for name in found:
                path = pathlib.Path(folder) / name
                if str(path.relative_to(self.folder)) not in self.digests:
                    path.unlink()

    def configure(self):
        if (self.build / "build.ninja").exists():
            self.ask("build.ninja")  # configures anew where the files of a glob are others
            return
        reference = (self.root / ".." / "shared" / "reference").resolve()
        command = ["cmake", "--preset", self.preset, "-B", str(self.build), "-G", "Ninja",
                   # a warning is not a test
                   "-DPINNQUAD_WARNINGS_AS_ERRORS=OFF", "-DCMAKE_CXX_FLAGS_INIT=-w",
                   "-DPINNQUAD_BUILD_BENCH=OFF", "-DPINNQUAD_TESTS_LEFT_OUT="]
        if reference.is_dir():
            command.append(f"-DPINNQUAD_REFERENCE_DIR={reference}")
        code, said = run(command, self.folder)
        if code != 0:
            (self.build / "build.ninja").unlink(missing_ok=True)
            raise Failed(f"cmake failed: {last_line(said)}")

    def ninja(self, *arguments):
        return run(["ninja", "-C", str(self.build), *arguments], self.build)

    def ask(self, *arguments):
        code, said = self.ninja(*arguments)
        if code != 0:
            raise Failed(f"ninja {shlex.join(arguments)}: {last_line(said)}")
        return [line for line in said.splitlines() if not line.startswith("ninja: Entering directory")]

    def make(self, targets):
        """Builds, with a line of progress now and then."""
        command = ["ninja", "-C", str(self.build), "-j", str(self.jobs), *targets]
        shown, tail = time.monotonic(), []
        with started(command, self.build, env={**os.environ, "NINJA_STATUS": "[%f of %t, %e s] "}) as process:
            for line in process.stdout:
                tail = (tail + [line.rstrip()])[-40:]
                count = re.match(r"\[(\d+) of (\d+), ([\d.]+) s\]", line)
                if count and time.monotonic() - shown > 10:
                    shown = time.monotonic()
                    done, whole, spent = int(count[1]), int(count[2]), float(count[3])
                    left = spent / done * (whole - done) if done else 0
                    self.say(f"  {done} of {whole} build steps; about {minutes(left)} left")
        if process.returncode != 0:
            errors = [line for line in tail if "error" in line] or tail
            raise Failed(f"the tree does not build without any mutant: {errors[0] if errors else 'ninja failed'}")

    @functools.cached_property
    def cache(self):
        return (self.build / "CMakeCache.txt").read_text()

    @property
    def compiler(self):
        return re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", self.cache, re.MULTILINE).group(1)

    def confined(self, cpu_s, *command):
        """A loop without end must not take the machine's time, memory or disk. CPU time, of each process, since the clock runs on
        while others compute. Sanitizers need the address space; a test of the data room makes a file of 8 GiB that is a hole."""
        memory = "" if "-fsanitize" in self.cache else f"ulimit -v {4 << 20}; "
        return ["bash", "-c", memory + f"ulimit -c 0; ulimit -f {9 << 20}; ulimit -t {int(cpu_s)}; exec \"$@\"", "confined",
                *command]

    def walk_build(self):
        for folder, folders, names in os.walk(self.build):
            if folder == str(self.build):
                folders[:] = [name for name in folders if name != "Testing"]
            for name in names:
                path = os.path.join(folder, name)
                state = os.lstat(path)
                yield os.path.relpath(path, self.build), (state.st_mtime_ns, state.st_size)

    def keep(self):
        """A second copy of the build folder, brought up to the first."""
        self.index = dict(self.walk_build())
        stale = {}
        if self.kept.exists():
            for folder, _, names in os.walk(self.kept):
                for name in names:
                    path = os.path.join(folder, name)
                    state = os.lstat(path)
                    stale[os.path.relpath(path, self.kept)] = (state.st_mtime_ns, state.st_size)
        for name in stale.keys() - self.index.keys():
            (self.kept / name).unlink()
        for name, state in self.index.items():
            if stale.get(name) != state:
                copy_file(self.build / name, self.kept / name)

    def is_changed(self, name):
        """Does a file of the build folder say something else than without a mutant?"""
        return (self.build / name).read_bytes() != (self.kept / name).read_bytes()

    def restore(self):
        now = dict(self.walk_build())
        for name in now.keys() - self.index.keys():
            (self.build / name).unlink()
        for name, state in self.index.items():
            if now.get(name) != state:
                copy_file(self.kept / name, self.build / name)

    @contextlib.contextmanager
    def mutated(self, mutant):
        target = self.folder / HEADERS / mutant.path
        text, times = target.read_text(), os.stat(target)
        try:
            target.write_text(mutant.applied(text))
            yield
        finally:
            self.restore()
            # last: a run that is killed before leaves a header that the next one finds changed
            target.write_text(text)
            os.utime(target, ns=(times.st_atime_ns, times.st_mtime_ns))

