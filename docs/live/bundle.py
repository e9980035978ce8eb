"""Makes the scripts of a page that draws; pages opened from a folder can load nothing else.

bundle.py data OUT FILE            a program or a scene: compressed, as text, under the name of OUT
bundle.py figure OUT FILE SCRIPT   a figure's program and script; OUT is figure_NAME.js
bundle.py page OUT SCRIPT... PAGE  a page's script, with what its worker runs as text
"""

import base64
import gzip
import json
import sys
from pathlib import Path


def text_of(file: Path) -> str:
    """As atob() and DecompressionStream("gzip") read it."""
    return json.dumps(base64.b64encode(gzip.compress(file.read_bytes(), 9, mtime=0)).decode())


def main() -> None:
    kind, out, *files = sys.argv[1], *map(Path, sys.argv[2:])
    if kind == "data":
        text = f"(window.liveTexts ??= {{}})[{json.dumps(out.stem)}] = {text_of(files[0])};\n"
    elif kind == "figure":
        module, script = files
        text = f"figureModules.{script.stem} = {text_of(module)};\n{script.read_text(encoding='utf-8')}"
    else:
        *scripts, page = [file.read_text(encoding="utf-8") for file in files]
        text = f"{{\nconst workerSource = {json.dumps(''.join(scripts))};\n{page}}}\n"
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
