#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What scripts/mutation promises, without a compiler: which edits the rules make and where they make none, that a seed draws the
same sample, that a verdict stands as long as its file and its tests do, that the copy is as it was, that claims are kept."""
import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile
import time
import types
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts" / "lib"))
from mutation import judge as judges, rules, survivors, tests, tree as trees  # noqa: E402


def program():
    loader = importlib.machinery.SourceFileLoader("mutation", str(ROOT / "scripts" / "mutation"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutation", loader))
    loader.exec_module(module)
    return module


def edits(line, before="", after=""):
    """rule -> the lines that it makes of this one."""
    found = {}
    for mutant in rules.mutants_of(before + line + after, "room/file.hpp", "room"):
        made = mutant.applied(before + line + after)
        assert made.startswith(before) and made.endswith(after), made
        found.setdefault(mutant.rule, set()).add(" ".join(made[len(before):len(made) - len(after) or None].split()))
    return found


class Rules(unittest.TestCase):
    def test_comparison(self):
        for mark, others in {"<": ("<=", ">="), ">=": (">", "<"), "==": ("!=",)}.items():
            self.assertEqual(edits(f"x = a {mark} b;"), {"comparison": {f"x = a {other} b;" for other in others}})

    def test_sign_and_dropped_term(self):
        self.assertEqual(edits("x = a - b * f(c, d);"), {
            "sign": {"x = a + b * f(c, d);"},
            "dropped term": {"x = a;", "x = -b * f(c, d);", "x = a - b;", "x = a - f(c, d);"}})
        self.assertEqual(edits("return {-x, y};"), {"sign": {"return {x, y};"}})
        self.assertEqual(edits("if (a(x, y) && !b) {", after="}"), {"dropped term": {"if (a(x, y)) {", "if (!b) {"}})
        # the middle of a chain has no left operand of its own
        self.assertEqual(edits("x = a + b + c;")["dropped term"], {"x = b + c;", "x = a + c;", "x = a + b;"})
        self.assertEqual(edits("sum[i] += x;", "{ ", " }"),
                         {"sign": {"sum[i] -= x;"}, "dropped term": {"{}"}})

    def test_off_by_one(self):
        self.assertEqual(edits("x = v[2];"), {"off by one": {"x = v[1];", "x = v[3];"}})
        self.assertEqual(edits("f(0u);"), {"off by one": {"f(1u);"}})
        self.assertEqual(edits("for (int i = k; i < n; ++i) f(i);")["off by one"], {"for (int i = k; i + 1 < n; ++i) f(i);"})

    def test_constant(self):
        self.assertEqual(edits("x = 0.5f;"), {"constant": {"x = 1.0f;", "x = 0.55f;"}})
        self.assertEqual(edits("x = 1e-3;"), {"constant": {"x = 0.002;", "x = 0.0011;"}})
        self.assertEqual(edits("x = 0.0;"), {"constant": {"x = 1.0;"}})
        self.assertEqual(edits("x = 0x7f80u;"), {"constant": {"x = 0x7f81u;"}})
        self.assertEqual(edits("bool x = true;"), {"constant": {"bool x = false;"}})

    def test_removed(self):
        self.assertEqual(edits("if (bad) return Status::bad;")["removed"], {"{}"})
        self.assertEqual(edits("if (bad(x)) {\n  y(); x = z;\n  return false;\n}")["removed"],
                         {"{}", "if (bad(x)) { {} x = z; return false; }"})
        self.assertEqual(edits("case Kind::wide: return wide;", "{ ", " }")["removed"], {"case Kind::wide: {}"})
        self.assertEqual(edits("detail::check<T>(x).all();", "{ ", " }")["removed"], {"{}"})
        # the other branch, a declaration, a constructor
        for line in ("if (a) return b; else c = d;", "Matrix<Scalar> m(x);", "Model(x);", "static_assert(ok(x));"):
            self.assertNotIn("removed", edits(line, "{ ", " }"), line)

    def test_templates_are_no_comparisons(self):
        for line in ("template <class T, int N>", "Matrix<Scalar, 3, 3> m;", "std::vector<std::array<float, 4>> v;",
                     "const Scalar* first = &x;", "auto&& y = f(x);", "p->x = y;", "i++, --j;", "virtual int f() const = 0;",
                     "Scalar n[3] = {};", "bool operator==(const T& a);"):
            self.assertEqual(edits(line), {}, line)
        self.assertEqual(edits("std::enable_if_t<(N > M)> f();"),
                         {"comparison": {"std::enable_if_t<(N >= M)> f();", "std::enable_if_t<(N <= M)> f();"}})

    def test_decoys_are_left_alone(self):
        decoys = ["// a < b, x + 1 == 2\n", "/* if (a) return 1;\n   c - 3 */", '"a < 1 + 2"', 'R"raw(a " < 1 + 2 " b)raw"',
                  "'1'", "#include <a/b - 1.hpp>\n", "#define LIMIT(x) \\\n  (x + 1 < 2)\n", "#if X > 2\n", "/// y = 1 + x\n",
                  "decltype(f(0.5) + 1) z;\n", "void g() noexcept(noexcept(f(0.5)));\n", "[[deprecated(\"1 + 1\")]] ",
                  'static_assert(ok, "n > 1: 2 < 3");\n']
        text, spans = "", []
        for decoy in decoys:
            text += "x = y + 1;\n"
            spans.append((len(text), len(text) + len(decoy)))
            text += decoy + "\n"
        found = rules.mutants_of(text, "room/file.hpp", "room")
        self.assertEqual(len(found), len(decoys) * len(rules.mutants_of("x = y + 1;\n", "room/file.hpp", "room")))
        for mutant in found:
            for begin, end in spans:
                self.assertTrue(mutant.end <= begin or mutant.start >= end, text[begin:end])


class Draw(unittest.TestCase):
    TEXT = (ROOT / "include/pinnquad/core/rotation.hpp").read_text()

    def order(self, text, seed):
        return [mutant.key for mutant in rules.draw_order(rules.mutants_of(text, "core/rotation.hpp", "core"), seed)]

    def test_seed(self):
        self.assertEqual(self.order(self.TEXT, 1), self.order(self.TEXT, 1))
        self.assertNotEqual(self.order(self.TEXT, 1)[:20], self.order(self.TEXT, 2)[:20])

    def test_no_key_twice_and_no_empty_edit(self):
        found = rules.mutants_of(self.TEXT, "core/rotation.hpp", "core")
        self.assertEqual(len({mutant.key for mutant in found}), len(found))
        for mutant in found:
            self.assertEqual(self.TEXT[mutant.start:mutant.end], mutant.old)
            self.assertNotEqual(mutant.applied(self.TEXT), self.TEXT)
            self.assertEqual(self.TEXT.splitlines()[mutant.line - 1].strip()[:len(mutant.code)], mutant.code)

    def test_edits_elsewhere_move_nothing(self):
        longer = self.TEXT.replace("namespace pinnquad {\n", "namespace pinnquad {\n\n// more\n\n", 1)
        self.assertEqual(self.order(longer, 1), self.order(self.TEXT, 1))

    def test_rules_take_turns(self):
        first = rules.draw_order(rules.mutants_of(self.TEXT, "core/rotation.hpp", "core"), 1)[:6]
        self.assertEqual({mutant.rule for mutant in first}, set(rules.RULES))

    def test_shares(self):
        candidates = {"small": 3, "middle": 100, "large": 900}
        share = rules.shares(candidates, 150)
        self.assertEqual(sum(share.values()), 150)
        self.assertEqual(share["small"], 3)
        self.assertGreater(share["large"], 8 * share["middle"] - 40)
        self.assertGreaterEqual(share["middle"], 5)
        self.assertEqual(sum(rules.shares(candidates, 7).values()), 7)
        self.assertEqual(rules.shares(candidates, 5000), candidates)


class Verdicts(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.work = pathlib.Path(self.folder.name)
        self.text = "int f(int a) { return a + 1; }\n"
        self.mutant = rules.mutants_of(self.text, "core/f.hpp", "core")[0]

    def step(self, name, tests_digest="1"):
        step = tests.Step(name, "source", {"include/pinnquad/core/f.hpp"}, f"{name}.o", "core")
        step.tests_digest = tests_digest
        return step

    def test_stand_as_long_as_what_they_rest_on(self):
        results = program().Results(self.work / "results.json", False)
        near, far = self.step("near"), self.step("far")
        results.add(self.mutant, self.text, "killed", "near", [near], 1.0)
        again = program().Results(self.work / "results.json", False)
        self.assertEqual(again.find(self.mutant, self.text, [near, far])["by"], "near")
        self.assertTrue(again.find(self.mutant, self.text, [near, self.step("far", "2")]))
        self.assertFalse(again.find(self.mutant, self.text, [self.step("near", "2"), far]))
        self.assertFalse(again.find(self.mutant, self.text, [far]))
        self.assertFalse(again.find(self.mutant, self.text + "\n", [near, far]))
        results.add(self.mutant, self.text, "survived", "", [near, far], 1.0)
        self.assertTrue(results.find(self.mutant, self.text, [far, near]))
        self.assertFalse(results.find(self.mutant, self.text, [near, self.step("far", "2")]))
        self.assertFalse(results.find(self.mutant, self.text, [near, far, self.step("new")]))
        self.assertFalse(program().Results(self.work / "results.json", True).known)

    def tree(self):
        tree = trees.Tree(self.work, self.work, "dev", 1, None)
        header = tree.folder / "include/pinnquad/core/f.hpp"
        header.parent.mkdir(parents=True)
        header.write_text(self.text)
        (tree.build / "tests").mkdir(parents=True)
        (tree.build / "tests/f.o").write_text("object")
        tree.keep()
        return tree, header

    def test_copy_is_as_it_was(self):
        tree, header = self.tree()
        states = [os.stat(path) for path in (header, tree.build / "tests/f.o")]
        for error in (None, KeyboardInterrupt):
            try:
                with tree.mutated(self.mutant):
                    self.assertEqual(header.read_text(), self.mutant.applied(self.text))
                    (tree.build / "tests/f.o").write_text("mutated")
                    (tree.build / "tests/new.o").write_text("mutated")
                    if error:
                        raise error
            except KeyboardInterrupt:
                pass
            self.assertEqual(header.read_text(), self.text)
            self.assertEqual((tree.build / "tests/f.o").read_text(), "object")
            self.assertFalse((tree.build / "tests/new.o").exists())
            for state, path in zip(states, (header, tree.build / "tests/f.o")):
                self.assertEqual(os.stat(path).st_mtime_ns, state.st_mtime_ns)

    def test_nearest_test_first(self):
        judge = judges.Judge(trees.Tree(self.work, self.work, "dev", 1, None), "", None)
        steps = []
        for name, room, build_s in (("g_test.cpp", "core", 1), ("f_test.cpp", "core", 9), ("a_test.cpp", "aero", 0.1),
                                    ("h_test.cpp", "core", 0.5)):
            steps.append(tests.Step(name, "source", {"include/pinnquad/core/f.hpp"}, f"tests/{name}.o", room, build_s))
        judge.steps = steps + [tests.Step("blind", "source", set(), "tests/blind.o", "core")]
        self.assertEqual([step.name for step in judge.seen_by("core/f.hpp")],
                         ["f_test.cpp", "h_test.cpp", "g_test.cpp", "a_test.cpp"])

    def test_a_folder_sees_what_its_scripts_compile(self):
        (self.work / "tests/boards").mkdir(parents=True)
        (self.work / "tests/boards/run.sh").write_text('g++ "$root"/tests/nn/*.cpp "$root/tests/main.cpp"\n')
        stub = types.SimpleNamespace(folder=self.work, digests=dict.fromkeys(
            ("tests/boards/run.sh", "tests/nn/a.cpp", "tests/nn/a.hpp", "tests/main.cpp", "tests/core/b.cpp"), ""))
        self.assertEqual(tests.Tests(stub, "").compiled_by({"tests/boards/run.sh"}), {"tests/nn/a.cpp"})

    def test_a_folder_waits_for_a_mutant_that_asks_for_it(self):
        folder = tests.Step("boards", "folder", {"include/pinnquad/core/f.hpp"})
        folder.digest = "1"
        judge = judges.Judge(types.SimpleNamespace(work=self.work), "", lambda text: None)
        asked = []
        judge.try_unmutated = lambda step, _: asked.append(step.name) or {"says": "is skipped", "run_s": 0.0}
        judge.see_pass([folder])
        self.assertEqual(([step.name for step in judge.steps], asked), (["boards"], []))
        judge.see_folders(self.mutant)
        self.assertEqual((judge.steps, asked), ([], ["boards"]))
        judge.see_pass([folder])  # known by now
        self.assertEqual((judge.steps, asked), ([], ["boards"]))

    def test_cases_of_a_compiler_are_asked_alone(self):
        judge = judges.Judge.__new__(judges.Judge)
        judge.tree = types.SimpleNamespace(jobs=2)
        steps = [types.SimpleNamespace(kind=kind)
                 for kind in ("source", "source", "source", "compile_fail", "compile_fail", "program", "folder")]
        self.assertEqual([[step.kind for step in batch] for batch in judge.batches(steps)],
                         [["source", "source"], ["source"], ["compile_fail"], ["compile_fail"], ["program", "folder"]])

    def test_time_limit_ends_what_was_started(self):
        with self.assertRaises(trees.TimedOut):
            trees.run(["bash", "-c", "set -m; sleep 60 & echo $! >child; wait"], self.work, 0.5)
        child = int((self.work / "child").read_text())
        for _ in range(100):
            try:
                # reaped, or waiting for whoever inherited it
                if pathlib.Path(f"/proc/{child}/stat").read_text().rsplit(") ", 1)[1].startswith("Z"):
                    return
            except FileNotFoundError:
                return
            time.sleep(0.05)
        self.fail("what a test started outlives its time limit")


class List(unittest.TestCase):
    def test_claims_are_kept_and_need_a_reason(self):
        text = "int f(int a) { return a + 1; }\n"
        found = rules.mutants_of(text, "core/f.hpp", "core")
        by_key = {mutant.key: mutant for mutant in found}
        verdict = lambda word: {"verdict": word, "by": ""}
        entries = {mutant.key: verdict("survived" if place < 2 else "killed") for place, mutant in enumerate(found)}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "survivors.md"
            write = lambda: survivors.write_list(path, found, entries, survivors.Claims.read(path), by_key, 1)
            with open(os.devnull, "w") as nowhere:
                stdout, sys.stdout = sys.stdout, nowhere
                try:
                    score, _ = write()
                    self.assertAlmostEqual(score, 100 * (len(found) - 2) / len(found))
                    claimed = path.read_text()
                    first = survivors.entry(found[0])
                    self.assertIn(first, claimed)
                    claimed = claimed.replace(first + "\n", "") + first + "\n"
                    path.write_text(claimed)
                    with self.assertRaises(survivors.BadList):
                        write()
                    path.write_text(claimed + "  Reason: a is never\n  negative\n")
                    for _ in range(2):
                        score, wrong = write()
                        self.assertAlmostEqual(score, 100 * (len(found) - 2) / (len(found) - 1))
                        self.assertEqual(wrong, [])
                        self.assertIn(first + "\n  Reason: a is never\n  negative\n", path.read_text())
                    entries[found[0].key] = verdict("killed")
                    self.assertEqual(write()[1], [found[0].key])
                finally:
                    sys.stdout = stdout


if __name__ == "__main__":
    unittest.main()
