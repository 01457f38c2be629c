# SPDX-License-Identifier: MIT
# The deepest stack below a function, from what gcc writes with -fcallgraph-info=su: each function's own frame and whom it calls.
#   stack_depth.py FILE.ci FUNCTION MOST_BYTES
# Exit code 1 if it is deeper, calls itself, or has a frame of a size that is not known. A function from elsewhere (libm) counts as
# LIBRARY_BYTES, more than any of newlib's float functions that flight code calls takes.
import re
import sys

LIBRARY_BYTES = 64


def read(path):
    frame, calls = {}, {}
    for line in open(path):
        node = re.match(r'node: \{ title: "([^"]*)" label: "([^"]*)"', line)
        edge = re.match(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', line)
        if node:
            size = re.search(r"(\d+) bytes \((static|dynamic,bounded)\)", node.group(2))
            unbounded = "bytes (dynamic)" in node.group(2)
            frame[node.group(1)] = None if unbounded else (int(size.group(1)) if size else LIBRARY_BYTES)
        elif edge:
            calls.setdefault(edge.group(1), set()).add(edge.group(2))
    return frame, calls


def deepest(name, frame, calls, known, above):
    if name in above:
        sys.exit(f"{name} calls itself")
    if name not in known:
        own = frame.get(name, LIBRARY_BYTES)
        if own is None:
            sys.exit(f"the frame of {name} has no bound")
        below = [deepest(callee, frame, calls, known, above | {name}) for callee in sorted(calls.get(name, ()))]
        bytes_below, path = max(below, key=lambda pair: pair[0], default=(0, []))
        known[name] = own + bytes_below, [(name, own)] + path
    return known[name]


file, function, most = sys.argv[1], sys.argv[2], int(sys.argv[3])
frame, calls = read(file)
if function not in frame:
    sys.exit(f"{file}: no function {function}")
total, path = deepest(function, frame, calls, {}, frozenset())
for name, own in path:
    print(f"{own:6d}  {name}")
print(f"{total:6d}  of {most} bytes")
sys.exit(0 if total <= most else 1)
