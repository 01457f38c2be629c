# SPDX-License-Identifier: MIT
"""The report of a study: planted effects get their verdicts, the page is whole, bad input leaves nothing behind."""
import base64
import itertools
import json
import math
import re
import shutil
import statistics
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest
from conftest import Program, cell, edited, no_partial_files, replaced, same_bytes, table

OUTPUTS = ["report.html", "report.json", "table3.csv", "comparisons.csv", "claims.csv"]
PLANTED = {"1.1": "reproduced", "1.2": "reproduced", "2.1": "reproduced", "2.2": "in part", "2.3": "reproduced",
           "3.1": "reproduced", "3.2": "in part", "3.3": "reproduced", "4.1": "not reproduced", "4.2": "not reproduced",
           "4.3": "reproduced", "4.4": "reproduced", "5.1": "reproduced", "5.2": "not reproduced", "5.3": "in part",
           "5.4": "not reproduced"}


@pytest.fixture(scope="module")
def driver(program):
    return program("report_driver")


@pytest.fixture(scope="module")
def planted(driver, tmp_path_factory):
    """A study of 8 seeds without its report, and one with it."""
    folder = tmp_path_factory.mktemp("planted")
    driver("make plain 8", cwd=folder)
    shutil.copytree(folder / "plain", folder / "planted")
    driver("report planted", cwd=folder)
    return folder


@pytest.fixture
def study(planted, work):
    """study(change): a study with other rows, in edited/."""

    def write(change=lambda line, cells: None):
        shutil.rmtree("edited", ignore_errors=True)
        shutil.copytree(planted / "plain", "edited")
        edited(planted / "plain/rows.csv", "edited/rows.csv", change)

    return write


def verdicts(folder):
    return {row["id"]: row["verdict"] for row in table(Path(folder, "claims.csv"))}


def shown(folder):
    return Path(folder, "report.html").read_text(encoding="utf-8")


class Page(HTMLParser):
    void = {"meta", "img", "br", "hr", "link", "input"}

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.ids, self.links, self.texts = [], [], [], []
        self.drawings, self.named = 0, {"title": 0, "desc": 0}

    def start(self, tag, attributes, closed):
        assert tag not in ("script", "iframe", "object"), f"the page holds a <{tag}>"
        assert tag != "link" or ("href", "data:,") in attributes, "the page links a file"
        for name, value in attributes:
            assert not name.startswith("on"), f"the page holds {name}="
            if name == "id":
                self.ids.append(value)
            if name in ("href", "src", "xlink:href", "srcset", "poster"):
                self.links.append(value)
        self.drawings += tag == "svg"
        if tag in self.named and self.open[-1] == "svg":
            self.named[tag] += 1
        if tag == "img":
            assert dict(attributes).get("alt"), "a picture has no words for who does not see it"
        if not closed and tag not in self.void:
            self.open.append(tag)

    def handle_starttag(self, tag, attributes):
        self.start(tag, attributes, False)

    def handle_startendtag(self, tag, attributes):
        self.start(tag, attributes, True)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-1:]}, line {self.getpos()[0]}"
        self.open.pop()

    def handle_data(self, data):
        self.texts.append(data)


def exact_p(differences):
    """Two-sided Wilcoxon by trying all signs."""
    decided = sorted((d for d in differences if d != 0), key=abs)
    if not decided:
        return 1.0, 0.0
    ranks = [1 + sum(abs(o) < abs(d) for o in decided) + (sum(abs(o) == abs(d) for o in decided) - 1) / 2
             for d in decided]
    wins = sum(r for r, d in zip(ranks, decided) if d < 0)
    least = min(wins, sum(ranks) - wins)
    reached = sum(sum(r for r, s in zip(ranks, signs) if s) <= least for signs in itertools.product((0, 1),
                                                                                                    repeat=len(ranks)))
    return min(1.0, 2 * reached / 2 ** len(ranks)), (2 * wins - sum(ranks)) / sum(ranks)


def look(folder):
    """Is the page well-formed and alone, and are its figures those of the rows? From outside."""
    text, page = shown(folder), Page()
    page.feed(text)
    page.close()
    assert not page.open, f"never closed: {page.open}"
    assert len(set(page.ids)) == len(page.ids), "an id stands twice"
    for link in page.links:
        inside = link.startswith("#") and link[1:] in page.ids
        assert inside or link == "data:," or link.startswith("data:image/svg+xml;base64,"), f"a link out, or to nowhere: {link[:60]}"
    assert page.drawings >= 4 and page.drawings == page.named["title"] == page.named["desc"], "drawings without a name"
    assert text.startswith("<!DOCTYPE html>") and "{{" not in text, "the page is not what a browser takes for one"
    bare = re.sub(r'"data:[^"]*"', "", text)
    for word in "http:", "https:", "url(", "@import":
        assert word not in bare, f"the page refers to something outside: {word}"
    assert not re.search(r"\bnan\b|\binf\b", bare), "the page shows nan or inf"
    assert not re.search(r"<[^>]*\bNaN\b", bare, re.I), "a drawing has a coordinate that is no number"

    folder = Path(folder)
    rows = [row for row in table(folder / "rows.csv") if row["weights"] == "final"]

    def values(model, flight, flight_seed, measure):
        found = {int(r["seed"]): float(r[measure]) for r in rows
                 if (r["model"], r["flight"], r["flight_seed"]) == (model, flight, flight_seed)}
        return {seed: value for seed, value in found.items() if math.isfinite(value)}

    flights = {(row["flight"], row["flight_seed"]) for row in rows}
    for line in table(folder / "comparisons.csv"):
        if not line["flight_seed"]:
            assert int(line["pairs"]) <= len(flights) - 1, "trainings of one flight are counted as independent pairs"
            continue
        a, b = (values(line[who], line["flight"], line["flight_seed"], line["measure"])
                for who in ("candidate", "baseline"))
        seeds = sorted(a.keys() & b.keys())
        p, effect = exact_p([a[s] - b[s] for s in seeds])
        baseline = sum(b[s] for s in seeds)
        assert int(line["pairs"]) == len(seeds) and int(line["wins"]) == sum(a[s] < b[s] for s in seeds), line
        assert abs(float(line["p_value"]) - p) < 1e-12 and abs(float(line["rank_biserial"]) - effect) < 1e-12, line
        change = sum(a[s] - b[s] for s in seeds) / baseline if baseline else math.nan
        assert not baseline or abs(float(line["relative_difference"]) - change) < 1e-9, line
    report, settings = (json.loads((folder / name).read_text()) for name in ("report.json", "study.json"))
    assert {c["id"]: c["verdict"] for d in report["discussions"] for c in d["claims"]} == verdicts(folder)
    words = " ".join(page.texts)
    for row in report["table3"]:
        for measure in row["measures"]:
            assert measure["mean"] in words and measure["paper"] in words, f"the page does not show {measure}"
    for line in table(folder / "table3.csv"):
        model = int(line["model"])
        flight = "d1" if model <= 10 else "d2" if model <= 12 else "d3"
        found = list(values(line["model"], flight, str(settings.get("flight_seed")), line["measure"]).values())
        if found and "flight_seed" in settings:
            assert int(line["seeds"]) == len(found) and math.isclose(float(line["mean"]), statistics.fmean(found),
                                                                     rel_tol=1e-12)
            assert len(found) < 2 or math.isclose(float(line["deviation"]), statistics.stdev(found), rel_tol=1e-9)


def test_planted(planted):
    """It is found, with 8 seeds; the smallest p is 2^-7."""
    folder = planted / "planted"
    for file in OUTPUTS:
        assert (folder / file).stat().st_size, file
    look(folder)
    assert verdicts(folder) == PLANTED
    comparisons = (folder / "comparisons.csv").read_text()
    for line in [r"2,4,mae,d1,1,8,8,0,0,.*,0\.0078125,1,better,", r"7,8,mae,d1,1,8,0,0,8,.*,0\.0078125,-1,worse,",
                 r'2,4,mae,"further flights, means",,3,3,0,0,.*,0\.25,']:
        assert re.search(f"^{line}", comparisons, re.M), line
    assert comparisons.count("further flights") == 6
    page = shown(folder)
    assert "&lt;quadrotor&gt; &amp; Co" in page, "text of study.json is not escaped"
    assert "Seeds vary the training, not the data" in page
    assert re.search(r'class="box banner".*8 seeds of 20\.', page)
    no_partial_files(planted)

    def columns(claim):
        return re.search(rf'id="claim-{claim}".*\n?.*\n?.*(<thead>.*?</thead>)', page).group(1)

    assert re.search('>network</th>.*>linearized</th>.*>factor</th><th class="n">paper</th>', columns("1.1"))
    assert re.search(">baseline</th>.*>candidate</th>.*>change</th>.*>lower in</th>.*>p</th>", columns("2.1"))
    (claim,) = [row for row in (folder / "claims.csv").read_text().splitlines() if row.startswith("1.1,")]
    assert re.search(r": network 4\.\d*e-3, linearized 10[\d.]*e-3, factor 2[\d.]* times", claim)


def test_few_seeds_decide_nothing(driver, study):
    """Whichever way five lean; six do. A study of the default size has no banner."""
    driver("make five 5")
    driver("report five")
    assert set(verdicts("five").values()) == {"undecided"} and 'class="badge not"' not in shown("five")
    look("five")
    driver("make six 6")
    driver("report six")
    assert {claim: verdicts("six")[claim] for claim in ("2.1", "4.1", "4.2")} == \
        {"2.1": "reproduced", "4.1": "not reproduced", "4.2": "not reproduced"}
    # model 8 alone has five
    study(lambda line, c: None if line == 1 or c[0] == "1" or int(c[3]) <= (5 if c[0] == "8" else 6) else False)
    driver("report edited")
    wanted = {"2.1": "reproduced", "4.1": "undecided", "4.2": "undecided", "4.4": "undecided", "5.2": "not reproduced"}
    assert {claim: verdicts("edited")[claim] for claim in wanted} == wanted
    driver("make twenty 20")
    driver("report twenty")
    assert 'class="box banner"' not in shown("twenty")
    study(lambda line, c: [*c[:4], 12, *c[5:]] if c[4] == "300" else None)
    replaced("edited/study.json", "edited/study.json", ('"epochs": 300', '"epochs": 12'))
    driver("report edited")
    assert "12 epochs of 300, 8 seeds of 20." in shown("edited")


@pytest.mark.parametrize("factor", [0.001, 4])
def test_suspect_entries_decide_nothing(driver, study, planted, factor):
    """Whatever models 3 and 10 have in pitch."""
    at = list(table(planted / "plain/rows.csv")[0]).index("angle_difference_deg_pitch")
    study(lambda line, c: [*c[:at], float(c[at]) * factor, *c[at + 1 :]] if c[0] in ("3", "10") else None)
    driver("report edited")
    assert verdicts("edited") == PLANTED


def test_the_other_way_round(driver, study):
    study(lambda line, c: [6 - int(c[0]), *c[1:]] if c[0] in ("2", "4") else None)
    driver("report edited")
    assert {verdicts("edited")[claim] for claim in ("2.1", "2.2", "2.3")} == {"not reproduced"}
    look("edited")


def test_incomplete(driver, study):
    """Reported as far as it goes."""
    study(lambda line, c: False if c[0] == "14" or (c[0], c[3]) == ("6", "3") else None)
    driver("report edited")
    wanted = {"5.2": "not judged", "5.4": "not judged", "5.1": "reproduced"}
    assert {claim: verdicts("edited")[claim] for claim in wanted} == wanted
    assert "model 14: no rows" in shown("edited") and "model 6: 7 of 8 seeds, without seed 3" in shown("edited")
    look("edited")
    study(lambda line, c: None if line == 1 or (c[0], c[2], c[3]) == ("4", "1", "2") else False)
    shutil.rmtree("edited/series")
    driver("report edited")
    assert verdicts("edited")["2.1"] == "not judged" and "no series/model2.csv" in shown("edited")
    assert re.search("hold what they show: .*Fig. 5, Fig. 6", shown("edited"))
    look("edited")


def test_pictures_of_flights(driver, study):
    """As fly --pictures leaves them."""
    study()
    for picture in "d2/ground_effect", "d3/wind":
        path = Path(f"edited/flights/{picture}.svg")
        path.parent.mkdir(parents=True)
        path.write_text(f"<svg>{picture}</svg>\n")
    driver("report edited")
    for path in Path("edited/flights").rglob("*.svg"):
        assert f'base64,{base64.b64encode(path.read_bytes()).decode()}"' in shown("edited"), path
    look("edited")


def test_odd_rows(driver, study):
    """Cut off, as of a run that was killed; of a training that diverged; of best weights; nothing but the rows."""
    study()
    cut = Path("edited/rows.csv").read_text()
    Path("edited/rows.csv").write_text(cut + cut.splitlines()[-1][:40])
    driver("report edited")
    assert "cut off: left out" in shown("edited")
    study(lambda line, c: [*c[:6], *15 * ["nan"], *c[21:]] if (c[0], c[2], c[3]) == ("4", "1", "5") else None)
    driver("report edited")
    assert "model 4: 1 trainings without a finite error" in shown("edited")
    look("edited")
    study()
    rows = Path("edited/rows.csv").read_text().splitlines()
    best = [",".join([*row.split(",")[:5], "best", *row.split(",")[6:]]) for row in rows[1:]
            if row.startswith(("2,", "4,"))]
    Path("edited/rows.csv").write_text("\n".join([*rows, *best, ""]))
    driver("report edited")
    assert "best-validation weights" in shown("edited")
    look("edited")
    Path("edited/study.json").write_text("{}\n")
    driver("report edited")
    look("edited")


def in_column(name, value):
    """A change of row 8, of which the column is found by its name."""
    places = {}

    def change(line, cells):
        if line == 1:
            places[name] = cells.index(name)
        elif line == 8:
            cells[places[name]] = value

    return change


ROWS = [
    ("1", "mae", cell(1, 7, "wrong")), ("7:9", '"fast"', cell(7, 9, "fast")), ("7:9", "empty cell", cell(7, 9, "")),
    ("8:1", '"15"', cell(8, 1, 15)), ("8:6", "final or best", cell(8, 6, "mean")), ("8:4", "a seed", cell(8, 4, "-1")),
    ("8:5", '"999"', cell(8, 5, 999)), ("8:3", '"99"', cell(8, 3, 99)), ("8:3", "d9", cell(8, 2, "d9")),
    ("8:7", '"-5"', cell(8, 7, -5)), ("8:7", '"nan"', cell(8, 7, "nan")), ("8:11", '"inf"', cell(8, 11, "inf")),
    ("8:9", '"1.01"', cell(8, 9, 1.01)), ("8:*", "share", in_column("sign_violation_share_yaw", 1.5)),
    ("8:*", "degrees", in_column("angle_difference_deg_roll", 200)), ("8:*", "seconds", in_column("training_s", -1)),
    ("9:*", "fields", lambda line, cells: cells[:-1] if line == 9 else None),
    ("10", "line 9", lambda line, cells: [*cells[:-1], f"{cells[-1]}\n{','.join(cells)}"] if line == 9 else None),
    ("1", "finished training", lambda line, cells: None if line == 1 else False),
    ("1", "empty file", lambda line, cells: False)]


@pytest.fixture
def refused(driver, planted):
    """refused(at, keyword): edited/ is refused, and what was there stays."""

    def check(at, keyword):
        shutil.copy(planted / "planted/report.html", "edited")
        driver.refused("report edited", at=at, keyword=keyword)
        same_bytes(planted / "planted/report.html", "edited/report.html")
        no_partial_files("edited")

    return check


@pytest.mark.parametrize("place, keyword, change", ROWS)
def test_refused_rows(study, refused, place, keyword, change):
    study(change)
    refused(f"rows.csv:{place}", keyword)


@pytest.mark.parametrize("text, place, keyword", [
    ('{"x": ' + 100000 * "[", ":1:70", "64 levels"), ('{"x": 1e400}', "", "double"),
    ('{\n "a": 1,\n oops\n}', ":3:2", "JSON"), ('{"kind": "ablation"}', "", "Table 2")])
def test_refused_settings(study, refused, text, place, keyword):
    study()
    Path("edited/study.json").write_text(f"{text}\n")
    refused(f"study.json{place}", keyword)


def test_refused_files(driver, study, refused):
    for name in "rows.csv", "study.json":
        study()
        Path("edited", name).unlink()
        refused(name, "readable file")
    study()
    replaced("edited/study.json", "edited/study.json", ('"seeds"', '"models": [2, 4], "seeds"'))
    refused("rows.csv:10:1", '"3"')
    study()
    edited("edited/series/model4.csv", "series.csv", cell(5, 1, "soon"))
    shutil.move("series.csv", "edited/series/model4.csv")
    refused("model4.csv:5:1", '"soon"')
    driver.refused("report absent", at="absent/study.json", keyword="readable file")


def test_interrupted(driver, study):
    """Ctrl-C before the work is done."""
    study()
    Path("edited/report.html").write_text("before\n")
    line = driver.refused("interrupt edited", code=130, keyword="interrupted").lines[0]
    assert line.startswith("report: ")
    assert Path("edited/report.html").read_text() == "before\n"
    no_partial_files("edited")


def test_all_or_none(driver, study):
    """The last of the five can't be written; a disk that is full for one of them."""
    study()
    Path("edited/claims.csv").mkdir()
    driver.refused("report edited", at="edited/claims.csv", keyword="a folder")
    assert not Path("edited/report.html").exists()
    no_partial_files("edited")
    Path("edited/claims.csv").rmdir()
    Path("small").mkdir()
    # in a name space of its own: small/ is a disk of two pages
    if not shutil.which("unshare") or subprocess.run("unshare -rm mount -t tmpfs tmpfs small".split(),
                                                     capture_output=True).returncode:
        pytest.skip("a full disk: no name space to mount one in")
    Path("edited/claims.csv").symlink_to("../small/claims.csv")
    script = """mount -t tmpfs -o size=8k tmpfs small && head -c 4096 /dev/zero >small/filled && : >small/claims.csv
        head -c 4096 /dev/zero >small/filled_too 2>/dev/null
        exec "$0" report edited"""
    Program("unshare").refused("-rm bash -c", script, driver, at="edited/claims.csv", keyword="No space left")
    assert not Path("edited/report.html").exists()
    no_partial_files("edited")
