# SPDX-License-Identifier: MIT
"""What a study says of the paper: its tables (Gu, Primatesta, Rizzo: Physics-informed Neural Network for Quadrotor
Dynamical Modeling, Robotics and Autonomous Systems 171, 2024), pairs of models compared seed by seed, the claims of
Discussions 1-5, and how each is judged. A verdict is computed from the rows."""
import math
from collections import namedtuple
from dataclasses import dataclass, field
from statistics import fmean, stdev

import numpy as np

Model = namedtuple("Model", "structure batch_norm term data split")  # of Table 2; the split in % of the flight
LINEARIZED, VANILLA, INFORMED = "linearized model, Eq. (3)", "vanilla", "physics-informed"
CONSTANT, ANNEALED = "constant weight", "annealed"


def _pair(data, split):
    """A vanilla network and a physics-informed one, both with batch norm."""
    return [Model(VANILLA, True, None, data, split), Model(INFORMED, True, ANNEALED, data, split)]


# docs/paper.md, deviation 16: models 7-10 are printed alike; the caption of Fig. 7 tells them apart
TABLE_2 = dict(enumerate([
    Model(LINEARIZED, False, None, "D1", "– / – / 20"), Model(VANILLA, False, None, "D1", "60 / 20 / 20"),
    Model(INFORMED, False, CONSTANT, "D1", "60 / 20 / 20"), Model(INFORMED, False, ANNEALED, "D1", "60 / 20 / 20"),
    *_pair("D1", "60 / 20 / 20"), *_pair("D1, reduced", "20 / – / 40"), *_pair("D1, reduced", "20 / – / 80"),
    *_pair("D2", "60 / 20 / 20"), *_pair("D3", "60 / 20 / 20")], start=1))


def model_words(model):
    """As a table or a drawing names it."""
    entry = TABLE_2[model]
    return "linearized" if model == 1 else (entry.term or "vanilla") + ", BN" * entry.batch_norm


# The four figures of Table 3: column of rows.csv, and from its unit to the one shown.
Measure = namedtuple("Measure", "column label unit scale")
ERROR = Measure("mae", "mean absolute error", "e-3", 1e3)
ANGLES = [Measure(f"angle_difference_deg_{axis}", f"angle, {axis}", " deg", 1) for axis in ("roll", "pitch", "yaw")]
MEASURES = [ERROR, *ANGLES]
# Table 3 in the units of rows.csv, by model: (mean, deviation) of each measure. Model 1 has no deviations.
TABLE_3 = {model: dict(zip(MEASURES, entries)) for model, entries in enumerate([
    [(1.023e-1, 0), (1.321, 0), (6.327, 0), (9.200e-2, 0)],
    [(3.867e-3, 2.424e-4), (22.669, 4.603), (25.309, 4.626), (1.402, 0.466)],
    [(3.775e-3, 3.525e-4), (12.507, 1.666), (1.706, 1.498), (0.118, 9.611e-2)],
    [(3.493e-3, 3.296e-4), (16.550, 2.517), (23.543, 4.238), (0.463, 0.204)],
    [(2.625e-3, 1.160e-4), (26.409, 4.746), (28.281, 5.491), (0.499, 0.118)],
    [(2.480e-3, 1.030e-4), (24.337, 3.555), (28.604, 4.618), (0.273, 0.0677)],
    [(4.874e-3, 6.764e-4), (33.717, 4.994), (22.997, 4.762), (0.347, 0.142)],
    [(3.793e-3, 3.444e-4), (6.550, 1.546), (6.472, 1.478), (0.136, 4.227e-2)],
    [(5.981e-3, 1.190e-3), (40.489, 7.631), (23.196, 6.782), (0.269, 0.141)],
    [(4.405e-3, 6.185e-4), (12.053, 1.176), (1.171, 1.383), (0.316, 3.021e-2)],
    [(2.747e-4, 4.570e-5), (4.582, 1.829), (1.615, 0.796), (57.040, 11.849)],
    [(2.580e-4, 4.290e-5), (5.662, 2.031), (1.724, 0.631), (23.399, 5.521)],
    [(4.771e-3, 3.661e-4), (9.526, 4.686), (18.904, 5.065), (6.954, 0.997)],
    [(4.525e-3, 3.087e-4), (5.754, 3.315), (16.587, 3.202), (1.729, 0.716)]], start=1)}
# docs/paper.md, deviation 19: a leading digit may be lost. They are marked, and no claim is judged by them.
SUSPECT = {(3, ANGLES[1]), (10, ANGLES[1])}
PAIRS = [(2, 4), (2, 3), (3, 4), (5, 6), (7, 8), (9, 10), (11, 12), (13, 14)]  # baseline, candidate
EPOCHS, SEEDS = 300, 20  # Sec. 5, and a study's default
VANILLA_S, INFORMED_S = 234, 373  # Sec. 5.4: a training of models 2 and 4, PyTorch with CUDA on a laptop's RTX 3060

SIGNIFICANCE = 0.05
FEWEST_SEEDS = 6  # below, no exact p-value can fall below 0.05, and a mean is of too few trainings for a yes or a no
MOST_PAIRS = 500  # the exact test costs their cube


def mean_and_deviation(values):
    """NaN where undefined: the mean of none, the deviation of fewer than two."""
    return fmean(values) if values else math.nan, stdev(values) if len(values) > 1 else math.nan


def _paper_ratio(candidate, baseline, measure):
    return TABLE_3[candidate][measure][0] / TABLE_3[baseline][measure][0]


def paper_change(pair, measure):
    """Relative change of the paper's means; None where an entry is suspect."""
    return None if any((model, measure) in SUSPECT for model in pair) else _paper_ratio(pair[1], pair[0], measure) - 1


class Paired:
    """Candidate against baseline on the same seeds, lower is better. Exact two-sided Wilcoxon signed-rank test: zeros
    are dropped, equal differences share their mid-rank (which scipy.stats.wilcoxon has no exact distribution for). With
    n decided pairs p is never below 2^(1-n). `effect`: matched-pairs rank biserial, +1 if the candidate always wins."""

    def __init__(self, candidate, baseline):
        difference = np.subtract(candidate, baseline)
        self.pairs, self.wins = len(difference), int((difference < 0).sum())
        self.losses = int((difference > 0).sum())
        self.ties = self.pairs - self.wins - self.losses
        self.candidate_mean, self.baseline_mean = fmean(candidate), fmean(baseline)
        self.mean_difference = fmean(difference)
        self.change = self.mean_difference / abs(self.baseline_mean) if self.baseline_mean else math.nan
        self.p, self.effect = 1.0, 0.0
        difference = difference[difference != 0]
        if len(difference):
            _, group, count = np.unique(np.abs(difference), return_inverse=True, return_counts=True)
            ranks = (2 * np.cumsum(count) - count + 1)[group]  # doubled, so that mid-ranks are whole numbers
            won, total = int(ranks[difference < 0].sum()), int(ranks.sum())
            chance = np.zeros(min(won, total - won) + 1)  # of each sum of ranks, with all signs equally likely
            chance[0] = 1
            for rank in ranks:
                chance[rank:] += chance[:-rank]
                chance /= 2
            self.p, self.effect = min(1.0, 2 * float(chance.sum())), (2 * won - total) / total
        sure = self.p < SIGNIFICANCE
        self.lower = self.mean_difference < 0
        self.says = (("better" if sure and self.effect > 0 else "lower, unsure") if self.lower else
                     "worse" if sure and self.effect < 0 else "not lower, unsure")


@dataclass
class Comparison:
    pair: tuple
    measure: Measure
    flight: tuple
    result: Paired
    changes: list  # each seed's, against the baseline's mean


def compare(study, pair, measure, flight=None, weights=None):
    """On the flight of Table 2 where none is named. None where the models' flights or weights differ, or no seed has
    both."""
    first = [study.flights.get(model, [None])[0] for model in pair]
    if flight is None and (None in first or first[0] != first[1]):
        return None
    flight, weights = flight or first[0], weights or study.weights
    if len({study.weights_of(model, flight, weights) for model in pair}) > 1:
        return None
    baseline, candidate = ({row.seed: row.figures[measure.column] for row in study.trainings(model, flight, weights)}
                           for model in pair)
    seeds = [seed for seed in candidate if seed in baseline and math.isfinite(candidate[seed] - baseline[seed])]
    if not 1 <= len(seeds) <= MOST_PAIRS:
        return None
    result = Paired([candidate[seed] for seed in seeds], [baseline[seed] for seed in seeds])
    mean = abs(result.baseline_mean) or math.nan
    return Comparison(pair, measure, flight, result, [(candidate[seed] - baseline[seed]) / mean for seed in seeds])


def all_comparisons(study):
    return [c for pair in PAIRS for measure in MEASURES if (c := compare(study, pair, measure))]


@dataclass
class FlightsComparison:
    """One pair and measure over further flights. Trainings of one flight share its rows, and are no independent
    witnesses of what another flight would give: across flights, a flight's mean over its seeds is one pair."""
    pair: tuple
    measure: Measure
    flights: list
    of_means: Paired  # each flight's mean, divided by its baseline's


def further_comparisons(study):
    """The main comparison, 4 against 2, on every measure; then the errors of the other pairs."""
    found = []
    for pair, measure in [(PAIRS[0], measure) for measure in MEASURES] + [(pair, ERROR) for pair in PAIRS[1:]]:
        flights = [c for flight in sorted(study.flights.get(pair[0], [])[1:])
                   if (c := compare(study, pair, measure, flight)) and c.result.baseline_mean > 0]
        if 1 <= len(flights) <= MOST_PAIRS:
            ratios = [c.result.candidate_mean / c.result.baseline_mean for c in flights]
            found.append(FlightsComparison(pair, measure, flights, Paired(ratios, [1.0] * len(ratios))))
    return found


# How claims are judged.

REPRODUCED, IN_PART, NOT_REPRODUCED, UNDECIDED, NOT_JUDGED = VERDICTS = (
    "reproduced", "in part", "not reproduced", "undecided", "not judged")
SUSPECT_WORDS = "suspect in the paper: not counted"


@dataclass
class Evidence:
    """A line of figures behind a verdict, with units; what does not apply is empty."""
    what: str
    says: str
    before: str = ""  # the first figure compared
    after: str = ""
    change: str = ""
    wins: str = ""  # seeds in which the second is lower
    p: str = ""
    paper: str = ""  # the change in the paper's Table 3


def text_of(pattern, value):
    return pattern % value if math.isfinite(value) else "-"


def percent(share):
    return text_of("%+.1f %%", 100 * share)


def mean_text(measure, value):
    return text_of("%.3f", measure.scale * value) + measure.unit


def pair_text(pair):
    return f"{pair[1]} against {pair[0]}"


@dataclass
class Judged:
    """Counts conditions: all of them reproduce a claim, some in part; where a figure is missing there is no verdict."""
    evidence: list = field(default_factory=list)
    verdict: str = NOT_JUDGED
    seeds: int = MOST_PAIRS  # the fewest that any of its figures has
    held: int = 0
    counted: int = 0
    missing: bool = False

    def mean(self, study, model, measure):
        """Over the seeds; None where there is none."""
        values = study.values(model, measure.column)
        if not values:
            return None
        if model > 1:  # the linearized model is not trained
            self.seeds = min(self.seeds, len(values))
        return fmean(values)

    def lacks(self, model):
        self.evidence.append(Evidence(f"model {model}", "missing"))
        self.missing = True

    def count(self, holds, what, *figures, paper):
        self.evidence.append(Evidence(what, "holds" if holds else "does not hold", *figures, paper=paper))
        self.held, self.counted = self.held + bool(holds), self.counted + 1

    def done(self):
        if not self.missing and self.counted:
            self.verdict = REPRODUCED if self.held == self.counted else IN_PART if self.held else NOT_REPRODUCED
        return self


def _cells(study, cells):
    """The rule of comparisons, COMPARED."""
    judged, says = Judged(), []
    for pair, measure in cells:
        c, what = compare(study, pair, measure), f"{pair_text(pair)}, {measure.label}"
        line = Evidence(what, "no seed has both models")
        if c:
            r, paper = c.result, paper_change(pair, measure)
            line = Evidence(what, r.says, mean_text(measure, r.baseline_mean), mean_text(measure, r.candidate_mean),
                            percent(r.change), f"{r.wins}/{r.pairs}", text_of("%.2g", r.p),
                            "" if paper is None else percent(paper))
        judged.evidence.append(line)
        if any((model, measure) in SUSPECT for model in pair):
            line.says = SUSPECT_WORDS
        elif c:
            judged.seeds = min(judged.seeds, r.pairs)
            says.append(r)
        else:
            judged.missing = True
    better, worse = (sum(r.says == word for r in says) for word in ("better", "worse"))
    if not judged.missing and says:
        judged.verdict = (REPRODUCED if better == len(says) else
                          IN_PART if 0 < better >= worse or all(r.lower for r in says) else NOT_REPRODUCED)
    return judged


def _errors(*pairs):
    return lambda study: _cells(study, [(pair, ERROR) for pair in pairs])


def _angles(*pairs):
    return lambda study: _cells(study, [(pair, measure) for pair in pairs for measure in ANGLES])


def _magnitude(study):
    judged, all_lower = Judged(), True
    linearized = judged.mean(study, 1, ERROR)
    if linearized is None:
        judged.lacks(1)
    for model in 2, 3, 4:
        network = judged.mean(study, model, ERROR)
        if network is None:
            judged.lacks(model)
        elif linearized is not None:
            all_lower = all_lower and network < linearized
            judged.count(linearized >= 10 * network, f"1 against {model}, {ERROR.label}", mean_text(ERROR, network),
                         mean_text(ERROR, linearized), text_of("%.1f times", _ratio(linearized, network)),
                         paper=text_of("%.1f times", _paper_ratio(1, model, ERROR)))
    judged.done()
    if judged.verdict == NOT_REPRODUCED and all_lower:
        judged.verdict = IN_PART
    return judged


def _linearized_angles(study):
    judged = Judged()
    if 1 not in study.flights:
        judged.lacks(1)
    for model in 2, 3, 4:
        for measure in ANGLES:
            one, network = judged.mean(study, 1, measure), judged.mean(study, model, measure)
            if network is None and measure == ANGLES[0]:
                judged.lacks(model)
            if one is None or network is None:
                continue
            line = (f"1 against {model}, {measure.label}", mean_text(measure, network), mean_text(measure, one),
                    percent(_ratio(one, network) - 1))
            if (model, measure) in SUSPECT:
                judged.evidence.append(Evidence(line[0], SUSPECT_WORDS, *line[1:]))
            else:
                judged.count(one < network, *line, paper=percent(_paper_ratio(1, model, measure) - 1))
    return judged.done()


def _ratio(one, other):
    return one / other if other else math.nan


def _best_model(study):
    judged = _cells(study, [((model, 6), ERROR) for model in range(2, 6)])
    if judged.verdict not in (NOT_JUDGED, REPRODUCED):
        means = {model: judged.mean(study, model, ERROR) for model in range(2, 7)}
        judged.verdict = IN_PART if all(means[6] < means[model] for model in range(2, 6)) else NOT_REPRODUCED
    return judged


def _means(condition, *pairs):
    """A condition on the means of a baseline and of a candidate, for each pair."""
    def judge(study):
        judged = Judged()
        for pair in pairs:
            baseline, candidate = means = [judged.mean(study, model, ERROR) for model in pair]
            if None in means:
                judged.lacks(pair[means.index(None)])
                continue
            judged.count(condition(baseline, candidate), f"{pair_text(pair)}, {ERROR.label}",
                         mean_text(ERROR, baseline), mean_text(ERROR, candidate),
                         percent(_ratio(candidate, baseline) - 1),
                         paper=percent(_paper_ratio(pair[1], pair[0], ERROR) - 1))
        return judged.done()
    return judge


def _larger_gain(study):
    judged, full, paper = Judged(), compare(study, (5, 6), ERROR), paper_change((5, 6), ERROR)
    if not full:
        judged.lacks(6 if 5 in study.flights else 5)
    for pair in (7, 8), (9, 10):
        reduced = compare(study, pair, ERROR)
        if not reduced:
            judged.lacks(pair[pair[0] in study.flights])
        if reduced and full:
            judged.seeds = min(judged.seeds, reduced.result.pairs, full.result.pairs)
            gain, of_full = reduced.result.change, full.result.change
            judged.count(gain < of_full and gain < 0, f"{pair_text(pair)}; on the full set 6 against 5",
                         percent(of_full), percent(gain), text_of("%+.1f points", 100 * (gain - of_full)),
                         paper=text_of("%+.1f points", 100 * (paper_change(pair, ERROR) - paper)))
    return judged.done()


COMPARED = ("reproduced: better (lower mean, p < 0.05) in every comparison. In part: better in one at least and worse "
            "(p < 0.05) in no more, or lower in every mean. Else not reproduced")
ONE_TRAINING = ". Models 9 and 10 are the trainings of 7 and 8, judged on more rows: one piece of evidence"
ALL_HOLD = "Reproduced: every condition holds. In part: some do. Else not reproduced"
DISCUSSIONS = ["the linearized model as baseline", "physics-informed loss and cyclical annealing", "batch norm",
               "the reduced data set", "ground effect and periodic wind"]
# The columns: two figures, and what lies between them.
Claim = namedtuple("Claim", "id statement rule judge columns", defaults=[("baseline", "candidate", "change")])
CLAIMS = [
    Claim("1.1", "Every network, vanilla or physics-informed, predicts commands at least ten times better than the "
          "linearized model.",
          "reproduced: the error of model 1 is at least 10 times the mean error of each of models 2, 3, 4. In part: of "
          "some, or every network is better by less. Else not reproduced", _magnitude,
          ("network", "linearized", "factor")),
    Claim("1.2", "The linearized model's ellipses lie closer to the target's than those of the networks: poor in "
          "error, good in slope.",
          "conditions: the angle difference of model 1 is below the mean of each of models 2, 3, "
          "4 about each axis. " + ALL_HOLD, _linearized_angles, ("network", "linearized", "change")),
    Claim("2.1", "The physics-informed networks (3: constant weight, 4: annealed) have a lower error than the vanilla "
          "network (2).", COMPARED, _errors((2, 3), (2, 4))),
    Claim("2.2", "Cyclical annealing (4) lowers the error further than a constant weight (3).", COMPARED,
          _errors((3, 4))),
    Claim("2.3", "The ellipses of the vanilla network (2) deviate more from the target's than those of the "
          "physics-informed network (4).", COMPARED, _angles((2, 4))),
    Claim("3.1", "The physics-informed network gains from batch norm (6 against 4).", COMPARED, _errors((4, 6))),
    Claim("3.2", "With annealing and batch norm, model 6 is the best on D1.", "reproduced: model 6 is better (lower "
          "mean error, p < 0.05) than each of models 2 to 5. In part: its mean error is the lowest. Else not "
          "reproduced", _best_model),
    Claim("3.3", "The vanilla network with batch norm (5) comes close to model 6: both are near saturation.",
          "reproduced: the mean error of model 5 is at most 10 % above that of model 6. Else not reproduced",
          _means(lambda six, five: five / six - 1 <= 0.10, (6, 5)), ("model 6", "model 5", "excess")),
    Claim("4.1", "On the reduced set the physics-informed networks have a lower error than the vanilla ones (8 against "
          "7, 10 against 9).", COMPARED + ONE_TRAINING, _errors((7, 8), (9, 10))),
    Claim("4.2", "That advantage is more pronounced than on the full set: physics helps most where data is scarce.",
          "conditions: the relative gain of 8 against 7, and of 10 against 9, exceeds that of 6 against 5. " +
          ALL_HOLD + ONE_TRAINING, _larger_gain, ("change, full set", "change, reduced set", "difference")),
    Claim("4.3", "On the reduced set the physics-informed networks are also more consistent with physics (ellipse "
          "angles).", COMPARED + ONE_TRAINING, _angles((7, 8), (9, 10))),
    Claim("4.4", "All networks lose accuracy when trained on the reduced set.",
          "conditions: the mean errors of 7 and 9 exceed that of 5, those of 8 and 10 that of 6. " + ALL_HOLD,
          _means(lambda full, reduced: reduced > full, (5, 7), (5, 9), (6, 8), (6, 10)),
          ("full set", "reduced set", "change")),
    Claim("5.1", "With ground effect (D2) the physics-informed network (12) has a lower error than the vanilla one "
          "(11).", COMPARED, _errors((11, 12))),
    Claim("5.2", "With periodic wind (D3) the physics-informed network (14) has a lower error than the vanilla one "
          "(13).", COMPARED, _errors((13, 14))),
    *(Claim(at, f"With {effect} the physics-informed network is more consistent with physics (ellipse angles).",
            COMPARED, _angles(pair))
      for at, effect, pair in [("5.3", "ground effect (D2)", (11, 12)), ("5.4", "periodic wind (D3)", (13, 14))])]


def judged_claims(study):
    """Every claim of Discussions 1-5 that figures can decide, in the paper's order, each with its verdict."""
    found = [(claim, claim.judge(study)) for claim in CLAIMS]
    for _, judged in found:
        if judged.seeds < FEWEST_SEEDS and judged.verdict != NOT_JUDGED:
            judged.verdict = UNDECIDED
    return found
