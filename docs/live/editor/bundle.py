"""Makes the editor of the site's pages: bundle.py NPM FOLDER OUT.

npm installs in FOLDER what package-lock.json names; OUT is the folder of what a page loads. Where
npm cannot, OUT is left empty, and the site is made without the editor.
"""

import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent


def main() -> None:
    npm, folder, out = sys.argv[1], *map(Path, sys.argv[2:])
    shutil.rmtree(out, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    for file in ("package.json", "package-lock.json"):
        shutil.copy(HERE / file, folder)
    install = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
    installed = subprocess.run(install, cwd=folder, capture_output=True, encoding="utf-8")
    if installed.returncode != 0:
        print(installed.stderr.strip()[-2000:], file=sys.stderr)
        print("The site is made without the editor: npm could not install what it takes.")
        return
    sources = folder / "sources"  # what they import is looked for in the folders above them
    shutil.copytree(HERE, sources, dirs_exist_ok=True)
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
