# SPDX-License-Identifier: MIT
"""The Python that the pages show runs, one block after the other, as a reader would run it."""
import os
import re
import subprocess
import sys

import pytest
from conftest import SOURCE

NEEDED = {"docs/python.md": ("matplotlib", "pandas", "sklearn", "joblib", "scipy", "torch"), "docs/simulator.md": ()}


@pytest.mark.parametrize("page", NEEDED)
def test_the_page_runs_from_top_to_bottom(page, tmp_path):
    for name in NEEDED[page]:
        pytest.importorskip(name)
    blocks = re.findall(r"^```python\n(.*?)^```$", (SOURCE / page).read_text(), re.S | re.M)
    assert blocks
    script = tmp_path / "page.py"
    script.write_text("\n".join(blocks))
    ran = subprocess.run([sys.executable, "page.py"], cwd=tmp_path, capture_output=True, text=True,
                         env={**os.environ, "MPLBACKEND": "Agg"})
    assert ran.returncode == 0, ran.stderr
    if page == "docs/python.md":
        assert {"flight.csv", "flight.png", "my_model", "my_study", "vehicle.toml"} <= {path.name for path in tmp_path.iterdir()}
        assert "proven" in ran.stdout
        study = max(blocks, key=len)
        assert "study.run" in study and len(study.splitlines()) <= 30
