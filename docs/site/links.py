"""Where things are on the site, for the texts and for the comments in the code."""

import re
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LESSONS = sorted(folder.name for folder in (ROOT / "lessons").glob("[0-9][0-9]_*"))
FILES = Counter(file.name for file in (ROOT / "lessons").glob("[0-9][0-9]_*/*.[ch]pp"))
# Equations of pages beside the way, by their numbers: the name of the page.
BESIDE = {
    tuple(number.split(".")): page.stem
    for page in (ROOT / "lessons").glob("[0-9][0-9]_*/[a-z]*.md")
    for number in re.findall(r"\\tag\{([\d.]+)\}", page.read_text(encoding="utf-8"))
}
EQUATION = re.compile(r"\bEq\. \d+\.\d+(?:(?:, | and )\d+\.\d+)*")


def page_of(chapter: str, number: str) -> str:
    """The name of the page that an equation stands on."""
    return BESIDE.get((chapter, number), f"derivation_{int(chapter):02}")


def link_equations(citation: str) -> str:
    """Makes links of "Eq. 1.3", or of each number in "Eq. 1.3 and 1.4"."""
    return re.sub(
        r"(?:Eq\. )?(\d+)\.(\d+)",
        lambda found: f"[{found[0]}]({page_of(found[1], found[2])}.html#eq_{found[1]}_{found[2]})",
        citation,
    )


def source_page(path: Path) -> str:
    """Doxygen's name for the page with a file's code: that of lessons/02_x/main.cpp is
    02__x_2main_8cpp_source.html, since other lessons have a main.cpp too."""
    name = str(path.relative_to(ROOT / "lessons")) if FILES[path.name] > 1 else path.name
    escapes = {"_": "__", "/": "_2", ".": "_8"}
    return "".join(escapes.get(c, c) for c in name) + "_source.html"
