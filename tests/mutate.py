# SPDX-License-Identifier: MIT
"""Plants small bugs in a lesson's headers, one at a time, and counts those that the lesson's tests notice: ./tests/mutate.

All mutants are compiled at once: each mutated function has a body for each of its mutants, and an environment variable
chooses one. What is no function's body, such as a constant, is compiled mutant by mutant.
"""
import concurrent.futures
import fcntl
import filecmp
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import threading
import time
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutants"
SOURCE, BUILD = WORK / "source", WORK / "build"
MOST_BYTES = 6 << 30  # of memory, for a mutant that does not stop allocating

SWITCH = """// SPDX-License-Identifier: MIT
#pragma once
#include <cstdlib>
#include <type_traits>
inline const int planted_mutant = std::getenv("RASTERBOOK_MUTANT") ? std::atoi(std::getenv("RASTERBOOK_MUTANT")) : 0;
constexpr bool is_planted(int mutant) { return !std::is_constant_evaluated() && planted_mutant == mutant; }
"""

# clang-format puts spaces around binary operators, and none inside of template brackets.
EXCHANGED = [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" < ", " > "), (" == ", " != "),
             (" != ", " == "), (" + ", " - "), (" - ", " + "), (" * ", " / "), (" / ", " * "), (" % ", " / "),
             (" && ", " || "), (" || ", " && "), (" += ", " -= "), (" -= ", " += "), (" *= ", " /= "), (" << ", " >> "),
             (" >> ", " << "), (" & ", " | "), (" | ", " & ")]
EXCHANGED_WORDS = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin", "true": "false",
                   "false": "true", "lessThan": "lessThanEqual", "lessThanEqual": "lessThan", "all": "any", "low": "high",
                   "high": "low", "near": "far", "far": "near", "a": "b", "b": "c", "c": "a", "u": "v", "v": "u",
                   "first": "last", "last": "first", "casters": "receivers", "receivers": "casters", "break": "continue"}


@dataclass
class Mutant:
    file: str  # below lessons/
    begin: int  # what is replaced
    end: int
    text: str
    number: int = 0
    fate: str = ""

    def applied(self, source):
        return source[:self.begin] + self.text + source[self.end:]


def blanked(source):
    """The source with all that must not change replaced by spaces: comments, strings, directives, assertions."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())
    source = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', blank, source, flags=re.S)
    source = re.sub(r"^[ ]*#(?:[^\n]*\\\n)*[^\n]*", blank, source, flags=re.M)
    others = r"\b(?:static_assert|assert)\s*\(.*?;|\[\[.*?\]\]|\busing [^;]*;|\btemplate <[^\n]*"
    source = re.sub(others, blank, source, flags=re.S)
    # What is noted for --probe, which has tests of its own.
    return re.sub(r"^[^\n]*\b(?:trace|note)_\w+\([^{};]*\) (?:const )?\{.*?^\}|\b(?:trace|note)\w*\(.*?;|\bif \(is_traced\(\)\)", blank, source,
                  flags=re.S | re.M)


def closing(code, at):
    """The position of the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] in "({[") - (code[i] in ")}]")
        if depth == 0:
            return i
    raise ValueError("an open bracket")


def candidates(file, source):
    code = blanked(source)
    for old, new in EXCHANGED:
        for m in re.finditer(re.escape(old), code):
            yield Mutant(file, m.start(), m.end(), new)
    within = list(function_bodies(source)) + list(member_initialisers(source))
    for m in re.finditer(r"(?<!::)\b[A-Za-z]+\b(?!<)|(?<=glm::)\w+|(?<=std::)(?:min|max|floor|ceil|sin|cos)\b", code):
        is_member = code[m.start() - 1] == "."
        if m.group() in EXCHANGED_WORDS:
            is_declared = re.search(r"(?<!return)(?<!case)[\w>&*] $|auto&?&? \[[\w, ]*$", code[:m.start()]) or (
                code[m.start() - 2:m.start()] == ", " and code[m.end():m.end() + 3] == " = ")
            if is_declared or not any(begin < m.start() < end for begin, end in within):
                continue
            yield Mutant(file, m.start(), m.end(), EXCHANGED_WORDS[m.group()])
        elif is_member and re.fullmatch("[xyzw]", m.group()):
            yield Mutant(file, m.start(), m.end(), {"x": "y", "y": "x", "z": "x", "w": "z"}[m.group()])
    for m in re.finditer(r"(?<![\w.'])(\d+)(?![\w.'])", code):
        for change in (1, -1):
            if int(m.group()) + change >= 0:
                yield Mutant(file, m.start(), m.end(), str(int(m.group()) + change))
    for m in re.finditer(r"(?<![\w.'])(\d+\.\d*|\d+(?=e-?\d))((?:e-?\d+)?f?)(?!\w)", code):
        digits = float(m.group(1))
        for other in (2 * digits, 0.5 * digits) if digits else (1.0,):
            yield Mutant(file, m.start(), m.end(), repr(other) + m.group(2))
    for m in re.finditer(r"!(?=[\w(])|(?<=[(,=?:] )-(?=[\w(])|(?<=\()-(?=\w)|(?<=return )-", code):  # negations
        yield Mutant(file, m.start(), m.end(), "")
    for m in re.finditer(r"(?:(?<=[(=?:,] )|(?<=\()|(?<=return ))(?!return)[\w.]+ [-+*] ", code):  # a term
        yield Mutant(file, m.start(), m.end(), "")
    for m in re.finditer(r"\bif \(", code):
        end = closing(code, m.end() - 1) + 1
        condition = source[m.end() - 1:end]
        if ";" in condition:
            continue
        yield Mutant(file, m.end() - 1, end, f"(!{condition})")
        yield Mutant(file, m.end() - 1, end, f"(false && {condition})")


def function_bodies(source):
    """The positions of the braces around each function's body."""
    code = blanked(source)
    head, i = 0, 0
    while i < len(code):
        if code[i] in ";}":
            head = i + 1
        elif code[i] == "(":
            i = closing(code, i)
        elif code[i] == "{":
            before = code[head:i].strip()
            if re.match(r"(?:inline )?namespace\b|(?:struct|class|union)\b", before):
                head = i + 1
            elif ")" in before and not before.startswith("enum") and not re.search(r"[=,(]$|^constexpr [^(]*=", before):
                yield i, closing(code, i)
                i = closing(code, i)
                head = i + 1
            else:
                i = closing(code, i)
        i += 1


def member_initialisers(source):
    """The positions of what stands between = and ; in a struct."""
    bodies = list(function_bodies(source))
    for m in re.finditer(r"^    (?!constexpr|static|using)[\w:<>, *]+ = ([^;{}]*);", blanked(source), flags=re.M):
        if not any(begin < m.start() < end for begin, end in bodies):
            yield m.span(1)


def is_within(mutant, spans):
    return next(((b, e) for b, e in spans if b < mutant.begin + 1 and mutant.end <= e), None)


def with_all(file, source, mutants):
    """The source in which is_planted(number) chooses a body."""
    name = SOURCE / "lessons" / file
    of_span = {}
    for mutant in mutants:
        for spans, is_body in ((function_bodies(source), True), (member_initialisers(source), False)):
            if span := is_within(mutant, spans):
                of_span.setdefault((span, is_body), []).append(mutant)
    parts, at = [], 0
    for ((begin, end), is_body), inside in sorted(of_span.items(), key=lambda s: s[0]):
        def changed(m):
            return source[begin:m.begin] + m.text + source[m.end:end]
        line = source.count("\n", 0, begin) + 1
        parts.append(source[at:begin])
        if is_body:
            parts.append("{")
            for m in inside:
                parts.append(f'if (is_planted({m.number}))\n#line {line} "mutant_{m.number}"\n{changed(m)}}} else ')
            parts.append(f'\n#line {line} "{name}"\n{source[begin:end]}}}')
        else:
            for m in inside:
                parts.append(f'is_planted({m.number}) ?\n#line {line} "mutant_{m.number}"\n({changed(m)}) :')
            parts.append(f'\n#line {line} "{name}"\n{source[begin:end]}')
        at = end
    parts.append(source[at:])
    return '#include "tests/planted.hpp"\n#line 1 "%s"\n%s' % (name, "".join(parts))


def write(path, text):
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def copy_source():
    files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                           check=True).stdout.splitlines()
    for file in files:
        old, new = ROOT / file, SOURCE / file
        new.parent.mkdir(parents=True, exist_ok=True)
        if old.is_file() and not (new.exists() and filecmp.cmp(old, new, shallow=False)):
            shutil.copyfile(old, new)
            shutil.copymode(old, new)
    write(SOURCE / "tests" / "planted.hpp", SWITCH)


def build(*targets):
    """What the compiler says when it fails; nothing when it succeeds."""
    run = subprocess.run(["cmake", "--build", BUILD, "--target", *targets, "--", "-k", "0"], capture_output=True, text=True)
    return run.stdout + run.stderr if run.returncode else ""


def run_tests(program, names, number, seconds):
    """How a test program ends with a mutant: "", or what was noticed."""
    if not names:
        return ""
    command = [BUILD / "tests" / program, "--gtest_fail_fast", "--gtest_brief=1", "--gtest_filter=" + ":".join(names)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                               env=os.environ | {"RASTERBOOK_MUTANT": str(number)}, start_new_session=True,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES)))
    try:
        out, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
        return "did not end"
    if process.returncode == 0:
        return ""
    failed = re.search(r"^\[  FAILED  \] (\S+)", out, flags=re.M)
    return failed.group(1).rstrip(",") if failed else "crashed"


class Tests:
    """A test program's tests in three groups: quick ones, slow ones, and pictures, which are drawn into one folder."""

    def __init__(self, program):
        self.program, self.lock = program, threading.Lock()
        times = WORK / f"{program}.json"
        start = time.monotonic()
        subprocess.run([BUILD / "tests" / program, f"--gtest_output=json:{times}"], capture_output=True)
        self.seconds = time.monotonic() - start
        quick, slow, pictures = [], [], []
        for suite in json.loads(times.read_text())["testsuites"]:
            for test in suite["testsuite"]:
                if "failures" in test:  # it takes a program that is not built
                    print(f'{program}: {suite["name"]}.{test["name"]} fails without any mutant, and is left out', flush=True)
                    continue
                group = pictures if "PictureOf" in test["name"] else quick if float(test["time"][:-1]) < 0.2 else slow
                group.append((float(test["time"][:-1]), f'{suite["name"]}.{test["name"]}'))
        self.groups = [[name for _, name in sorted(group)] for group in (quick, slow, pictures)]

    def notice(self, number, group):
        seconds = 20 + 8 * self.seconds
        if group < 2:
            return run_tests(self.program, self.groups[group], number, seconds)
        with self.lock:
            return run_tests(self.program, self.groups[group], number, seconds)


def fate_of(tests, number):
    for group in range(3):
        for program in tests:
            if noticed := program.notice(number, group):
                return noticed
    return "survived"


def line_of(source, position):
    return source.count("\n", 0, position) + 1


def name_of(mutant, sources):
    source = sources[mutant.file]
    return f"{mutant.file}:{line_of(source, mutant.begin)}: {source[mutant.begin:mutant.end]!r} -> {mutant.text!r}"


def report(mutant, source):
    line = line_of(source, mutant.begin)
    before, after = (text.splitlines()[line - 1].strip() for text in (source, mutant.applied(source)))
    print(f"lessons/{mutant.file}:{line}\n  - {before}\n  + {after}", flush=True)


def headers_of(lesson):
    return {f"{lesson}/{header.name}": header.read_text() for header in sorted((ROOT / "lessons" / lesson).glob("*.hpp"))
            if header.name != "count_triangle.hpp"}  # for --probe alone


def chosen_mutants(sources, count, seed):
    found = {}
    for file, source in sources.items():
        for mutant in candidates(file, source):
            found.setdefault((file, mutant.begin, mutant.end), []).append(mutant)
    dice = random.Random(seed)
    chosen = [dice.choice(same) for same in dice.sample(list(found.values()), min(count, len(found)))]
    return sorted(chosen, key=lambda m: (m.file, m.begin))


def save(lesson, seed, sources, chosen):
    text = "".join(f"{name_of(mutant, sources)}: {mutant.fate}\n" for mutant in chosen)
    (WORK / f"{lesson}_{seed}.txt").write_text(text)


def survivors(lesson, sources, chosen, seed):
    """Those that no test noticed the last time."""
    fates = (WORK / f"{lesson}_{seed}.txt").read_text().splitlines()
    return [mutant for mutant in chosen if f"{name_of(mutant, sources)}: survived" in fates]


def main(lesson, sources, chosen, seed):
    copy_source()
    for i, mutant in enumerate(chosen):
        mutant.number = 1000 * int(lesson[:2]) + i + 1  # no other lesson's
    started = time.monotonic()
    if not (BUILD / "build.ninja").exists():
        subprocess.run(["cmake", "-G", "Ninja", "-S", SOURCE, "-B", BUILD, "-DCMAKE_BUILD_TYPE=None",
                        "-DCMAKE_CXX_FLAGS=-O1 -DNDEBUG -w"], check=True, stdout=subprocess.DEVNULL)
    # The lesson's tests, and those of its laboratory.
    of_lab = f"lab_{lesson[:2]}_test" if lesson >= "04" else "lab_test"
    programs = [name for name in (f"{lesson}_test", of_lab) if (ROOT / "tests" / f"{name}.cpp").exists()]

    together = [m for m in chosen if is_within(m, function_bodies(sources[m.file])) or
                is_within(m, member_initialisers(sources[m.file]))]
    all_targets = sorted({lesson, *programs})
    targets = [lesson], all_targets  # the program first: it shows most errors, and soon
    while targets:
        for file, source in sources.items():
            of_file = [m for m in together if m.file == file]
            write(SOURCE / "lessons" / file, with_all(file, source, of_file) if of_file else source)
        said = build(*targets[0])
        if not said:
            targets = targets[1:]
            continue
        wrong = {int(n) for n in re.findall(r"\bmutant_(\d+):\d+:\d+: (?:fatal )?error", said)}
        if not wrong:  # a mutant can also show where a function is called
            wrong = {int(n) for n in re.findall(r"\bmutant_(\d+):\d+", said)}
        if not wrong:
            sys.exit("error: this does not compile\n" + said[-6000:])
        for m in together:
            if m.number in wrong:
                m.fate = "did not compile"
        together = [m for m in together if not m.fate]
    print(f"{lesson}: {len(together)} mutants compiled together after {time.monotonic() - started:.0f} s", flush=True)
    tests = [Tests(program) for program in programs]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for m, fate in zip(together, pool.map(lambda m: fate_of(tests, m.number), together)):
            m.fate = fate
            if fate == "survived":
                report(m, sources[m.file])

    save(lesson, seed, sources, chosen)
    for m in [m for m in chosen if not m.fate]:  # one by one
        for file, source in sources.items():
            write(SOURCE / "lessons" / file, m.applied(source) if file == m.file else source)
        m.fate = "did not compile" if build(*all_targets) else fate_of(tests, 0)
        if m.fate == "survived":
            report(m, sources[m.file])
    for file, source in sources.items():
        write(SOURCE / "lessons" / file, source)

    save(lesson, seed, sources, chosen)
    fates = [m.fate for m in chosen]
    failed, survived = fates.count("did not compile"), fates.count("survived")
    print(f"{lesson}: {time.monotonic() - started:.0f} s; build/mutants/{lesson}_{seed}.txt says who noticed which\n"
          f"mutants: {len(chosen)} planted, {len(chosen) - failed - survived} caught, "
          f"{failed} did not compile (do not count), {survived} survived")


if __name__ == "__main__":
    name, seed_of_all = sys.argv[1], int(sys.argv[3])
    WORK.mkdir(parents=True, exist_ok=True)
    only_one = open(WORK / "lock", "w")
    fcntl.flock(only_one, fcntl.LOCK_EX)
    headers = headers_of(name)
    mutants = chosen_mutants(headers, int(sys.argv[2]), seed_of_all)
    if len(sys.argv) > 4:
        mutants = survivors(name, headers, mutants, seed_of_all)
    main(name, headers, mutants, seed_of_all)
