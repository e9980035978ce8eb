"""What the sandbox has at hand: the lessons' files, and of each exercise what its answer changes."""

import json
import re

from links import LESSONS, ROOT

EXERCISE = re.compile(r"^\*\*(\d+)\.\*\* .*?(?=^\*\*\d+\.\*\* |\Z)", re.DOTALL | re.MULTILINE)


def exercises_of(lesson: str) -> dict[str, dict]:
    """By their names, as 05.1: the files to change, and the options to draw with."""
    text = (ROOT / "lessons" / lesson / "README.md").read_text(encoding="utf-8")
    exercises = {}
    for found in EXERCISE.finditer(text.partition("\n## Your turn\n")[2]):
        changed = re.findall(r"^--- lessons/(\S+)/(\S+)$", found[0], re.MULTILINE)
        names = [file if folder == lesson else f"{folder}/{file}" for folder, file in changed]
        drawn = re.search(r"^`\./lessons/run \d\d(.*)` draws", found[0], re.MULTILINE)
        exercises[f"{lesson[:2]}.{found[1]}"] = {
            "lesson": lesson,
            "files": list(dict.fromkeys([*names, "main.cpp"])),
            "options": drawn[1].split() if drawn else [],
        }
    return exercises


def sandbox_files() -> str:
    """exercises.json, as docs/live/editor/sandbox.js reads it."""
    lessons = {
        lesson: {
            file.name: file.read_text(encoding="utf-8")
            for file in sorted((ROOT / "lessons" / lesson).glob("*.[ch]pp"))
        }
        for lesson in LESSONS
    }
    program = (ROOT / "docs/live/editor/sandbox.cpp").read_text(encoding="utf-8")
    exercises = {name: each for lesson in LESSONS for name, each in exercises_of(lesson).items()}
    return json.dumps({"program": program, "lessons": lessons, "exercises": exercises})
