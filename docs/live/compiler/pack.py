"""Makes the compiler of the site's pages: pack.py NPM CLANG FOLDER LINKED JUDGE OUT.

npm installs clang, compiled to WebAssembly, in FOLDER. OUT is the folder of what a page fetches:
the compiler; headers and sources; objects and libraries; what is precompiled for all lessons; what
is known of the lessons; and the golden pictures. LINKED lists the objects that programs are linked
with, JUDGE is judge.cpp's module. Where npm cannot install the compiler, OUT is left empty, and the
site is made without the editor.
"""

import gzip
import hashlib
import json
import re
import shlex
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

from npm import install

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
LESSONS = sorted(path.name for path in (ROOT / "lessons").glob("[01][0-9]_*"))[:12]
# What a reader's file and the tests may include, beside the headers of the course.
STANDARD = """algorithm array bit bitset cassert cctype cfloat chrono climits cmath compare complex concepts
cstddef cstdint cstdio cstdlib cstring deque exception filesystem fstream functional initializer_list iomanip
iostream istream iterator limits list map memory new numbers numeric optional ostream queue random ranges set
span sstream stack stdexcept string string_view tuple type_traits typeinfo unordered_map unordered_set utility
variant vector version glm/glm.hpp glm/ext.hpp gtest/gtest.h""".split()
LIBRARIES = ("crt1-reactor.o", "crt1-command.o", "libc.a", "libc-printscan-long-double.a", "libc++.a", "libc++abi.a",
             "builtins")
TO_WASM = ["--target=wasm32-wasi", "-std=c++20", "-fignore-exceptions", "-DGTEST_HAS_EXCEPTIONS=0",
           "-DGTEST_HAS_PTHREAD=0", "-DGTEST_HAS_STREAM_REDIRECTION=0"]


def system_headers(clang: str) -> list[Path]:
    """What the C and C++ libraries, GLM and GoogleTest include."""
    text = "".join(f"#include <{name}>\n" for name in STANDARD)
    listed = subprocess.run([clang, *TO_WASM, "-M", "-x", "c++", "-"], input=text, check=True,
                            capture_output=True, encoding="utf-8").stdout
    return [Path(name) for name in listed.replace("\\\n", " ").split()[1:] if name != "-"]


def search_path(clang: str) -> list[str]:
    """Where headers are looked for; the other clang's own come from the package."""
    said = subprocess.run([clang, *TO_WASM, "-E", "-v", "-x", "c++", "-"], input="", check=True,
                          capture_output=True, encoding="utf-8").stderr
    listed = re.search(r"#include <\.\.\.> search starts here:\n(.*?)End of search list", said, re.DOTALL)
    assert listed, said
    folders = [line.strip() for line in listed[1].splitlines()]
    return ["/clang" if "lib/clang/" in folder else str(Path(folder).resolve()) for folder in folders]


def library(clang: str, name: str) -> Path:
    asked = "-print-libgcc-file-name" if name == "builtins" else f"-print-file-name={name}"
    return Path(subprocess.run([clang, *TO_WASM, asked], check=True, capture_output=True, encoding="utf-8").stdout.strip())


def asking_sooner(span: str) -> str:
    """libc++'s <span>, which asks whether what it is made of is an array before it asks whether it is a range: that takes long to answer."""
    is_no_span = r"    !__is_std_span<.*\n"
    is_no_array = r"    !__is_std_array<.*\n    !is_array_v<.*\n"
    sooner, count = re.subn(f"({is_no_span})((?:.*\\n)+?)({is_no_array})", r"\1\3\2", span)
    return sooner if count == 1 else span


def texts(clang: str, resources: Path) -> dict[str, str]:
    """All headers and sources, by the names that the compiler in the page has for them."""
    found = {}
    for header in system_headers(clang):
        if "lib/clang/" not in str(header):  # of the other clang
            text = header.read_text("utf-8", "replace")
            found[str(header.resolve())[1:]] = asking_sooner(text) if header.name == "span" else text
    builtin = r"(?:\./)?(?:usr/)?include/((?:__std|__float|std|float|limits|inttypes|iso646|tgmath)[\w.]*\.h)"
    with tarfile.open(resources) as tar:
        for member in tar.getmembers():
            name = re.fullmatch(builtin, member.name)
            if name and (file := tar.extractfile(member)):
                found[f"clang/{name[1]}"] = file.read().decode()
    for pattern in ("common/**/*.hpp", "lessons/lab/*.hpp", "tests/support/*.hpp", "docs/live/**/*.hpp"):
        for file in ROOT.glob(pattern):
            found[str(file.relative_to(ROOT))] = file.read_text("utf-8")
    for lesson in LESSONS:
        for file in (ROOT / "lessons" / lesson).glob("*.[hc]pp"):
            found[str(file.relative_to(ROOT))] = file.read_text("utf-8")
        for file in ROOT.glob(f"tests/{lesson}_*test.cpp"):
            found[str(file.relative_to(ROOT))] = file.read_text("utf-8")
    return found


def marks_of(kind: str, lesson: str) -> list[str]:
    readme = (ROOT / "lessons" / lesson / "README.md").read_text("utf-8")
    return re.findall(rf"^{kind}: (.*)$", readme, re.MULTILINE)


def before(lesson: str) -> str | None:
    """The lesson that one goes on from."""
    if named := marks_of("builds on", lesson):
        return named[0]
    at = LESSONS.index(lesson)
    return LESSONS[at - 1] if at > 0 else None


def starter(lesson: str) -> dict[str, str]:
    """What ./lessons/run --start gives."""
    folder = ROOT / "lessons" / lesson
    files = {file.name: file.read_text("utf-8") for file in sorted((folder / "starter").glob("*.hpp"))}
    main = (ROOT / "lessons" / (before(lesson) or lesson) / "main.cpp").read_text("utf-8")
    if base := before(lesson):
        main = main.replace(f'"{base}"', f'"{lesson}"')
        main = main.replace(f"\n/// Lesson {base[:2]}", f"\n/// Lesson {lesson[:2]}")
    return {**files, "main.cpp": main}


def names_of(equations: str) -> list[str]:
    """As tests' names begin: of "10.1-10.2 10.8" with Eq10_1_, Eq10_2_ and Eq10_8_."""
    found = re.finditer(r"(\d+)\.(\d+)(?:-\d+\.(\d+))?", equations)
    return [f"Eq{part[1]}_{i}_" for part in found for i in range(int(part[2]), int(part[3] or part[2]) + 1)]


def pictures(lesson: str) -> dict[str, dict]:
    """The tests of pictures: the program's options, the golden picture, how many pixels may jump."""
    found = {}
    for file in sorted(ROOT.glob(f"tests/{lesson}_*test.cpp")):
        text = file.read_text("utf-8")
        numbers = dict(re.findall(r"constexpr std::size_t (\w+) = (\d+);", text))
        for test in re.finditer(r"^TEST\((\w+), (PictureOf\w+)\) \{(.*?)\}\s*$(?=\n\n|\n?\Z|\nTEST|\n//)", text, re.MULTILINE | re.DOTALL):
            suite, name, body = test.groups()
            call = re.search(r'equals_golden\(\s*"(\w+)",\s*"(\w+)"(?:,\s*\{(.*?)\})?(?:,\s*(\w+))?\)', body, re.DOTALL)
            if other := re.search(r"IsLesson(\d\d)s", name):
                golden = next(path for path in LESSONS if path.startswith(other[1]))
                call_options, jump = "", None
            elif call and call[1] == lesson:
                golden, call_options, jump = call[2], call[3] or "", call[4]
            else:
                continue
            found[name] = {
                "suite": suite, "golden": f"{golden}.png", "options": re.findall(r'"([^"]*)"', call_options),
                "mayJump": int(numbers.get(jump, 0)) if jump else 0,
                "place": f"{file.relative_to(ROOT)}:{text[:test.start()].count(chr(10)) + 1}",
            }
    return found


def tests_of_formulas(lesson: str) -> list[Path]:
    """Files of tests that a page can run: there are neither files nor threads in it, and no time to compile whole lessons."""
    not_there = re.findall(r'^    "(\w+)"', (HERE / "formula_tests.hpp").read_text("utf-8"), re.MULTILINE)

    def is_one(text: str) -> bool:
        formulas = re.findall(r"^TEST\(\w+, (Eq(?!\w*HardCase)\w+)", text, re.MULTILINE)
        return any(name not in not_there for name in formulas) and not re.search(r'std::ofstream|std::this_thread|#include "support/(?:lesson_|pictures)', text)

    return [file for file in sorted(ROOT.glob(f"tests/{lesson}_*test.cpp")) if is_one(file.read_text("utf-8"))]


def equations_of_threads(lesson: str) -> set[str]:
    """Those of which a test starts threads: a page cannot run it."""
    texts = [file.read_text("utf-8") for file in ROOT.glob(f"tests/{lesson}_*test.cpp")]
    return {name for text in texts if "std::this_thread" in text
            for name in re.findall(r"^TEST\(\w+, (Eq\d+_\d+_)", text, re.MULTILINE)}


def described(lesson: str) -> dict:
    folder = ROOT / "lessons" / lesson
    given = starter(lesson)
    of_threads = equations_of_threads(lesson)
    steps = []
    for mark in marks_of("step", lesson):
        equations, options, names, title = (part.strip() for part in mark.split("|"))
        steps.append({"title": title, "equations": names_of(equations), "options": shlex.split(options),
                      "pictures": [name for name in names.split() if name != "-"],
                      "hasThreads": not of_threads.isdisjoint(names_of(equations))})
    return {
        "before": before(lesson), "starter": given, "steps": steps, "pictures": pictures(lesson),
        "solution": {name: (folder / name).read_text("utf-8") for name in given},
        "apart": [str(file.relative_to(ROOT)) for file in sorted(folder.glob("*.cpp")) if file.name != "main.cpp"],
        "tests": [str(file.relative_to(ROOT)) for file in tests_of_formulas(lesson)],
    }


def precompile_shared(found: dict[str, str], folder: Path, path: list[str], out: Path) -> None:
    """Takes half a minute; so it is kept in `folder` until something that is precompiled changes."""
    parts = {name: text for name, text in found.items() if not re.match(r"lessons/|tests/\d", name)}
    includes = {line for text in found.values() for line in re.findall(r"^[ \t]*#[ \t]*include.*", text, re.MULTILINE)}
    scripts = ("compiler_worker.js", "toolchain.js", "precompile_shared.mjs", "package-lock.json")
    tools = [(HERE / name).read_text("utf-8") for name in scripts]
    key = hashlib.sha256(json.dumps([parts, sorted(includes), path, tools], sort_keys=True).encode()).hexdigest()[:16]
    kept = folder / f"shared_{key}.pch.gz"
    if kept.exists():
        shutil.copy(kept, out / "shared.pch.gz")
        return
    subprocess.run(["node", HERE / "precompile_shared.mjs", out, json.dumps(path)], check=True)
    for other in folder.glob("shared_*.pch.gz"):
        other.unlink()
    new = shutil.copy(out / "shared.pch.gz", folder / "new.pch.gz")
    new.rename(kept)


def compressed(file: Path, data: bytes) -> None:
    file.write_bytes(gzip.compress(data, 9, mtime=0))


def main() -> None:
    npm, clang = sys.argv[1:3]
    folder, linked, judge, out = map(Path, sys.argv[3:])
    shutil.rmtree(out, ignore_errors=True)
    if not install(npm, HERE, folder):
        return
    out.mkdir(parents=True)
    modules = folder / "node_modules"
    package = modules / "@yowasp/clang"
    compressed(out / "llvm.wasm.gz", (package / "gen/llvm.core.wasm").read_bytes())
    found = texts(clang, package / "gen/llvm-resources.tar")
    compressed(out / "texts.json.gz", json.dumps(found).encode())
    # Objects and libraries in a row; their sizes come first.
    names = [*map(Path, linked.read_text().split()), *(library(clang, name) for name in LIBRARIES)]
    parts = {name.name: name.read_bytes() for name in names}
    sizes = json.dumps({name: len(data) for name, data in parts.items()}).encode()
    compressed(out / "objects.gz", len(sizes).to_bytes(4, "little") + sizes + b"".join(parts.values()))
    lessons = {lesson: described(lesson) for lesson in LESSONS}
    (out / "lessons.json").write_text(json.dumps(lessons), encoding="utf-8")
    (out / "golden").mkdir()
    for golden in {picture["golden"] for lesson in lessons.values() for picture in lesson["pictures"].values()}:
        shutil.copy(ROOT / "tests/golden" / golden, out / "golden")
    shutil.copytree(modules / "@bjorn3/browser_wasi_shim/dist", out / "wasi")
    for script in HERE.glob("*.js"):
        shutil.copy(script, out)
    program = (HERE / "program_worker.js").read_text("utf-8") + (HERE.parent / "lesson.js").read_text("utf-8")
    (out / "program_worker.js").write_text(program, encoding="utf-8")
    compressed(out / "judge.wasm.gz", judge.read_bytes())
    (out / "package.json").write_text('{"type": "module"}', encoding="utf-8")  # scripts are modules, for Node as well
    path = search_path(clang)
    precompile_shared(found, folder, path, out)
    all_files = [file for file in sorted(out.rglob("*.gz"))]
    version = hashlib.sha256(b"".join(file.read_bytes() for file in all_files)).hexdigest()[:16]
    manifest = {"version": version, "searchPath": path, "sizes": {file.name: file.stat().st_size for file in all_files}}
    (out / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")


if __name__ == "__main__":
    main()
