"""Installs packages of npm, for what makes the editor of the site's pages and its compiler."""

import shutil
import subprocess
import sys
from pathlib import Path


def install(npm: str, lock: Path, folder: Path) -> bool:
    """Installs in a folder what package-lock.json of another names; says so where npm cannot."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in ("package.json", "package-lock.json"):
        shutil.copy(lock / file, folder)
    command = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
    done = subprocess.run(command, cwd=folder, capture_output=True, encoding="utf-8")
    if done.returncode != 0:
        print(done.stderr.strip()[-2000:], file=sys.stderr)
        print(f"The site is made without the editor: npm could not install what its {lock.name} takes.")
    return done.returncode == 0
