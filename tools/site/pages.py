#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Pages of the site before and after mkdocs. Called by scripts/heavy/site.

    pages.py point_inside PAGES   links to files and folders that are no pages become code font; notebooks are pages
    pages.py check HTML           each link of the site that stays in it leads to a page, and to a place of it

Exit code: 0; 1 with page: message for each fault.
"""
import html.parser
import re
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")


def point_inside(pages):
    """What the repository has and the site has not is named, not linked: a path in the tree."""
    for page in pages.rglob("*.md"):
        def named(match, folder=page.parent):
            text, target = match.groups()
            place = target.split("#")[0]
            if "://" in target or not place or (folder / place).is_file():
                return match[0]
            if place.endswith(".ipynb") and (folder / place).with_suffix(".md").is_file():
                return f"[{text}]({place[:-6]}.md)"
            path = (folder / place).resolve().relative_to(pages.resolve())
            if (pages / path / "README.md").is_file():
                return f"[{text}]({place.rstrip('/')}/README.md)"
            return text if f"`{path}`" == text or str(path) in text else f"{text} (`{path}`)"

        lines, fenced = [], False
        for line in page.read_text().splitlines():
            fenced ^= line.startswith("```")
            lines.append(line if fenced else LINK.sub(named, line))
        page.write_text("\n".join(lines) + "\n")
    return 0


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.places, self.targets = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif value and (name, tag) in (("href", "a"), ("src", "img"), ("src", "script"), ("href", "link")):
                self.targets.append(value)


def check(site):
    pages = {path: Page(path.read_text()) for path in site.rglob("*.html")}
    faults = 0
    for path, page in pages.items():
        for target in page.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc or target.startswith("javascript:") or path.name == "404.html":
                continue
            place = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            if place.is_dir():
                place /= "index.html"
            fault = "" if place.is_file() else "the link leads nowhere"
            inside = site / place.relative_to(site.resolve()) if not fault else None
            if not fault and parts.fragment and inside in pages and unquote(parts.fragment) not in pages[inside].places:
                fault = "no such place in the page"
            if fault and path.relative_to(site).parts[0] != "cpp":  # Doxygen's own
                print(f"{path.relative_to(site)}: {fault}: {target}")
                faults += 1
    print(f"{len(pages)} pages, {sum(len(page.targets) for page in pages.values())} links, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("point_inside", "check"):
        sys.exit(__doc__)
    sys.exit(globals()[sys.argv[1]](Path(sys.argv[2])))
