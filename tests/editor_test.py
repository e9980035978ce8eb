"""Writes lessons in their pages, in headless Chromium: editor_test.py SITE_FOLDER BUILD_FOLDER.

A stand-in takes the compiler's place: it answers at once, so that what the editor itself does can
be tried in seconds. Exits with 77 where something is missing, or with 1 if
RASTERBOOK_SITE_REQUIRED is set.
"""

import base64
import functools
import http.server
import io
import json
import re
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from pathlib import Path

from live_test import LESSONS, PIXELS, native_bytes
from site_test import ROOT, check_log, skip, start_browser

SIZES = {"desk": (1400, 1000), "phone": (390, 844)}
# A page's state, once nothing is under way.
IS_DONE = """const { run, state } = document.querySelector(".live").dataset;
return run === "done" && (state === "ready" || state === "failed");"""
OUTCOME = "return document.querySelector('.outcome').textContent"
WRITTEN = "return document.querySelector('.cm-content').cmTile.view.state.doc.toString()"
KEPT = "return localStorage.getItem(`rasterbook ${arguments[0]}`)"
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

    def log_message(self, *_: object) -> None:
        pass

    def translate_path(self, path: str) -> str:
        if path == "/live/compiler/toolchain.js":
            return str(ROOT / "tests/support/toolchain_stand_in.js")
        if path.startswith("/live/compiler/golden/"):
            return str(ROOT / "tests/golden" / Path(path).name)
        return super().translate_path(path)

    def do_GET(self) -> None:
        if self.path != "/live/compiler/lessons.json":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(self.lessons)))
        self.end_headers()
        self.wfile.write(self.lessons)


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
        return self.browser.find_element("xpath", f"//button[normalize-space()='{text}']")

    def until(self, true, seconds: float = 60) -> None:
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.browser, seconds, 0.02).until(lambda _: true())

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
