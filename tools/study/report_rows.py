# SPDX-License-Identifier: MIT
"""What a study left in its folder, read for its report: study.json, rows.csv, series/. Bad input is a BadInput, one
line: `path:line:column: expected ..., found ...`."""
import json
import math
import re
from collections import namedtuple

MODELS = range(1, 15)  # of Table 2
AXES = ("roll", "pitch", "yaw")
FIGURES = [kind + motor for motor in ("", "_u1", "_u2", "_u3", "_u4") for kind in ("mae", "rmse", "r2")] + [
    f"{kind}_{axis}" for axis in AXES for kind in ("angle_difference_deg", "raw_angle_difference_deg", "slope_error",
                                                   "correlation", "target_correlation", "sign_violation_share")]
# what figures of a kind can be, by how their columns' names begin; one that is not here can be anything
RANGES = {**dict.fromkeys(("mae", "rmse", "validation_mae"), (0, math.inf, "an error of 0 or more")),
          **dict.fromkeys(("angle_difference", "raw_angle_difference"), (0, 180, "degrees from 0 to 180")),
          **dict.fromkeys(("correlation", "target_correlation"), (-1, 1, "a value from -1 to 1")),
          "r2": (-math.inf, 1, "at most 1"), "sign_violation_share": (0, 1, "a share from 0 to 1"),
          "training_s": (0, math.inf, "0 seconds or more")}
NUMBER = re.compile(r"-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
MOST_LEVELS = 64  # of brackets in study.json; a study has 4

Flight = namedtuple("Flight", "name seed")
Row = namedtuple("Row", "model flight seed epochs weights figures")  # a figure that is not finite is NaN


class BadInput(Exception):
    def __init__(self, path, line, column, expected, found):
        place = f"{path}" + "".join(f":{number}" for number in (line, column) if number)
        super().__init__(f"{place}: expected {expected}, found {found}")


def quoted(cell):
    shown = re.sub("[^ -~]", "?", cell[:40])
    return f'"{shown}{"..." * (len(cell) > 40)}"' if cell else "an empty cell"


def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise BadInput(path, 0, 0, "a readable file", f"none ({error.strerror})") from None


def read_text(path):
    content = read_bytes(path)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadInput(path, content.count(b"\n", 0, error.start) + 1, 0, "UTF-8 text", "other bytes") from None


def is_count(value):
    return type(value) is int and 0 <= value < 2**64


class Settings:
    """study.json: how the study was made. A report shows all of it, and needs none of it but that it is an object."""

    def __init__(self, path):
        self.all = read_object(path)
        kind = self.all.get("kind")
        if isinstance(kind, str) and kind != "table 2":
            raise BadInput(path, 0, 0, "a study of Table 2", f"one of kind {quoted(kind)}")
        self.weights = "best" if self.all.get("weights") == "best" else "final"  # which are judged
        seeds, epochs = self.all.get("seeds"), self.all.get("epochs")
        self.seeds = len(seeds) if isinstance(seeds, list) else seeds if is_count(seeds) else 0  # 0: it does not say
        self.epochs = epochs if is_count(epochs) else 0
        # the first of each name is Table 2's
        self.flights = [Flight(entry["name"], entry["seed"]) for entry in self._entries("flights")
                        if isinstance(entry, dict) and isinstance(entry.get("name"), str)
                        and is_count(entry.get("seed"))]
        if is_count(self.all.get("flight_seed")):
            self.flights.sort(key=lambda flight: flight.seed != self.all["flight_seed"])
        self.models, self.splits = [], {}  # the splits: rows that train, validate, test
        for entry in self._entries("models"):
            facts = entry if isinstance(entry, dict) else {"id": entry}
            model = facts.get("id")
            model = int(model) if isinstance(model, str) and re.fullmatch("[0-9]{1,2}", model) else model
            if type(model) is not int or model not in MODELS:
                continue
            self.models.append(model)
            split = [facts.get(f"{part}_rows") for part in ("train", "validation", "test")]
            if all(map(is_count, split)):
                self.splits[model] = " / ".join(str(rows or "–") for rows in split)
        recipe = self.all.get("recipe")

        def number(key, least, most, otherwise):
            value = recipe.get(key) if isinstance(recipe, dict) else None
            return value if type(value) in (int, float) and least <= value <= most else otherwise

        self.lambda_max, self.cycles, self.hold = (
            number("lambda_max", 1e-9, 1e9, 0.1), int(number("cycles", 1, 1e6, 5)), number("hold", 0, 1, 0.5))

    def _entries(self, key):
        return self.all[key] if isinstance(self.all.get(key), list) else []

    def plans(self, model):
        return not self.models or model in self.models


def read_object(path):
    text, levels = read_text(path), 0

    def place(at):
        return text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)

    def no_number(word):
        raise BadInput(path, 0, 0, "JSON of numbers that a double holds", word[:40])

    def double(word):
        return float(word) if math.isfinite(float(word)) else no_number(word)

    for mark in re.finditer(r'"(?:[^"\\]|\\.)*"|[][{}]', text):  # before the parser, which descends once per level
        levels += {"[": 1, "{": 1, "]": -1, "}": -1}.get(mark[0], 0)
        if levels > MOST_LEVELS:
            raise BadInput(path, *place(mark.start()), f"JSON of at most {MOST_LEVELS} levels", "one nested deeper")
    try:
        value = json.loads(text, parse_float=double, parse_constant=no_number)
        json.dumps(value, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        found = "something else" if error.pos < len(text.rstrip()) else "its end"
        raise BadInput(path, *place(error.pos), "JSON", found) from None
    except ValueError as error:  # half a surrogate pair, a number of thousands of digits
        raise BadInput(path, 0, 0, "JSON", str(error).split(":")[0]) from None
    if not isinstance(value, dict):
        raise BadInput(path, 1, 1, "a JSON object", type(value).__name__)
    return value


class Table:
    """The lines of a CSV: iterating sets `line` and `cells`, by column. Columns by name in any order, others
    ignored."""

    def __init__(self, path, columns):
        self.path, self.line = path, 1
        *self._lines, self._unended = read_text(path).split("\n")
        if not self._lines and not self._unended:
            raise BadInput(path, 1, 0, "a header that names the columns", "an empty file")
        head = self._split((self._lines or [self._unended])[0])
        self._width, self._places = len(head), {}
        for name in columns:
            places = [at for at, cell in enumerate(head, start=1) if cell == name]
            if len(places) != 1:
                raise BadInput(path, 1, places[1] if places else 0, f"one column named {name}",
                               f"{len(places) or 'none'} among {len(head)} columns")
            self._places[name] = places[0]
        self.cut = False  # the last row is not whole: a run was killed while it wrote

    @staticmethod
    def _split(line):
        return [cell.strip(" \t") for cell in line.removesuffix("\r").split(",")]

    def __iter__(self):
        last = [self._unended] * (self._unended != "" and self._lines != [])
        for self.line, text in enumerate(self._lines[1:] + last, start=2):
            cells = self._split(text)
            if cells == [""] and self.line >= len(self._lines) and not last:
                return  # an empty line at the end
            if len(cells) != self._width and last and self.line == len(self._lines) + 1:
                self.cut = True
                return
            if len(cells) != self._width:
                raise BadInput(self.path, self.line, min(len(cells), self._width) + 1,
                               f"{self._width} fields as in the header", len(cells))
            self.cells = {name: cells[at - 1] for name, at in self._places.items()}
            yield self.cells

    def refuse(self, column, expected):
        raise BadInput(self.path, self.line, self._places[column], f"{expected} in column {column}",
                       quoted(self.cells[column]))

    def count(self, column, least, most, expected):
        cell = self.cells[column]
        if not re.fullmatch("[0-9]{1,20}", cell) or not least <= int(cell) <= most:
            self.refuse(column, expected)
        return int(cell)

    def number(self, column):
        cell = self.cells[column]
        if not NUMBER.fullmatch(cell) or math.isinf(float(cell)):
            self.refuse(column, "a number")
        return float(cell)

    def figure(self, column):
        """NaN where it is not finite (a training that diverged, a share of nothing), else within what its kind can
        be."""
        if self.cells[column].removeprefix("-") in ("nan", "inf"):
            return math.nan
        value, spare = self.number(column), 1e-9  # of a quotient's rounding
        anything = (-math.inf, math.inf, "")
        least, most, words = next((RANGES[kind] for kind in RANGES if column.startswith(kind)), anything)
        if not least - spare <= value <= most + spare:
            self.refuse(column, words)
        return value


def read_rows(path, settings):
    """The rows, and whether a last one was cut off. A row that the study cannot have written is refused."""
    figures = [*FIGURES, "validation_mae", "training_s"]
    table = Table(path, ["model", "flight", "flight_seed", "seed", "epochs", "weights", *figures])
    rows, lines, most = [], {}, 2**64 - 1
    for cells in table:
        model = table.count("model", 1, MODELS[-1], "a model of Table 2, 1 to 14,")
        if not settings.plans(model):
            table.refuse("model", "a model of study.json")
        if not cells["flight"]:
            table.refuse("flight", "a flight's name")
        flight = Flight(cells["flight"], table.count("flight_seed", 0, most, "a seed"))
        if settings.flights and flight not in settings.flights:
            table.refuse("flight_seed", f"the seed of a flight {flight.name} of study.json")
        seed, epochs = table.count("seed", 0, most, "a seed"), table.count("epochs", 0, 10**6, "a number of epochs")
        if settings.epochs not in (0, epochs) and (model > 1 or epochs > 0):  # model 1 is not trained
            table.refuse("epochs", f"the epochs of study.json, {settings.epochs},")
        if cells["weights"] not in ("final", "best"):
            table.refuse("weights", "final or best")
        row = Row(model, flight, seed, epochs, cells["weights"], {name: table.figure(name) for name in figures})
        for one, other in ((f"mae{motor}", f"rmse{motor}") for motor in ("", "_u1", "_u2", "_u3", "_u4")):
            undefined = [name for name in (one, other) if math.isnan(row.figures[name])]
            if len(undefined) == 1:  # where commands are not finite neither error is
                table.refuse(undefined[0], f"a finite error beside a finite {other if undefined[0] == one else one}")
        first = lines.setdefault((model, flight, seed, row.weights), table.line)
        if first != table.line:
            raise BadInput(path, table.line, 0, "one row per training", f"a second one (the first is line {first})")
        rows.append(row)
    if not rows:
        raise BadInput(path, 1, 0, "at least one finished training", "only the header")
    return rows, table.cut


def read_series(path):
    """{column: values} of the test block of one seed: flown and predicted commands beside the angular accelerations."""
    columns = "time_s wdot_x wdot_y wdot_z u1 u2 u3 u4 p1 p2 p3 p4".split()
    table = Table(path, columns)
    values = [[table.number(name) for name in columns] for _ in table]
    if len(values) < 3:
        raise BadInput(path, 0, 0, "3 rows or more", len(values))
    return dict(zip(columns, zip(*values)))


class Study:
    """Rows with the choices that make a report: the flight that a model is judged on first, and which weights."""

    def __init__(self, rows, settings):
        self.rows, self.weights = rows, settings.weights
        self._runs = {}
        for row in sorted(rows, key=lambda row: row.seed):
            self._runs.setdefault((row.model, row.flight, row.weights), []).append(row)
        flights = dict.fromkeys([*settings.flights, *(row.flight for row in rows)])
        # a model's first flight is the first of study.json that it has rows for; the rest are further ones
        flown = {(row.model, row.flight) for row in rows}
        self.flights = {model: found for model in MODELS if (found := [f for f in flights if (model, f) in flown])}
        self.expected = sorted({row.seed for row in rows if row.model > 1 and row.flight == self.flights[row.model][0]})

    def weights_of(self, model, flight, choice):
        """Final weights for the reduced sets (docs/paper.md, deviation 16: two of them leave no validation data), the
        choice elsewhere; the other kind where there is no other."""
        wanted = "final" if 7 <= model <= 10 else choice
        other = "best" if wanted == "final" else "final"
        return other if (model, flight, wanted) not in self._runs and (model, flight, other) in self._runs else wanted

    def trainings(self, model, flight=None, choice=None):
        """By seed; on the model's first flight where none is named."""
        if flight is None:
            flight = self.flights.get(model, [None])[0]
        return self._runs.get((model, flight, self.weights_of(model, flight, choice or self.weights)), [])

    def values(self, model, figure):
        """Over the seeds on its first flight, those that are finite."""
        return [row.figures[figure] for row in self.trainings(model) if math.isfinite(row.figures[figure])]
