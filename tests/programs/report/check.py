# SPDX-License-Identifier: MIT
# A study's report, looked at from outside: is the page well-formed and alone, and are its figures those of the rows?
#   check.py DIR
import csv
import itertools
import json
import math
import re
import statistics
import sys
from html.parser import HTMLParser

folder = sys.argv[1]


def require(holds, words):
    if not holds:
        sys.exit("FAILED: " + words)


class Page(HTMLParser):
    void = {"meta", "img", "br", "hr", "link", "input"}

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.ids, self.links, self.texts = [], [], [], []
        self.drawings, self.named = 0, {"title": 0, "desc": 0}

    def start(self, tag, attributes, closed):
        require(tag not in ("script", "iframe", "object", "link"), f"the page holds a <{tag}>")
        for name, value in attributes:
            require(not name.startswith("on"), f"the page holds {name}=")
            if name == "id":
                self.ids.append(value)
            if name in ("href", "src", "xlink:href", "srcset", "poster"):
                self.links.append(value)
        self.drawings += tag == "svg"
        if tag in self.named and self.open[-1] == "svg":
            self.named[tag] += 1
        if tag == "img":
            require(dict(attributes).get("alt"), "a picture has no words for who does not see it")
        if not closed and tag not in self.void:
            self.open.append(tag)

    def handle_starttag(self, tag, attributes):
        self.start(tag, attributes, False)

    def handle_startendtag(self, tag, attributes):
        self.start(tag, attributes, True)

    def handle_endtag(self, tag):
        require(self.open and self.open[-1] == tag, f"</{tag}> closes <{self.open[-1] if self.open else 'nothing'}>, line {self.getpos()[0]}")
        self.open.pop()

    def handle_data(self, data):
        self.texts.append(data)


text = open(folder + "/report.html", encoding="utf-8").read()
page = Page()
page.feed(text)
page.close()
require(not page.open, f"never closed: {page.open}")
require(len(set(page.ids)) == len(page.ids), "an id stands twice")
for link in page.links:
    require(link.startswith("data:image/svg+xml;base64,") or (link.startswith("#") and link[1:] in page.ids), f"a link leaves the page or leads nowhere: {link[:60]}")
require(page.drawings >= 4 and page.drawings == page.named["title"] == page.named["desc"], f"of {page.drawings} drawings {page.named} are named")
require(text.startswith("<!DOCTYPE html>") and "{{" not in text, "the page is not what a browser takes for one")
shown = re.sub(r'"data:[^"]*"', "", text)
for word in ("http:", "https:", "url(", "@import"):
    require(word not in shown, f"the page refers to something outside: {word}")
require(not re.search(r"\bnan\b|\binf\b", shown), "the page shows nan or inf")
require(not re.search(r"<[^>]*\bNaN\b", shown, re.I), "a drawing has a coordinate that is no number")

rows = [row for row in csv.DictReader(open(folder + "/rows.csv")) if row["weights"] == "final"]


def column(model, flight, flight_seed, measure):
    found = {int(r["seed"]): float(r[measure]) for r in rows if r["model"] == model and r["flight"] == flight and r["flight_seed"] == flight_seed}
    return {seed: value for seed, value in found.items() if math.isfinite(value)}


def exact_p(differences):
    """Two-sided Wilcoxon by trying all signs."""
    decided = sorted((d for d in differences if d != 0), key=abs)
    if not decided:
        return 1.0, 0.0
    ranks = [1 + sum(abs(o) < abs(d) for o in decided) + (sum(abs(o) == abs(d) for o in decided) - 1) / 2 for d in decided]
    wins = sum(r for r, d in zip(ranks, decided) if d < 0)
    least = min(wins, sum(ranks) - wins)
    reached = sum(sum(r for r, s in zip(ranks, signs) if s) <= least for signs in itertools.product((0, 1), repeat=len(ranks)))
    return min(1.0, 2 * reached / 2 ** len(ranks)), (2 * wins - sum(ranks)) / sum(ranks)


checked = 0
for line in csv.DictReader(open(folder + "/comparisons.csv")):
    if not line["flight_seed"]:
        continue
    a = column(line["candidate"], line["flight"], line["flight_seed"], line["measure"])
    b = column(line["baseline"], line["flight"], line["flight_seed"], line["measure"])
    seeds = sorted(a.keys() & b.keys())
    p, effect = exact_p([a[s] - b[s] for s in seeds])
    baseline = sum(b[s] for s in seeds)
    change = sum(a[s] - b[s] for s in seeds) / baseline if baseline else math.nan
    where = f"{line['candidate']} against {line['baseline']}, {line['measure']}"
    require(int(line["pairs"]) == len(seeds), f"{where}: pairs")
    require(int(line["wins"]) == sum(a[s] < b[s] for s in seeds), f"{where}: wins")
    require(abs(float(line["p_value"]) - p) < 1e-12, f"{where}: p is {p}, the report says {line['p_value']}")
    require(abs(float(line["rank_biserial"]) - effect) < 1e-12, f"{where}: effect size")
    require(not baseline or abs(float(line["relative_difference"]) - change) < 1e-9, f"{where}: change is {change}")
    checked += 1
further = {(r["flight"], r["flight_seed"]) for r in rows}
for line in csv.DictReader(open(folder + "/comparisons.csv")):
    if not line["flight_seed"]:
        require(int(line["pairs"]) <= len(further) - 1, "trainings of one flight are counted as independent pairs")
said = json.load(open(folder + "/report.json"))
verdicts = {line["id"]: line["verdict"] for line in csv.DictReader(open(folder + "/claims.csv"))}
require({c["id"]: c["verdict"] for d in said["discussions"] for c in d["claims"]} == verdicts, "report.json and claims.csv differ")
words = " ".join(page.texts)
for row in said["table3"]:
    for measure in row["measures"]:
        require(measure["mean"] in words and measure["paper"] in words, f"report.json has what the page does not show: {measure}")
settings = json.load(open(folder + "/study.json"))
for line in csv.DictReader(open(folder + "/table3.csv")):
    model, measure = line["model"], line["measure"]
    flight = "d1" if int(model) <= 10 else "d2" if int(model) <= 12 else "d3"
    values = list(column(model, flight, str(settings.get("flight_seed")), measure).values())
    if not values or "flight_seed" not in settings:
        continue
    require(int(line["seeds"]) == len(values), f"table3.csv, model {model}: seeds")
    require(math.isclose(float(line["mean"]), statistics.fmean(values), rel_tol=1e-12), f"table3.csv, model {model}, {measure}: mean")
    if len(values) > 1:
        require(math.isclose(float(line["deviation"]), statistics.stdev(values), rel_tol=1e-9), f"table3.csv, model {model}, {measure}: deviation")
print(f"the page is well-formed and alone; {checked} comparisons are as the rows say")
