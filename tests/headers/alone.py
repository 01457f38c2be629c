# SPDX-License-Identifier: MIT
"""alone.py <include> <working folder> <flight rooms, with | between> <clang++> <flag>...: each header of the library
compiles on its own, included twice so that its guard is tried; one that flies without exceptions and RTTI.

What a header includes anyway is precompiled for it: Eigen, and the header that instantiates Eigen's solvers. A header
that doesn't include those is compiled without, and would not find what it forgot to include."""
import re
import subprocess
import sys
from pathlib import Path

PRECOMPILED = "pinnquad/regression/ridge.hpp", "Eigen/Core"  # the first that a header includes


def main(include, work, flight_rooms, *compiler):
    work.mkdir(parents=True, exist_ok=True)
    includes = {str(path.relative_to(include)): set(re.findall(r'^#include [<"]((?:pinnquad|Eigen)/[^>"]+)',
                                                               path.read_text(), re.M))
                for path in sorted(include.glob("pinnquad/**/*.hpp"))
                if path.parent.name != "impl"}  # their headers include them
    assert all(any(base in found for found in includes.values()) for base in PRECOMPILED), "nobody includes them"
    for found in includes.values():  # and what those include
        added = found
        while added:
            added = set().union(*(includes.get(header, ()) for header in added)) - found
            found |= added

    groups = {}
    for header, found in includes.items():
        unit = work / (re.sub("[/.]", "_", header) + ".cpp")
        unit.write_text(f"#include <{header}>\n#include <{header}>  // again: #pragma once\n")
        flies = bool(re.match(rf"pinnquad/(({flight_rooms})/|flight\.hpp|version\.hpp)", header))
        base = next((base for base in PRECOMPILED if base in found), None)
        groups.setdefault((flies, base), []).append(unit)

    failed = 0
    for (flies, base), units in groups.items():
        command = [*compiler, "-std=c++17", f"-I{include}", *(["-fno-exceptions", "-fno-rtti"] if flies else [])]
        precompiled = []
        if base:
            (work / "precompiled.hpp").write_text(f"#include <{base}>\n")
            subprocess.run([*command, "-fpch-instantiate-templates", "-x", "c++-header", work / "precompiled.hpp", "-o",
                            work / "precompiled.pch"], check=True)
            precompiled = ["-include-pch", work / "precompiled.pch"]
        failed |= subprocess.run([*command, *precompiled, "-fsyntax-only", *units]).returncode
    print(f"{len(includes)} headers, {len(groups)} groups")
    return failed != 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]), *sys.argv[3:]))
