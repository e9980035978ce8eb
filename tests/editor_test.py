"""Writes lessons in their pages, in headless Chromium: editor_test.py SITE_FOLDER BUILD_FOLDER [CHECK...].

A stand-in takes the compiler's place: it answers at once, so that what the editor itself does can
be tried in seconds. Exits with 77 where something is missing, or with 1 if
RASTERBOOK_SITE_REQUIRED is set.
"""

import base64
import http.server
import io
import json
import random
import re
import string
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

from live_test import LESSONS, PIXELS, axe_of, native_bytes, serve
from site_test import ROOT, check_log, skip, start_browser

SIZES = {"desk": (1400, 1000), "phone": (390, 844)}
# A page's state, once nothing is under way.
IS_DONE = """const { run, state } = document.querySelector(".live").dataset;
return run === "done" && (state === "ready" || state === "failed");"""
OUTCOME = "return document.querySelector('.outcome').textContent"
WRITTEN = "return document.querySelector('.cm-content').cmTile.view.state.doc.toString()"
KEPT = "return localStorage.getItem(`rasterbook ${arguments[0]}`)"
MIDDLES = """return [...document.querySelectorAll("figure canvas")].map((canvas) =>
  [...canvas.getContext("2d").getImageData(480, 270, 1, 1).data].slice(0, 3));"""
WIDTH = """return [document.scrollingElement, document.getElementById("doc-content")]
  .filter((box) => box.scrollWidth > box.clientWidth).length"""


def lessons_json() -> str:
    """What the compiler's side of the site says of the lessons, from the lessons themselves."""
    lessons = {}
    for i, name in enumerate(LESSONS):
        folder = ROOT / "lessons" / name
        starter = {file.name: file.read_text("utf-8") for file in (folder / "starter").iterdir()}
        before = LESSONS[max(i - 1, 0)]
        starter["main.cpp"] = (ROOT / "lessons" / before / "main.cpp").read_text("utf-8")
        steps = [
            [part.strip() for part in line.split("|")]
            for line in re.findall(r"^step: (.*)$", (folder / "README.md").read_text("utf-8"), re.M)
        ]
        lessons[name] = {
            "before": before,
            "starter": starter,
            "solution": {file: (folder / file).read_text("utf-8") for file in starter},
            "steps": [{"title": step[3], "options": step[1].split()} for step in steps],
        }
    return json.dumps(lessons)


class Server(http.server.SimpleHTTPRequestHandler):
    """The site, with the stand-in in the compiler's place."""

    lessons = lessons_json().encode()
    programs: dict[str, bytes] = {}
    has_compiler = True

    def log_message(self, *_: object) -> None:
        pass

    def translate_path(self, path: str) -> str:
        if path == "/live/compiler/toolchain.js":
            return str(ROOT / "tests/support/toolchain_stand_in.js")
        if path.startswith("/live/compiler/golden/"):
            return str(ROOT / "tests/golden" / Path(path).name)
        return super().translate_path(path)

    def do_GET(self) -> None:
        name = self.path.removeprefix("/live/compiler/")
        if name == "lessons.json":
            content = self.lessons
        elif name.removesuffix(".wasm") in self.programs:
            content = self.programs[name.removesuffix(".wasm")]
        elif name == "toolchain.js" and not self.has_compiler:
            return self.send_error(404)
        else:
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)


class EditorPage:
    """A page with an editor in a browser."""

    def __init__(self, browser, address: str) -> None:
        self.browser = browser
        self.address = address

    def script(self, text: str, *arguments: object):
        return self.browser.execute_script(text, *arguments)

    def all(self, selector: str) -> list:
        return self.browser.find_elements("css selector", selector)

    def one(self, selector: str):
        return self.browser.find_element("css selector", selector)

    def button(self, text: str):
        """The one that is shown."""
        found = self.browser.find_elements("xpath", f'//button[normalize-space()="{text}"]')
        return next(button for button in found if button.is_displayed())

    def until(self, true, seconds: float = 60) -> None:
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.browser, seconds, 0.05).until(lambda _: true())

    def view(self, width: str, scheme: str) -> None:
        columns, rows = SIZES[width]
        metrics = {"width": columns, "height": rows, "deviceScaleFactor": 1, "mobile": False}
        media = {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", media)

    def open(self, page: str, is_forgotten: bool = True) -> None:
        """A page, with its editor open; and nothing kept of before."""
        self.browser.get("about:blank")
        self.browser.get(f"{self.address}/{page}")
        if is_forgotten:
            self.script("localStorage.clear()")
            self.browser.refresh()
        if not page.startswith("sandbox"):
            self.until(lambda: self.script("return document.querySelector('.live').dataset.state") == "ready")
            self.one(".live .write").click()
        self.until(lambda: self.all(".cm-content"))

    def run(self) -> None:
        self.button("Run").click()
        self.wait()

    def wait(self) -> None:
        self.until(lambda: self.script(IS_DONE))

    def write(self, text: str) -> None:
        """In place of all that the file shown has."""
        self.script(
            """const { view } = document.querySelector(".cm-content").cmTile;
view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: arguments[0] } });""",
            text,
        )

    def answer(self, is_yes: bool = True) -> str:
        """To the question that the browser asks."""
        alert = self.browser.switch_to.alert
        text = alert.text
        alert.accept() if is_yes else alert.dismiss()
        return text

    @property
    def outcome(self) -> str:
        return self.script(OUTCOME)

    @property
    def note(self) -> str:
        return self.one(".editor .note").text

    @property
    def written(self) -> str:
        return self.script(WRITTEN)

    @property
    def tabs(self) -> list[str]:
        return [tab.text for tab in self.all(".tabs [role=tab]")]


# Programs of readers that go wrong, and what is to be said of them.
WRONG_PROGRAMS = {
    "endless": ("for (volatile int i = 0;;) i = i + 1;", "did not end within 10 seconds"),
    "trap": ("__builtin_trap();", "The program ended in draw"),
    "recursion": ("return deeper(width) + deeper(height);", "calls itself without end in deeper"),
}
PROGRAM = """#define EXPORTED(name) __attribute__((export_name(#name)))
static char given[1 << 24];
__attribute__((noinline)) int deeper(int n) { volatile int m = n + 1; return deeper(m) + m; }
EXPORTED(_initialize) void initialize(void) {}
EXPORTED(start) void start(void) {}
EXPORTED(controls) const char* controls(void) {
    return "{\\"model\\": \\"teapot.obj\\", \\"hasProbe\\": false, \\"controls\\": []}";
}
EXPORTED(room) char* room(int bytes) { return given; }
EXPORTED(take_scene) void take_scene(void) {}
EXPORTED(prepare) void prepare(void) {}
EXPORTED(draw) int draw(int width, int height) { BODY }
"""


def wrong_programs() -> dict[str, bytes]:
    """As WebAssembly; the functions keep their names."""
    made = {}
    with tempfile.TemporaryDirectory() as folder:
        source, out = Path(folder, "program.c"), Path(folder, "program.wasm")
        for name, (body, _) in WRONG_PROGRAMS.items():
            source.write_text(PROGRAM.replace("BODY", body), encoding="utf-8")
            command = ["clang-19", "--target=wasm32", "-O0", "-nostdlib", "-Wl,--no-entry"]
            subprocess.run([*command, source, "-o", out], check=True)
            made[name] = out.read_bytes()
    return made


def check_closed(page: EditorPage) -> list[str]:
    """As long as the editor is not asked for, nothing of it is loaded."""
    page.browser.get("about:blank")
    page.browser.get(f"{page.address}/lesson_02.html")
    page.until(lambda: page.script("return document.querySelector('.live').dataset.state") == "ready")
    loaded = page.script("return performance.getEntriesByType('resource').map(({ name }) => name)")
    return [f"loads {name} unasked" for name in loaded if re.search("/(editor|compiler)/", name)]


def check_loop(page: EditorPage, build: Path) -> list[str]:
    """What a step's first run shows; then errors, and going on."""
    problems = []
    page.open("lesson_02.html")
    if page.tabs != ["triangle.hpp", "main.cpp"]:
        problems.append(f"has the files {page.tabs}")
    page.run()
    if "Step 1 is not done yet" not in page.outcome or page.script("return standIn.step") != 1:
        problems.append(f"the first run says '{page.outcome}'")
    if "And main.cpp is still lesson 01's" not in page.outcome:
        problems.append("does not say that a wrong picture's main.cpp is as it was")
    if [tier.text for tier in page.all(".tiers li")] != ["formulas 5 of 9", "pictures 0 of 1"]:
        problems.append("does not count what passes")
    if not page.one(".failure").text.startswith("FAILED Lines.PictureOfTheLesson"):
        problems.append("does not show the first failure")
    if not page.one(".failure a").get_attribute("href").endswith("/derivation_01.html#eq_1_3"):
        problems.append("does not lead to the equation that is to be read")
    page.until(lambda: page.all(".looks"))
    sizes = [(canvas.get_property("width"), canvas.get_property("height")) for canvas in page.all("figure canvas")]
    words = page.one(".comparison").text
    expected, own, apart = page.script(MIDDLES)
    differing = re.search(r"([\d,]+) of 518,400 pixels differ", words)
    if sizes != [(960, 540)] * 3 or not differing or differing[1] == "0" or "drawn with --paint barycentric" not in words:
        problems.append(f"does not compare the pictures: {sizes}, {words}")
    if apart != [min(255, 8 * abs(a - b)) for a, b in zip(expected, own)] or expected == own:
        problems.append(f"of {expected} and {own} the difference is {apart}")
    if page.one(".looks").text != f"In the middle {','.join(map(str, own))}, expected {','.join(map(str, expected))}.":
        problems.append(f"of {expected} and {own} it is said: {page.one('.looks').text}")
    if page.script(PIXELS) != native_bytes(build, LESSONS[1]):
        problems.append("does not draw with the program that was made")

    page.write("int a;\n    #error no such thing\n#warning hm\n")
    page.run()
    if page.outcome != "It does not compile: 1 error with 1 warning." or page.all(".failure")[0].is_displayed():
        problems.append(f"of an error it says '{page.outcome}'")
    said = [message.text for message in page.all(".messages li")]
    if said != ["triangle.hpp:2:6 error no such thing", "triangle.hpp:3:2 warning hm"]:
        problems.append(f"lists {said}")
    if len(page.all(".cm-lint-marker-error")) != 1 or len(page.all(".cm-lint-marker-warning")) != 1:
        problems.append("does not mark the lines")
    page.all(".tabs button")[1].click()
    page.one(".messages button").click()
    position = page.script("const { main } = document.querySelector('.cm-content').cmTile.view.state.selection; return main.head")
    if position != 12 or page.one("[role=tab][aria-selected=true]").text != "triangle.hpp":
        problems.append(f"a message leads to {position}")

    page.write("int done;\n")
    page.run()
    if "Step 1 is done" not in page.outcome or "main.cpp is still" not in page.outcome:
        problems.append(f"of a main.cpp that is left as it was it says '{page.outcome}'")
    page.all(".tabs button")[1].click()
    page.write("int main() {}\n")
    page.run()
    if not re.fullmatch(r"Step 1 is done; compiled and tested in [\d.]+ s\.", page.outcome) or page.all(".messages li"):
        problems.append(f"of what is right it says '{page.outcome}'")
    page.button("Go on to step 2").click()
    page.wait()
    if page.script("return standIn.step") != 2 or "Step 2 is done" not in page.outcome:
        problems.append("does not go on to the next step")
    return problems


def check_runs(page: EditorPage) -> list[str]:
    """A newer run ends an older one, a pause starts one, Stop ends one, and failures are said."""
    problems = []
    page.open("lesson_01.html")
    page.write("// SLOW\n")
    page.button("Run").click()
    page.until(lambda: page.outcome == "Compiling …")
    page.write("#error newer\n")
    page.run()
    if "1 error" not in page.outcome or page.script("return standIn.stops") != 1:
        problems.append(f"a newer run does not end the older one: {page.outcome}")
    page.write("// SLOW\n")
    page.button("Run").click()
    page.until(lambda: page.outcome == "Compiling …")
    page.button("Stop").click()
    if page.outcome != "Stopped." or page.button("Stop").is_enabled():
        problems.append(f"Stop leads to '{page.outcome}'")
    page.write("// NO TOOLCHAIN\n")
    page.run()
    if page.outcome != "There is not enough memory for the compiler.":
        problems.append(f"of the compiler's failure it says '{page.outcome}'")
    page.one(".editor input[type=checkbox]").click()
    before = page.script("return standIn.runs")
    page.write("// TODO: typed\n")
    time.sleep(0.5)
    if page.script("return standIn.runs") != before:
        problems.append("does not wait for a pause")
    page.until(lambda: page.script("return standIn.runs") == before + 1, 5)
    page.wait()
    return problems


def check_wrong_programs(page: EditorPage) -> list[str]:
    """Each ends in a sentence, and the next one draws."""
    problems = []
    page.open("lesson_02.html")
    for name, (_, sentence) in WRONG_PROGRAMS.items():
        page.write(f"// PROGRAM {name}\n")
        page.run()
        status = page.script("return document.querySelector('.live .status').textContent")
        if sentence not in status:
            problems.append(f"{name}: says '{status}'")
        page.write("int fine;\n")
        page.run()
        status = page.script("return document.querySelector('.live .status').textContent")
        if "by your program" not in status:
            problems.append(f"{name}: draws nothing afterwards: {status}")
    return problems


def check_storage(page: EditorPage) -> list[str]:
    problems = []
    page.open("lesson_03.html")
    first = page.written
    page.write("// mine\n")
    page.browser.refresh()
    page.until(lambda: page.all(".write"))
    if page.one(".write").text != "Go on writing":
        problems.append("does not say that something is written already")
    page.open("lesson_03.html", is_forgotten=False)
    if page.written != "// mine\n":
        problems.append("forgets what was written")
    page.button("Start the lesson again").click()
    page.answer(is_yes=False)
    if page.written != "// mine\n":
        problems.append("starts again without a yes")
    page.button("Start the lesson again").click()
    question = page.answer()
    if page.written != first or page.script(KEPT, LESSONS[2]) or "is lost" not in question:
        problems.append("does not start the lesson again")
    page.write("// at the beginning of step 2\n")
    page.script("const [, step] = document.querySelectorAll('.step option'); step.parentElement.value = step.value; step.parentElement.dispatchEvent(new Event('change'))")
    page.wait()
    page.write("// later\n")
    page.button("Start the step again").click()
    page.answer()
    if page.written != "// at the beginning of step 2\n":
        problems.append("does not start the step again")
    page.script("Storage.prototype.setItem = () => { throw new DOMException('', 'QuotaExceededError'); }")
    page.write("// too much\n")
    if "storage is full" not in page.note:
        problems.append(f"of a full storage it says '{page.note}'")
    page.script("localStorage.clear(); localStorage['rasterbook 03_z_buffer'] = '{'")
    page.script("Object.defineProperty(localStorage, 'rasterbook 03_z_buffer', { value: '{' })")
    page.open("lesson_03.html", is_forgotten=False)
    if page.written != first:
        problems.append("cannot bear what is kept to be unreadable")
    return problems


def zip_of(files: dict[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return packed.getvalue()


def check_zip(page: EditorPage) -> list[str]:
    problems = []
    page.open("lesson_03.html")
    page.write("// mine, with an \u00e9\n")
    page.open("lesson_04.html", is_forgotten=False)
    page.script("""URL.createObjectURL = (blob) => {
  blob.arrayBuffer().then((bytes) => (window.saved = btoa(String.fromCharCode(...new Uint8Array(bytes)))));
  return "javascript:void 0";
}""")
    page.button("Save as mine.zip").click()
    page.until(lambda: page.script("return window.saved"))
    with zipfile.ZipFile(io.BytesIO(base64.b64decode(page.script("return saved")))) as saved:
        names = sorted(saved.namelist())
        headers = sorted(file.name for file in (ROOT / "lessons/04_mvp/starter").iterdir())
        expected = ["mine/03_z_buffer/depth_buffer.hpp", "mine/03_z_buffer/main.cpp"]
        expected += sorted(f"mine/04_mvp/{name}" for name in [*headers, "main.cpp"])
        if names != expected or saved.read(names[0]).decode() != "// mine, with an \u00e9\n":
            problems.append(f"saves {names}")
    given = {
        "good": ({"mine/04_mvp/clip.hpp": b"// from the file\r\n"}, "Loaded: 04_mvp."),
        "of another place": ({"x/mine/02_triangle_fill/main.cpp": b"// 2\n", "readme.txt": b""}, "Loaded: 02_triangle_fill."),
        "empty": ({"readme.txt": b"hello"}, "has no files of a lesson"),
        "binary": ({"mine/04_mvp/clip.hpp": b"\xff\xfe"}, "is no text in UTF-8"),
        "broken": (None, "is no zip that can be read"),
    }
    with tempfile.TemporaryDirectory() as folder:
        for name, (files, sentence) in given.items():
            file = Path(folder, "mine.zip")
            file.write_bytes(b"PK nothing" if files is None else zip_of(files))
            page.one(".editor input[type=file]").send_keys(str(file))
            if sentence.startswith("Loaded"):
                time.sleep(0.3)
                page.answer()
            for _ in range(100):
                if sentence in page.note:
                    break
                time.sleep(0.02)
            else:
                problems.append(f"of a zip that is {name} it says '{page.note}'")
    clip = json.loads(page.script(KEPT, "04_mvp"))["files"]["clip.hpp"]
    if clip != "// from the file\n":
        problems.append("does not keep what it has loaded")
    if json.loads(page.script(KEPT, LESSONS[1]) or "{}").get("files") != {"main.cpp": "// 2\n"}:
        problems.append("does not keep another lesson's files")

    page.open("sandbox.html#start=05.1")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "mine.zip")
        file.write_bytes(zip_of({"mine/05_textures/main.cpp": b"// 5\n", "mine/06_phong/phong.hpp": b"// 6\n"}))
        page.one(".editor input[type=file]").send_keys(str(file))
        time.sleep(0.3)
        page.answer()
        page.until(lambda: "Loaded" in page.note, 5)
    if page.tabs != ["main.cpp", "06_phong/phong.hpp"] or page.written != "// 5\n":
        problems.append(f"the sandbox loads {page.tabs}")
    return problems


def check_solution(page: EditorPage) -> list[str]:
    problems = []
    page.open("lesson_02.html")
    own = page.written
    page.button("Course's solution").click()
    if page.written != (ROOT / "lessons/02_triangle_fill/triangle.hpp").read_text("utf-8"):
        problems.append("does not show the course's file")
    if not page.all(".cm-deletedChunk") or not page.all(".cm-changedLine"):
        problems.append("does not show what differs")
    if page.script("return document.querySelector('.cm-content').contentEditable") == "true" and not page.script(
        "return document.querySelector('.cm-content').cmTile.view.state.readOnly"
    ):
        problems.append("the course's file can be changed")
    page.button("Course's solution").click()
    if page.written != own:
        problems.append("does not come back to the reader's file")
    return problems


def check_keyboard(page: EditorPage) -> list[str]:
    """All of it without a pointer, beginning at the button that opens the editor."""
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    def press(*keys: str) -> None:
        ActionChains(page.browser).send_keys(*keys).perform()

    focus = "return document.activeElement"
    problems = []
    page.browser.get("about:blank")
    page.browser.get(f"{page.address}/lesson_02.html")
    page.script("localStorage.clear()")
    page.until(lambda: page.script("return document.querySelector('.live').dataset.state") == "ready")
    page.script("document.querySelector('.write').focus()")
    press(Keys.ENTER)
    page.until(lambda: page.all(".cm-content"))
    if page.script(focus) != page.one(".cm-content"):
        problems.append("the code has no focus when the editor opens")
    before = page.written
    press("x", Keys.TAB)
    if not page.written.startswith("    x") or page.script(focus) != page.one(".cm-content"):
        problems.append(f"Tab does not indent: {page.written[:20]!r}")
    ActionChains(page.browser).key_down(Keys.CONTROL).send_keys("z", "z").key_up(Keys.CONTROL).perform()
    if page.written != before:
        problems.append("Ctrl+Z takes nothing back")
    ActionChains(page.browser).key_down(Keys.CONTROL).send_keys(Keys.ENTER).key_up(Keys.CONTROL).perform()
    page.until(lambda: page.script("return window.standIn?.runs") == 1)
    page.wait()
    press(Keys.ESCAPE, Keys.TAB)
    if page.script(focus) == page.one(".cm-content") or page.written != before:
        problems.append("Escape, then Tab, does not leave the code")
    ActionChains(page.browser).key_down(Keys.SHIFT).send_keys(Keys.TAB).key_up(Keys.SHIFT).perform()
    press(Keys.ESCAPE)
    ActionChains(page.browser).key_down(Keys.SHIFT).send_keys(Keys.TAB).key_up(Keys.SHIFT).perform()
    if page.script(focus) != page.one("[role=tab][aria-selected=true]"):
        problems.append("Shift+Tab does not lead from the code to its tab")
    press(Keys.ARROW_RIGHT)
    if page.one("[role=tab][aria-selected=true]").text != "main.cpp":
        problems.append("the arrow keys do not choose another file")
    outline = page.script("return getComputedStyle(document.activeElement).outlineStyle")
    if outline == "none":
        problems.append("one cannot see which tab has the focus")
    page.script("[...document.querySelectorAll('.editor button')].find((it) => it.textContent === 'Close').focus()")
    press(Keys.ENTER)
    if page.all(".editor") or page.script(focus) != page.one(".write"):
        problems.append("the focus is lost when the editor is closed")
    return problems


def check_sandbox(page: EditorPage, site: Path) -> list[str]:
    problems = []
    course = json.loads((site / "live/editor/exercises.json").read_text("utf-8"))
    if len(course["exercises"]) < 60:
        problems.append(f"has {len(course['exercises'])} exercises")
    for name, exercise in course["exercises"].items():
        for file in exercise["files"]:
            folder, _, bare = file.rpartition("/")
            if bare not in course["lessons"][folder or exercise["lesson"]]:
                problems.append(f"{name}: there is no {file}")
        text = (site / f"lesson_{name[:2]}.html").read_text("utf-8")
        if f'href="sandbox.html#start={name}"' not in text or f'id="exercise_{name[3:]}"' not in text:
            problems.append(f"{name}: its lesson does not lead to it")

    page.open("sandbox.html")
    if page.tabs != ["main.cpp"] or page.written != course["program"]:
        problems.append(f"begins with {page.tabs}")
    page.run()
    if page.script("return standIn.last.lesson") != "sandbox" or not page.outcome.startswith("Compiled"):
        problems.append(f"the small program: {page.outcome}")
    field = page.one(".adding input")
    for name, sentence in {"a b.hpp": "no file's name", "shade.exe": "no file's name", "main.cpp": "there already"}.items():
        field = page.one(".adding input")
        field.clear()
        field.send_keys(name)
        page.button("Add file").click()
        if sentence not in page.note:
            problems.append(f"of a file {name} it says '{page.note}'")
    field.clear()
    field.send_keys("05_textures/texture.hpp")
    page.button("Add file").click()
    if page.tabs != ["main.cpp", "05_textures/texture.hpp"] or page.written != course["lessons"]["05_textures"]["texture.hpp"]:
        problems.append("does not add a lesson's file")
    page.button("Remove this file").click()
    page.answer()
    if page.tabs != ["main.cpp"]:
        problems.append("does not remove a file")
    page.write("// my own\n")

    page.open("sandbox.html#start=05.1", is_forgotten=False)
    if page.tabs != ["texture.hpp", "main.cpp"] or "Make the mip levels visible" not in page.one(".exercise").text:
        problems.append(f"exercise 05.1 has {page.tabs}")
    page.run()
    chosen = page.script("return document.querySelector('.live .bar:not(.editor *) select').value")
    if page.script("return standIn.last.lesson") != "05_textures" or chosen != "horizon.obj":
        problems.append(f"exercise 05.1 is drawn with {chosen}")
    page.write(f"// tried\n{page.written}")
    page.button("What you changed").click()
    changed = [line.text for line in page.all(".cm-changedLine")]
    if changed != ["// tried"] or page.all(".cm-deletedLine"):
        problems.append(f"says that {changed} was changed")
    page.button("What you changed").click()
    page.write("// tried\n")
    page.button("Copy link").click()
    page.until(lambda: "link" in page.note)
    link = page.browser.current_url
    if "start=05.1" not in link or "model=horizon.obj" not in link or "code=" not in link:
        problems.append(f"makes the link {link}")
    page.write("// my own again\n")
    page.browser.get("about:blank")
    page.script("0")
    page.browser.get(link)
    page.until(lambda: page.all(".cm-content"))
    if page.written != "// my own again\n":
        problems.append("forgets what was written since the link was made")
    page.browser.get("about:blank")
    page.browser.get(f"{page.address}/index.html")
    page.script("localStorage.clear()")
    page.browser.get(link)
    page.until(lambda: page.all(".cm-content"))
    if page.written != "// tried\n" or page.tabs != ["texture.hpp", "main.cpp"]:
        problems.append("a link does not bring its files")
    page.run()
    if page.script("return document.querySelector('.live .bar:not(.editor *) select').value") != "horizon.obj":
        problems.append("a link does not bring its options")
    page.write("".join(random.Random(1).choices(string.ascii_letters, k=60000)))
    page.button("Copy link").click()
    if "too long" not in page.note:
        problems.append(f"of a long link it says '{page.note}'")
    for address, sentence in {"start=77.1": "There is no lesson and no exercise '77.1'", "code=abc": "cannot be read"}.items():
        page.browser.get("about:blank")
        page.browser.get(f"{page.address}/sandbox.html#{address}")
        page.until(lambda: page.all(".offer span") and page.one(".offer span").text)
        page.until(lambda: sentence in page.one(".offer span").text, 5)
    return problems


def check_elsewhere(page: EditorPage, site: Path) -> list[str]:
    """From a folder, and where the compiler is missing."""
    problems = []
    page.browser.get(f"{site.as_uri()}/lesson_05.html")
    page.until(lambda: page.script("return document.querySelector('.live').dataset.state") == "ready")
    page.one(".write").click()
    for file in ("lesson_05.html", "sandbox.html"):
        if file != "lesson_05.html":
            page.browser.get(f"{site.as_uri()}/{file}")
        words = page.one(".offer span").text
        if "./docs/run --serve" not in words or not words.endswith(f"8000/{file}"):
            problems.append(f"{file} from a folder: says '{words}'")
    page.browser.execute_cdp_cmd("Network.setCacheDisabled", {"cacheDisabled": True})
    Server.has_compiler = False
    page.open("sandbox.html")
    page.button("Run").click()
    page.until(lambda: "cannot be read" in page.outcome, 10)
    Server.has_compiler = True
    return problems


def check_looks(page: EditorPage, axe: str) -> list[str]:
    """Nothing is wider than the page, and what axe-core calls serious or critical."""
    problems = []
    for name in ("lesson_02.html", "sandbox.html#start=02.3"):
        page.view("desk", "light")
        page.open(name)
        page.run()
        if "sandbox" not in name:
            page.until(lambda: page.all(".looks"))
        for width in SIZES:
            for scheme in ("light", "dark"):
                page.view(width, scheme)
                page.write("int a;\n#warning hm\n// TODO\n")
                page.run()
                if page.script(WIDTH) != 0:
                    problems.append(f"{name}, {width}, {scheme}: is wider than the page")
                page.script(axe)
                for fault in page.script("return axe.run('.live').then((found) => found.violations)"):
                    if fault["impact"] in ("serious", "critical"):
                        problems.append(f"{name}, {width}, {scheme}: {fault['help']}: {fault['nodes'][0]['html'][:200]}")
    page.view("desk", "light")
    return problems


def main() -> None:
    site, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    browser = start_browser(site)
    if not (site / "live/editor/editor.js").exists():
        skip("the site has no editor: npm was missing")
    axe = axe_of(build)
    Server.programs = wrong_programs()
    server, address = serve(site, Server)
    page = EditorPage(browser, address)
    page.view("desk", "light")
    checks = {
        "closed": lambda: check_closed(page),
        "the loop": lambda: check_loop(page, build),
        "runs": lambda: check_runs(page),
        "wrong programs": lambda: check_wrong_programs(page),
        "storage": lambda: check_storage(page),
        "zip": lambda: check_zip(page),
        "solution": lambda: check_solution(page),
        "keyboard": lambda: check_keyboard(page),
        "sandbox": lambda: check_sandbox(page, site),
        "looks": lambda: check_looks(page, axe),
        "elsewhere": lambda: check_elsewhere(page, site),
    }
    problems = []
    try:
        for name in sys.argv[3:] or checks:
            check = checks[name]
            problems += [f"{name}: {problem}" for problem in check()]
            noted = check_log(browser, name, (address,))
            problems += noted if name != "elsewhere" else []
    finally:
        browser.quit()
        server.shutdown()
    for problem in problems:
        print(problem)
    print(f"{len(checks)} checks of the editor; {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
