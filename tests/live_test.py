"""Runs the lessons in their pages, in headless Chromium: live_test.py SITE_FOLDER BUILD_FOLDER.

Every lesson's page is opened from the folder and from a server and has to draw the bytes that the
program draws; every control has to change the picture as the option does, or to say why not; a
probed pixel has to have the program's reasons; what goes wrong has to end in a sentence. If
RASTERBOOK_TURN is such as 1/4, controls and pixels are tried in the lessons whose number divided by 4
leaves 1, each page is opened from one of the two places, and of the texts' comparisons and of what is
asked about accessibility, every other one is tried. Exits with 77 where something is missing, or
with 1 if RASTERBOOK_SITE_REQUIRED is set.
"""

import functools
import hashlib
import http.server
import re
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

from site_test import ROOT, WIDTHS, check_log, is_turn_of, of_this_turn, skip, start_browser

LESSONS = sorted(folder.name for folder in (ROOT / "lessons").glob("[0-9]*"))

# Until a picture is drawn in full, or something is wrong.
WAIT = """return new Promise((done) => {
  const look = () => (/^(ready|failed)$/.test(document.querySelector(".live")?.dataset.state) ? done() : setTimeout(look, 10));
  look();
});"""
STATUS = 'return document.querySelector(".live .status").textContent'
PIXELS = """const canvas = document.querySelector(".live canvas");
const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
const rgb = new Uint8Array(pixels.length / 4 * 3);
for (let i = 0, j = 0; i < pixels.length; i += 4)
  for (let c = 0; c < 3; ++c) rgb[j++] = pixels[i + c];
return crypto.subtle.digest("SHA-256", rgb).then((hash) =>
  [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, "0")).join(""));"""
PIXEL = """const canvas = document.querySelector(".live canvas");
return [...canvas.getContext("2d").getImageData(...arguments, 1, 1).data].slice(0, 3);"""
# Another value than the control has now, as a reader would choose it.
CHANGE = """const control = arguments[0];
if (control.tagName === "SELECT") control.selectedIndex = (control.selectedIndex + 1) % control.length;
else if (control.type === "checkbox") control.checked = !control.checked;
else if (control.type === "number") {
  const value = +control.value;
  const other = control.step === "1" ? Math.floor(value / 2) : value * 0.8 + 3;
  control.value = Math.min(Math.max(other, +control.min), +control.max);
} else control.value = arguments[1];
control.dispatchEvent(new Event("change"));"""
# Options of earlier lessons are tried there, and once more in the last lesson.
CONTROLS = ".live details:nth-of-type(-n+2) .option :is(select, input):not([disabled])"
ALL_CONTROLS = ".live .option :is(select, input):not([disabled])"
# What a browser may lack, as scripts that run before those of the page.
LACKS = {
    "WebAssembly": ("delete window.WebAssembly;", "no WebAssembly"),
    "SIMD": (
        """const Own = Blob;
window.Blob = class extends Own { constructor(parts, options) {
  const prefix = "WebAssembly.compile = () => Promise.reject(new WebAssembly.CompileError('no such opcode'));";
  super(options?.type === "text/javascript" ? [prefix, ...parts] : parts, options); } };""",
        "SIMD",
    ),
    "a worker": (
        """window.Worker = class { constructor() { setTimeout(() => this.onerror?.(new Event("error")), 100); }
  postMessage() {} terminate() {} };""",
        "has ended",
    ),
}
# What an address may ask for in vain, and a part of what is said of it.
BAD_ADDRESSES = {
    "lesson_05.html#filter=cubic": "'cubic' is not one of nearest, bilinear, trilinear",
    "lesson_05.html#fov=171": "'171' is not a number from 1 to 170",
    "lesson_05.html#pitch=steep": "'steep' is not a number from -90 to 90",
    "lesson_05.html#colour=red": "colour=red, which this page does not have",
    "lesson_05.html#model=../secret.obj": "which this page does not have",
    "lesson_12.html#camera=nobody": "there is no camera 'nobody'",
    "lesson_12.html#samples=64&shadow-size=8192&size=1920x1080": "not enough memory",
}


ACCESSIBLE = (
    "index.html",
    "lesson_05.html",
    "lesson_09.html#pcf=1&against=7",
    "derivation_02.html",
    "accuracy_05.html",
)


def native_bytes(build: Path, lesson: str, options: list[str] | None = None) -> str:
    """The hash of the pixels that the program draws, row by row from the top."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.bmp"
        command = [build / lesson, *(options or []), "--out", file]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        header, pixels = file.read_bytes()[:54], file.read_bytes()[54:]
    row = 3 * int.from_bytes(header[18:22], "little")
    rows = [bytearray(pixels[at : at + row]) for at in range(0, len(pixels), row)]
    for each in rows:
        each[0::3], each[2::3] = each[2::3], each[0::3]  # blue, green, red
    return hashlib.sha256(b"".join(reversed(rows))).hexdigest()


class QuietServer(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        pass


class LivePage:
    """A lesson's page in a browser."""

    def __init__(self, browser) -> None:
        self.browser = browser

    def open(self, address: str) -> None:
        self.browser.get("about:blank")  # else a change after # would not load the page anew
        self.browser.get(address)
        self.wait()

    def go(self, options: str) -> None:
        """To other options, in the same page."""
        script = """document.querySelector(".live").dataset.state = "asked";
if (location.hash === `#${arguments[0]}`) dispatchEvent(new HashChangeEvent("hashchange"));
else location.hash = arguments[0];"""
        self.browser.execute_script(script, options)
        self.wait()

    def wait(self) -> None:
        self.browser.execute_script(WAIT)

    @property
    def status(self) -> str:
        return self.browser.execute_script(STATUS)

    @property
    def pixels(self) -> str:
        return self.browser.execute_script(PIXELS)

    def all(self, selector: str) -> list:
        return self.browser.find_elements("css selector", selector)


def check_bytes(page: LivePage, address: str, lesson: str, expected: str) -> list[str]:
    page.open(f"{address}/lesson_{lesson[:2]}.html")
    if page.pixels != expected:
        return [f"does not draw the program's bytes: {page.status}"]
    return []


def check_controls(page: LivePage, address: str, lesson: str, build: Path) -> list[str]:
    """Each control by itself, from the lesson's presets: as the program with the command shown."""
    problems = []
    page.open(f"{address}/lesson_{lesson[:2]}.html#size=480x270")
    usual = page.pixels
    names = [name.text for name in page.all(".live .option .name")]
    if len(names) < 2:
        problems.append(f"has {len(names)} controls")
    controls = ALL_CONTROLS if lesson == LESSONS[-1] else CONTROLS
    for i in range(len(page.all(controls))):
        control = page.all(controls)[i]
        label = control.get_attribute("aria-label")
        page.browser.execute_script(CHANGE, control, "fit")
        page.wait()
        pixels = page.pixels
        if pixels == usual and "changes no pixel." not in page.status:
            problems.append(f"{label}: changes nothing, and does not say why: {page.status}")
        option = re.match(r"[\w-]+", label)[0]
        if f"{option}=" not in page.browser.current_url:
            problems.append(f"{label}: is not in the address")
        command = page.all(".live .commands code")[0].text.split()
        program = f"lab_{lesson}" if command[1] == "lab" else lesson
        if program != lesson:
            command.remove("lab")
        if command[:2] != ["./lessons/run", lesson[:2]] or f"--{option}" not in command:
            problems.append(f"{label}: is not in the command line {' '.join(command)}")
        if option == "show-threads":
            command += ["--threads", "1"]
        if pixels != native_bytes(build, program, command[2:]):
            problems.append(f"{label}: draws other bytes than {' '.join(command)}")
        page.go("size=480x270")
        if page.pixels != usual:
            problems.append(f"{label}: the address does not take it back")
    for control in page.all(".live .option [disabled]"):
        if not control.find_element("xpath", "..").find_elements("tag name", "small"):
            problems.append(f"{control.get_attribute('aria-label')}: cannot be used, without a reason")
    return problems


def check_probe(page: LivePage, address: str, lesson: str, build: Path, site: Path) -> list[str]:
    """The reasons are those of the program, the last line is the pixel, and each equation is found."""
    problems = []
    page.open(f"{address}/lesson_{lesson[:2]}.html#size=480x270")
    # Where there are the background, the floor, and things on it in most scenes.
    for x, y in ((10, 5), (200, 135), (250, 120), (240, 180), (300, 250)):
        page.go(f"size=480x270&probe={x},{y}")
        command = [build / f"{lesson}_complete", "--size", "480x270", "--probe", f"{x},{y}"]
        expected = subprocess.run(command, check=True, capture_output=True, encoding="utf-8").stdout
        reasons = page.all(".live .reasons")[0]
        text = page.browser.execute_script("return arguments[0].textContent", reasons)
        if text != expected.rstrip("\n"):
            problems.append(f"pixel {x}, {y}: says other things than the program")
        red, green, blue = page.browser.execute_script(PIXEL, x, y)
        if not text.endswith(f"#{red:02x}{green:02x}{blue:02x}"):
            problems.append(f"pixel {x}, {y}: does not end with its colour")
        for link in reasons.find_elements("tag name", "a"):
            file, anchor = link.get_attribute("href").rsplit("/", 1)[1].split("#")
            if f'id="{anchor}"' not in (site / file).read_text(encoding="utf-8"):
                problems.append(f"pixel {x}, {y}: {link.text} leads nowhere")
    return problems


def check_click(page: LivePage, address: str) -> list[str]:
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    problems = []
    page.open(f"{address}/lesson_05.html#size=480x270")
    canvas = page.all(".live canvas")[0]
    page.browser.execute_script("scrollTo(0, 0)")
    ActionChains(page.browser).move_to_element(canvas).click().perform()
    page.wait()
    asked = re.search(r"probe=(\d+)(?:,|%2C)(\d+)", page.browser.current_url)
    if not asked or abs(int(asked[1]) - 240) > 1 or abs(int(asked[2]) - 135) > 1:
        problems.append(f"a click in the middle probes {asked and asked[0]}")
    canvas.send_keys(Keys.ESCAPE)
    page.wait()
    if page.all(".live .probe")[0].is_displayed():
        problems.append("Escape does not close the probe")
    canvas.send_keys(Keys.ENTER)
    page.wait()
    canvas.send_keys(Keys.SHIFT + Keys.ARROW_DOWN)
    page.wait()
    if "pixel 240, 136" not in page.all(".live .reasons")[0].text:
        problems.append("Enter and Shift with an arrow do not probe")
    before = page.pixels
    ActionChains(page.browser, 0).click_and_hold(canvas).move_by_offset(40, 0).release().perform()
    page.wait()
    if "yaw=" not in page.browser.current_url or page.pixels == before:
        problems.append("the pointer does not turn the scene")
    return problems


def check_keys(page: LivePage, address: str) -> list[str]:
    from selenium.webdriver.common.keys import Keys

    problems = []
    page.open(f"{address}/lesson_05.html#size=480x270")
    for keys, option in ((Keys.ARROW_RIGHT, "yaw"), (Keys.ARROW_UP, "pitch"), ("+", "distance")):
        before = page.pixels
        page.all(".live canvas")[0].send_keys(keys)
        page.wait()
        if f"{option}=" not in page.browser.current_url or page.pixels == before:
            problems.append(f"the keys do not change {option}")
    command = page.all(".live .commands code")[0].text
    if command != "./lessons/run 05 --size 480x270 --yaw -35 --pitch 32 --distance 1.267":
        problems.append(f"shows the command line '{command}'")
    return problems


def check_quality(page: LivePage, address: str, build: Path) -> list[str]:
    """An option that says what the lesson does anyway still counts more than --quality."""
    page.open(f"{address}/lesson_12.html#size=480x270&quality=fast&filter=trilinear")
    command = page.all(".live .commands code")[0].text.split()[2:]
    if command != "--size 480x270 --quality fast --filter trilinear".split():
        return [f"shows the options {' '.join(command)}"]
    if page.pixels != native_bytes(build, "12_effects", command):
        return ["--quality counts more than an option of its own"]
    return []


def check_comparison(page: LivePage, address: str) -> list[str]:
    problems = []
    for asked, expected in {
        "filter=nearest&against=trilinear": r"\d+ % of the pixels differ, by [\d.]+ of 255",
        "filter=trilinear&compare=yes": r"No pixel differs",
        "filter=nearest&against=trilinear&difference=8": r"% of the pixels differ",
    }.items():
        page.open(f"{address}/lesson_05.html#size=480x270&{asked}")
        if not re.search(expected, page.status):
            problems.append(f"{asked}: says {page.status}")
    both = [element.is_displayed() for element in page.all(".live canvas")]
    if both != [True, False]:
        problems.append("does not show the difference alone")
    page.open(f"{address}/lesson_05.html#size=480x270&filter=nearest&against=trilinear")
    tags = [tag.text for tag in page.all(".live .tag")]
    if tags != ["filter nearest", "filter trilinear"]:
        problems.append(f"names what is compared {tags}")
    return problems


def check_links(page: LivePage, site: Path, address: str) -> list[str]:
    """What the texts compare can be compared, and differs, or is about time alone."""
    problems = []
    for text in of_this_turn(sorted(site.glob("accuracy_*.html")), 2):
        found = re.findall(
            r'href="(lesson_\d\d\.html)#([^"]+)">Compare</a> (.*?)</p>', text.read_text("utf-8")
        )
        if not found and text.stem != "accuracy_costs":
            problems.append(f"{text.name} has no comparison")
        for lesson, options, words in found:
            options = f"size=480x270&{options.replace('&amp;', '&')}"
            if f"/{lesson}#" in page.browser.current_url:
                page.go(options)
            else:
                page.open(f"{address}/{lesson}#{options}")
            if ("RMS" in page.status) == ("the same picture" in words):
                problems.append(f"{text.name}: {words}: {page.status}")
    return problems


def check_failures(page: LivePage, address: str) -> list[str]:
    problems = []
    for asked, sentence in BAD_ADDRESSES.items():
        page.open(f"{address}/{asked}")
        if sentence not in page.status:
            problems.append(f"{asked}: says '{page.status}'")
        page.go("size=480x270")
        if "480 × 270 pixels in" not in page.status:
            problems.append(f"{asked}: draws nothing afterwards: {page.status}")
    for what, (script, sentence) in LACKS.items():
        added = page.browser.execute_cdp_cmd(
            "Page.addScriptToEvaluateOnNewDocument", {"source": script}
        )
        page.open(f"{address}/lesson_14.html")
        page.browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", added)
        if sentence not in page.status:
            problems.append(f"without {what}: says '{page.status}'")
        if not page.all(".contents img")[0].is_displayed():
            problems.append(f"without {what}: the still picture is gone")
    return problems


def check_accessibility(page: LivePage, address: str, axe: str) -> list[str]:
    """What axe-core calls serious or critical, with all options shown, light and dark."""
    problems = []
    for name in of_this_turn(ACCESSIBLE, 2):
        for scheme in ("light", "dark"):
            media = {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
            page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
            page.browser.get("about:blank")
            page.browser.get(f"{address}/{name}")
            if name.startswith("lesson"):
                page.wait()
            page.browser.execute_script(axe)
            page.browser.execute_script("document.querySelectorAll('details').forEach((it) => (it.open = true))")
            for fault in page.browser.execute_script("return axe.run().then((found) => found.violations)"):
                if fault["impact"] in ("serious", "critical"):
                    problems.append(f"{name}, {scheme}: {fault['help']}: {fault['nodes'][0]['html'][:150]}")
    return problems


def axe_of(build: Path) -> str:
    """The script that looks for what keeps people out."""
    axe = build / "axe/node_modules/axe-core/axe.min.js"
    if not axe.exists():
        skip(f"{axe} is missing: npm install --prefix {build / 'axe'} axe-core")
    return axe.read_text(encoding="utf-8")


def serve(site: Path, handler: type = QuietServer) -> tuple[http.server.ThreadingHTTPServer, str]:
    """A server of the site, and its address."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(handler, directory=site))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, f"http://127.0.0.1:{server.server_port}"


def main() -> None:
    site, build = (Path(argument).resolve() for argument in sys.argv[1:])
    browser = start_browser(site)
    if not (site / "live").exists():
        skip("the site's pages do not draw: clang 19 for WebAssembly was missing")
    axe = axe_of(build)
    server, address = serve(site)
    places = {"from the folder": site.as_uri(), "from a server": address}
    folder = places["from the folder"]
    columns, rows = WIDTHS["desk"]
    browser.set_window_size(columns, rows)
    browser.set_script_timeout(120)  # for WAIT
    page = LivePage(browser)
    problems = []
    try:
        for lesson in LESSONS:
            expected = native_bytes(build, lesson)
            for i, (place, address) in enumerate(places.items()):
                if is_turn_of(int(lesson[:2]) + i, 2):
                    found = check_bytes(page, address, lesson, expected)
                    problems += [f"{lesson}, {place}: {problem}" for problem in found]
            if is_turn_of(int(lesson[:2])):
                found = check_controls(page, folder, lesson, build)
                if lesson != "01_bresenham_lines":
                    found += check_probe(page, folder, lesson, build, site)
                problems += [f"{lesson}: {problem}" for problem in found]
            problems += check_log(browser, lesson, (folder, places["from a server"]))
        problems += check_click(page, folder) + check_keys(page, folder) + check_quality(page, folder, build)
        problems += check_comparison(page, folder)
        problems += check_links(page, site, folder)
        problems += check_log(browser, "comparisons", (folder,))
        problems += check_failures(page, folder)
        problems += check_accessibility(page, folder, axe)
    finally:
        browser.quit()
        server.shutdown()
    for problem in problems:
        print(problem)
    print(f"{len(LESSONS)} lessons in their pages; {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
