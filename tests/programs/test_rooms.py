# SPDX-License-Identifier: MIT
"""The rooms of the program: a file includes headers of its own room and of those that tools/CMakeLists.txt names before
it, all by their path from tools/; the program itself may include every room. Program and examples do not include each
other."""
import re

from conftest import SOURCE


def includes(folder, endings, pattern):
    for path in sorted(path for path in folder.rglob("*") if path.suffix in endings):
        for line, text in enumerate(path.read_text().splitlines(), start=1):
            found = re.match(pattern, text)
            if found:
                yield path.relative_to(folder), line, found.group(1)


def faults(tools, examples):
    rooms = re.findall("^#   ([a-z_]*)  ", (tools / "CMakeLists.txt").read_text(), re.M)
    assert len(rooms) > 1, "CMakeLists.txt names no rooms"
    for folder in tools.iterdir():
        if folder.is_dir() and folder.name not in rooms:
            yield f"{folder.name}: CMakeLists.txt does not name this room"
    place = {name: at for at, name in enumerate(rooms)}
    for file, line, header in includes(tools, (".hpp", ".cpp"), '#include "(.*)"'):
        room, other = file.parts[0], header.split("/")[0]
        if header.startswith("pinnquad/"):
            continue
        if "examples/" in header:
            yield f"{file}:{line}: the program includes an example: {header}"
        elif not (tools / header).is_file():
            yield f"{file}:{line}: no such header from here: {header}"
        elif len(file.parts) > 1 and place.get(other, 99) > place.get(room, 0):
            yield f"{file}:{line}: {room} comes before {other}"
    for file, line, header in includes(examples, (".hpp", ".cpp", ".h", ".c"), ' *# *include *[<"](.*?)[>"]'):
        if (tools / header).is_file() or "tools/" in header:
            yield f"{file}:{line}: an example includes the program: {header}"


def test_one_direction():
    assert list(faults(SOURCE / "tools", SOURCE / "examples")) == []
