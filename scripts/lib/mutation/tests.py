# SPDX-License-Identifier: MIT
"""Which tests see a file, read from the compilers' dependency files (ninja -t deps). A test is a step as small as it gets: one
source of a doctest program linked alone, a whole program where a source needs the others, the cases of one source of
tests/compile_fail, and, for what no program of this build includes, a folder whose tests compile for other machines."""
import fnmatch
import functools
import json
import os
import re
import shlex

from mutation.tree import HEADERS, digest, run

TEST_MAIN = "tests/CMakeFiles/test_main.dir/main.cpp.o"
OTHER_MACHINES = ("instruction_sets",)  # folders of tests/ that compile by themselves


class Step:
    """One test that can be asked alone. kind: source, program, compile_fail, folder. sees: files of the tree that it is made
    from; target: what ninja builds for it; parts: a program's objects where each may run alone."""

    def __init__(self, name, kind, sees, target=None, room=None, build_s=0.0, parts=()):
        self.name, self.kind, self.sees, self.target, self.room, self.parts = name, kind, set(sees), target, room, parts
        self.tests_digest = self.digest = None
        self.build_s, self.run_s = build_s, 1.0


class Tests:
    def __init__(self, tree, only):
        self.tree, self.only = tree, re.compile(only)

    @functools.cached_property
    def commands(self):
        """Name of a test -> its command, as CMake wrote it down (ctest lists none of a program that is not built)."""
        found, folders = {}, [self.tree.build]
        for folder in folders:
            if not (folder / "CTestTestfile.cmake").exists():
                continue
            text = (folder / "CTestTestfile.cmake").read_text()
            folders += [folder / name for name in re.findall(r'^subdirs\("(.*)"\)$', text, re.MULTILINE)]
            for name, words in re.findall(r"^add_test\(\[=*\[(.*?)\]=*\] (.*)\)$", text, re.MULTILINE):
                quoted = re.findall(r'"((?:[^"\\]|\\.)*)"', words)
                if self.only.search(name):
                    found[name] = [re.sub(r"\\(.)", r"\1", word) for word in quoted]
        return found

    def programs(self):
        """Target -> names of the tests that call it: tests whose command is a program of this build."""
        targets = {line.rpartition(": ")[0] for line in self.tree.ask("-t", "targets", "all")}
        found = {}
        for name, command in self.commands.items():
            program = os.path.relpath(command[0], self.tree.build) if command else ""
            if program in targets:
                found.setdefault(program, []).append(name)
        return found

    def steps(self, programs):
        """Of what is built: sources before the program that they make."""
        found = list(self.program_steps(programs))
        found += [*self.compile_fail_steps(), *self.folder_steps(found)]
        found = [step for step in found if any(path.startswith(HEADERS) for path in step.sees)]
        for step in found:
            self.put_digests(step)
        return found

    def in_tree(self, path):
        """The path relative to the tree, None for what lies elsewhere."""
        path = os.path.normpath(os.path.join(self.tree.build, path))
        folder = f"{self.tree.folder}{os.sep}"
        return path[len(folder):] if path.startswith(folder) else None

    def dependencies(self):
        """Object -> files of the tree that its compiler read."""
        found = {}
        for line in self.tree.ask("-t", "deps"):
            if not line.startswith(" "):
                current = found.setdefault(line.split(": #deps")[0], set())
            elif self.in_tree(line.strip()):
                current.add(self.in_tree(line.strip()))
        return found

    def compile_seconds(self):
        found = {}
        for line in (self.tree.build / ".ninja_log").read_text().splitlines()[1:]:
            begin, end, _, output, _ = line.split("\t")
            found[output] = (int(end) - int(begin)) / 1000
        return found

    @staticmethod
    def folder_of(program):
        """Where the objects of the program's own sources lie."""
        return os.path.join(os.path.dirname(program), "CMakeFiles", f"{os.path.basename(program)}.dir", "")

    def program_steps(self, programs):
        dependencies, seconds = self.dependencies(), self.compile_seconds()
        for program, names in programs.items():
            inputs = self.tree.ask("-t", "inputs", program)
            objects = [path for path in inputs if path in dependencies and path.endswith(".o")]
            own = self.folder_of(program)
            parts = [path for path in objects if path.startswith(own)] if TEST_MAIN in inputs else []
            for part in parts:
                yield Step(f"{names[0]}: {part[len(own):-len('.o')]}", "source", dependencies[part], part, names[0],
                           seconds.get(part, 1.0))
            for name in names:
                yield Step(name, "program", set().union(*(dependencies[path] for path in objects)), program, name,
                           sum(seconds.get(path, 0.0) for path in objects), parts)

    def reached(self, names):
        """The files and all of the tree that they include, whatever stands in an #if."""
        found, todo = set(names), list(names)
        for name in todo:
            text = (self.tree.folder / name).read_text(errors="replace")
            for include in re.findall(r'^[ \t]*#[ \t]*include [<"](.*?)[>"]', text, re.MULTILINE):
                for place in (os.path.dirname(name), "include", ""):
                    path = os.path.normpath(os.path.join(place, include))
                    if path in self.tree.digests:
                        if path not in found:
                            found.add(path)
                            todo.append(path)
                        break
        return found

    def compile_fail_steps(self):
        """The cases of one source together: what a compiler refuses is tested nowhere else."""
        groups = {}
        for name, command in self.commands.items():
            sources = [word[len("-DSOURCE="):] for word in command if word.startswith("-DSOURCE=")]
            if name.startswith("compile_fail.") and sources:
                groups.setdefault(".".join(name.split(".")[:2]), set()).add(self.in_tree(sources[0]))
        for group, sources in sorted(groups.items()):
            yield Step(group, "compile_fail", self.reached(sources))

    def compiled_by(self, names):
        """Tests of other folders that scripts among the files compile: "$root"/tests/nn/*.cpp."""
        texts = [(self.tree.folder / name).read_text() for name in names if name.endswith(".sh")]
        patterns = [pattern for text in texts for pattern in re.findall(r'"\$root"/(tests/[\w./*]+\.cpp)', text)]
        return {name for pattern in patterns for name in fnmatch.filter(self.tree.digests, pattern)}

    def folder_steps(self, programs):
        """For headers that no program sees: the tests of a folder whose sources reach them."""
        blind = {name for name in self.tree.digests if name.startswith(HEADERS) and name.endswith(".hpp")}
        blind -= set().union(*(step.sees for step in programs))
        for folder in OTHER_MACHINES:
            own = {name for name in self.tree.digests if os.path.dirname(name) == f"tests/{folder}"}
            own |= self.compiled_by(own)
            unseen = self.reached(own) & blind
            if unseen and any(name.startswith(f"{folder}.") for name in self.commands):
                yield Step(folder, "folder", own | unseen)

    def put_digests(self, step):
        """Of the tests: their sources, and the data beside them. Of all: every file that they are made from."""
        folders = {os.path.dirname(path) for path in step.sees if path.startswith("tests/") and path.endswith(".cpp")}
        data = {name for name in self.tree.digests
                if os.path.dirname(name) in folders and not name.endswith((".cpp", ".hpp"))}
        tests = data | {path for path in step.sees if not path.startswith("include/")}

        def tell(names):
            return digest(step.name, *(f"{name} {self.tree.digests.get(name)}" for name in sorted(names)))

        step.tests_digest, step.digest = tell(tests), tell(data | step.sees)

    def active_lines(self, path, seeing):
        """The lines of a header with conditional parts that the preprocessor keeps in some of the steps that see it; None where
        all are, or may be."""
        header = f"{HEADERS}/{path}"
        text = (self.tree.folder / header).read_text()
        if not re.search(r"^[ \t]*#[ \t]*(if|el)", text, re.MULTILINE) or any(step.kind == "folder" for step in seeing):
            return None
        kept, seen_flags = set(), set()
        for step in seeing:
            if step.target is None:
                continue
            own = self.folder_of(step.target)
            for output in [step.target] if step.kind == "source" else \
                    [name for name in self.compile_commands if name.startswith(own)]:
                words = shlex.split(self.compile_commands[output])
                flags = frozenset(word for word in words if word.startswith(("-D", "-m", "-f", "-O")))
                if flags not in seen_flags:
                    found = self.preprocessed(words, header)
                    kept |= found
                    if found:
                        seen_flags.add(flags)
        return kept

    @functools.cached_property
    def compile_commands(self):
        """Object -> command that compiles it."""
        listed = json.loads("\n".join(self.tree.ask("-t", "compdb")))
        return {entry["output"]: entry["command"] for entry in listed if entry["output"].endswith(".o")}

    def preprocessed(self, words, header):
        """The lines of the header that are more than blank behind the preprocessor."""
        command = [*words[:words.index("-MD")], "-E", words[words.index("-c") + 1]]
        code, said = run(command, self.tree.build, 300)
        kept, here, line = set(), False, 0
        for text in said.splitlines() if code == 0 else ():
            marker = re.match(r'# (\d+) "(.*?)"', text)
            if marker:
                here, line = self.in_tree(marker[2]) == header, int(marker[1])
                continue
            if here and text.strip():
                kept.add(line)
            line += 1
        return kept
