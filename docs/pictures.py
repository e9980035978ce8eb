"""Draws the pictures that no test draws:
pictures.py cover BUILD_FOLDER | strip BUILD_FOLDER | turn BUILD_FOLDER |
            card LESSON BUILD_FOLDER FOLDER | mistakes [PICTURE...] | answers [NN [K]] |
            check-answers.

`cover` draws README.md's first picture by the command below it.

`strip` puts README.md's second picture together, a panel a lesson, each drawn by the lesson's own
program with the options in its README's line "strip: OPTIONS".

`turn` draws README.md's animation by the command below it.

`card` draws a lesson's card of the site's gallery, with the options in its README's line
"turn: OPTIONS": FOLDER/LESSON.webp, an animation of one turn, and FOLDER/LESSON_still.webp, its
first frame.

`mistakes` makes the mistakes of docs/troubleshooting.md, one after the other, in a copy of the code:
in the file that a section links to last before its diff, the right line (+) is replaced by the
wrong one (-). The lesson is built and draws with the section's command. Where the right line is
not found once, that is an error: the page is not up to date.

`answers` does so with the answers to the exercises in lessons/NN_*/README.md. An answer's diff is a
unified one whose lines "@@" have no numbers, the lesson then draws with its first command, and the
picture is the one that the answer shows. `check-answers` draws all of them, and compares; with a TURN
such as 1/4, only those of the lessons whose number divided by 4 leaves 1.
"""

import contextlib
import fcntl
import math
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
LESSONS = sorted(folder.name for folder in (ROOT / "lessons").glob("[0-9][0-9]_*"))

Picture = list[bytes]  # rows from the top, red, green and blue of each pixel


def read_bmp(file: Path) -> Picture:
    data = file.read_bytes()
    (begin,) = struct.unpack_from("<I", data, 10)
    width, height = struct.unpack_from("<ii", data, 18)
    stride = (3 * width + 3) // 4 * 4
    data = data.ljust(begin + stride * height, b"\0")  # a file may be wrong on purpose
    rows = []
    for y in range(height):
        stored = data[begin + y * stride : begin + y * stride + 3 * width]
        row = bytearray(len(stored))
        row[0::3], row[1::3], row[2::3] = stored[2::3], stored[1::3], stored[0::3]
        rows.insert(0, bytes(row))
    return rows


def filtered(row: bytes, above: bytes, channels: int) -> bytes:
    """A row of a PNG, by the filter that leaves the smallest numbers."""

    def paeth(a: int, b: int, c: int) -> int:
        to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - 2 * c)
        return a if to_a <= to_b and to_a <= to_c else b if to_b <= to_c else c

    left, corner = bytes(channels) + row, bytes(channels) + above
    ways = [
        row,
        bytes((x - a) & 255 for x, a in zip(row, left)),
        bytes((x - b) & 255 for x, b in zip(row, above)),
        bytes((x - (a + b) // 2) & 255 for x, a, b in zip(row, left, above)),
        bytes((x - paeth(a, b, c)) & 255 for x, a, b, c in zip(row, left, above, corner)),
    ]
    best = min(range(5), key=lambda i: sum(min(x, 256 - x) for x in ways[i]))
    return bytes([best]) + ways[best]


def png(rows: Picture, channels: int = 3) -> bytes:
    """The bytes of a file: fewer than what the lessons write, and they take longer."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    width = len(rows[0]) // channels
    header = struct.pack(">IIBBBBB", width, len(rows), 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    above = [bytes(len(rows[0])), *rows]
    lines = b"".join(filtered(row, before, channels) for row, before in zip(rows, above))
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(lines, 9))
        + chunk(b"IEND", b"")
    )


def draw(program: Path, options: list[str], size: str) -> Picture:
    """What a lesson draws; with smooth edges, if the options do not say otherwise."""
    if "--size" not in options:
        options = [*options, "--size", size]
    if "--samples" not in options:
        options = [*options, "--samples", "16"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.bmp"
        subprocess.run([program, *options, "--out", file], check=True, capture_output=True)
        return read_bmp(file)


# The cover and the strip: README.md


def draw_cover(build: Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    command = re.search(r"\./lessons/run 11 (--model workshop[^`\n#]*)", readme)
    picture = draw(build / "11_scenes", shlex.split(command[1]), "1280x720")
    (ROOT / "docs/cover.png").write_bytes(png(picture))


PANEL, GAP = (168, 300), 6  # px


def draw_strip(build: Path) -> None:
    width, height = PANEL
    gap = bytes(4 * GAP)  # transparent, so that it fits a light page and a dark one
    strip = [b""] * height
    for lesson in LESSONS:
        readme = (ROOT / "lessons" / lesson / "README.md").read_text(encoding="utf-8")
        asked = re.search(r"^strip:(.*)$", readme, re.MULTILINE)
        if not asked:
            continue
        picture = draw(build / lesson, shlex.split(asked[1]), f"{width}x{height}")
        left = (len(picture[0]) // 3 - width) // 2  # a wider picture is cut on both sides
        for y in range(height):
            row = picture[y][3 * left : 3 * (left + width)]
            pixels = b"".join(row[i : i + 3] + b"\xff" for i in range(0, len(row), 3))
            strip[y] += (gap if strip[y] else b"") + pixels
    (ROOT / "docs/strip.png").write_bytes(png(strip, channels=4))


# The turns: README.md's animation, and the cards of the site's gallery


CARD_SIZE, CARD_FRAMES, CARD_MS = "400x225", 48, 4000
TURN_MS = 12000


def write_webp(frames: list[Path], file: Path, ms: int, quality: int) -> None:
    """An animation that starts again when it ends; a still picture, if there is one frame."""
    # Each frame is stored whole: a change to the one before would leave traces behind.
    subprocess.run(
        ["img2webp", "-loop", "0", "-kmin", "0", "-kmax", "1", "-lossy", "-q", str(quality)]
        + ["-d", str(ms // len(frames)), *frames, "-o", file],
        check=True,
        capture_output=True,
    )


def draw_turn(build: Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    command = re.search(r"\./lessons/run 14 (--frames[^`\n]*)", readme)
    with tempfile.TemporaryDirectory() as folder:
        options = [*shlex.split(command[1]), "--size", "640x360"]
        subprocess.run([build / "14_simd", *options], check=True, cwd=folder)
        write_webp(sorted(Path(folder).iterdir()), ROOT / "docs/turn.webp", TURN_MS, 75)


def turned_teapot(angle: float, folder: Path) -> Path:
    """The teapot of lessons 01 to 03, which have no camera to move. They fit what they draw into
    the picture: faces without area hold the place of a whole turn."""
    cos, sin = math.cos(angle), math.sin(angle)
    lines = []
    radius_at: dict[float, float] = {}  # by height, rounded
    for line in (ROOT / "assets/models/teapot.obj").read_text(encoding="utf-8").splitlines():
        kind, *values = line.split(" ")
        if kind in ("v", "vn"):
            x, y, z = map(float, values)
            line = f"{kind} {cos * x + sin * z} {y} {cos * z - sin * x}"
            if kind == "v":
                radius_at[round(y, 1)] = max(radius_at.get(round(y, 1), 0), math.hypot(x, z))
        lines.append(line)
    for y, radius in radius_at.items():
        for k in range(64):
            x, z = radius * math.cos(k * math.pi / 32), radius * math.sin(k * math.pi / 32)
            lines += [f"v {x} {y} {z}", "f -1 -1 -1"]
    shutil.copy(ROOT / "assets/models/teapot.mtl", folder)
    model = folder / "teapot.obj"
    model.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return model


def draw_card(lesson: str, build: Path, to: Path) -> None:
    readme = (ROOT / "lessons" / lesson / "README.md").read_text(encoding="utf-8")
    asked = re.search(r"^turn:(.*)$", readme, re.MULTILINE)
    options = ["--size", CARD_SIZE, "--samples", "4", *shlex.split(asked[1] if asked else "")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def run(*more: object) -> None:
            subprocess.run(
                [build / lesson, *options, *map(str, more)], check=True, stdout=subprocess.DEVNULL
            )

        if LESSONS.index(lesson) < 3:
            for k in range(CARD_FRAMES):
                model = turned_teapot(-2 * math.pi * k / CARD_FRAMES, folder)
                run("--model", model, "--out", folder / f"{k:02}.png")
        else:
            run("--frames", CARD_FRAMES, "--out", folder / "%02d.png")
        frames = sorted(folder.glob("*.png"))
        to.mkdir(exist_ok=True)
        write_webp(frames, to / f"{lesson}.webp", CARD_MS, 60)
        write_webp(frames[:1], to / f"{lesson}_still.webp", CARD_MS, 60)


# The mistakes


SIZE = "416x234"  # small enough that a picture takes less than 100 kB


class Mistake(NamedTuple):
    lesson: str
    options: list[str]
    right_picture: Path
    wrong_picture: Path
    file: Path  # relative to ROOT
    right: list[str]
    wrong: list[str]


def mistakes() -> list[Mistake]:
    """Those of the page, in its order."""
    page = ROOT / "docs/troubleshooting.md"
    found = []
    for section in page.read_text(encoding="utf-8").split("\n## ")[1:]:
        before, fence, after = section.partition("```diff\n")
        if not fence:
            continue
        command = re.search(r"`\./lessons/run (\d\d)([^`]*)`", before)
        right_picture, wrong_picture = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", before)
        lines = after.partition("```")[0].splitlines()
        found.append(
            Mistake(
                next(lesson for lesson in LESSONS if lesson.startswith(command[1])),
                shlex.split(command[2]),
                page.parent / right_picture,
                page.parent / wrong_picture,
                (page.parent / re.findall(r"\]\((\.\./[^)]+[ch]pp)\)", before)[-1])
                .resolve()
                .relative_to(ROOT),
                [line[1:].strip() for line in lines if line.startswith("+")],
                [line[1:].strip() for line in lines if line.startswith("-")],
            )
        )
    return found


def exchanged(code: str, right: list[str], wrong: list[str]) -> str:
    """The code with the wrong lines in place of the right ones, which are there once."""
    lines = code.splitlines()
    bare = [line.strip() for line in lines]
    places = [i for i in range(len(lines)) if bare[i : i + len(right)] == right]
    if len(places) != 1:
        raise SystemExit(f"error: {len(places)} times in the code: {' / '.join(right)}")
    lines[places[0] : places[0] + len(right)] = wrong
    return "\n".join(lines) + "\n"


def build(tree: Path, lesson: str) -> Path:
    subprocess.run(
        ["cmake", "--build", tree / "build", "--target", lesson, "--", "-j2"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return tree / "build" / lesson


@contextlib.contextmanager
def copied_tree() -> Iterator[Path]:
    """A copy of the code to change, configured in its folder build/; one program at a time has it."""
    tree = ROOT / "build/mistakes"
    tree.mkdir(parents=True, exist_ok=True)
    with (tree / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        copy_code(tree)
        yield tree


def copy_code(tree: Path) -> None:
    for name in ("CMakeLists.txt", "assets", "docs", "tests"):
        if not (tree / name).exists():
            (tree / name).symlink_to(ROOT / name)

    def copy_if_other(source: str, copy: str) -> None:
        if not Path(copy).exists() or Path(source).read_bytes() != Path(copy).read_bytes():
            shutil.copy(source, copy)

    for name in ("common", "lessons"):
        shutil.copytree(ROOT / name, tree / name, copy_function=copy_if_other, dirs_exist_ok=True)
    # Optimised enough to draw, and quickly built; a mistake may break what an assertion expects.
    subprocess.run(
        ["cmake", "-S", tree, "-B", tree / "build", "-G", "Ninja", "-D", "BUILD_TESTING=OFF",
         "-D", "CMAKE_BUILD_TYPE=", "-D", "CMAKE_CXX_FLAGS=-O1 -DNDEBUG -w"],
        check=True,
        stdout=subprocess.DEVNULL,
    )  # fmt: skip


def drawn_with(tree: Path, changed_code: dict[str, str], lesson: str, options: list[str]) -> Picture:
    """What a lesson draws with other texts in some files; their own are put back."""
    own_code = {file: (tree / file).read_text(encoding="utf-8") for file in changed_code}
    try:
        for file, text in changed_code.items():
            (tree / file).write_text(text, encoding="utf-8")
        return draw(build(tree, lesson), options, SIZE)
    finally:
        for file, text in own_code.items():
            (tree / file).write_text(text, encoding="utf-8")


def draw_mistakes(tree: Path, only: list[str]) -> None:
    drawn = set()
    for m in mistakes():
        if only and m.wrong_picture.stem not in only:
            continue
        if m.right_picture not in drawn:
            m.right_picture.write_bytes(png(drawn_with(tree, {}, m.lesson, m.options)))
            drawn.add(m.right_picture)
        code = exchanged((tree / m.file).read_text(encoding="utf-8"), m.right, m.wrong)
        picture = drawn_with(tree, {str(m.file): code}, m.lesson, m.options)
        m.wrong_picture.write_bytes(png(picture))
        print(m.wrong_picture.relative_to(ROOT))


# The answers to the exercises


class Answer(NamedTuple):
    name: str  # 06_1
    lesson: str
    program: str
    options: list[str] | None  # of its first command for the lesson
    picture: Path | None
    diff: str


def answers() -> list[Answer]:
    found = []
    for lesson in LESSONS:
        readme = ROOT / "lessons" / lesson / "README.md"
        for part in readme.read_text(encoding="utf-8").split("<summary>Answer ")[1:]:
            number, _, text = part.partition("</summary>")
            text = text.partition("</details>")[0]
            command = re.search(rf"\./lessons/run (lab )?{lesson[:2]}\b([^`\n#]*)", text)
            picture = re.search(r"!\[[^\]]*\]\(([^)]+)\)", text)
            found.append(
                Answer(
                    f"{lesson[:2]}_{number}",
                    lesson,
                    f"lab_{lesson}" if command and command[1] else lesson,
                    shlex.split(command[2]) if command else None,
                    (readme.parent / picture[1]).resolve() if picture else None,
                    text.partition("```diff\n")[2].partition("```")[0],
                )
            )
    return found


def changed(code: dict[str, str], diff: str) -> None:
    """Makes the changes of a diff in the texts of files."""
    for of_file in re.split(r"^--- ", diff, flags=re.MULTILINE)[1:]:
        file, _, places = of_file.partition("\n")
        for place in re.split(r"^(?:@@.*|\+\+\+ .*)\n", places, flags=re.MULTILINE):
            lines = [line or " " for line in place.splitlines()]
            before = "".join(line[1:] + "\n" for line in lines if line[0] != "+")
            after = "".join(line[1:] + "\n" for line in lines if line[0] != "-")
            count = ("\n" + code[file]).count("\n" + before)
            if before and count != 1:
                raise SystemExit(f"error: {count} times in {file}:\n{before}")
            code[file] = ("\n" + code[file]).replace("\n" + before, "\n" + after, 1)[1:]


def draw_answers(tree: Path, of_lesson: str = "", number: str = "", is_check: bool = False, turn: str = "0/1") -> None:
    remainder, divisor = map(int, turn.split("/"))
    if remainder >= divisor:
        raise SystemExit(f"error: {turn} is no lesson's turn")
    # What an answer changes is compiled again for it, and once more for the next that does not: so those that change the
    # same follow each other, and what all lessons include is changed last.
    def order(answer: Answer) -> tuple[bool, str, list[str]]:
        return "--- common/" in answer.diff, answer.lesson, sorted(re.findall(r"^--- .*", answer.diff, flags=re.MULTILINE))

    for answer in sorted(answers(), key=order):
        if of_lesson and answer.name.split("_")[0] != of_lesson.zfill(2):
            continue
        if number and answer.name.split("_")[1] != number:
            continue
        if answer.options is None:
            raise SystemExit(f"error: answer {answer.name} has no command")
        files = re.findall(r"^--- (.*)$", answer.diff, flags=re.MULTILINE)
        code = {file: (tree / file).read_text(encoding="utf-8") for file in files}
        changed(code, answer.diff)
        if int(answer.lesson[:2]) % divisor != remainder:
            continue
        picture = png(drawn_with(tree, code, answer.program, answer.options))
        if answer.picture is None:
            print(f"{answer.name}: draws; it shows no picture")
        elif not is_check:
            answer.picture.parent.mkdir(exist_ok=True)
            answer.picture.write_bytes(picture)
            print(f"{answer.name}: {answer.picture.relative_to(ROOT)}")
        elif answer.picture.read_bytes() == picture:
            print(f"{answer.name}: as shown")
        else:
            raise SystemExit(f"error: answer {answer.name} draws another picture than it shows")


def main() -> None:
    match sys.argv[1:]:
        case ["cover", folder]:
            draw_cover(Path(folder).resolve())
        case ["strip", folder]:
            draw_strip(Path(folder).resolve())
        case ["turn", folder]:
            draw_turn(Path(folder).resolve())
        case ["card", lesson, folder, to]:
            draw_card(lesson, Path(folder).resolve(), Path(to))
        case ["mistakes", *only]:
            with copied_tree() as tree:
                draw_mistakes(tree, only)
        case ["answers", *which] if len(which) <= 2:
            with copied_tree() as tree:
                draw_answers(tree, *which)
        case ["check-answers"]:
            with copied_tree() as tree:
                draw_answers(tree, is_check=True)
        case ["check-answers", turn] if re.fullmatch(r"\d+/\d+", turn):
            with copied_tree() as tree:
                draw_answers(tree, is_check=True, turn=turn)
        case _:
            raise SystemExit(__doc__)


if __name__ == "__main__":
    main()
