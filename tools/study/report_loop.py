# SPDX-License-Identifier: MIT
"""Controllers compared in the loop, judged from loop.json: errors by controller and condition, their ratios to those of
the baselines on the same flights, with intervals."""
import functools
import itertools
import math

import numpy as np

from report_page import shown
from report_rows import BadInput, read_object

BASELINES = ("pid", "indi")  # the others are compared with them
DRAWS = 1000  # of a bootstrap
MASK = 2**64 - 1


def mersenne_twister():
    """The 64 bit numbers of std::mt19937_64 with seed 1. NumPy has the 32 bit generator alone, and docs/loop.md quotes
    intervals of these."""
    state = [1]
    for i in range(1, 312):
        state.append(6364136223846793005 * (state[-1] ^ state[-1] >> 62) + i & MASK)
    while True:
        for i in range(312):
            x = state[i] & ~0x7FFFFFFF | state[(i + 1) % 312] & 0x7FFFFFFF
            state[i] = state[(i + 156) % 312] ^ x >> 1 ^ (0xB5026F5AA96619E9 if x & 1 else 0)
        for x in state:
            x ^= x >> 29 & 0x5555555555555555
            x ^= x << 17 & 0x71D67FFFEDA60000
            x ^= x << 37 & 0xFFF7EEE000000000
            yield x ^ x >> 43


@functools.cache
def drawn(count):
    """Which of `count` values each draw takes, with replacement."""
    bits = itertools.islice(mersenne_twister(), DRAWS * count)
    return np.array([x % count for x in bits]).reshape(DRAWS, count)


def geometric_mean(logarithms):
    """With the 95 % interval by bootstrap; None of no values."""
    if not logarithms:
        return None
    values = np.array(logarithms)
    means = np.sort(np.exp(values[drawn(len(values))].mean(axis=1)))
    return {"mean": math.exp(values.mean()), "lower": means[DRAWS // 40], "upper": means[DRAWS - 1 - DRAWS // 40]}


def summary_of(rows):
    """By gains, controller and condition the error over trajectories and seeds, and its ratio to each baseline's on the
    same flights. A crashed flight counts as one, and is in no mean."""
    logarithms, flown = {}, {}
    for row in rows:
        cell = row["gains"], row["controller"], row["condition"]
        flight = row["gains"], row["condition"], row["trajectory"], row["seed"]
        flown.setdefault(cell, []).append(flight)
        if not row["crashed"]:
            logarithms[row["controller"], flight] = math.log(max(1e-9, row["rmse_cm"]))
    summary = []
    for (gains, controller, condition), flights in flown.items():
        own = {flight: logarithms[controller, flight] for flight in flights if (controller, flight) in logarithms}
        summary.append({"gains": gains, "controller": controller, "condition": condition, "flights": len(flights),
                        "crashed": len(flights) - len(own), "rmse_cm": geometric_mean(list(own.values())), **{
                            f"over_{base}": geometric_mean([error - logarithms[base, flight]
                                                            for flight, error in own.items()
                                                            if (base, flight) in logarithms]) for base in BASELINES}})
    return summary


def interval(mean):
    return "" if mean is None else "{mean:.2f} ({lower:.2f} to {upper:.2f})".format(**mean)


def error_text(cell):
    if cell["rmse_cm"] is None:
        return "lost"
    return interval(cell["rmse_cm"]) + (f", {cell['crashed']} lost" if cell["crashed"] else "")


def tables_of(gains, summary, tuning):
    cells = {(each["controller"], each["condition"]): each for each in summary if each["gains"] == gains}
    controllers, conditions = (list(dict.fromkeys(names)) for names in zip(*cells))

    def table(name, text_of):
        return {"name": name, "titles": ["controller", *conditions], "lines": [
            [controller, *(text_of(cells[controller, each]) if (controller, each) in cells else ""
                           for each in conditions)] for controller in controllers]}

    tables = [table("RMSE, cm, geometric mean over trajectories and seeds, 95 % interval", error_text)]
    tables += [table(f"Ratio to {base}, the same flights", lambda cell: interval(cell[f"over_{base}"]))
               for base in BASELINES if base in controllers]
    if gains == "tuned":
        tables.append({"name": "Gains found, as factors of the equal ones",
                       "titles": ["controller", "position, velocity", "attitude, rates", "learning", "evaluations"],
                       "lines": [[found["tuned"], *(shown(found[key], 2) for key in ("outer", "inner", "learning")),
                                  str(found["evaluations"])] for found in tuning]})
    return tables


def judged(folder):
    """All that the page says, and a function that makes its drawings by section."""
    path = folder / "loop.json"
    result = read_object(path)
    try:
        return judged_result(result)
    except (KeyError, TypeError, ValueError) as error:
        raise BadInput(path, 0, 0, "what pinnquad-study loop writes", f"{type(error).__name__} {error}") from None


def judged_result(result):
    summary, noise = summary_of(result["rows"]), result["noise"]
    if not summary:
        raise ValueError("no rows")
    words = {"equal": "Moderate gains, the same for all.",
             "tuned": "Found for each by the same search on other trajectories and seeds."}
    sets = list(dict.fromkeys(each["gains"] for each in summary))
    recoveries = list(dict.fromkeys(each["condition"] for each in result["series"]))
    half_s = 0.5 * result["duration_s"]
    figures = {
        "title": "Controllers in the loop",
        "plan": f"The vehicle that {result['model']} was made for: {result['airframe']}, {result['vehicle']}. Seeds 1 to "
                f"{result['seeds']}, flights of {result['duration_s']:.0f} s, errors of what comes after 10 s. What "
                f"controllers see has white noise of {noise['position_m']:g} m, {noise['velocity_m_s']:g} m/s, "
                f"{noise['attitude_rad']:g} rad, {noise['body_rates_rad_s']:g} rad/s and comes "
                f"{1e3 * result['delay_s']:g} ms late.",
        "summary": summary,
        "sections": [
            *({"name": f"{gains.capitalize()} gains", "words": words[gains], "told": True,
               "tables": tables_of(gains, summary, result["tuning"])} for gains in sets),
            *({"name": f"Recovery: {condition}", "words": "", "told": False, "tables": []}
              for condition in recoveries),
            {"name": "What flew", "words": "", "told": False, "tables": [
                {"name": name, "titles": [name[:-1], ""],
                 "lines": [[each["name"], each["summary"]] for each in result[name]]}
                for name in ("controllers", "conditions")]}]}

    def drawings():
        import report_charts  # here, since matplotlib takes a second: bad input is refused before

        made = {section["name"]: [] for section in figures["sections"]}
        for gains in sets:
            cells = [each for each in summary if each["gains"] == gains and each["rmse_cm"]]
            conditions = list(dict.fromkeys(each["condition"] for each in summary))
            errors = {}
            for each in cells:
                errors.setdefault(each["controller"], {})[each["condition"]] = each["rmse_cm"]["mean"]
            made[f"{gains.capitalize()} gains"].append(report_charts.marks(
                f"Errors, {gains} gains", "Position error of each controller under each condition",
                "RMSE of the position, cm", conditions, errors))
        for condition in recoveries:
            panels = {}
            for each in result["series"]:
                if each["condition"] == condition:
                    time = each["period_s"] * np.arange(len(each["error_cm"]))
                    near = (time >= half_s - 3) & (time <= half_s + 8)
                    panels.setdefault(f"{each['gains']} gains", {})[each["controller"]] = (
                        time[near], np.array(each["error_cm"])[near])
            made[f"Recovery: {condition}"].append(report_charts.lines(
                f"Recovery: {condition}", f"Position error over time under {condition}", "time, s", "error, cm",
                panels))
        return made

    return figures, drawings
