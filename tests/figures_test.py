"""Drags the live figures of the built site in headless Chromium: figures_test.py SITE_FOLDER.

Each figure is opened at desk and phone width. Every handle has to answer the pointer and the
keyboard, a finger on it must not scroll the page, every control has to change the picture, and the
values shown first are those of the texts' examples. Exits with 77 where something is missing, or with 1 if RASTERBOOK_SITE_REQUIRED
is set.
"""

import re
import sys
from pathlib import Path

from site_test import ROOT, WIDTHS, check_log, skip, start_browser

# What a figure's readout says at first: numbers of the derivation beside it.
EXAMPLES = {
    "line_methods": "k = 7 r = 2.5 e = 14 ≤ Δx = 14 so j = 2, e = 14 float y = 2.5000002",
    "edge_functions": "p = (2.5, 2.5) Ebc = 4 Eca = 6 Eab = 6 2A = 16",
    "shadow_bias": "light 38° above the floor bias of the floor: 0.0342 × 0 = 0",
    "clipping": "4 vertices, 2 triangles a: inside b: outside right",
    "tangent_basis": "h = 1 T to B: 116° T′ to B′: 90° texel (0, 0, 1)",
    "schedule": "T1 = 389 ms T8 = 49.4 ms speedup 7.9 idle 1.5 %",
    "footprint": "ϱ = 9.92 level = 3.31",
}

LIVE = """return document.querySelector(".figure.live") !== null &&
    document.querySelector(".figure .drawing").childElementCount > 0"""
# The picture before a figure: "shown", "hidden", or "none".
STILL = """const still = document.querySelector(".figure").previousElementSibling.querySelector("img");
return still === null ? "none" : still.getClientRects().length > 0 ? "shown" : "hidden";"""
DRAWN = """const figure = document.querySelector(".figure figure");
return figure.querySelector(".drawing").innerHTML + figure.querySelector(".readout").innerHTML;"""
MIDDLE = """const { x, y, width, height } = arguments[0].querySelector(".knob").getBoundingClientRect();
return [x + width / 2, y + height / 2];"""
SCROLLED = "return scrollY + document.getElementById('doc-content').scrollTop"
# But for what a picture within the picture cuts off.
TOO_WIDE = """return [...document.querySelectorAll(".figure .drawing > :not(svg)")].filter((it) => {
  const { left, right } = it.getBoundingClientRect();
  return left < 0 || right > innerWidth;
}).map((it) => it.outerHTML.slice(0, 80));"""
# A slider goes to one end; another control is clicked.
CHANGE = """const [control, end] = arguments;
if (control.type !== "range") control.click();
else {
  control.value = control[end];
  control.dispatchEvent(new Event("input"));
}"""


def figures() -> dict[str, str]:
    """Each figure's page, by the marks in the derivations."""
    return {
        name: f"derivation_{text.name[:2]}.html"
        for text in sorted(ROOT.glob("docs/derivations/*.md"))
        for name in re.findall(r"<!-- figure: (\w+) -->", text.read_text(encoding="utf-8"))
    }


class Figure:
    """A figure in an open page."""

    def __init__(self, browser, page: Path, width: str) -> None:
        from selenium.webdriver.support.ui import WebDriverWait

        columns, rows = WIDTHS[width]
        metrics = {"width": columns, "height": rows, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        browser.get(page.as_uri())
        WebDriverWait(browser, 10).until(lambda _: browser.execute_script(LIVE))
        self.browser = browser

    def all(self, selector: str) -> list:
        return self.browser.find_elements("css selector", f".figure {selector}")

    def changed_by(self, action) -> bool:
        before = self.browser.execute_script(DRAWN)
        action()
        return self.browser.execute_script(DRAWN) != before

    def bring_into_view(self, handle) -> None:
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", handle)

    def drag(self, handle, x: int, y: int) -> None:
        """Towards the middle of the picture, by so much to the side and up or down."""
        from selenium.webdriver import ActionChains

        knob, middle = handle.find_element("css selector", ".knob").rect, self.all("svg")[0].rect
        x = x if knob["x"] < middle["x"] + middle["width"] / 2 else -x
        y = y if knob["y"] < middle["y"] + middle["height"] / 2 else -y
        chain = ActionChains(self.browser, 0)
        chain.click_and_hold(handle.find_element("css selector", ".knob"))
        chain.move_by_offset(x, y).release().perform()

    def touch(self, handle) -> None:
        """A finger drags it downwards, which would scroll a page."""
        x, y = self.browser.execute_script(MIDDLE, handle)
        steps = [("touchStart", 0), *[("touchMove", 8 * i) for i in range(1, 6)], ("touchEnd", None)]
        for event, down in steps:
            points = [] if down is None else [{"x": x + down / 2, "y": y + down}]
            touch = {"type": event, "touchPoints": points}
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", touch)

    def scrolled_by(self, action) -> float:
        before = self.browser.execute_script(SCROLLED)
        action()
        return self.browser.execute_script(SCROLLED) - before


def check_figure(browser, name: str, page: Path, width: str) -> list[str]:
    from selenium.common.exceptions import TimeoutException
    from selenium.webdriver.common.keys import Keys

    try:
        figure = Figure(browser, page, width)
    except TimeoutException:
        return [f"{name}, {width}: does not start"]
    problems = []
    if browser.execute_script(STILL) == "shown":
        problems.append("the still picture stays beside it")
    shown = " ".join(figure.all(".readout")[0].text.split())
    if EXAMPLES[name] not in shown:
        problems.append(f"shows {shown!r}, not {EXAMPLES[name]!r}")
    problems += [f"is too wide: {shape}" for shape in browser.execute_script(TOO_WIDE)]
    ways = [(40, 0), (0, 40)]
    keys = [Keys.ARROW_LEFT, Keys.ARROW_RIGHT, Keys.ARROW_UP, Keys.ARROW_DOWN]
    for handle in figure.all(".handle"):
        label = handle.get_attribute("aria-label")
        figure.bring_into_view(handle)
        if not any([figure.changed_by(lambda: figure.drag(handle, *way)) for way in ways]):
            problems.append(f"the pointer does not move {label!r}")
        if not any([figure.changed_by(lambda: handle.send_keys(key)) for key in keys]):
            problems.append(f"the keyboard does not move {label!r}")
        figure.bring_into_view(handle)
        if figure.scrolled_by(lambda: figure.touch(handle)) != 0:
            problems.append(f"a finger on {label!r} scrolls the page")
    for control in figure.all("input:not(:checked)"):
        changes = [
            figure.changed_by(lambda: browser.execute_script(CHANGE, control, end))
            for end in ("min", "max")
        ]
        if not any(changes):
            text = control.find_element("xpath", "./..").text
            problems.append(f"{text!r} changes nothing")
    return [f"{name}, {width}: {problem}" for problem in problems]


def check_without_webassembly(browser, pages: list[Path]) -> list[str]:
    """The still pictures stay."""
    script = {"source": "delete window.WebAssembly"}
    browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", script)
    problems = []
    for page in pages:
        browser.get(page.as_uri())
        if browser.execute_script(STILL) == "hidden":
            problems.append(f"{page.name}: no still picture without WebAssembly")
        problems += check_log(browser, f"{page.name} without WebAssembly")
    return problems


def main() -> None:
    site = Path(sys.argv[1]).resolve()
    if (site / "index.html").exists() and not (site / "live/figure.js").exists():
        skip("the figures are not compiled; that takes clang++-19 when the site is built")
    browser = start_browser(site)
    pages = {name: site / page for name, page in figures().items()}
    problems = []
    try:
        for name, page in pages.items():
            for width in WIDTHS:
                problems += check_figure(browser, name, page, width)
                problems += check_log(browser, f"{name}, {width}")
        problems += check_without_webassembly(browser, list(pages.values()))
    finally:
        browser.quit()
    for problem in problems:
        print(problem)
    print(f"{len(pages)} figures at two widths; {len(problems)} problems")
    sys.exit(1 if problems or not pages else 0)


if __name__ == "__main__":
    main()
