#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Writes the report of a folder that `pinnquad-study paper`, `beyond` or `loop` wrote.

    pinnquad-study paper --seeds 20 --out study
    tools/study/report.py study          installed: pinnquad-study-report study

Reads DIR/loop.json, or DIR/study.json, rows.csv and series/; writes DIR/report.html and report.json, for the paper's
study also table3.csv, comparisons.csv and claims.csv, all or none. Needs Debian's python3-numpy, python3-matplotlib and python3-jinja2. Exit code: 0 written,
whatever its verdicts; 1 without these packages; 2 bad input or a file that can't be read or written; 130 interrupted,
nothing written.
"""
import argparse
import base64
import csv
import importlib.util
import io
import json
import math
import os
import signal
import sys
from pathlib import Path

missing = [name for name in ("numpy", "matplotlib", "jinja2") if importlib.util.find_spec(name) is None]
if missing:
    sys.exit(f"{Path(sys.argv[0]).name}: no {missing[0]} here. On Debian or Ubuntu, as root: apt-get install python3-" +
             " python3-".join(missing))
import report_beyond  # noqa: E402
import report_loop  # noqa: E402
from report_claims import (  # noqa: E402
    CLAIMS, DISCUSSIONS, EPOCHS, ERROR, INFORMED_S, MEASURES, PAIRS, SEEDS, SUSPECT, TABLE_2, TABLE_3, VANILLA_S,
    VERDICTS, all_comparisons, compare, further_comparisons, judged_claims, mean_and_deviation, model_words, pair_text,
    paper_change)
from report_page import BadOutput, json_file, quantity, shown, shown_p, whole_page, write_all  # noqa: E402
from report_rows import MODELS, BadInput, Settings, Study, read_bytes, read_rows, read_series  # noqa: E402


def kind_of(says):
    """The class that colours a line of figures."""
    return {"better": "good", "holds": "good", "worse": "bad", "does not hold": "bad"}.get(says, "mild")


# Tables of the page.

def claims_table(claims):
    kinds = dict(zip(VERDICTS, ("reproduced", "part", "not", "undecided", "open")))
    discussions = [{"number": at, "title": title, "claims": []} for at, title in enumerate(DISCUSSIONS, start=1)]
    for claim, judged in claims:
        discussions[int(claim.id[0]) - 1]["claims"].append({
            "id": claim.id, "statement": claim.statement, "rule": claim.rule, "verdict": judged.verdict,
            "verdict_kind": kinds[judged.verdict], "paired": any(e.wins for e in judged.evidence),
            **{f"column_{key}": name for key, name in zip(("from", "to", "change"), claim.columns)},
            "lines": [{"what": e.what, "from": quantity(e.before), "to": quantity(e.after),
                       "change": quantity(e.change), "wins": e.wins,
                       "p": shown_p(float(e.p)) if e.p else "", "paper": quantity(e.paper), "says": e.says,
                       "kind": kind_of(e.says)} for e in judged.evidence]})
    return discussions


def table2_rows(study, settings):
    rows = []
    for model, entry in TABLE_2.items():
        trainings, network, run = study.trainings(model), model > 1, model in study.flights
        first = study.flights[model][0] if run else None
        rows.append({
            "model": model, "network": entry.structure, "data": entry.data, "term": entry.term or "–",
            "batch_norm": ("with" if entry.batch_norm else "without") if network else "–",
            "split": settings.splits.get(model, entry.split), "flight": flight_text(first) if run else "not run",
            "seeds": str(len(trainings)) if network or not run else "–",
            "epochs": ", ".join(map(str, sorted({row.epochs for row in trainings}))) if network else "–",
            "weights": trainings[0].weights if network and trainings else "–",
            "closes": model in (1, 4) or model > 4 and model % 2 == 0})
    return rows


def flight_text(flight):
    return f"{flight.name}, seed {flight.seed}"


def table3_rows(study):
    rows = []
    for group in range(1, 5), *(range(first, first + 2) for first in range(5, 15, 2)):
        for model in group:
            measures = []
            for measure in MEASURES:
                means = {other: mean_and_deviation(study.values(other, measure.column)) for other in group}
                mean, deviation = means[model]
                paper, paper_deviation = TABLE_3[model][measure]
                measures.append({
                    "mean": shown(measure.scale * mean, 3),
                    "deviation": "" if math.isnan(deviation) else shown(measure.scale * deviation, 3),
                    "best": not math.isnan(mean) and not any(other < mean for other, _ in means.values()),
                    "paper": shown(measure.scale * paper, 3), "suspect": (model, measure) in SUSPECT,
                    "paper_deviation": shown(measure.scale * paper_deviation, 3) if paper_deviation else ""})
            rows.append({"model": model, "name": model_words(model), "measures": measures,
                         "closes": model == group[-1]})
    return rows


def measure_name(measure):
    return measure.label + (", 10⁻³" if measure == ERROR else ", °")


def comparison_row(r, scale=None, **more):
    """The right half of every table of comparisons. Means are shown where they have a unit."""
    return {"baseline": shown(scale * r.baseline_mean, 3) if scale else "",
            "candidate": shown(scale * r.candidate_mean, 3) if scale else "", "change": shown(100 * r.change, 1, True),
            "wins": r.wins, "of": r.pairs, "p": shown_p(r.p), "effect": shown(r.effect, 2, True), "says": r.says,
            "kind": kind_of(r.says), **more}


def comparison_rows(comparisons):
    rows = []
    for before, c, after in zip([None, *comparisons], comparisons, [*comparisons[1:], None]):
        paper = paper_change(c.pair, c.measure)
        rows.append(comparison_row(c.result, c.measure.scale, pair=pair_text(c.pair), measure=measure_name(c.measure),
                                   opens=not before or before.pair != c.pair, closes=not after or after.pair != c.pair,
                                   paper="suspect†" if paper is None else shown(100 * paper, 1, True)))
    return rows


def flight_rows(further, study):
    rows = []
    for f in further:
        first = compare(study, f.pair, f.measure)
        lines = [(f"{flight_text(first.flight)} (Table 2’s)", first.result)] if first else []
        lines += [(flight_text(c.flight), c.result) for c in f.flights]
        rows += [comparison_row(result, f.measure.scale, flight=flight, pair=pair_text(f.pair),
                                measure=measure_name(f.measure), opens=at == 0, closes=False)
                 for at, (flight, result) in enumerate(lines)]
        rows.append(comparison_row(f.of_means, flight="means of the further flights", pair=pair_text(f.pair),
                                   measure=measure_name(f.measure), opens=False, closes=True))
    return rows


def other_weights_rows(study):
    """The same pairs under the weights that the report does not use, where rows.csv has them."""
    other, rows = "best" if study.weights == "final" else "final", []
    for pair in PAIRS:
        flight = study.flights.get(pair[0], [None])[0]
        if study.weights_of(pair[0], flight, other) != study.weights_of(pair[0], flight, study.weights):
            if c := compare(study, pair, ERROR, flight, other):
                rows.append(comparison_row(c.result, ERROR.scale, pair=pair_text(pair)))
    return rows


def cost_rows(study):
    """Seconds of a training, and physics-informed over vanilla."""
    rows = []
    for pair in PAIRS:
        vanilla, informed = (study.values(model, "training_s") for model in pair)
        if TABLE_2[pair[0]].term or not vanilla or not informed:
            continue
        (mean, deviation), (other, other_deviation) = mean_and_deviation(vanilla), mean_and_deviation(informed)
        rows.append({"pair": pair_text(pair), "vanilla": shown(mean, 2), "informed": shown(other, 2),
                     "vanilla_deviation": shown(deviation, 2) if len(vanilla) > 1 else "",
                     "informed_deviation": shown(other_deviation, 2) if len(informed) > 1 else "",
                     "ratio": shown(other / mean if mean else math.nan, 3)})
    return rows


# Gaps of a study: against Table 2, its own plan, and a study's defaults.

def missing_lines(study, settings, cut):
    absent = ", ".join(str(model) for model in MODELS if not settings.plans(model))
    lines = [f"not part of this study: models {absent}"] if absent else []
    if cut:
        lines.append("rows.csv ends with a row that is cut off: left out")
    wanted = max(settings.seeds, len(study.expected))
    for model in filter(settings.plans, MODELS):
        trainings = study.trainings(model)
        if not trainings:
            lines.append(f"model {model}: no rows")
        if not trainings or model == 1:  # which is not trained
            continue
        seeds = {row.seed for row in trainings}
        if len(seeds) < wanted:
            without = ", ".join(str(seed) for seed in study.expected if seed not in seeds)
            lines.append(f"model {model}: {len(seeds)} of {wanted} seeds" + (without and f", without seed {without}"))
        undefined = sum(math.isnan(row.figures["mae"]) for row in trainings)
        if undefined:
            lines.append(f"model {model}: {undefined} trainings without a finite error, left out")
    return lines


def smaller_than_default(study, settings):
    """A model that lacks seeds of a study that has them is named by missing_lines()."""
    counts = [(min([EPOCHS, *(row.epochs for row in study.rows if row.model > 1)]), EPOCHS, "epoch"),
              (max(settings.seeds, len(study.expected)), SEEDS, "seed")]
    return ", ".join(f"{count} {what}{'s' * (count != 1)} of {default}" for count, default, what in counts
                     if count < default)


# Everything in study.json.

def json_text(value):
    if value is None or isinstance(value, bool):
        return {None: "–", True: "yes", False: "no"}[value]
    if isinstance(value, str):
        return value
    if isinstance(value, list) and not any(isinstance(entry, (list, dict)) for entry in value):
        return ", ".join(map(json_text, value))
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), sort_keys=True)


def lists_objects(value):
    return isinstance(value, list) and value != [] and all(isinstance(entry, dict) for entry in value)


def settings_values(entries, prefix=""):
    """Names and values, nested ones in lines of their own."""
    for key, value in sorted(entries.items()):
        name = prefix + key.replace("_", " ")
        if isinstance(value, dict):
            yield from settings_values(value, f"{name} › ")
        elif not lists_objects(value):
            yield {"name": name, "value": json_text(value)}


def objects_table(name, objects):
    """With the keys of all of them; what names an object stands first."""
    keys = dict.fromkeys(key for entry in objects for key in sorted(entry))
    keys = sorted(keys, key=lambda key: 0 if key in ("name", "model") else 1 if key == "seed" else 2)
    numbers = {key: all(type(entry.get(key, 0)) in (int, float) for entry in objects) for key in keys}
    return {"name": name.replace("_", " "),
            "head": [{"text": key.replace("_", " "), "number": numbers[key]} for key in keys],
            "rows": [{"cells": [{"text": json_text(entry[key]) if key in entry else "", "number": numbers[key]}
                                for key in keys]} for entry in objects]}


# The page, and the tables as CSV: numbers with all their digits.

def flight_pictures(folder):
    """The pictures that `fly --pictures` left in flights/; the names of those that are not there."""
    pictures = [("trajectory", "Fig. 4 (d)", "The flown path of D1, coloured by speed."),
                ("correlation", "Fig. 2 over the whole flight",
                 "Angular acceleration and signed command sum over the whole flight."),
                ("ground_effect", "Fig. 5", "D2: thrust ratio of the ground effect models with what was flown; below, "
                 "height and force over time with the split."),
                ("wind", "Fig. 6", "D3: drag and what the wind adds along the body’s axes; below, the wind.")]
    files, found, left_out = sorted((folder / "flights").rglob("*.svg")), [], []
    for ending, name, caption in pictures:
        file = next((file for file in files if file.name.endswith(f"{ending}.svg")), None)
        if file:
            found.append({"name": name, "caption": caption, "base64": base64.b64encode(read_bytes(file)).decode()})
        else:
            left_out.append(name)
    return found, left_out


def page_figures(folder, study, settings, series, cut, comparisons, further, claims):
    """All that the page says but for the drawings: report.json. Figures are text in the page's signs."""
    pictures, left_out = flight_pictures(folder)
    if not series:
        left_out.insert(0, "Fig. 2 over some seconds and Fig. 8 (no series/model2.csv, series/model4.csv)")
    main = next((c for c in comparisons if (c.pair, c.measure) == (PAIRS[0], ERROR)), None)
    of_means = next((f.of_means for f in further if (f.pair, f.measure) == (PAIRS[0], ERROR)), None)
    patience = settings.all.get("patience")
    return {
        "title": "Physics-informed quadrotor dynamics: the paper’s study, run again",
        "rows": len(study.rows), "seeds": len(study.expected), "smaller": smaller_than_default(study, settings),
        "missing": missing_lines(study, settings, cut), "claim_count": len(CLAIMS),
        **{verdict.replace(" ", "_"): sum(judged.verdict == verdict for _, judged in claims) for verdict in VERDICTS},
        "main": main and comparison_row(main.result, ERROR.scale, flight=main.flight.name,
                                        paper=shown(100 * paper_change(main.pair, ERROR), 1, True),
                                        further=of_means and comparison_row(of_means)),
        "discussions": claims_table(claims), "table3": table3_rows(study), "pairs": comparison_rows(comparisons),
        "tests": len(comparisons) + sum(len(f.flights) + 1 for f in further),
        "other_weights": other_weights_rows(study),
        "other_weights_are": "best-validation" if study.weights == "final" else "final",
        "further_flights": flight_rows(further, study),
        "figures": {"cycles": settings.cycles, "hold": shown(settings.hold, 2),
                    "lambda_max": shown(settings.lambda_max, 3), "flights": pictures,
                    "epochs": max(row.epochs for row in study.rows) or EPOCHS, "left_out": ", ".join(left_out)},
        "cost": cost_rows(study), "paper_vanilla_s": shown(VANILLA_S, 0), "paper_informed_s": shown(INFORMED_S, 0),
        "paper_cost_ratio": shown(INFORMED_S / VANILLA_S, 3), "table2": table2_rows(study, settings),
        "split_unit": "rows" if settings.splits else "%", "patience": "" if patience is None else json_text(patience),
        "settings": {"values": list(settings_values(settings.all)),
                     "lists": [objects_table(key, value) for key, value in sorted(settings.all.items())
                               if lists_objects(value)]}}


def page(figures, study, settings, series, comparisons):
    import report_charts  # here, since matplotlib takes a second: bad input is refused before

    drawings = {
        "changes": report_charts.changes(comparisons),
        "correlation": report_charts.correlation(next(iter(series.values()))) if series else "",
        "ellipses": report_charts.ellipses(series),
        "schedule": report_charts.schedule(settings, figures["figures"]["epochs"]),
        "errors_d1": report_charts.errors(study, range(1, 11), "Test error on D1"),
        "errors_d2": report_charts.errors(study, (11, 12), "Test error on D2, with ground effect"),
        "errors_d3": report_charts.errors(study, (13, 14), "Test error on D3, with periodic wind")}

    return whole_page("report.html", figures, drawings)


def csv_text(head, rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(
        [head, *([repr(cell).removesuffix(".0") if isinstance(cell, float) else cell for cell in row] for row in rows)])
    return text.getvalue()


def table3_csv(study):
    rows = []
    for model, paper in TABLE_3.items():
        for measure in MEASURES:
            values = study.values(model, measure.column)
            rows.append([model, measure.column, len(values), *mean_and_deviation(values), paper[measure][0],
                         paper[measure][1] if model > 1 else math.nan, int((model, measure) in SUSPECT)])
    return csv_text(["model", "measure", "seeds", "mean", "deviation", "paper_mean", "paper_deviation",
                     "paper_entry_suspect"], rows)


def comparisons_csv(comparisons, further):
    lines = [(c, *c.flight, c.result) for c in comparisons]
    for f in further:
        lines += [(c, *c.flight, c.result) for c in f.flights] + [(f, "further flights, means", "", f.of_means)]
    rows = []
    for of, flight, seed, r in lines:
        paper = paper_change(of.pair, of.measure)
        rows.append([*of.pair, of.measure.column, flight, seed, r.pairs, r.wins, r.ties, r.losses, r.baseline_mean,
                     r.candidate_mean, r.change, r.p, r.effect, r.says, math.nan if paper is None else paper])
    return csv_text(["baseline", "candidate", "measure", "flight", "flight_seed", "pairs", "wins", "ties", "losses",
                     "baseline_mean", "candidate_mean", "relative_difference", "p_value", "rank_biserial", "outcome",
                     "paper_relative_difference"], rows)


def claims_csv(claims):
    rows = []
    for claim, judged in claims:
        figures = []
        for e in judged.evidence:
            words = e.what
            if e.before:
                words += ": " + ", ".join(f"{name} {value}"
                                          for name, value in zip(claim.columns, (e.before, e.after, e.change)))
            words += f", lower in {e.wins}, p = {e.p}" if e.wins else ""
            figures.append(words + (f", the paper {e.paper}" if e.paper else "") + f": {e.says}")
        rows.append([claim.id, claim.id[0], judged.verdict, claim.statement, claim.rule, "; ".join(figures)])
    return csv_text(["id", "discussion", "verdict", "statement", "rule", "figures"], rows)


def judged(folder):
    """What stands in the folder, judged: all that the page says, and what it says it of."""
    settings = Settings(folder / "study.json")
    rows, cut = read_rows(folder / "rows.csv", settings)
    series = {model: read_series(path) for model in (2, 4) if (path := folder / f"series/model{model}.csv").exists()}
    study = Study(rows, settings)
    comparisons, further, claims = all_comparisons(study), further_comparisons(study), judged_claims(study)
    figures = page_figures(folder, study, settings, series, cut, comparisons, further, claims)
    return figures, study, settings, series, comparisons, further, claims


def report_paper(folder):
    figures, study, settings, series, comparisons, further, claims = judged(folder)
    write_all(folder, {
        "report.html": page(figures, study, settings, series, comparisons),
        "report.json": json_file(figures), "table3.csv": table3_csv(study),
        "comparisons.csv": comparisons_csv(comparisons, further), "claims.csv": claims_csv(claims)})


def report_sections(folder, module):
    """A page of sections: drawings and tables. Prints its tables."""
    figures, drawings = module.judged(folder)
    write_all(folder, {"report.html": whole_page("report_sections.html", figures, drawings()),
                       "report.json": json_file(figures)})
    for section in figures["sections"]:
        for table in section["tables"] if section["told"] else []:
            widths = [max(len(line[at]) for line in (table["titles"], *table["lines"]))
                      for at in range(len(table["titles"]))]
            print(": ".join(filter(None, (section["name"], section["words"]))) + f"\n  {table['name']}")
            for first, *cells in table["titles"], *table["lines"]:
                print(" ", first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(cells, widths[1:])))


def report(folder):
    if os.path.exists(folder / "loop.json"):  # False for a name that is too long, where Path.exists() raises
        report_sections(folder, report_loop)
    elif report_beyond.is_beyond(folder):
        report_sections(folder, report_beyond)
    else:
        report_paper(folder)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"{self.prog}: {message} (see --help)\n")


def interrupt(number, frame):
    raise KeyboardInterrupt


def main():
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of a study")
    folder = parser.parse_args().folder
    for number in signal.SIGTERM, signal.SIGHUP:
        if signal.getsignal(number) != signal.SIG_IGN:  # nohup
            signal.signal(number, interrupt)
    try:
        report(folder)
    except (BadInput, BadOutput) as error:
        print(f"{parser.prog}: {''.join(c if c.isprintable() else '?' for c in str(error))}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # the report is written; who read the tables left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print(f"{parser.prog}: interrupted; nothing was written", file=sys.stderr)
        return 130
    print(f"report      {folder / 'report.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
