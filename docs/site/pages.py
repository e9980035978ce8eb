"""Makes Doxygen's pages of the course's texts: pages.py BUILD_FOLDER KATEX_FOLDER [--live] [--editor].

The texts are written for GitHub. Here their formulas, links, pictures and quoted equations become
what Doxygen 1.9.4 understands, each lesson gets a page of what it changes, and the pages of
a lesson get links to each other. With --live, a lesson's page draws its picture itself; with --editor,
it can be written there, if BUILD_FOLDER/live has the editor. It writes
BUILD_FOLDER/site_pages, and BUILD_FOLDER/site what Doxygen does not bring itself.
"""

import html
import json
import os
import re
import shutil
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from exercises import EXERCISE, sandbox_files
from links import EQUATION, LESSONS, ROOT, link_equations, source_page


class Page(NamedTuple):
    """A page of the site; `kind` is what a lesson's navigation calls it."""

    name: str
    kind: str
    text: Path | None


def lesson_pages(lesson: str) -> list[Page]:
    """What belongs to a lesson, in the order of reading."""
    number = lesson[:2]
    pages = [
        Page(f"lesson_{number}", f"Lesson {number}", ROOT / "lessons" / lesson / "README.md"),
        Page(f"derivation_{number}", "Derivation", ROOT / "docs/derivations" / f"{lesson}.md"),
        Page(f"accuracy_{number}", "Accuracy", ROOT / "docs/accuracy" / f"{lesson}.md"),
        Page(f"changes_{number}", "What changed", None),
    ]
    return [page for page in pages if page.text is None or page.text.exists()]


COURSE = [lesson_pages(lesson) for lesson in LESSONS]
OTHERS = [
    Page("index", "Start", ROOT / "README.md"),
    Page("costs", "What accuracy costs", ROOT / "docs/accuracy/costs.md"),
    Page("roofline", "Where the time goes", ROOT / "docs/roofline.md"),
    Page("side_by_side", "Side by side", ROOT / "docs/side_by_side.md"),
    Page("troubleshooting", "Troubleshooting", ROOT / "docs/troubleshooting.md"),
    Page("glossary", "Glossary", ROOT / "docs/glossary.md"),
    Page("conventions", "Conventions", ROOT / "docs/conventions.md"),
    Page("gltf", "glTF scenes", ROOT / "docs/gltf.md"),
    Page("toon_materials", "Toon materials", ROOT / "lessons/07_toon/toon_materials.md"),
    Page("working_on_your_own", "Working on your own", ROOT / "docs/working_on_your_own.md"),
    Page("where_next", "Where to go from here", ROOT / "docs/where_next.md"),
    Page("animation", "Animation", ROOT / "docs/animation.md"),
    Page("reliability", "Reliability", ROOT / "docs/reliability.md"),
    Page("assets", "Assets", ROOT / "assets/README.md"),
]
GALLERY = Page("gallery", "Gallery", None)
SANDBOX = Page("sandbox", "Sandbox", None)
PAGE_OF = {page.text: page for page in [*sum(COURSE, []), *OTHERS] if page.text}
EQUATIONS = {
    number
    for text in PAGE_OF
    for number in re.findall(r"\\tag\{([\d.]+)\}", text.read_text(encoding="utf-8"))
}

# What a text is searched for, in this order: code stays as it is.
TOKENS = re.compile(
    r"""^```diff\n(?P<diff>.*?)^```$ | ^```math\n(?P<display>.*?)\n```$ | \$`(?P<math>[^`\n]+)`\$
      | ^```.*?^```$ | `[^`\n]+`
      | \$(?P<inline>[^$\n]+)\$
      | (?P<comment><!--.*?-->)
      | <details><summary>(?P<summary>.*?)</summary> | (?P<end></details>)
      | \[!\[(?P<link_alt>[^\]]*)\]\((?P<link_picture>[^)\s]+)\)\]\((?P<link_target>[^)\s]+)\)
      | !\[(?P<alt>[^\]]*)\]\((?P<picture>[^)\s]+)\)
      | \]\((?P<target>[^)\s]+)\)
      | (?P<sources><picture>.*?</picture>)
      | <[a-z][^<>]*> | (?P<quote>")
      | (?P<equation>%s)
      | \((?P<number>\d+\.\d+)\)"""
    % EQUATION.pattern.replace(" ", "[ ]"),
    re.DOTALL | re.MULTILINE | re.VERBOSE,
)
# Doxygen does not see emphasis around a formula.
EMPHASIS_WITH_FORMULA = re.compile(
    r"(?<![*\w])(\*\*?)(?=[^\s*])([^*\n]*\\endhtmlonly[^*\n]*)(?<=\S)\1(?![*\w])"
)


class Site:
    """The folders that are written, and the texts on their way there."""

    def __init__(self, build: Path, is_live: bool, is_editor: bool) -> None:
        self.is_live = is_live
        scripts = build / "live/scripts"
        self.has_editor = is_editor and all(
            (scripts / part).exists() for part in ("editor/editor.js", "compiler/manifest.json")
        )
        written = scripts / "compiler/lessons.json"
        self.written = set(json.loads(written.read_text("utf-8"))) if self.has_editor else set()
        self.kept = build / "webp"  # pictures that were converted before
        self.to_webp: dict[Path, Path] = {}
        self.pages, self.site = build / "site_pages", build / "site"
        self.code: list[Page] = []  # code that texts link to and Doxygen does not read
        for folder in (self.pages, self.site):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)

    def link(self, text: Path, target: str) -> str:
        """The address on the site of what `target` is in a text."""
        if re.match(r"https?:", target):
            return target
        path, _, anchor = target.partition("#")
        file = (text.parent / path).resolve() if path else text
        if file in PAGE_OF:
            return f"{PAGE_OF[file].name}.html" + (f"#{anchor}" if anchor else "")
        if file.suffix not in (".cpp", ".hpp"):
            shutil.copy(file, self.site / f"{file.name}.txt")
            return f"{file.name}.txt"
        shown = file.relative_to(ROOT)
        if shown.parts[0] in ("common", "lessons") and "starter" not in shown.parts:
            return source_page(file)
        page = Page(f"code_{file.stem}", file.name, file)
        if page not in self.code:
            self.code.append(page)
            self.write(page.name, f"# {shown} {{#{page.name}}}\n\n\\includelineno {shown}\n")
        return f"{page.name}.html"

    def picture_file(self, text: Path, target: str) -> str:
        """The name on the site of a picture of a text, which is copied there."""
        return Path(shutil.copy(text.parent / target, self.site)).name

    def picture(self, text: Path, target: str, alt: str) -> str:
        """A picture of a text."""
        file = text.parent / target
        size = ""
        if file.suffix == ".png":
            name = f"{file.name}.webp"
            self.to_webp[file.resolve()] = self.site / name
            # So that nothing moves when it comes; PNG has both numbers at this place.
            width, height = struct.unpack(">II", file.read_bytes()[16:24])
            size = f' width="{width}" height="{height}"'
        else:
            name = self.picture_file(text, target)
        return f'<img src="{name}" alt="{html.escape(alt)}"{size} loading="lazy"/>'

    def live(self, page: Page, comment: str) -> str:
        """What a comment asks for where pages draw: a figure, or a link to a comparison.

        `figure: NAME` is docs/live/figures/NAME; `compare: OPTIONS | in words` are options of the
        page's lesson; `sandbox: in words` is a link to the sandbox, which comes with the editor.
        """
        if not self.is_live:
            return ""
        if words := re.fullmatch(r"<!-- sandbox: (.+) -->", comment):
            link = '<a href="sandbox.html">Open the sandbox</a>'
            return html_only(f'<p class="compare">{link} {words[1]}</p>') if self.has_editor else ""
        if name := re.fullmatch(r"<!-- figure: (\w+) -->", comment):
            return html_only(
                f'<div class="figure" data-name="{name[1]}"></div>\n'
                '<link rel="stylesheet" href="live/figure.css">'
                '<script src="live/figure.js" defer></script>'
                f'<script src="live/figure_{name[1]}.js" defer></script>'
            )
        if asked := re.fullmatch(r"<!-- compare: (\S+) \| (.+) -->", comment):
            address = f"lesson_{page.name[-2:]}.html#{html.escape(asked[1])}"
            return html_only(f'<p class="compare"><a href="{address}">Compare</a> {asked[2]}</p>')
        return ""

    def convert_pictures(self) -> None:
        """The same pixels in half of the bytes."""
        self.kept.mkdir(exist_ok=True)

        def convert(png: Path, webp: Path) -> None:
            kept = self.kept / webp.name
            if not kept.exists() or kept.stat().st_mtime < png.stat().st_mtime:
                options = ["-quiet", "-lossless", "-exact", "-z", "3"]
                subprocess.run(["cwebp", *options, png, "-o", kept], check=True)
            shutil.copy(kept, webp)

        with ThreadPoolExecutor() as pool:
            list(pool.map(lambda pair: convert(*pair), self.to_webp.items()))

    def without_a_command_line(self, number: str, text: str) -> str:
        """A lesson's text that says where its page has what the command line has."""
        diff = f"`./lessons/run --diff {number}`"
        text = text.replace(diff, f"[{diff}](changes_{number}.html)")
        if not any(lesson.startswith(number) for lesson in self.written):
            return text
        heading = "## Write it yourself\n"
        note = (
            "Here, the button **Write it yourself** below the picture opens these files in an editor, "
            "with the same steps and tests. On the command line:\n"
        )
        return text.replace(heading, f"{heading}\n{note}")

    def write(self, name: str, text: str) -> None:
        (self.pages / f"{name}.md").write_text(text, encoding="utf-8")

    def convert(self, page: Page) -> str:
        """A text as Doxygen wants it, without its title."""
        text = page.text.read_text(encoding="utf-8")
        if self.has_editor and page.name.startswith("lesson_"):
            text = with_sandbox(page.name[-2:], text)

        def convert_token(found: re.Match[str]) -> str:
            if found["diff"]:
                return html_only(marked(found["diff"]))
            if formula := found["display"]:
                tag = re.search(r"\\tag\{(\d+)\.(\d+)\}", formula)
                anchor = tag and f'<a class="anchor" id="eq_{tag[1]}_{tag[2]}"></a>'
                return (html_only(anchor) if anchor else "") + f"\\f[{formula}\\f]"
            if formula := found["inline"] or found["math"]:
                return f"\\htmlonly\\({html.escape(formula)}\\)\\endhtmlonly"
            if mark := re.fullmatch(r"<!-- exercise: (\d\d)\.(\d+) -->", found["comment"] or ""):
                return html_only(f'<a class="anchor" id="exercise_{mark[2]}"></a>')
            if mark := re.fullmatch(r"<!-- try: ([\d.]+) -->", found["comment"] or ""):
                link = f'<a href="sandbox.html#start={mark[1]}">Try it in the sandbox</a>'
                return html_only(f'<p class="compare try">{link}</p>')
            if found["comment"]:
                return self.live(page, found["comment"])
            if found["summary"]:
                return html_only(f"<details><summary>{found['summary']}</summary>")
            if found["end"]:
                return html_only("</details>")
            if found["link_picture"]:
                picture = self.picture(page.text, found["link_picture"], found["link_alt"])
                return f'<a href="{self.link(page.text, found["link_target"])}">{picture}</a>'
            if found["picture"]:
                return self.picture(page.text, found["picture"], found["alt"])
            if found["sources"]:
                return html_only(
                    re.sub(
                        r'(?<=src=")[^"]+|(?<=srcset=")[^"]+',
                        lambda target: self.picture_file(page.text, target[0]),
                        found["sources"],
                    )
                )
            if target := found["target"]:
                return f"]({self.link(page.text, target)})"
            if found["quote"]:
                # Between plain ones Doxygen would leave formulas as they are.
                return "\u201c" if found.string[found.start() - 1] in " \n(|" else "\u201d"
            if found["equation"]:
                return link_equations(found["equation"])
            if found["number"] in EQUATIONS:
                return f"({link_equations(found['number'])})"
            return found[0]

        text = TOKENS.sub(convert_token, text).partition("\n")[2]
        if page.name.startswith("lesson_"):
            text = self.without_a_command_line(page.name[-2:], text)
        text = EMPHASIS_WITH_FORMULA.sub(
            lambda found: "<{0}>{1}</{0}>".format("b" if found[1] == "**" else "em", found[2]), text
        )
        if page.name != "index":
            text = re.sub(r"^## (.*)$", with_anchor, text, flags=re.MULTILINE)
        else:  # its headings are not to stand between the lessons in the tree
            text = re.sub(r"^## (.*)$", r"<h2>\1</h2>", text, flags=re.MULTILINE)
        return text


def place_to_draw(lesson: str, has_editor: bool) -> str:
    """Where the page draws, as docs/live/live.js takes it; with the editor's button."""
    models = " ".join(
        file.name for file in sorted((ROOT / "assets/models").iterdir())
        if file.suffix in (".obj", ".glb", ".gltf")
    )
    editor = " data-editor" if has_editor else ""
    live = f'<div class="live" data-lesson="{lesson}" data-models="{models}"{editor}></div>'
    return html_only(f'{live}<script src="live/live.js" defer></script>')


def with_live_picture(lesson: str, text: str, has_editor: bool) -> str:
    """A lesson's text with the place, behind its first picture, where the page draws."""

    def first(image: re.Match[str]) -> str:
        return image[0].replace(' loading="lazy"', "") + place_to_draw(lesson, has_editor)

    return re.sub(r"<img [^>]*>", first, text, count=1)


def with_sandbox(number: str, text: str) -> str:
    """A lesson's text with a mark before each exercise, and one for its link before the answer."""
    before, heading, turn = text.partition("\n## Your turn\n")

    def marked_exercise(found: re.Match[str]) -> str:
        name = f"{number}.{found[1]}"
        asked, answer, rest = found[0].partition("<details><summary>Answer ")
        return f"<!-- exercise: {name} -->\n\n{asked}<!-- try: {name} -->\n\n{answer}{rest}"

    return before + heading + EXERCISE.sub(marked_exercise, turn)


def with_anchor(heading: re.Match[str]) -> str:
    """A heading that is found by the name which GitHub gives it."""
    name = re.sub(r"[^\w -]", "", heading[1].lower()).replace(" ", "-")
    return html_only(f'<a class="anchor" id="{name}"></a>') + f"\n{heading[0]}"


def title(page: Page) -> str:
    """The first line of a text, without its "# "."""
    return page.text.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")


def html_only(code: str) -> str:
    return f"\n\\htmlonly[block]\n{code}\n\\endhtmlonly\n"


def steps(lesson: int, current: Page) -> str:
    """The line that leads through a lesson's pages and on to the next lesson."""
    links = [
        f'<a href="{page.name}.html"{" aria-current=page" * (page == current)}>{page.kind}</a>'
        for page in COURSE[lesson]
    ]
    for following, *_ in COURSE[lesson + 1 : lesson + 2]:
        links.append(f'<a class="on" href="{following.name}.html">{following.kind}</a>')
    return html_only(f'<nav class="steps" aria-label="This lesson">{" ".join(links)}</nav>')


def neighbours(lesson: int, current: Page) -> str:
    """Links to the pages before and after, through the whole course."""
    start = OTHERS[0]
    conventions = next(page for page in OTHERS if page.name == "conventions")
    order = [start, *sum(COURSE, []), conventions]
    at = order.index(current)
    before, after = order[at - 1], order[at + 1]
    names = {before: before.kind, after: after.kind}
    if current == COURSE[lesson][0] and lesson > 0:
        names[before] = f"{COURSE[lesson - 1][0].kind}: {before.kind.lower()}"
    if current == COURSE[lesson][-1] and after != conventions:
        names[after] = title(after)
    return html_only(
        '<nav class="neighbours" aria-label="Before and after">'
        f'<a class="before" href="{before.name}.html">{names[before]}</a>'
        f'<a class="next" href="{after.name}.html">{names[after]}</a></nav>'
    )


def changes(lesson: int) -> str:
    """What ./lessons/run --diff prints, as a page's text."""
    name = LESSONS[lesson]
    command = f"./lessons/run --diff {name[:2]}"
    output = subprocess.run(
        [ROOT / "lessons/run", "--diff", name],
        check=True,
        capture_output=True,
        encoding="utf-8",
        env={**os.environ, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull},
    ).stdout
    diff, _, files = output.partition("\nmain.cpp: ") if lesson else ("", "", output)
    count, _, files = files.partition("\n")
    new = [
        f"- [`{Path(path).name}`]({source_page(ROOT / path)}), {length} lines"
        for path, length in re.findall(r"^new: (\S+), (\d+) lines$", files, re.MULTILINE)
    ]
    if lesson:
        compared = re.findall(r"^(?:---|\+\+\+) lessons/(\S+)/main\.cpp$", diff, re.MULTILINE)
        before, after = (
            f"[{folder}/main.cpp]({source_page(ROOT / 'lessons' / folder / 'main.cpp')})"
            for folder in compared
        )
        count = re.sub(r"(\d+) insertions?\(\+\)", r"**\1 lines added**", count)
        count = re.sub(r"(\d+) deletions?\(-\)", r"**\1 removed**", count)
        summary = f"From {before} to {after}: {count}."
    else:
        summary = count
    text = [
        summary + (" Indentation is passed over." if lesson else ""),
        "New files:" if lesson and new else "",
        *new,
        *([html_only(marked(diff[diff.index("@@") :]))] if diff else []),
        f"In a terminal: `{command}`",
    ]
    return "\n\n".join(text) + "\n"


def marked(diff: str) -> str:
    """A diff as HTML, each line with its kind."""
    kinds = {"+": "added", "-": "removed", "@": "place"}
    lines = [
        f'<span class="{kinds.get(line[:1], "same")}">{html.escape(line) or " "}</span>'
        for line in diff.splitlines()
    ]
    return f'<pre class="diff">{"".join(lines)}</pre>'


def gallery() -> str:
    """A card a lesson: a picture that site.js turns, and what the lesson's text begins with."""
    cards = []
    for lesson, (page, *_) in zip(LESSONS, COURSE):
        sentence = re.search(r"^> (.*)$", page.text.read_text(encoding="utf-8"), re.MULTILINE)
        cards.append(
            f'<li><img src="{lesson}_still.webp" data-turn="{lesson}.webp" alt=""/>\n'
            f'<h2><a href="{page.name}.html">{html.escape(title(page))}</a></h2>\n'
            f"<p>{html.escape(sentence[1])}</p></li>"
        )
    return html_only(f'<ul class="gallery">\n{"".join(cards)}\n</ul>')


def sandbox() -> str:
    """The page of whatever a reader wants to try."""
    return f"""All lessons' headers are at hand here: include what you need, and draw. An option that the
program declares becomes a control below its picture; `run_lesson` hands over the scene that is
chosen there. What you write stays in this browser.
{place_to_draw("sandbox", True)}"""


def layout(code: list[Page], has_editor: bool) -> str:
    """The navigation tree, for Doxygen."""

    def tab(page: Page, name: str, inside: str = "") -> str:
        kind = "usergroup" if inside else "user"
        name = html.escape(name)
        return f'<tab type="{kind}" url="{page.name}.html" title="{name}">{inside}</tab>\n'

    tabs = ['<tab type="mainpage" title="Start"/>\n', tab(GALLERY, GALLERY.kind)]
    for lesson, *parts in COURSE:
        tabs.append(tab(lesson, title(lesson), "".join(tab(part, part.kind) for part in parts)))
    tabs += [tab(page, page.kind) for page in ([SANDBOX] if has_editor else []) + OTHERS[1:]]
    tabs.append(
        '<tab type="usergroup" url="files.html" title="The code">'
        '<tab type="filelist" title="Files"/><tab type="classlist" title="Classes"/>\n'
        + "".join(tab(page, page.kind) for page in sorted(code))
        + "</tab>\n"
    )
    return f'<doxygenlayout><navindex>\n{"".join(tabs)}</navindex></doxygenlayout>\n'


def copy_katex(katex: Path, site: Path) -> None:
    """KaTeX with the fonts of the one format that every browser of today reads."""
    (site / "katex/fonts").mkdir(parents=True)
    shutil.copy(katex / "katex.min.js", site / "katex/katex.js")
    shutil.copy(katex / "contrib/auto-render.js", site / "katex")
    style = (katex / "katex.min.css").read_text(encoding="utf-8")
    style = re.sub(r",url\([^)]*\) format\(['\"](?:woff|truetype)['\"]\)", "", style)
    (site / "katex/katex.css").write_text(style, encoding="utf-8")
    for font in (katex / "fonts").glob("*.woff2"):
        shutil.copy(font, site / "katex/fonts")


def main() -> None:
    build, katex = map(Path, sys.argv[1:3])
    site = Site(build, "--live" in sys.argv, "--editor" in sys.argv)
    copy_katex(katex, site.site)
    for page in OTHERS:
        label = "mainpage" if page.name == "index" else page.name
        site.write(page.name, f"# {title(page)} {{#{label}}}\n{site.convert(page)}")
    site.write(GALLERY.name, f"# {GALLERY.kind} {{#{GALLERY.name}}}\n{gallery()}")
    if site.has_editor:
        site.write(SANDBOX.name, f"# {SANDBOX.kind} {{#{SANDBOX.name}}}\n{sandbox()}")
        (site.site / "live/editor").mkdir(parents=True)
        (site.site / "live/editor/exercises.json").write_text(sandbox_files(), encoding="utf-8")
    shutil.copytree(build / "cards", site.site, dirs_exist_ok=True)
    for lesson, pages in enumerate(COURSE):
        for page in pages:
            name = title(page) if page.text else f"What lesson {LESSONS[lesson][:2]} changes"
            text = site.convert(page) if page.text else changes(lesson)
            if site.is_live and page == pages[0]:
                text = with_live_picture(LESSONS[lesson], text, LESSONS[lesson] in site.written)
            text = f"{steps(lesson, page)}\n{text}{neighbours(lesson, page)}"
            site.write(page.name, f"# {name} {{#{page.name}}}\n{text}")
    site.convert_pictures()
    (site.pages / "layout.xml").write_text(layout(site.code, site.has_editor), encoding="utf-8")


if __name__ == "__main__":
    main()
