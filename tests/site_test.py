"""Opens the built site in headless Chromium: site_test.py SITE_FOLDER.

Every page of text and some of the code are looked at, at desk and phone width, light and dark;
the links of all pages are followed. If RASTERBOOK_TURN is such as 1/4, only every fourth page is
opened at phone width, from number 1 on, and every other one at desk width. Exits with 77 where
something is missing, or with 1 if RASTERBOOK_SITE_REQUIRED is set.
"""

import json
import os
import re
import shutil
import sys
from collections.abc import Iterable
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[1]
LESSONS = sorted(folder.name for folder in (ROOT / "lessons").glob("[0-9][0-9]_*"))
TEXTS = (
    r"index|gallery|sandbox|costs|roofline|side_by_side|troubleshooting|glossary|conventions|gltf|animation|assets"
    r"|(lesson|derivation|accuracy|changes)_\d\d|code_.+"
)
CODE = r"files|annotated|(triangle|image|lesson__app)_8hpp(_source)?|classrasterbook_1_1Image"
WIDTHS = {"desk": (1280, 900), "phone": (390, 844)}

# What a page says is wrong with itself.
INSPECTION = r"""return (async (isText, isDark) => {
const isAsAsked = () => matchMedia("(prefers-color-scheme: dark)").matches === isDark &&
  document.documentElement.classList.contains("dark-mode") === isDark;
for (let i = 0; i < 500 && !isAsAsked(); ++i) await new Promise((done) => setTimeout(done, 20));  // the page has to hear of it
for (const image of document.images) image.loading = "eager";
await Promise.allSettled([document.fonts.ready, ...[...document.images].map(i => i.decode())]);
const problems = [];
for (const box of [document.scrollingElement, document.getElementById("doc-content")])
  if (box.scrollWidth > box.clientWidth)
    problems.push(`is ${box.scrollWidth} pixels wide on a screen of ${box.clientWidth}`);
if (document.scrollingElement.scrollHeight > document.scrollingElement.clientHeight)
  problems.push("goes on below the box that scrolls");
for (const image of document.images)
  if (!image.complete || image.naturalWidth === 0) problems.push(`does not show ${image.src}`);
if (isText) {
  const prose = document.querySelector(".contents").cloneNode(true);
  for (const other of prose.querySelectorAll("code, pre, .fragment, .katex")) other.remove();
  const raws = /.{0,20}(\$|\\[a-zA-Z()[\]]|\*|\]\(|`).{0,20}/g;
  for (const raw of prose.textContent.match(raws) ?? [])
    problems.push(`shows what should have been set: ${raw}`);
}
const [red, green, blue] = getComputedStyle(document.body).backgroundColor.match(/\d+/g);
return { problems, equations: document.querySelectorAll(".katex .tag").length,
         formulas: document.querySelectorAll(".katex").length, ground: +red + +green + +blue };
})(...arguments)"""


def skip(reason: str) -> None:
    print(f"skipped: {reason}")
    sys.exit(1 if os.environ.get("RASTERBOOK_SITE_REQUIRED") else 77)


def is_turn_of(number: int, most_turns: int | None = None) -> bool:
    """Whether what has this number is to be tried; without RASTERBOOK_TURN, all is.

    @param most_turns  In so many turns all is tried, however many there are.
    """
    remainder, turns = map(int, os.environ.get("RASTERBOOK_TURN", "0/1").split("/"))
    if most_turns:
        turns = min(turns, most_turns)
    return number % turns == remainder % turns


def of_this_turn(things: Iterable, most_turns: int | None = None) -> list:
    """Those whose place in the list has its turn."""
    return [thing for i, thing in enumerate(things) if is_turn_of(i, most_turns)]


class Links(HTMLParser):
    """A page's links, its anchors, and where it says to go next."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.targets: list[tuple[str, str]] = []
        self.anchors: set[str] = set()
        self.next = ""
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        for name in ("href", "src", "srcset", "data"):
            if name in values:
                self.targets.append((tag, values[name]))
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        if values.get("class") == "next":
            self.next = values["href"]


def check_links(site: Path) -> list[str]:
    """Every link of every page, of the tree and of the menu leads somewhere."""
    problems = []
    pages = {page.name: Links(page) for page in sorted(site.glob("*.html"))}
    for name, page in pages.items():
        for tag, target in page.targets:
            url = urlsplit(target)
            file = unquote(url.path) or name
            if url.scheme:
                if tag != "a" and url.scheme not in ("javascript", "data"):
                    problems.append(f"{name}: loads from elsewhere: {target}")
            elif not (site / file).exists():
                problems.append(f"{name}: a dead link: {target}")
            elif url.fragment and "=" not in url.fragment and file in pages and url.fragment not in pages[file].anchors:
                problems.append(f"{name}: a link to no anchor: {target}")
    for script in ("navtreedata.js", "menudata.js"):
        # But for Doxygen's own list of where parts of the tree begin.
        tree = (site / script).read_text(encoding="utf-8").split("var NAVTREEINDEX")[0]
        for target in re.findall(r'"([\w-]+\.html)', tree):
            if target not in pages:
                problems.append(f"{script}: a dead link: {target}")
    way = ["lesson_01.html"]
    while (following := pages[way[-1]].next) in pages and following not in way:
        way.append(following)
    for name in sorted(pages):
        if re.match(r"(lesson|derivation|accuracy|changes)_\d\d\.html", name) and name not in way:
            problems.append(f"{name}: no way leads there from lesson 01 by what comes next")
    return problems


def check_view(browser, page: Path, width: str, scheme: str) -> list[str]:
    """One page at one width: loaded in light, and looked at again in dark."""
    columns, rows = WIDTHS[width]
    metrics = {"width": columns, "height": rows, "deviceScaleFactor": 1, "mobile": columns < 768}
    media = {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
    if scheme == "light":
        browser.get(page.as_uri())
    seen = browser.execute_script(INSPECTION, bool(re.fullmatch(TEXTS, page.stem)), scheme == "dark")
    problems = seen["problems"]
    if (seen["ground"] < 200) != (scheme == "dark"):
        problems.append("has the wrong background")
    if seen["formulas"] != len(re.findall(r"\\[(\[]", formulas_of(page))):
        problems.append(f"has set {seen['formulas']} formulas, not all")
    for text in ROOT.glob(f"docs/derivations/{page.stem.removeprefix('derivation_')}_*.md"):
        numbered = text.read_text(encoding="utf-8").count("\\tag{")
        if seen["equations"] != numbered:
            problems.append(f"has {seen['equations']} numbered equations of {numbered}")
    return [f"{page.name}, {width}, {scheme}: {problem}" for problem in problems]


def formulas_of(page: Path) -> str:
    """A page's text without its code, where "\\(" would be no formula."""
    text = page.read_text(encoding="utf-8").partition('<div class="contents">')[2]
    return re.sub(r'<div class="line">.*?</div>|<(code|pre)\b.*?</\1>', "", text, flags=re.DOTALL)


def check_gallery(browser, page: Path) -> list[str]:
    """A card turns under the pointer and with the focus, and rests afterwards."""
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By

    problems = []

    def expect(is_turning: bool, when: str) -> None:
        shown = [Path(picture.get_attribute("src")).name for picture in pictures]
        expected = [f"{lesson}{'' if is_turning else '_still'}.webp" for lesson in LESSONS[:1]]
        expected += [f"{lesson}_still.webp" for lesson in LESSONS[1:]]
        if shown != expected:
            problems.append(f"{page.name}, {when}: shows {' '.join(shown)}")

    for motion in ("no-preference", "reduce"):
        media = {"features": [{"name": "prefers-reduced-motion", "value": motion}]}
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
        browser.get(page.as_uri())
        pictures = browser.find_elements(By.CSS_SELECTOR, ".gallery img")
        link = browser.find_element(By.CSS_SELECTOR, ".gallery a")
        title = browser.find_element(By.CSS_SELECTOR, ".title")
        turns = motion != "reduce"
        expect(False, f"{motion}, at first")
        ActionChains(browser).move_to_element(pictures[0]).perform()
        expect(turns, f"{motion}, under the pointer")
        ActionChains(browser).move_to_element(title).perform()
        expect(False, f"{motion}, with the pointer elsewhere")
        browser.execute_script("arguments[0].focus()", link)
        expect(turns, f"{motion}, with the focus")
        browser.execute_script("arguments[0].blur()", link)
        expect(False, f"{motion}, without the focus")
    for lesson in LESSONS:
        frames = (page.parent / f"{lesson}.webp").read_bytes().count(b"ANMF")
        if frames < 24:
            problems.append(f"{page.name}: the turn of {lesson} has {frames} frames")
    return problems


def check_log(browser, after: str, hosts: tuple[str, ...] = ("file:",)) -> list[str]:
    """What the browser noted since last asked: errors, requests that failed or left the site."""
    problems = [f"{after}: {entry['message']}" for entry in browser.get_log("browser")]
    for entry in browser.get_log("performance"):
        event = json.loads(entry["message"])["message"]
        if event["method"] == "Network.loadingFailed" and not event["params"].get("canceled"):
            problems.append(f"{after}: a request failed: {event['params']['errorText']}")
        elif event["method"] == "Network.requestWillBeSent":
            url = event["params"]["request"]["url"]
            if not url.startswith((*hosts, "data:", "blob:", "about:")):
                problems.append(f"{after}: asks another host: {url}")
    return problems


def start_browser(site: Path):
    """Chromium without a window, if all is there that it takes."""
    try:
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        skip("python3-selenium is not installed")
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        skip("chromium and chromium-driver are not installed")
    if not (site / "index.html").exists():
        skip("the site is not built; ./docs/run builds it")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(options=options, service=Service(driver))


def main() -> None:
    site = Path(sys.argv[1]).resolve()
    browser = start_browser(site)
    problems = check_links(site)
    files = sorted(site.glob("*.html"))
    pages = [file for file in files if re.fullmatch(f"{TEXTS}|{CODE}", file.stem)]
    on_desk = of_this_turn(pages, 2)
    on_phone = of_this_turn(pages)
    try:
        for page in pages:
            for width, of_width in zip(WIDTHS, (on_desk, on_phone)):
                if page not in of_width:
                    continue
                for scheme in ("light", "dark"):
                    problems += check_view(browser, page, width, scheme)
                    problems += check_log(browser, page.name)
        problems += check_gallery(browser, site / "gallery.html")
    finally:
        browser.quit()
    for problem in dict.fromkeys(problems):
        print(problem)
    print(f"{len(pages)} pages; {len(on_desk)} at desk width, {len(on_phone)} at phone width, light and dark; {len(problems)} problems")
    sys.exit(1 if problems or len(pages) < 20 else 0)


if __name__ == "__main__":
    main()
