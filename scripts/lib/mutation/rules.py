# SPDX-License-Identifier: MIT
"""Edits of C++ text that a test should notice: made by rules, never by hand, and drawn by a seed.

Reads text laid out by this repository's .clang-format: a binary operator has a space on both sides, a template's bracket
and a sign have not. Comments, strings, preprocessor lines and what is never evaluated (decltype, noexcept) are left alone.
"""
import bisect
import hashlib
import re
from collections import defaultdict, namedtuple

RULES = {
    "comparison": "a comparison without its boundary, or turned round",
    "sign": "plus for minus, minus for plus, or a lost sign",
    "dropped term": "a sum, a product or a condition without one of its terms; an accumulation left out",
    "off by one": "a whole number one more or one less; a loop that ends one early",
    "constant": "a number doubled or a tenth larger; a flag turned; a bit of a mask",
    "removed": "a guard, a case's return or a call that is not there",
}

_TOKEN = re.compile(r"""
    (?P<directive> ^[ \t]*\#(?:\\[\s\S]|[^\\\n])* )
  | (?P<space>     \n|[^\S\n]+ )
  | (?P<comment>   //[^\n]*|/\*[\s\S]*?\*/ )
  | (?P<string>    (?:u8|[uUL])?R"(?P<raw>[^()\\\s]{0,16})\([\s\S]*?\)(?P=raw)"|(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*"
                 | (?:u8|[uUL])?'(?:[^'\\\n]|\\.)+' )
  | (?P<number>    \.?\d(?:[eEpP][+-]|'?[\w.])* )
  | (?P<word>      [A-Za-z_]\w* )
  | (?P<mark>      <<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|>>|[<>=!+\-*/%&|^]=|&&|\|\||. )
""", re.VERBOSE | re.MULTILINE)

_STRENGTH = {"||": 1, "&&": 2, "|": 3, "^": 4, "&": 5, "==": 6, "!=": 6, "<": 7, ">": 7, "<=": 7, ">=": 7, "<<": 8,
             ">>": 8, "+": 9, "-": 9, "*": 10, "/": 10, "%": 10}
_CLOSES = {")": "(", "]": "[", "}": "{"}
_ENDS = {",", ";", "?", ":", "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
_NO_OPERAND = {"return", "case", "throw", "else", "do", "operator", "template", "typename", "class", "if", "while", "for"}
_UNEVALUATED = {"decltype", "noexcept", "alignas", "alignof", "sizeof", "__attribute__", "asm"}
_NO_CALL = _NO_OPERAND | _UNEVALUATED | {"static_assert", "static_cast", "switch", "using", "delete", "new", "defined", "constexpr"}
_COMPARISONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
_LEAVES = {"return", "throw", "break", "continue"}


class Mutant(namedtuple("Mutant", "path room rule line start end old new code column key")):
    """One edit: text[start:end], which is old, becomes new. code is the line where it starts, column its place in there. The
    key is the same as long as that line is, wherever it moves."""
    __slots__ = ()

    def applied(self, text):
        return text[:self.start] + self.new + text[self.end:]

    def says(self):
        """The edit in one line of Markdown."""
        if "\n" in self.old or self.new == "{}":
            old = re.sub(r"\s+", " ", re.sub(r"//.*", "", self.old)).strip()
            return f"without `{old if len(old) <= 160 else old[:157] + '...'}`"
        after = self.code[:self.column] + self.new + self.code[self.column + len(self.old):]
        return f"`{self.code}` becomes `{re.sub(' +', ' ', after).strip()}`"


class _Code:
    """The tokens that mean something, their brackets matched."""

    def __init__(self, text):
        self.text, self.kind, self.token, self.start, self.end, self.before, self.after = text, [], [], [], [], [], []
        apart = True
        for match in _TOKEN.finditer(text):
            kind = match.lastgroup if match.lastgroup != "raw" else "string"
            if kind in ("space", "comment", "directive"):
                if self.after:
                    self.after[-1] = True
                apart = True
                continue
            token, start = match.group(), match.start()
            pieces = [token]
            if token == ">>" and not apart:  # closes two templates
                pieces = [">", ">"]
            for piece in pieces:
                self.kind.append(kind)
                self.token.append(piece)
                self.start.append(start)
                self.end.append(start + len(piece))
                self.before.append(apart)
                self.after.append(False)
                start += len(piece)
                apart = False
        self._match()

    def _match(self):
        count = len(self.token)
        self.partner, self.inside = [None] * count, [None] * count
        stack = []
        for i, token in enumerate(self.token):
            if self.kind[i] != "mark":
                self.inside[i] = stack[-1] if stack else None
                continue
            if token == ">" and not self.before[i] and stack and self.token[stack[-1]] == "<":
                self._close(stack.pop(), i)
            elif token in _CLOSES:
                while stack and self.token[stack[-1]] != _CLOSES[token]:
                    stack.pop()  # what looked like a template's bracket
                if stack:
                    self._close(stack.pop(), i)
            self.inside[i] = stack[-1] if stack else None
            if token in "([{" or (token == "<" and not (self.before[i] and self.after[i]) and i
                                  and (self.kind[i - 1] == "word" and self.token[i - 1] != "operator")):
                stack.append(i)

    def _close(self, opening, closing):
        self.partner[opening], self.partner[closing] = closing, opening

    def ends_operand(self, i):
        """May the token before an operator be the end of what it works on?"""
        if i < 0:
            return False
        if self.kind[i] in ("number", "string"):
            return True
        if self.kind[i] == "word":
            return self.token[i] not in _NO_OPERAND
        return self.token[i] in (")", "]", "}") or (self.token[i] == ">" and self.partner[i] is not None)

    def is_binary(self, i):
        return (self.kind[i] == "mark" and self.token[i] in _STRENGTH and self.before[i] and self.after[i]
                and self.partner[i] is None and self.ends_operand(i - 1))

    def is_left_alone(self, i):
        """Inside what is never evaluated, or an attribute?"""
        opening = self.inside[i]
        while opening is not None:
            if opening and self.token[opening] == "(" and self.token[opening - 1] in _UNEVALUATED:
                return True
            if self.token[opening] == "[" and self.token[opening + 1:opening + 2] == ["["]:
                return True
            opening = self.inside[opening]
        return False

    def right_end(self, i):
        """Index of the last token of the binary operator's right operand."""
        j = i + 1
        while j < len(self.token):
            if self.kind[j] == "mark":
                token = self.token[j]
                if self.partner[j] is not None and self.partner[j] > j:
                    j = self.partner[j] + 1
                    continue
                if token in _CLOSES or token in _ENDS or (token == ">" and self.partner[j] is not None):
                    break
                if self.is_binary(j) and _STRENGTH[token] <= _STRENGTH[self.token[i]]:
                    break
            j += 1
        return j - 1

    def left_start(self, i):
        """Index of the first token of the left operand, None where the operator is not the first of its chain."""
        j = i - 1
        while j >= 0:
            token = self.token[j]
            if self.kind[j] == "word" and token in _NO_OPERAND:
                break
            if self.kind[j] == "mark":
                if self.partner[j] is not None and self.partner[j] < j:
                    j = self.partner[j] - 1
                    continue
                if token in "([{" or token in _ENDS or (token == "<" and self.partner[j] is not None):
                    break
                if self.is_binary(j) and _STRENGTH[token] <= _STRENGTH[self.token[i]]:
                    if _STRENGTH[token] == _STRENGTH[self.token[i]]:
                        return None
                    break
            j -= 1
        return j + 1

    def statement_end(self, i):
        """Index of the semicolon, or closing brace of a block, that ends the statement starting at i; None if in doubt."""
        if self.token[i] == "{":
            return self.partner[i]
        while i < len(self.token):
            if self.kind[i] == "mark":
                if self.token[i] == ";":
                    return i
                if self.token[i] in _CLOSES:
                    return None
                if self.partner[i] is not None and self.partner[i] > i:
                    i = self.partner[i]
            i += 1
        return None


def _comparisons(code, i):
    if code.is_binary(i):
        for new in _COMPARISONS.get(code.token[i], ()):
            yield code.start[i], code.end[i], new


def _signs(code, i):
    token = code.token[i]
    if token in ("+", "-") and code.is_binary(i):
        if "string" not in (code.kind[i - 1], code.kind[i + 1]):
            yield code.start[i], code.end[i], "-" if token == "+" else "+"
    elif token in ("+=", "-="):
        yield code.start[i], code.end[i], "-=" if token == "+=" else "+="
    elif token == "-" and code.kind[i] == "mark" and not code.after[i] and not code.ends_operand(i - 1):
        yield code.start[i], code.end[i], ""


def _dropped_terms(code, i):
    token = code.token[i]
    if token in ("+", "-", "*", "/", "%", "&&", "||") and code.is_binary(i):
        yield code.end[i - 1], code.end[code.right_end(i)], ""
        left = code.left_start(i)
        if token in ("+", "-", "*", "&&", "||") and left is not None and left < i:
            yield code.start[left], code.start[i + 1], "-" if token == "-" else ""
    elif token in ("+=", "-=", "*=", "/=", "|=", "&=") and code.kind[i] == "mark":
        start = i - 1
        while start >= 0 and not (code.kind[start] == "mark" and code.token[start] in ("{", "}", ";", ")", "(", ",")):
            start = code.partner[start] - 1 if code.token[start] in ("]",) else start - 1
        if start >= 0 and (code.token[start] in ("{", "}", ";") or (code.token[start] == ")" and code.before[start + 1])):
            end = code.statement_end(i)
            if end is not None and code.inside[end] == code.inside[i]:
                yield code.start[start + 1], code.end[end], "{}"


_WHOLE = re.compile(r"(\d[\d']*)([uUlLzZ]*)$")


def _is_template_argument(code, i):
    """Nothing but the literal between a template's bracket and the next comma or bracket?"""
    opening = code.inside[i]
    return (opening is not None and code.token[opening] == "<" and code.token[i - 1] in ("<", ",")
            and code.token[i + 1] in (",", ">"))


def _is_extent(code, i):
    """The literal in `Type name[3]`, or `= 0` of a pure virtual function?"""
    if code.token[i - 1] == "[" and i >= 3 and code.kind[i - 2] == "word" and code.token[i - 3] not in _NO_OPERAND:
        return code.kind[i - 3] == "word" or (code.token[i - 3] == ">" and code.partner[i - 3] is not None)
    return code.token[i - 1] == "=" and code.token[i - 2] in (")", "const", "noexcept", "override")


def _off_by_one(code, i):
    if code.kind[i] == "number":
        whole = _WHOLE.match(code.token[i])
        if whole and not _is_template_argument(code, i) and not _is_extent(code, i):
            value = int(whole.group(1).replace("'", ""), 8 if re.match(r"0\d", whole.group(1)) else 10)
            yield code.start[i], code.end[i], f"{value + 1}{whole.group(2)}"
            if value > 0:
                yield code.start[i], code.end[i], f"{value - 1}{whole.group(2)}"
    elif code.token[i] in ("<", "<=") and code.is_binary(i):
        opening = code.inside[i]
        if opening and code.token[opening] == "(" and code.token[opening - 1] == "for":
            yield code.end[i - 1], code.end[i - 1], " + 1"


def _constants(code, i):
    token = code.token[i]
    if token in ("true", "false") and code.kind[i] == "word":
        if not _is_template_argument(code, i):
            yield code.start[i], code.end[i], "false" if token == "true" else "true"
    elif code.kind[i] == "number" and not _WHOLE.match(token):
        suffix = re.search(r"[uUlLzZ]*$" if token[:2].lower() in ("0x", "0b") else r"[fFlL]?$", token).group()
        digits = token[:len(token) - len(suffix)].replace("'", "")
        if "p" not in digits.lower() and re.match(r"0[xX]", digits):
            yield code.start[i], code.end[i], f"{int(digits, 16) ^ 1:#x}{suffix}"
        elif re.match(r"0[bB]", digits):
            yield code.start[i], code.end[i], f"{int(digits, 2) ^ 1:#b}{suffix}"
        else:
            value = float.fromhex(digits) if digits[:2].lower() == "0x" else float(digits)
            for new in (1.0,) if value == 0 else (2 * value, 1.1 * value):
                if new != float("inf"):
                    yield code.start[i], code.end[i], f"{new!r}{suffix}"


def _ends_by_leaving(code, opening):
    """Is the last statement of the block that opens here one that leaves it?"""
    last = code.partner[opening] - 1
    if code.token[last] != ";":
        return False
    j = last - 1
    while j > opening and not (code.token[j] in (";", "{", "}") and code.kind[j] == "mark" and code.partner[j] != last):
        j = code.partner[j] - 1 if code.partner[j] is not None and code.partner[j] < j else j - 1
    return code.token[j + 1] in _LEAVES


def _removed(code, i):
    if code.kind[i] != "word":
        return
    token = code.token[i]
    if token == "if":
        opening = i + 2 if code.token[i + 1] == "constexpr" else i + 1
        if code.token[opening] != "(" or code.partner[opening] is None:
            return
        body = code.partner[opening] + 1
        end = code.statement_end(body)
        if end is None or code.token[end + 1:end + 2] == ["else"]:
            return
        guard = code.token[body] in _LEAVES or (code.token[body] == "{" and _ends_by_leaving(code, body))
        if guard or (code.token[body] != "{" and _call_end(code, body) == end):
            yield code.start[i], code.end[end], "{}"
    elif token == "return" and code.token[i - 1] == ":":
        end = code.statement_end(i)
        if end is not None:
            yield code.start[i], code.end[end], "{}"
    elif i and code.token[i - 1] in (";", "{", "}"):
        end = _call_end(code, i)
        if end is not None:
            yield code.start[i], code.end[end], "{}"


def _call_end(code, i):
    """Index of the semicolon where a statement that is nothing but a call starts at i, else None."""
    name = None
    while code.kind[i] == "word" and code.token[i] not in _NO_CALL:
        name = code.token[i]
        i += 1
        if code.token[i] == "<" and code.partner[i] is not None:
            i = code.partner[i] + 1
        while code.token[i] == "[" and code.partner[i] is not None:
            i = code.partner[i] + 1
        if code.token[i] == "(" and code.partner[i] is not None:
            closing = code.partner[i]
            if code.token[closing + 1] == ";":
                return closing + 1 if name[0].islower() else None
            i = closing + 1
        if code.token[i] not in (".", "->", "::"):
            return None
        i += 1
        if code.token[i] == "template":
            i += 1
    return None


_EDITS = {"comparison": _comparisons, "sign": _signs, "dropped term": _dropped_terms, "off by one": _off_by_one,
          "constant": _constants, "removed": _removed}


def mutants_of(text, path, room):
    """All mutants of one file, in the order of its text."""
    code = _Code(text)
    begins = [0] + [match.end() for match in re.finditer("\n", text)]
    lines = text.split("\n")
    seen = defaultdict(int)  # how often the same edit of the same line came before
    found = []
    for i in range(len(code.token)):
        if code.is_left_alone(i):
            continue
        for rule, edits in _EDITS.items():
            for start, end, new in edits(code, i):
                line = bisect.bisect_right(begins, start) - 1
                words = re.sub(r"\s*//.*", "", lines[line]).strip()
                old, column = text[start:end], start - begins[line] - lines[line].index(words)
                edit = (path, rule, words, column, old, new)
                identity = "\0".join(map(str, (*edit, seen[edit])))
                seen[edit] += 1
                found.append(Mutant(path, room, rule, line + 1, start, end, old, new, words, column,
                                    hashlib.sha256(identity.encode()).hexdigest()[:10]))
    return found


def _rank(seed, *words):
    return hashlib.sha256("\0".join((str(seed), *words)).encode()).digest()


def draw_order(mutants, seed):
    """The mutants of one room in the order of a draw: the rules take turns, the seed decides within a rule. An edit
    elsewhere in the room does not change the order of the others."""
    rules = defaultdict(list)
    for mutant in mutants:
        rules[mutant.rule].append(mutant)
    turns = []
    for rule, members in rules.items():
        members.sort(key=lambda mutant: _rank(seed, mutant.key))
        turns += [(place, _rank(seed, rule, members[0].room), mutant) for place, mutant in enumerate(members)]
    return [mutant for _, _, mutant in sorted(turns, key=lambda turn: turn[:2])]


def shares(candidates, total, least=5):
    """How many mutants each room gives: `least` (or all it has, or what is there for each), and of the rest as much as it has
    code. candidates: room -> number of its mutants."""
    least = min(least, total // len(candidates))
    share = {room: min(least, count) for room, count in candidates.items()}
    rest = total - sum(share.values())
    room_left = {room: count - share[room] for room, count in candidates.items()}
    whole = sum(room_left.values())
    if rest <= 0 or whole == 0:
        return share
    rest = min(rest, whole)
    exact = {room: rest * left / whole for room, left in room_left.items()}
    given = {room: int(part) for room, part in exact.items()}
    missing = rest - sum(given.values())
    by_remainder = sorted((room for room in exact if given[room] < room_left[room]),
                          key=lambda room: (given[room] - exact[room], room))
    for room in by_remainder[:missing]:
        given[room] += 1
    return {room: share[room] + given[room] for room in share}
