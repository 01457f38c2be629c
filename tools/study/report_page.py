# SPDX-License-Identifier: MIT
"""Every report: figures in the page's signs, the page around its body, files written all or none."""
import contextlib
import html
import json
import math
import os
import re
from pathlib import Path

import jinja2

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "page"


def shown(value, decimals, plus=False):
    return f"{value:{'+' * plus}.{decimals}f}".replace("-", "−") if math.isfinite(value) else "–"


def quantity(text):
    text = "−" + text[1:] if text.startswith("-") else text
    return text.replace("e-3", "×10⁻³").replace(" deg", "°").replace(" %", "\u00a0%")


def shown_p(p):
    """Two significant figures; powers of ten below a thousandth."""
    if p >= 0.001:
        return f"{p:.{2 if p >= 0.1 else 3}f}"
    digits, power = f"{p:.1e}".split("e-")
    return digits + "×10⁻" + str(int(power)).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))


def whole_page(template, figures, drawings):
    def without_control(value):  # HTML has no place for them
        return re.sub(r"[\x00-\x1f\x7f]", " ", value) if type(value) is str else value

    body = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined,
                              finalize=without_control).from_string((HERE / template).read_text())
    parts = {"title": html.escape(figures["title"]), "body": body.render(figures, drawings=drawings),
             "style": "".join(path.read_text() for path in (PAGE / "palette.css", PAGE / "text.css", HERE / "report.css"))}
    return re.sub(r"\{\{\{?(\w+)\}?\}\}", lambda name: parts[name[1]], (PAGE / "page.html").read_text())


def json_file(figures):
    """What is not finite is null: JSON has no word for it."""

    def finite(value):
        if isinstance(value, dict):
            return {key: finite(entry) for key, entry in value.items()}
        if isinstance(value, (list, tuple)):
            return [finite(entry) for entry in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    return json.dumps(finite(figures), indent=2, ensure_ascii=False) + "\n"


class BadOutput(Exception):
    pass


def write_all(folder, files):
    """All are whole beside their places before the first is put there; a link's target is replaced."""
    with contextlib.ExitStack() as abandoned:
        whole = []
        for name, text in files.items():
            path = folder / name
            target = path.resolve()
            partial = target.with_name(f"{target.name}.partial-{os.getpid()}")
            try:
                if target.is_dir() or target.exists() and not os.access(target, os.W_OK):
                    why = "a folder" if target.is_dir() else "write-protected"
                    raise BadOutput(f"cannot write {path}: it is {why}")
                abandoned.callback(partial.unlink, missing_ok=True)
                partial.write_text(text, encoding="utf-8")
            except OSError as error:
                raise BadOutput(f"cannot write {path}: {error.strerror}") from None
            whole.append((partial, target))
        for partial, target in whole:
            partial.replace(target)
