"""Prints a file of code for Doxygen: its comments link to lessons, derivations and equations."""

import re
import sys
from pathlib import Path

from links import EQUATION, link_equations


def link_comment(line: str) -> str:
    """The same line, its citations made links if it is documentation."""
    if not line.lstrip().startswith("///") and "///<" not in line:
        return line
    line = EQUATION.sub(lambda found: link_equations(found[0]), line)
    line = line.replace("Eq. ", "Eq.\\ ")  # for Doxygen, no end of the first sentence
    line = re.sub(r"(?<= )--(?=\w)", r"\\--", line)  # an option, no dash
    line = re.sub(r"docs/derivations/(\d\d)_\w+\.md", r"@ref derivation_\1", line)
    line = re.sub(r"docs/(gltf|animation)\.md", r"@ref \1", line)
    return re.sub(r"Introduced in (lesson (\d\d))", r"Introduced in [\1](lesson_\2.html)", line)


def main() -> None:
    sys.stdout.reconfigure(encoding="utf-8")
    file = Path(sys.argv[1])
    text = file.read_text(encoding="utf-8")
    for line in text.splitlines():
        print(link_comment(line))
    if file.suffix == ".cpp" and "@file" not in text:
        print(f"/// @file\n/// The code behind {file.stem}.hpp.")


if __name__ == "__main__":
    main()
