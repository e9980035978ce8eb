"""Makes the editor of the site's pages: bundle.py NPM FOLDER OUT.

npm installs in FOLDER what package-lock.json names; OUT is the folder of what a page loads. Where
npm cannot, OUT is left empty, and the site is made without the editor.
"""

import shutil
import subprocess
import sys
from pathlib import Path

from npm import install

HERE = Path(__file__).parent


def main() -> None:
    npm, folder, out = sys.argv[1], *map(Path, sys.argv[2:])
    shutil.rmtree(out, ignore_errors=True)
    if not install(npm, HERE, folder):
        return
    sources = folder / "sources"  # what they import is looked for in the folders above them
    shutil.copytree(HERE, sources, dirs_exist_ok=True)
    shutil.copy(HERE.parent / "compiler/read_picture.js", sources)
    options = ["--bundle", "--format=esm", "--minify", "--legal-comments=eof", "--log-level=warning"]
    esbuild = folder / "node_modules/esbuild/bin/esbuild"
    made = folder / "editor.js"
    command = ["node", esbuild, sources / "editor.js", *options, f"--outfile={made}"]
    subprocess.run(command, check=True)
    out.mkdir(parents=True)
    shutil.copy(made, out)
    shutil.copy(HERE / "editor.css", out)


if __name__ == "__main__":
    main()
