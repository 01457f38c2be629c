# SPDX-License-Identifier: MIT
"""scripts/demo as a user runs it, with two programs that stand already in place of their compilation."""
import re
import subprocess
from pathlib import Path

from conftest import SOURCE, Program


def test_demo(program, compiler, work_on=("demo", "quickstart")):
    root = Path("repository").resolve()
    root.mkdir()
    for name in "include", "examples", "scripts":
        (root / name).symlink_to(SOURCE / name)
    standing = "\n".join(f'    */examples/{name}.cpp) cp "{program(name)}" "$out"; exit ;;' for name in work_on)
    stub = Path("compiler").resolve()
    stub.write_text(f"""#!/bin/bash
while [ "$1" != -o ]; do all+=("$1"); shift; done
out=$2
for word in "${{all[@]}}"; do
  case $word in
{standing}
  esac
done
exec "{compiler}" "${{all[@]}}" -O0 -o "$out" "${{@:3}}"
""")
    stub.chmod(0o755)
    demo = ["bash", root / "scripts/demo", "--seeds", "1", "--epochs", "12", "--out", "o"]
    environment = {"PATH": "/usr/bin:/bin", "CXX": str(stub)}
    done = subprocess.run(demo, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done
    said = done.stdout
    assert "motor commands, ok: 0.50" in said
    assert re.search(r"linearized formula +147\.18\n.*network +\d+\.\d+\n.*loss +\d+\.\d+\n +structured +[67]\.\d\d ", said), said
    assert "proven for every input" in said
    calm, loaded = re.search(r"^  export +([0-9.]+) +([0-9.]+)$", said, re.M).groups()
    unlearnt = re.search(r"^  export, learning nothing in flight +([0-9.]+) +([0-9.]+)$", said, re.M).groups()
    assert float(calm) < 2 and float(loaded) < 5 < 20 < float(unlearnt[1]), said
    for file in "flight.csv", "model.hpp", "model.block", "trust.hpp", "flown.svg":
        assert Path("o", file).stat().st_size > 1000, file

    # another shape of model than the header's is refused, and nothing is drawn
    fly = Program(root / "build/demo/fly_model")
    fly.refused(f"{SOURCE}/examples/models/demo_quadrotor.block none.svg", code=1, keyword="the model is refused")
    fly.refused("o/model.hpp none.svg", code=1, keyword="the model is refused")
    fly.refused("absent.block none.svg", code=1, keyword="no such readable file")
    assert not Path("none.svg").exists()
    program("demo").refused("o 0", code=1, keyword="expected FOLDER")
