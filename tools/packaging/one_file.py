#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The flight headers as one file.

    tools/packaging/one_file.py OUT/pinnquad_flight.hpp [--header pinnquad/flight.hpp]

Each header of pinnquad stands in it once, in the order in which the compiler would see it; includes of others come first.
Eigen is still to be had. A model's header that is included after it needs no other.
Exit code: 0; 2 bad input.
"""
import argparse
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2] / "include"
INCLUDE = re.compile(r'\s*#\s*include\s+(["<])([^">]+)[">]')
LICENCE = "// SPDX-License-Identifier: MIT\n"


def gather(name, seen, others, body):
    if name in seen:
        return
    seen.add(name)
    body.append(f"\n// {name}\n")
    nested = 0  # an include under a condition stays where it is
    for line in (ROOT / name).read_text().splitlines(keepends=True):
        directive = line.lstrip()
        found = INCLUDE.match(line)
        if directive.startswith("#if"):
            nested += 1
        elif directive.startswith("#endif"):
            nested -= 1
        if found and (ROOT / found[2]).is_file():
            gather(found[2], seen, others, body)
        elif found and nested == 0:
            others.setdefault(line.strip(), None)
        elif directive.rstrip() != "#pragma once" and line != LICENCE:
            body.append(line)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--header", default="pinnquad/flight.hpp", help="what to begin with (default: %(default)s)")
    options = parser.parse_args()
    if not (ROOT / options.header).is_file():
        parser.error(f"expected a header below {ROOT}, found {options.header}")
    others, body = {}, []
    gather(options.header, set(), others, body)
    text = (LICENCE + f"// {options.header} of pinnquad and all that it includes, made by tools/packaging/one_file.py.\n"
            "#pragma once\n#define PINNQUAD_ONE_FILE\n\n" + "\n".join(sorted(others)) + "\n" + "".join(body))
    try:
        aside = options.out.with_name(options.out.name + ".part")
        aside.write_text(text)
        os.replace(aside, options.out)
    except OSError as error:
        print(f"one_file.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
