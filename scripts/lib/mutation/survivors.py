# SPDX-License-Identifier: MIT
"""The table of a mutation run, and the list of its survivors, in which a reader claims that one is equivalent, and why."""
import re

from mutation.tree import HEADERS, write_whole

SURVIVORS, CLAIMED = "## Survivors", "## Claimed equivalent"
_ENTRY = re.compile(r"- `([0-9a-f]{10})`")
_KILLED = ("killed", "did not compile", "time limit")

_HEAD = """# Mutants that no test notices

Written by `scripts/mutation` (seed {seed}, {count} mutants). A survivor is a missing test, or an edit that no test could notice:
then move its entry to the second list and add a line `Reason: ...`. It is recognised by its key for as long as its line is the
same; a claim whose mutant is killed fails the run.

```text
{table}
```
"""


class BadList(Exception):
    """One line: file, line, what was expected."""


class Claims:
    """Key -> the text of its entry in the list of claimed equivalents."""

    def __init__(self):
        self.entries = {}

    @classmethod
    def read(cls, path):
        claims = cls()
        if not path.exists():
            return claims
        key, section, at = None, "", 0
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if line.startswith("## "):
                section, key = line, None
            elif section == CLAIMED and line.strip():
                entry = _ENTRY.match(line)
                if entry:
                    claims.expect_reason(path, key, at)
                    key, at = entry[1], number
                    claims.entries[key] = []
                elif key is None or not line.startswith("  "):
                    raise BadList(f"{path}:{number}: expected an entry '- `key` ...' or its indented lines")
                claims.entries[key].append(line)
        claims.expect_reason(path, key, at)
        return claims

    def expect_reason(self, path, key, number):
        if key is not None and not any(re.match(r"  Reason: \S", line) for line in self.entries[key]):
            raise BadList(f"{path}:{number}: expected a line '  Reason: ...' for {key}")

    def reason(self, key):
        """From the line with the reason on."""
        lines = self.entries[key]
        return lines[next(n for n, line in enumerate(lines) if line.startswith("  Reason: ")):]


def entry(mutant):
    return f"- `{mutant.key}` `{HEADERS}/{mutant.path}:{mutant.line}`, {mutant.rule}:\n  {mutant.says()}"


def table_of(sample, entries, claims):
    """Lines of the table, and the score in percent: killed of all that are not claimed equivalent."""
    heads = ("room", "mutants", "killed", "no compile", "time limit", "survived", "equivalent", "score")
    rooms = {}
    for mutant in sample:
        if mutant.key not in entries:
            continue
        row = rooms.setdefault(mutant.room, dict.fromkeys((*_KILLED, "survived", "equivalent"), 0))
        verdict = entries[mutant.key]["verdict"]
        row["equivalent" if verdict == "survived" and mutant.key in claims.entries else verdict] += 1
    rooms["all"] = {column: sum(row[column] for row in rooms.values())
                    for column in (*_KILLED, "survived", "equivalent")}
    lines = ["  ".join([f"{heads[0]:15}", *(f"{head:>10}" for head in heads[1:])])]
    score = 100.0
    for room, row in rooms.items():
        killed = sum(row[verdict] for verdict in _KILLED)
        score = 100.0 * killed / (killed + row["survived"]) if killed + row["survived"] else 100.0
        cells = [sum(row.values()), row["killed"], row["did not compile"], row["time limit"], row["survived"],
                 row["equivalent"]]
        lines.append("  ".join([f"{room:15}", *(f"{cell:10}" for cell in cells), f"{score:8.1f} %"]))
    row = rooms["all"]
    compiled = row["killed"] + row["time limit"]
    if compiled + row["survived"]:
        lines.append(f"score of those that compiled: {100.0 * compiled / (compiled + row['survived']):.1f} %")
    return lines, score


def write_list(path, sample, entries, claims, by_key, seed):
    """Writes the list, prints the table: (score, keys of claims that are wrong)."""
    table, score = table_of(sample, entries, claims)
    print("\n".join(table))
    survivors = [mutant for mutant in sample if entries.get(mutant.key, {}).get("verdict") == "survived"]
    text = _HEAD.format(seed=seed, count=len(entries), table="\n".join(table))
    text += f"\n{SURVIVORS}\n\n"
    for mutant in survivors:
        if mutant.key not in claims.entries:
            by = entries[mutant.key]["by"]
            text += entry(mutant) + (f"\n  ({by})" if by else "") + "\n"
    text += f"\n{CLAIMED}\n\n"
    for key in claims.entries:
        head = [entry(by_key[key])] if key in by_key else claims.entries[key][:-len(claims.reason(key))]
        text += "\n".join([*head, *claims.reason(key)]) + "\n"
    write_whole(path, text)
    return score, [key for key in claims.entries if entries.get(key, {}).get("verdict") in _KILLED]
