"""Makes the scripts of a page that draws; pages opened from a folder can load nothing else.

bundle.py data OUT FILE            a program or a scene: compressed, as text, under the name of OUT
bundle.py page OUT SCRIPT... PAGE  a page's script, with what its worker runs as text
"""

import base64
import gzip
import json
import sys
from pathlib import Path

kind, out, *files = sys.argv[1], *map(Path, sys.argv[2:])
if kind == "data":
    text = base64.b64encode(gzip.compress(files[0].read_bytes(), 9, mtime=0)).decode()
    out.write_text(f"(window.liveTexts ??= {{}})[{json.dumps(out.stem)}] = {json.dumps(text)};\n")
else:
    *scripts, page = [file.read_text(encoding="utf-8") for file in files]
    out.write_text(
        f"{{\nconst workerSource = {json.dumps(''.join(scripts))};\n{page}}}\n", encoding="utf-8"
    )
