# SPDX-License-Identifier: MIT
"""Judges mutants in a copy of the tree: builds and runs the tests that see the mutated file, nearest first, until one fails."""
import json
import pathlib
import re
import shutil
import signal
import time
from concurrent.futures import ThreadPoolExecutor

from mutation.tests import TEST_MAIN, Tests
from mutation.tree import HEADERS, Failed, TimedOut, digest, end_all, run, write_whole


class LinkFailed(Exception):
    pass


def by_clock(cpu_s):
    """For what waits instead of computing."""
    return 600 + 10 * cpu_s


class Judge:
    def __init__(self, tree, only, say):
        self.tree, self.tests, self.say = tree, Tests(tree, only), say
        self.steps, self.active = [], {}  # active: see is_compiled
        self.record = tree.work / "unmutated.json"

    def prepare(self):
        """Copies, builds, finds the steps, and sees each pass once: what fails unmutated can't judge."""
        self.say("copying the tree")
        self.tree.copy()
        self.tree.configure()
        programs = self.tests.programs()
        if not programs:
            raise Failed("no test program is chosen")
        begin = time.monotonic()
        self.say(f"building {len(programs)} test programs")
        self.tree.make([*programs, TEST_MAIN])
        self.say(f"built in {time.monotonic() - begin:.0f} s")
        self.see_pass(self.tests.steps(programs))
        self.tree.keep()

    # --- without a mutant

    def see_pass(self, steps):
        """Each step once without a mutant, but folders only when a mutant asks for them: they compile for minutes."""
        parts_alone, self.steps = {}, []
        for number, step in enumerate(steps, 1):
            if step.kind == "folder" and not self.known(step):
                self.steps.append(step)
                continue
            says = self.see_step(step, parts_alone, f"{number} of {len(steps)}")
            if step.kind == "source":
                parts_alone[step.target] = says == "passes"
            # a program whose sources all run alone says nothing more as a whole
            whole = step.kind == "program" and step.parts and all(parts_alone.get(part) for part in step.parts)
            if says == "passes" and not whole:
                self.steps.append(step)

    def see_folders(self, mutant):
        for step in [step for step in self.seen_by(mutant.path) if step.kind == "folder"]:
            if self.see_step(step, {}, "a folder") != "passes":
                self.steps.remove(step)

    def see_step(self, step, parts_alone, which):
        """What it says without a mutant: as before, where its files are the same."""
        known = self.known(step)
        if not known:
            known = {"digest": step.digest, **self.try_unmutated(step, parts_alone)}
            write_whole(self.record, json.dumps({**self.all_known(), step.name: known}, indent=0))
            self.say(f"  without a mutant, {which}: {step.name}: {known['says']}, {known['run_s']:.1f} s")
        step.run_s = known["run_s"]
        if known["says"] == "fails":
            raise Failed(f"{step.name} fails without any mutant ({known['why']})")
        return known["says"]

    def all_known(self):
        return json.loads(self.record.read_text()) if self.record.exists() else {}

    def known(self, step):
        entry = self.all_known().get(step.name)
        return entry if entry and entry["digest"] == step.digest else None

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

    # --- with one

    def seen_by(self, path):
        """The steps that see a header, nearest first: the test file of its name, its room's, the others by their time."""
        header, room = f"{HEADERS}/{path}", path.split("/")[0]
        stem = pathlib.PurePath(path).stem

        def distance(step):
            cost = step.build_s + step.run_s
            if step.target is None:
                return (3, cost)
            source = pathlib.PurePath(step.target).name if step.kind == "source" else ""
            if step.room == room and source.startswith(stem):
                return (0, cost)
            return (1 if step.room == room else 2, cost)

        return sorted((step for step in self.steps if header in step.sees), key=distance)

    def is_compiled(self, mutant):
        """Does a test compile the line of the mutant?"""
        if mutant.path not in self.active:
            seeing = self.seen_by(mutant.path)
            self.active[mutant.path] = self.tests.active_lines(mutant.path, seeing) if seeing else set()
        lines = self.active[mutant.path]
        return lines is None or mutant.line in lines

    def judge(self, mutant):
        """(verdict, what there is to say of it, steps that it rests on): survived, killed, "did not compile" or
        "time limit"."""
        self.see_folders(mutant)
        steps = self.seen_by(mutant.path)
        self.changed_code = False
        with self.tree.mutated(mutant):
            for batch in self.batches(steps):
                targets = [step.target for step in batch if step.target]
                verdict = self.build_mutant(targets, batch) if targets else None
                if verdict:
                    return verdict
                with ThreadPoolExecutor(self.tree.jobs) as pool:
                    try:
                        verdicts = list(pool.map(self.ask_changed, batch))
                    except BaseException:
                        end_all()
                        raise
                for step, verdict in zip(batch, verdicts):
                    if verdict not in ("survived", "skipped"):
                        return verdict, step.name, [step]
        return "survived", "" if self.changed_code else "same object code in every test", steps

    def batches(self, steps):
        """Steps to ask at once, in their order. Those of compile_fail, alone: each precompiles the same header first."""
        batch = []
        for step in steps:
            if batch and (len(batch) == self.tree.jobs or "compile_fail" in (step.kind, batch[-1].kind)):
                yield batch
                batch = []
            batch.append(step)
        if batch:
            yield batch

    def build_mutant(self, targets, batch):
        names = "build of " + ", ".join(step.name for step in batch)
        limit_s = 60 + 8 * max(step.build_s for step in batch)
        try:
            code, said = run(self.tree.confined(limit_s, "ninja", "-j", str(self.tree.jobs), *targets), self.tree.build,
                             by_clock(limit_s))
        except TimedOut:
            return "time limit", names, batch
        if code == 0:
            return None
        if "CPU time limit exceeded" in said:
            return "time limit", names, batch
        failed = re.findall(r"^FAILED: (\S+)", said, re.MULTILINE)
        if any(path.endswith((".o", ".gch")) for path in failed):
            return "did not compile", names, batch
        return "killed", names, batch  # a program that the build runs

    def ask_changed(self, step):
        if step.target:
            changed = self.tree.is_changed(step.target)
            self.changed_code |= changed
            if not changed:
                return "survived"
        return self.ask_step(step, 20 + 8 * step.run_s)

    def ask_step(self, step, limit_s):
        try:
            if step.kind == "source":
                return self.ask_source(step, limit_s)
            name = re.sub(r"([.+*?^$()\[\]])", r"\\\1", step.name)
            pattern = f"^{name}$" if step.target else f"^{name}\\."
            code, said = run(self.tree.confined(limit_s, "ctest", "--test-dir", str(self.tree.build), "-R", pattern, "-j",
                                                str(self.tree.jobs), "--stop-on-failure"),
                             self.tree.build, by_clock(limit_s))
        except TimedOut:
            return "time limit"
        if code == 0:
            return "survived" if " Passed " in said else "skipped"
        return "time limit" if "***Timeout" in said else "killed"

    def ask_source(self, step, limit_s):
        """Links one object with the main of all test programs, and runs it in a folder of its own."""
        folder = self.tree.work / "runs" / digest(step.name)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        try:
            objects = [str(self.tree.build / path) for path in (step.target, TEST_MAIN)]
            code, _ = run([self.tree.compiler, *objects, "-pthread", "-o", str(folder / "test")], folder, 300)
            if code != 0:
                raise LinkFailed
            code, _ = run(self.tree.confined(limit_s, str(folder / "test"), "--abort-after=1", "--out=/dev/null"), folder,
                          by_clock(limit_s))
            return {0: "survived", -signal.SIGXCPU: "time limit", -signal.SIGKILL: "time limit"}.get(code, "killed")
        finally:
            shutil.rmtree(folder, ignore_errors=True)

