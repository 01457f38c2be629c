# SPDX-License-Identifier: MIT
"""What must not compile, and what the compiler then says: the cases of one source, in two runs of the compiler.

A source is what its cases have in common, then a line for each case with its own text behind it (CMakeLists.txt). The
first run compiles what is common, and the text behind SOUND: the control. The second compiles all cases at once: for
each what is common and its own text, its macro defined, in a namespace and under a file name of its own, so that each
error says by its place whose it is. A case passes when one of its errors matches its expression. A case without such
an error is compiled alone: its text may not fit into a namespace, or the compiler says once what is wrong with a type
that two cases share.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys

CASE = re.compile(r"^// (?:CASE (\w+): (.+)|SOUND)$")
PLACE = re.compile(r"\bcase_(\w+):\d+")


def error_blocks(output, clang):
    """Each error's line with the lines that say where it is from: g++ says it before the error, clang++ in notes behind."""
    blocks, context = [], []
    for line in output.splitlines():
        if re.search(r"\b(fatal )?error: ", line):
            blocks.append((line, [line] if clang else context + [line]))
            context = []
        elif clang and blocks:
            blocks[-1][1].append(line)
        elif line.startswith(" ") or re.search(r": (note|warning): ", line):  # of a message that is over
            context = []
        else:
            context.append(line)
    return blocks


class Source:
    def __init__(self, arguments):
        self.path = pathlib.Path(arguments.source)
        self.clang = arguments.compiler_id.endswith("Clang")
        self.lines = self.path.read_text(encoding="utf-8").splitlines()
        self.cases, self.owners, owner = [], [], ""  # of each line: "" what is common, None the control, or a case
        for line in self.lines:
            match = CASE.match(line)
            if match:
                owner = match.group(1)
                self.cases += [match.groups()] if owner else []
            self.owners.append(owner)
        self.command = [arguments.compiler, "-std=c++17", "-fmessage-length=0", "-fno-diagnostics-color", "-fsyntax-only",
                        "-ferror-limit=0" if self.clang else "-fmax-errors=0", f"-I{self.path.parent}", *arguments.flags]

    def text(self, case):
        """What is common, and the case's own; lines keep their numbers."""
        return "\n".join(line if owner in ("", case) else "" for line, owner in zip(self.lines, self.owners)) + "\n"

    def compile(self, text, *more):
        done = subprocess.run([*self.command, *more, "-x", "c++", "-"], input=text, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**os.environ, "LC_ALL": "C"}, check=False)
        return done.returncode, done.stdout

    def all_cases(self):
        """Includes first, for all."""
        include = re.compile(r"^#include .*$", re.M)
        parts = include.findall(self.text(""))
        for macro, _ in self.cases:
            parts += [f"#define {macro}", f"namespace case_{macro} {{", f'#line 1 "case_{macro}"',
                      include.sub("", self.text(macro)), "}", f"#undef {macro}"]
        return "\n".join(parts) + "\n"

    def errors_of_cases(self):
        """The errors of the second run by case."""
        _, output = self.compile(self.all_cases())
        errors = {}
        for error, block in error_blocks(output, self.clang):
            for macro in {place.group(1) for line in block for place in PLACE.finditer(line)}:
                errors.setdefault(macro, []).append(error)
        return errors

    def fault_alone(self, macro, expression):
        code, output = self.compile(self.text(macro), f"-D{macro}")
        if code == 0:
            return "compiles, but must not"
        if not any(re.search(expression, error) for error, _ in error_blocks(output, self.clang)):
            return f"fails to compile, as it must, but no error message matches: {expression}\n{output}"
        return None

    def faults(self):
        code, output = self.compile(self.text(None))
        if code != 0:
            yield f"{self.path}: must compile, but does not\n{output}"
            return
        errors = self.errors_of_cases()
        for macro, expression in self.cases:
            if not any(re.search(expression, error) for error in errors.get(macro, ())):
                fault = self.fault_alone(macro, expression)
                if fault:
                    yield f"{self.path} [{macro}] {fault}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--compiler-id", required=True)
    parser.add_argument("source")
    parser.add_argument("flags", nargs=argparse.REMAINDER, help="of the compiler, behind --")
    arguments = parser.parse_args()
    arguments.flags = [flag for flag in arguments.flags if flag != "--"]
    source = Source(arguments)
    if not source.cases:
        sys.exit(f"{source.path}: no line '// CASE macro: expression'")
    faults = list(source.faults())
    print("\n".join(faults) or f"{source.path}: {len(source.cases)} cases")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
