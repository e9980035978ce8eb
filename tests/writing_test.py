"""Writes lessons in their pages with the site's own compiler: writing_test.py SITE_FOLDER BUILD_FOLDER [LESSON... | all].

Without lessons it takes lesson 09. Each lesson's starter has to compile and to fail readably; with the
course's files, all tests have to pass, and the picture has to have the native bytes. What goes wrong
has to end in a sentence, and the next run has to work. Prints how long runs take. Exits with 77
where something is missing, or with 1 if RASTERBOOK_SITE_REQUIRED is set.
"""

import json
import re
import subprocess
import sys
import time
from pathlib import Path

from editor_test import EditorPage
from live_test import LESSONS, PIXEL, PIXELS, native_bytes, serve
from site_test import ROOT, check_log, skip, start_browser

STATUS = "return document.querySelector('.live .status').textContent"
FAILURE = "return document.querySelector('.failure').textContent"
FIRST_MESSAGE = "return document.querySelector('.messages li')?.textContent ?? ''"
UNTIL_DONE = """return new Promise((done) => {
  const look = () => (document.querySelector(".live").dataset.run === "done" ? done() : setTimeout(look, 10));
  look();
});"""
PUT = "localStorage[`rasterbook ${arguments[0]}`] = arguments[1]"
EVERYTHING = "#include <vector>\nint main() { std::vector<char> all; for (;;) all.resize(all.size() + (1 << 28), 1); }\n"
# What stands in place of lesson 02's main.cpp, and a part of what is to be said.
WRONG = {
    "#error no such thing\n": "does not compile",
    "": "does not compile",
    "Dear diary, this is no C++.\n": "does not compile",
    "int main() { for (volatile int i = 0;;) i = i + 1; }\n": "did not end within",
    "volatile int n = 1;\nint deeper(int i) { return deeper(i + n) + n; }\nint main() { return deeper(1); }\n": "",
    EVERYTHING: "",
    "#include <vector>\nint main() { return std::vector<int>(3).at(4); }\n": "out_of_range: vector",
    "#include <memory>\n#include <vector>\nint main() { std::vector<std::unique_ptr<int>> all(1); auto more = all; }\n": "main.cpp:3:",
}


class Run(EditorPage):
    def timed_run(self) -> float:
        """How many seconds it takes until all is shown."""
        begun = time.monotonic()
        self.button("Run").click()
        self.script(UNTIL_DONE)
        return time.monotonic() - begun

    @property
    def failure(self) -> str:
        return self.script(FAILURE)


def check_lesson(page: Run, build: Path, lesson: str) -> list[str]:
    problems = []
    page.open(f"lesson_{lesson[:2]}.html")
    first = page.timed_run()
    is_failing = "is not done yet" in page.outcome and page.failure.startswith("FAILED ")
    if not is_failing:
        problems.append(f"the starter: {page.outcome} {page.failure[:200]}")
    again = []
    for i in range(2):
        page.write(f"{page.written}\n// edit {i}\n")
        again.append(page.timed_run())
    page.script(PUT, lesson, json.dumps({"files": solution(lesson), "step": 0, "begun": {}}))
    page.open(f"lesson_{lesson[:2]}.html", is_forgotten=False)
    solved = page.timed_run()
    page.wait()
    if "is done" not in page.outcome:
        problems.append(f"the course's files: {page.outcome} {page.failure[:300]}")
    elif page.script(PIXELS) != native_bytes(build, lesson):
        problems.append(f"draws other bytes than the program: {page.script(STATUS)}")
    if ("Threads and the hard cases are tested" in page.outcome) != (lesson == "10_threading"):
        problems.append(f"of what no page can test: {page.outcome}")
    times = ", ".join(f"{seconds:.1f}" for seconds in (first, *again, solved))
    print(f"{lesson}: {times} s (first, after two edits, the course's files)", flush=True)
    return problems


def check_probe(page: Run, build: Path) -> list[str]:
    """The reader's code explains a pixel."""
    from selenium.webdriver.common.keys import Keys

    lesson = "09_shadow_maps"
    command = [build / f"{lesson}_complete", "--probe", "640,360"]
    course = subprocess.run(command, check=True, capture_output=True, encoding="utf-8").stdout.rstrip()
    files = solution(lesson)
    files["shadow_map.hpp"] = files["shadow_map.hpp"].replace("return lit / (side", "return (0 * lit + 4) / (side")
    page.script(PUT, lesson, json.dumps({"files": files, "step": 0, "begun": {}}))
    page.open("lesson_09.html", is_forgotten=False)
    page.timed_run()
    page.wait()
    problems = []
    page.all(".tabs button")[0].click()
    tab = next(tab for tab in page.all(".tabs button") if tab.text == "shadow_map.hpp")
    tab.click()
    page.write(files["shadow_map.hpp"])
    page.timed_run()
    page.one(".live canvas").send_keys(Keys.ENTER)
    page.wait()
    reasons = page.script("return document.querySelector('.reasons').textContent")
    print(f"a pixel: {reasons[:120]!r}", flush=True)
    color = "#{:02x}{:02x}{:02x}".format(*page.script(PIXEL, 640, 360))
    if course.endswith(color):
        problems.append("the reader's header does not change the picture")
    if not reasons.endswith(color):
        problems.append(f"what explains a pixel does not end with its colour, {color}: {reasons[-40:]}")
    return problems


def solution(lesson: str) -> dict[str, str]:
    folder = ROOT / "lessons" / lesson
    names = [file.name for file in (folder / "starter").iterdir()] + ["main.cpp"]
    return {name: (folder / name).read_text("utf-8") for name in names}


def check_first(page: Run) -> list[str]:
    """Of several failures it tells the one that ./tests/run tells: that of the first equation, whatever the tests' names."""
    files = solution("03_z_buffer")
    files["depth_buffer.hpp"] = files["depth_buffer.hpp"].replace("farthest_ + glm::dot", "farthest_ - glm::dot")
    page.script(PUT, "03_z_buffer", json.dumps({"files": files, "step": 0, "begun": {}}))
    page.open("lesson_03.html", is_forgotten=False)
    page.timed_run()
    page.wait()
    print(f"depths that are subtracted: {page.failure[:100]!r}", flush=True)
    is_first = page.failure.startswith("FAILED ZBuffer.Eq3_2_DepthOfTheWorkedExample\n")
    return [] if is_first else [f"of depths that are subtracted it first says {page.failure[:200]}"]


def check_wrong(page: Run) -> list[str]:
    problems = []
    page.open("lesson_02.html")
    page.all(".tabs button")[1].click()
    right = page.written
    for text, sentence in WRONG.items():
        page.write(text)
        page.timed_run()
        time.sleep(1)
        page.wait()
        said = f"{page.outcome} {page.script(STATUS)} {page.failure} {page.script(FIRST_MESSAGE)}"
        print(f"{text[:50]!r}: {said[:300]}", flush=True)
        if not said.strip() or sentence not in said:
            problems.append(f"of {text[:60]!r} it says {said[:300]}")
        page.write(right)
        page.timed_run()
        if "is not done yet" not in page.outcome:
            problems.append(f"after {text[:60]!r}: {page.outcome}")
    page.all(".tabs button")[0].click()
    begin = "inline ScreenTriangle snap_triangle(vec2 a, vec2 b, vec2 c) {\n"
    page.write(solution("02_triangle_fill")["triangle.hpp"].replace(begin, begin + "for (volatile int i = 0;;) i = i + 1;\n"))
    page.timed_run()
    if not re.search(r"^FAILED Eq2_\d+_\w+\nEq2_\d+_\w+ did not end within 30 seconds$", page.failure) or " 0 of" in page.one(".tiers").text:
        problems.append(f"of a test that does not end it says {page.one('.tiers').text}: {page.failure}")
    return problems


def main() -> None:
    site, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    browser = start_browser(site)
    if not (site / "live/compiler/toolchain.js").exists() or not (site / "live/editor").exists():
        skip("the site has no editor with a compiler: npm was missing")
    lessons = json.loads((site / "live/compiler/lessons.json").read_text("utf-8"))
    server, address = serve(site)
    browser.set_script_timeout(600)  # for UNTIL_DONE
    page = Run(browser, address)
    page.view("desk", "light")
    problems = []
    asked = sys.argv[3:] or ["09_shadow_maps"]
    if asked == ["all"]:
        asked = [lesson for lesson in LESSONS if lesson in lessons]
    try:
        for lesson in asked:
            problems += [f"{lesson}: {problem}" for problem in check_lesson(page, build, lesson)]
        problems += check_probe(page, build)
        problems += check_first(page)
        problems += check_wrong(page)
        problems += check_log(browser, "writing", (address,))
    finally:
        browser.quit()
        server.shutdown()
    for problem in problems:
        print(problem)
    print(f"{len(asked)} lessons written in their pages; {len(problems)} problems")
    sys.exit(1 if problems or len(lessons) < 11 else 0)


if __name__ == "__main__":
    main()
