# SPDX-License-Identifier: MIT
"""What goes beyond the paper, judged from rows.csv: models by condition, each beside the paper's network of the same
flight and seed."""
import math
from collections import namedtuple

from report_claims import MOST_PAIRS, Paired, mean_and_deviation
from report_page import shown, shown_p
from report_rows import AXES, BadInput, Table, read_object, read_text

YARDSTICK = "paper"  # its error is what the others are measured by
ERROR, EIGHT = "mean_absolute_error", "eight_rmse_m"
PAIRED = (ERROR, EIGHT, "yaw_eight_rmse_m", "circle_rmse_m")
KEYS = ("model", "flight", "flight_seed", "seed")
# With axes: `worst` of the three is shown.
Column = namedtuple("Column", "title figure scale decimals worst", defaults=[None])
TABLES = {
    ERROR: ("Errors", [
        Column("error, 1e-3", ERROR, 1e3, 2), Column("wrong signs, %", "wrong_derivative_share", 100, 2, max),
        Column("least derivative", "least_derivative_over_nominal", 1, 2, min), Column("proven, %", "proven", 100, 0),
        Column("slope error, %", "slope_error", 100, 1, max), Column("pairs, %", "pair_violations", 100, 1, max),
        Column("network kept, %", "residual_kept", 100, 0), Column("training, s", "training_s", 1, 1)]),
    EIGHT: ("Closed loop", [
        column for name in ("eight", "yaw_eight", "circle")
        for column in (Column(f"{name.replace('_', ' ')}, cm", f"{name}_rmse_m", 100, 2),
                       Column("declined, %", f"{name}_declined_share", 100, 1))])}
FIGURES = [f"{column.figure}_{axis}" if column.worst else column.figure
           for _, columns in TABLES.values() for column in columns for axis in (AXES if column.worst else AXES[:1])]
# In the pictures of all conditions, from behind to the front.
ERRORS_SHOWN = ("vanilla", "vanilla_mirrored", "vanilla_physics", "inverse", "ridge", "structured")
LOOPS_SHOWN = ("none", "inverse", "vanilla", YARDSTICK, "structured")
SHOWN = ("structured", YARDSTICK, "inverse", "vanilla", "none", "ridge", "vanilla_mirrored", "vanilla_physics")


def is_beyond(folder):
    return read_object(folder / "study.json").get("kind") == "beyond"


def read_cells(path):
    """{condition: {model: {(flight seed, seed): {figure: value}}}}"""
    head = [name.strip() for name in read_text(path).partition("\n")[0].split(",")]
    table = Table(path, dict.fromkeys([*KEYS, "epochs", "weights", *FIGURES, *head]))
    figures, cells = [name for name in head if name not in (*KEYS, "epochs", "weights")], {}
    for row in table:
        seeds = tuple(table.count(name, 0, 2**64 - 1, "a seed") for name in KEYS[2:])
        cell = cells.setdefault(row["flight"], {}).setdefault(row["model"], {})
        if seeds in cell:
            raise BadInput(path, table.line, 0, "one row per training", "a second one")
        cell[seeds] = {name: table.figure(name) for name in figures}
    if not cells:
        raise BadInput(path, 1, 0, "at least one finished training", "only the header")
    return cells


def compared(cell, yardstick, figure):
    """A model without seeds stands beside each of the yardstick's. None without a pair."""
    pairs = []
    for (flight_seed, seed), by in yardstick.items():
        row = cell.get((flight_seed, seed)) or cell.get((flight_seed, 0))
        if row and math.isfinite(row[figure] - by[figure]):
            pairs.append((row[figure], by[figure]))
    return Paired(*zip(*pairs)) if 1 <= len(pairs) <= MOST_PAIRS else None


def found_in(models):
    """{model: {figure: mean, deviation, count, and of a paired one ratio, wins, pairs, p_value}}"""
    found = {}
    for model, cell in models.items():
        entry = found[model] = {}
        for name in next(iter(cell.values())):
            values = [row[name] for row in cell.values()]
            mean, deviation = mean_and_deviation(values) if all(map(math.isfinite, values)) else (math.nan, math.nan)
            entry[name] = {"mean": mean, "deviation": deviation, "count": len(values)}
        for figure in PAIRED:
            if result := compared(cell, models.get(YARDSTICK, {}), figure):
                entry[figure] |= {"ratio": 1 + result.change, "wins": result.wins, "pairs": result.pairs,
                                  "p_value": result.p}
    return found


def text_of(entry, column):
    names = [f"{column.figure}_{axis}" for axis in AXES] if column.worst else [column.figure]
    values = [entry[name]["mean"] for name in names if not math.isnan(entry[name]["mean"])]
    return shown(column.scale * (column.worst or max)(values), column.decimals) if values else "–"


def table_of(figure, found, order):
    name, columns = TABLES[figure]
    lines = []
    for model in order:
        pair = found[model][figure]
        lines.append([model, *(text_of(found[model], column) for column in columns), *(
            [shown(pair["ratio"], 3), f"{pair['wins']}/{pair['pairs']}", shown_p(pair["p_value"])]
            if "ratio" in pair else ["–"] * 3)])
    return {"name": name, "titles": ["model", *(column.title for column in columns), "ratio", "better", "p"],
            "lines": lines}


def judged(folder):
    """All that the page says, and a function that makes its drawings by section."""
    path = folder / "study.json"
    settings = read_object(path)
    cells = read_cells(folder / "rows.csv")
    try:
        models = {(entry["flight"], entry["id"]): entry["condition"] for entry in settings["models"]}
        plan = (f"{settings['seeds']} seeds, up to {settings['flights_of_main_comparison']} flights, "
                f"{settings['epochs']} epochs. ")
    except (KeyError, TypeError):
        raise BadInput(path, 0, 0, "what pinnquad-study beyond writes", "something else") from None
    orders, words = {}, {}
    for (condition, model), summary in models.items():
        if model in cells.get(condition, {}):
            orders.setdefault(condition, []).append(model)
            words[condition] = summary
    unknown = [(condition, model) for condition in cells for model in cells[condition]
               if (condition, model) not in models]
    if unknown:
        raise BadInput(folder / "rows.csv", 0, 0, "models and conditions of study.json", " ".join(unknown[0]))
    found = {condition: found_in(cells[condition]) for condition in orders}
    figures = {
        "title": "Beyond the paper",
        "plan": plan + "Ratio: mean absolute error, in the closed loop that of the figure-eight, over that of the paper’s "
                "network, paired by flight and seed; p: exact Wilcoxon signed-rank test, two-sided. Of the axes the worst "
                "is shown; rows.csv and report.json have all. Closed loop: root mean square error of the position with "
                "the model as feed-forward; where it declines the hover’s commands stand in.",
        "conditions": found,
        "sections": [{"name": "All conditions", "words": "", "told": False, "tables": []}, *(
            {"name": condition, "words": words[condition], "told": True, "tables": [
                table_of(figure, found[condition], order) for figure in TABLES
                if any(math.isfinite(entry[figure]["mean"]) for entry in found[condition].values())]}
            for condition, order in orders.items())]}

    def drawings():
        import report_charts  # here, since matplotlib takes a second: bad input is refused before

        def by_condition(names, figure, key, scale=1):
            values = {}
            for condition, entries in found.items():
                for name in names:
                    value = entries[name][figure].get(key, math.nan) if name in entries else math.nan
                    if math.isfinite(value):
                        values.setdefault(name, {})[condition] = scale * value
            ordered = {name: values[name] for name in names if name in values}
            return [each for each in found if any(each in marks for marks in ordered.values())], ordered

        made = {"All conditions": [
            report_charts.marks("Errors", "Per condition: mean absolute error of each model over that of the paper's "
                                "network", "error over the paper network's",
                                *by_condition(ERRORS_SHOWN, ERROR, "ratio"), line=1, styled=SHOWN),
            report_charts.marks("Closed loop", "Per condition: position error in the closed loop with the model as "
                                "feed-forward", "RMSE on the figure-eight, cm",
                                *by_condition(LOOPS_SHOWN, EIGHT, "mean", 100), styled=SHOWN)]}
        for condition, order in orders.items():
            ratios = {model: found[condition][model][ERROR].get("ratio", math.nan) for model in order}
            made[condition] = [report_charts.bars(
                "Errors over the paper's network", "mean absolute error over the paper network's",
                {model: ratio for model, ratio in ratios.items() if math.isfinite(ratio)}, 1.5)]
        return made

    return figures, drawings
