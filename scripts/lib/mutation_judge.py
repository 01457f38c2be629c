# SPDX-License-Identifier: MIT
"""Judges mutants in a copy of the tree: builds and runs the tests that see the mutated file, nearest first, until one fails.

What sees a file is read from the compilers' dependency files (ninja -t deps). A test is a step of its own as small as it gets:
one source of a doctest program linked alone, a whole program where a source needs the others, the cases of one source of
tests/compile_fail. After each mutant the copy and its build folder are as they were before, file times too.
"""
import contextlib
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

HEADERS = "include/pinnquad"


class Failed(Exception):
    """What the machine or the tree lacks for a run: one line."""


class TimedOut(Exception):
    pass


class LinkFailed(Exception):
    pass


_running = set()


@contextlib.contextmanager
def started(command, cwd, **how):
    """A process whose output is read; it and what it started are gone when the block ends, however it ends."""
    with subprocess.Popen(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          start_new_session=True, text=True, errors="replace", **how) as process:
        _running.add(process.pid)
        try:
            yield process
        except BaseException:
            end_group(process.pid)
            raise
        finally:
            _running.discard(process.pid)


def end_group(pid):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(pid, signal.SIGKILL)


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


class Step:
    """One test that can be asked alone. kind: source, program, compile_fail."""

    def __init__(self, name, kind, sees, target=None, room=None):
        self.name, self.kind, self.sees, self.target, self.room = name, kind, sees, target, room
        self.tests_digest = self.digest = None
        self.build_s, self.run_s = 1.0, 1.0
        self.sources = [path for path in sees if path.startswith("tests/") and path.endswith(".cpp")]


class Judge:
    def __init__(self, root, work, preset, jobs, only_tests, say):
        self.root, self.work, self.preset, self.jobs, self.say = root, work, preset, jobs, say
        self.only_tests = re.compile(only_tests)
        self.tree, self.build, self.kept, self.runs = work / "tree", work / "build", work / "kept", work / "runs"
        self.index = {}

    # --- a copy of the tree, built

    def copy_tree(self):
        """Brings the copy up to the tree. A file whose content is the same is not touched: its objects stay."""
        names = files_of(self.root)
        self.digests = {}
        for name in names:
            content = (self.root / name).read_bytes()
            self.digests[name] = digest(content)
            target = self.tree / name
            if not target.is_file() or target.read_bytes() != content:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
                shutil.copymode(self.root / name, target)
        for folder, _, found in os.walk(self.tree):
            for name in found:
                path = pathlib.Path(folder) / name
                if str(path.relative_to(self.tree)) not in self.digests:
                    path.unlink()

    def configure(self):
        if (self.build / "build.ninja").exists():
            return  # ninja configures anew by itself
        reference = (self.root / ".." / "shared" / "reference").resolve()
        command = ["cmake", "--preset", self.preset, "-B", str(self.build), "-G", "Ninja",
                   # a warning is not a test
                   "-DPINNQUAD_WARNINGS_AS_ERRORS=OFF", "-DCMAKE_CXX_FLAGS_INIT=-w",
                   "-DPINNQUAD_BUILD_BENCH=OFF", "-DPINNQUAD_STATIC_TESTS=ON"]
        if reference.is_dir():
            command.append(f"-DPINNQUAD_REFERENCE_DIR={reference}")
        code, said = run(command, self.tree)
        if code != 0:
            (self.build / "build.ninja").unlink(missing_ok=True)
            raise Failed(f"cmake failed: {last_line(said)}")

    def ninja(self, *arguments, limit_s=None):
        return run(["ninja", "-C", str(self.build), *arguments], self.build, limit_s)

    def ask(self, *arguments):
        code, said = self.ninja(*arguments)
        if code != 0:
            raise Failed(f"ninja {shlex.join(arguments)}: {last_line(said)}")
        return [line for line in said.splitlines() if not line.startswith("ninja: Entering directory")]

    def prepare(self):
        """Copies, builds, finds the steps, and sees each pass once: what fails unmutated can't judge."""
        self.say("copying the tree")
        self.copy_tree()
        self.configure()
        # the files of a glob may have changed
        self.ask("build.ninja")
        tests = self.all_tests()
        programs = self.programs(tests)
        if not programs:
            raise Failed("no test program is chosen")
        begin = time.monotonic()
        self.say(f"building {len(programs)} test programs")
        self.build_shown([*programs, self.test_main()])
        self.say(f"built in {time.monotonic() - begin:.0f} s")
        self.steps = [*self.program_steps(programs), *self.compile_fail_steps(tests)]
        self.see_pass()
        self.keep()

    def build_shown(self, targets):
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

    def all_tests(self):
        """Name -> command, as CMake wrote them down (ctest lists no command of a program that is not built)."""
        found, folders = {}, [self.build]
        for folder in folders:
            if not (folder / "CTestTestfile.cmake").exists():
                continue
            text = (folder / "CTestTestfile.cmake").read_text()
            folders += [folder / name for name in re.findall(r'^subdirs\("(.*)"\)$', text, re.MULTILINE)]
            for name, words in re.findall(r"^add_test\(\[=*\[(.*?)\]=*\] (.*)\)$", text, re.MULTILINE):
                quoted = re.findall(r'"((?:[^"\\]|\\.)*)"', words)
                found[name] = [re.sub(r"\\(.)", r"\1", word) for word in quoted]
        return found

    def programs(self, tests):
        """Target -> names of the tests that call it: tests whose command is a program of this build."""
        targets = {line.rpartition(": ")[0] for line in self.ask("-t", "targets", "all")}
        found = {}
        for name, command in tests.items():
            program = os.path.relpath(command[0], self.build) if command else ""
            if program in targets and self.only_tests.search(name):
                found.setdefault(program, []).append(name)
        return found

    def test_main(self):
        return "tests/CMakeFiles/test_main.dir/main.cpp.o"

    def dependencies(self):
        """Object -> files of the tree that its compiler read."""
        found, current = {}, None
        for line in self.ask("-t", "deps"):
            if line.startswith(" "):
                path = os.path.normpath(os.path.join(self.build, line.strip()))
                if path.startswith(f"{self.tree}{os.sep}"):
                    current.add(os.path.relpath(path, self.tree))
            elif ": #deps" in line:
                current = found.setdefault(line.split(": #deps")[0], set())
        return found

    def program_steps(self, programs):
        dependencies, seconds = self.dependencies(), self.compile_seconds()
        for program, names in programs.items():
            inputs = set(self.ask("-t", "inputs", program))
            objects = sorted(path for path in inputs if path.endswith(".o") and path in dependencies)
            own = f"{os.path.dirname(program)}/CMakeFiles/{os.path.basename(program)}.dir/".lstrip("/")
            sources = [path for path in objects if path.startswith(own)]
            alone = self.test_main() in inputs
            for path in sources if alone else []:
                name = self.source_of(path, own)
                step = Step(f"{names[0]}: {name}", "source", dependencies[path], path, names[0])
                step.build_s = seconds.get(path, 1.0)
                yield step
            for name in names:
                step = Step(name, "program", set().union(*(dependencies[path] for path in objects)), program, name)
                step.build_s = sum(seconds.get(path, 0.0) for path in objects)
                step.parts = sources if alone else None
                yield step

    @staticmethod
    def source_of(path, own):
        return path[len(own):-len(".o")]

    def compile_seconds(self):
        found = {}
        for line in (self.build / ".ninja_log").read_text().splitlines()[1:]:
            begin, end, _, output, _ = line.split("\t")
            found[output] = (int(end) - int(begin)) / 1000
        return found

    def compile_fail_steps(self, tests):
        """The cases of one source together: what a compiler refuses is tested nowhere else."""
        sources = {}
        for name, command in tests.items():
            values = dict(word[2:].split("=", 1) for word in command if word.startswith("-D") and "=" in word)
            if name.startswith("compile_fail.") and "SOURCE" in values and self.only_tests.search(name):
                sources.setdefault(values["SOURCE"], (values, []))[1].append(name)
        for source, (values, names) in sorted(sources.items()):
            code, said = run([values["COMPILER"], "-std=c++17", "-MM", "-I", values["INCLUDE_DIR"], "-isystem",
                              values["EIGEN_INCLUDE_DIR"], source], self.build)
            if code != 0:
                raise Failed(f"no dependencies of {source}: {last_line(said)}")
            paths = [os.path.normpath(path) for path in said.replace("\\\n", " ").split()[1:]]
            sees = {os.path.relpath(path, self.tree) for path in paths if path.startswith(f"{self.tree}{os.sep}")}
            group = names[0].split(".")[1]
            step = Step(f"compile_fail.{group}", "compile_fail", sees, None, "compile_fail")
            step.build_s, step.run_s = 0.0, 0.8 * len(names)
            yield step

    # --- without a mutant

    def see_pass(self):
        """Each step once without a mutant, unless it passed before with the same files."""
        record = self.work / "unmutated.json"
        before = json.loads(record.read_text()) if record.exists() else {}
        parts_alone, kept = {}, []
        todo = len(self.steps)
        for number, step in enumerate(self.steps, 1):
            self.digest_step(step)
            known = before.get(step.name)
            if known is None or known["digest"] != step.digest:
                known = {"digest": step.digest, **self.try_unmutated(step, parts_alone)}
                before[step.name] = known
                write_whole(record, json.dumps(before, indent=0))
                self.say(f"  without a mutant, {number} of {todo}: {step.name}: {known['says']}, {known['run_s']:.1f} s")
            step.run_s = known["run_s"]
            if step.kind == "source":
                parts_alone[step.target] = known["says"] == "passes"
            if known["says"] == "fails":
                raise Failed(f"{step.name} fails without any mutant ({known['why']})")
            # a program whose sources all run alone says nothing more as a whole
            whole = step.kind == "program" and step.parts and all(parts_alone.get(part) for part in step.parts)
            if known["says"] == "passes" and not whole:
                kept.append(step)
        self.steps = kept

    def digest_step(self, step):
        """Of the tests: their sources, and the data beside them. Of all: every file that they were made from."""
        folders = {os.path.dirname(path) for path in step.sources}
        data = {name for name in self.digests if os.path.dirname(name) in folders and not name.endswith((".cpp", ".hpp"))}
        tests = sorted(data | {path for path in step.sees if not path.startswith("include/")})
        tell = lambda names: digest(step.name, *(f"{name} {self.digests.get(name)}" for name in names))
        step.tests_digest, step.digest = tell(tests), tell(sorted(data | step.sees))

    def try_unmutated(self, step, parts_alone):
        if step.kind == "program" and step.parts and all(parts_alone.get(part) for part in step.parts):
            return {"says": "is the sum of its sources", "run_s": 0.0}
        begin = time.monotonic()
        try:
            verdict = self.ask_step(step, limit_s=600)
        except LinkFailed:
            return {"says": "does not link alone", "run_s": 0.0}
        says = {"survived": "passes", "skipped": "is skipped"}.get(verdict, "fails")
        if step.kind == "source" and says == "fails":  # it may count on the others: the whole program decides
            says = "fails alone"
        return {"says": says, "why": verdict, "run_s": time.monotonic() - begin}

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
                copy(self.build / name, self.kept / name)

    def restore_build(self):
        now = dict(self.walk_build())
        for name in now.keys() - self.index.keys():
            (self.build / name).unlink()
        for name, state in self.index.items():
            if now.get(name) != state:
                copy(self.kept / name, self.build / name)

    # --- with one

    def seen_by(self, path):
        """The steps that see a header, nearest first: the test file of its name, its room's, the others by their time."""
        header, room = f"{HEADERS}/{path}", path.split("/")[0]
        stem = pathlib.PurePath(path).stem

        def distance(step):
            cost = step.build_s + step.run_s
            if step.kind == "compile_fail":
                return (3, cost)
            source = pathlib.PurePath(step.target).name if step.kind == "source" else ""
            if step.room == room and source.startswith(stem):
                return (0, cost)
            return (1 if step.room == room else 2, cost)

        return sorted((step for step in self.steps if header in step.sees), key=distance)

    @contextlib.contextmanager
    def mutated(self, mutant):
        target = self.tree / HEADERS / mutant.path
        text, times = target.read_text(), os.stat(target)
        try:
            target.write_text(mutant.applied(text))
            yield
        finally:
            target.write_text(text)
            os.utime(target, ns=(times.st_atime_ns, times.st_mtime_ns))
            self.restore_build()

    def judge(self, mutant):
        """(verdict, what there is to say of it, steps that it rests on): survived, killed, "did not compile" or
        "time limit"."""
        steps = self.seen_by(mutant.path)
        if not steps:
            return "survived", "no test includes this file", steps
        self.changed_code = False
        with self.mutated(mutant):
            for first in range(0, len(steps), self.jobs):
                batch = steps[first:first + self.jobs]
                targets = [step.target for step in batch if step.target]
                limit_s = 60 + 8 * sum(step.build_s for step in batch)
                verdict = self.build_mutant(targets, limit_s, batch) if targets else None
                if verdict:
                    return verdict
                with ThreadPoolExecutor(self.jobs) as pool:
                    try:
                        verdicts = list(pool.map(self.ask_changed, batch))
                    except BaseException:
                        for pid in list(_running):
                            end_group(pid)
                        raise
                for step, verdict in zip(batch, verdicts):
                    if verdict not in ("survived", "skipped"):
                        return verdict, step.name, [step]
        return "survived", "" if self.changed_code else "same object code in every test", steps

    def build_mutant(self, targets, limit_s, batch):
        names = "build of " + ", ".join(step.name for step in batch)
        try:
            code, said = self.ninja("-j", str(self.jobs), *targets, limit_s=limit_s)
        except TimedOut:
            return "time limit", names, batch
        if code == 0:
            return None
        failed = re.findall(r"^FAILED: (\S+)", said, re.MULTILINE)
        if any(path.endswith((".o", ".gch")) for path in failed):
            return "did not compile", names, batch
        return "killed", names, batch  # a program that the build runs

    def ask_changed(self, step):
        if step.target:
            changed = (self.build / step.target).read_bytes() != (self.kept / step.target).read_bytes()
            self.changed_code |= changed
            if not changed:
                return "survived"
        return self.ask_step(step, 20 + 8 * step.run_s)

    def ask_step(self, step, limit_s):
        try:
            if step.kind == "source":
                return self.ask_source(step, limit_s)
            name = re.sub(r"([.+*?^$()\[\]])", r"\\\1", step.name)
            pattern = f"^{name}\\." if step.kind == "compile_fail" else f"^{name}$"
            code, said = run(["ctest", "--test-dir", str(self.build), "-R", pattern, "-j", str(self.jobs),
                              "--stop-on-failure", "--timeout", str(int(limit_s))], self.build, limit_s + 900)
        except TimedOut:
            return "time limit"
        if code == 0:
            return "skipped" if "***Skipped" in said else "survived"
        return "time limit" if "***Timeout" in said else "killed"

    def ask_source(self, step, limit_s):
        """Links one object with the main of all test programs, and runs it in a folder of its own."""
        folder = self.runs / digest(step.name)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        try:
            code, _ = run([self.compiler(), str(self.build / step.target), str(self.build / self.test_main()), "-pthread",
                           "-o", str(folder / "test")], folder, 300)
            if code != 0:
                raise LinkFailed
            code, _ = run([str(folder / "test"), "--abort-after=1", "--no-path-filenames"], folder, limit_s)
            return "survived" if code == 0 else "killed"
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def compiler(self):
        if not hasattr(self, "_compiler"):
            cache = (self.build / "CMakeCache.txt").read_text()
            self._compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", cache, re.MULTILINE).group(1)
        return self._compiler

    # --- which lines a compiler reads

    def active_lines(self, path):
        """The lines of a header with conditional parts that some test's preprocessor keeps; None where all are kept."""
        header = f"{HEADERS}/{path}"
        text = (self.tree / header).read_text()
        if not re.search(r"^[ \t]*#[ \t]*(if|el)", text, re.MULTILINE):
            return None
        if not hasattr(self, "_commands"):
            listed = json.loads("\n".join(self.ask("-t", "compdb")))
            self._commands = {entry["output"]: entry["command"] for entry in listed if entry["output"].endswith(".o")}
        kept, flags = set(), set()
        for step in self.steps:
            if step.kind != "source" and step.kind != "program" or header not in step.sees:
                continue
            outputs = [step.target] if step.kind == "source" else step.parts or self.objects_under(step.target)
            for output in outputs:
                words = shlex.split(self._commands.get(output, ""))
                defines = frozenset(word for word in words if word.startswith(("-D", "-m", "-f", "-O")))
                if not words or defines in flags:
                    continue
                found = self.preprocessed(words, header)
                if found:
                    flags.add(defines)
                    kept |= found
        return kept

    def objects_under(self, program):
        folder = f"{os.path.dirname(program)}/CMakeFiles/{os.path.basename(program)}.dir/".lstrip("/")
        return [output for output in self._commands if output.startswith(folder)]

    def preprocessed(self, words, header):
        command = words[:words.index("-MD")] + ["-E", words[words.index("-c") + 1]]
        code, said = run(command, self.build, 300)
        if code != 0:
            return set()
        kept, here, line = set(), False, 0
        wanted = str(self.tree / header)
        for text in said.splitlines():
            marker = re.match(r'# (\d+) "(.*?)"', text)
            if marker:
                here = os.path.normpath(os.path.join(self.build, marker[2])) == wanted
                line = int(marker[1])
            else:
                if here and text.strip():
                    kept.add(line)
                line += 1
        return kept


def copy(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    if os.path.islink(source):
        target.unlink(missing_ok=True)
    shutil.copy2(source, target, follow_symlinks=False)


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else "it said nothing"


def minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"
