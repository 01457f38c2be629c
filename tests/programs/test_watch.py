# SPDX-License-Identifier: MIT
"""WatchPage without a browser: what it refuses, that text cannot leave its element, and that the page holds the
flight."""
import base64
import json
import re
import struct
from pathlib import Path

import pytest
from conftest import no_partial_files


@pytest.fixture
def driver(program):
    return program("watch_driver")


@pytest.fixture
def bundle(work):
    Path("watch.json").write_text('{"style":"b{}","body":"<p>{{title}}</p>","script":"let whole = 1"}')


def test_without_the_bundle(driver):
    """Refused before anything flies or is written."""
    driver.refused("out.html rows.csv", at="out.html", keyword="apt-get install nodejs npm")
    assert not Path("rows.csv").exists()
    Path("watch.json").write_text('{"style":"no body","script":""}')
    driver.refused("out.html rows.csv 10", at="out.html", keyword="apt-get install nodejs npm")


def test_refused(driver, bundle):
    driver.refused("absent/out.html rows.csv 10", at="absent/out.html", keyword="cannot write")
    driver.refused("out.html rows.csv 0", keyword="no rows")


def test_page(driver, bundle):
    driver("out.html rows.csv 200", '</title><script>"a" & b</script>\n\x01end')
    page = Path("out.html").read_text()
    assert "<title>&lt;/title&gt;&lt;script&gt;&quot;a&quot; &amp; b&lt;/script&gt;  end</title>" in page
    for part in "b{}", "<p>{{title}}</p>", "<script>let whole = 1</script>", "</html>":
        assert part in page, part
    flight = re.search(r'^<script type="application/json" id="flight">(.*)</script>$', page, re.M).group(1)
    assert "<" not in flight
    no_partial_files()
    page = json.loads(flight)
    rows = [list(map(float, line.split(","))) for line in Path("rows.csv").read_text().splitlines()[1:]]
    assert len(rows) == 200
    # front right and rear left turn counter-clockwise
    assert [(r["x_m"] > 0, r["y_m"] > 0, r["spin"]) for r in page["rotors"]] == [(True, True, 1), (False, False, 1),
                                                                                 (True, False, -1), (False, True, -1)]
    velocity = page["velocity_unit_m_s"]
    # name, kind of number, first column of rows.csv, unit, tolerance in SI
    for name, kind, columns, first, unit, tolerance in [
            ("time_s", "f", 1, 0, 1, 1e-6), ("position_m", "f", 3, 1, 1, 1e-5),
            ("velocity", "h", 3, 4, velocity, 0.51 * velocity), ("attitude", "h", 4, 7, 1 / 32767, 1.6e-5),
            ("commands", "H", 4, 11, 1 / 65535, 8e-6)]:
        numbers = list(struct.iter_unpack(f"<{columns}{kind}", base64.b64decode(page[name])))
        assert len(numbers) == 200, name
        for shown, flown in zip(numbers, rows):
            for value, wanted in zip(shown, flown[first : first + columns]):
                assert abs(value * unit - wanted) <= tolerance, (name, shown, flown)
