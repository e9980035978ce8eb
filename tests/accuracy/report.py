#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts what a benchmark measured into its page: a table and a plot for each comparison.

report.py MEASURED.json PAGE.md, where the page has, for each comparison, the lines

    <!-- measured: COMPARISON | TIME'S UNIT | ERROR; *ERROR = HEADING; ... -->
    <!-- end -->

What stands between them is replaced. The errors are names of user counters, with another heading
for the table if need be; the one with the star is plotted.

Where there is no front to be found, it has other lines in place of the first one:

    <!-- table: COMPARISON | COUNTER; COUNTER = HEADING; ... -->
    <!-- grid: COMPARISON | ROWS' NAME | COUNTER = HEADING | COLUMN; COLUMN = HEADING; ... -->
    <!-- curves: ...as a grid's... -->

A table has a row for each variant. A grid has those variants that are called "ROW: COLUMN", and
curves are a grid of which a plot is drawn, too. The counter `time` stands for the time and its
quartiles. A column that is no variant's is taken for a counter.
"""

import json
import math
import pathlib
import re
import statistics
import subprocess
import sys

# Times closer than this are taken as equal: another run may order them the other way round.
TIME_TOLERANCE = 0.1

DIFFERING = "pixels that differ, %"  # a counter

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 600, 360, 104, 24, 20, 62  # of a plot, px
STYLE = """<style>
text { fill: #64748b }
@media (prefers-color-scheme: dark) { text { fill: #a9b4c4 } }
</style>"""


def read_variants(measured, comparison):
    """The variants of a comparison in the order in which they were declared."""
    runs = {}
    for run in measured["benchmarks"]:
        if run["run_type"] == "iteration" and run["name"].startswith(comparison + "/"):
            runs.setdefault(run["family_index"], []).append(run)
    variants = []
    for _, repetitions in sorted(runs.items()):
        times = [run["ns"] for run in repetitions]
        low, _, high = statistics.quantiles(times, n=4)
        variants.append({
            "name": repetitions[0]["name"].split("/")[1],
            "time": statistics.median(times),
            "quartiles": (low, high),
            "repetitions": len(times),
            "errors": repetitions[0],
        })
    return variants


def mark_front(variants, error):
    """Marks the Pareto front: no other variant is more accurate and as fast, or as accurate and faster."""
    for v in variants:
        v["error"] = v["errors"][error]
    for v in variants:
        v["front"] = not any(
            u["error"] < v["error"] and u["time"] <= v["time"] * (1 + TIME_TOLERANCE)
            or u["error"] == v["error"] and u["time"] < v["time"] * (1 - TIME_TOLERANCE)
            for u in variants)


def number(value):
    """Three significant digits, with commas between thousands."""
    if value == round(value) and abs(value) < 1000:
        return f"{value:.0f}"
    digits = 2 - math.floor(math.log10(abs(value)))
    rounded = round(value, digits)
    return f"{rounded:,.0f}" if digits <= 0 else f"{rounded:,.{digits}f}"


def table(variants, unit, errors):
    """`errors` are the counters' headings."""
    head = ["variant", unit, "quartiles", *errors.values(), ""]
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 2) + "---|"]
    for v in variants:
        low, high = v["quartiles"]
        cells = [v["name"], number(v["time"]), f"{number(low)}–{number(high)}",
                 *(number(v["errors"][e]) for e in errors), "front" if v["front"] else ""]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def time_ticks(low, high):
    """Round numbers from low to high, as many as there is room for."""
    for steps in ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 5, 7), (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8)):
        ticks = [m * 10.0**e for e in range(-3, 6) for m in steps if low <= m * 10.0**e <= high]
        if len(ticks) >= 4:
            break
    return ticks


class Axis:
    """A logarithmic axis on the page, in pixels."""

    def __init__(self, low, high, from_px, to_px):
        self.low, self.high, self.from_px, self.to_px = low, high, from_px, to_px

    def at(self, value):
        share = math.log(value / self.low) / math.log(self.high / self.low)
        return self.from_px + share * (self.to_px - self.from_px)


def place_labels(points, line):
    """For each (name, x, y) a place beside its point where no point, line or label is: (x, y, alignment)."""
    taken = [(x - 8, y - 8, x + 8, y + 8) for _, x, y in points]
    for (ax, ay), (bx, by) in zip(line, line[1:]):
        for i in range(1, 40):
            x, y = ax + (bx - ax) * i / 40, ay + (by - ay) * i / 40
            taken.append((x - 1, y - 1, x + 1, y + 1))
    places = []
    for name, x, y in points:
        width, height = 7.8 * len(name), 16
        choices = []
        for rise in (0, -12, 12, -18, 18, -36, 36, -54, 54):
            choices.append((x + 12, y + rise, "left"))
            if abs(rise) > 16:
                choices.append((x, y + rise, "center"))
            choices.append((x - 12, y + rise, "right"))
        for px, py, alignment in choices:
            left = px - {"left": 0, "right": width, "center": width / 2}[alignment]
            box = (left, py - height / 2, left + width, py + height / 2)
            free = all(box[2] <= t[0] or t[2] <= box[0] or box[3] <= t[1] or t[3] <= box[1] for t in taken)
            if free and box[0] > LEFT and box[2] < WIDTH - RIGHT and TOP < box[1] and box[3] < HEIGHT - BOTTOM:
                break
        taken.append(box)
        places.append((px, py, alignment))
    return places


def axes(x, y, y_ticks, unit, error, file):
    """The first lines of a gnuplot script: the picture, and time and error on logarithmic axes."""
    return [
        f"set terminal svg size {WIDTH},{HEIGHT} dynamic font 'sans-serif,14'",
        f"set output '{file}'",
        f"set lmargin at screen {LEFT / WIDTH}", f"set rmargin at screen {1 - RIGHT / WIDTH}",
        f"set tmargin at screen {1 - TOP / HEIGHT}", f"set bmargin at screen {BOTTOM / HEIGHT}",
        "set logscale xy", "unset key", "set tics scale 0", "set border 3 linecolor rgb '#94a3b8'",
        f"set xrange [{x.low}:{x.high}]", f"set yrange [{y.low}:{y.high}]",
        "set grid linetype 1 linewidth 0.5 linecolor rgb '#5594a3b8'",
        "set xtics nomirror (" + ", ".join(f'"{t:,g}" {t}' for t in time_ticks(x.low, x.high)) + ")",
        "set ytics nomirror (" + ", ".join(y_ticks) + ")",
        f"set xlabel '{unit}'",
        f"set label '{error}' at screen 0.025, screen {(1 - TOP / HEIGHT + BOTTOM / HEIGHT) / 2} rotate center",
    ]


def label(name, place, font="sans-serif,14"):
    px, py, alignment = place
    return f"set label \"{name}\" at screen {px / WIDTH}, screen {1 - py / HEIGHT} {alignment} font '{font}'"


def draw(script, file):
    """Runs a script that writes an SVG file, and gives this its style."""
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)
    svg = file.read_text()
    head_end = svg.index(">", svg.index("<svg")) + 1
    svg = svg[:head_end] + STYLE + svg[head_end:]
    file.write_text("\n".join(line.rstrip() for line in svg.splitlines()) + "\n")


def plot(variants, unit, error, file):
    """Error over time as SVG; an error of zero lies on the lowest line, which is marked 0."""
    times = [v["time"] for v in variants]
    positive = [v["error"] for v in variants if v["error"] > 0]
    spread = max(times) / min(times)
    x = Axis(min(times) / spread**0.12 / 1.3, max(times) * spread**0.12 * 1.5, LEFT, WIDTH - RIGHT)
    lowest_decade = math.floor(math.log10(min(positive) / 1.3))
    has_zero = len(positive) < len(variants)
    zero = 10.0**(lowest_decade - 1)
    y = Axis(zero / 2 if has_zero else 10.0**lowest_decade,
             10.0**math.ceil(math.log10(max(positive) * 1.1)), HEIGHT - BOTTOM, TOP)

    decades = range(lowest_decade, round(math.log10(y.high)) + 1)
    every = 1 + len(decades) // 9
    y_ticks = [f'"{10.0**d:,.{max(-d, 0)}f}" {10.0**d:g}' for d in decades if (d - lowest_decade) % every == 0]
    if has_zero:
        y_ticks.append(f'"0" {zero:g}')
    for v in variants:
        v["shown"] = max(v["error"], zero)
        v["px"] = x.at(v["time"]), y.at(v["shown"])
    front = sorted((v for v in variants if v["front"]), key=lambda v: v["time"])
    places = place_labels([(v["name"], *v["px"]) for v in variants], [v["px"] for v in front])

    script = axes(x, y, y_ticks, unit, error, file)
    script += [label(v["name"], place) for v, place in zip(variants, places)]
    data = lambda vs: "\n".join(f"{v['time']} {v['shown']}" for v in vs) + "\ne"
    others = [v for v in variants if not v["front"]]
    script.append(
        "plot '-' with lines linewidth 2 dashtype 2 linecolor rgb '#0d9488', "
        "'-' with points pointtype 7 pointsize 0.9 linecolor rgb '#0d9488'"
        + (", '-' with points pointtype 6 pointsize 0.9 linewidth 2 linecolor rgb '#7c8ca3'" if others else ""))
    script += [data(front), data(front)] + ([data(others)] if others else [])
    draw(script, file)


def value_of(variant, counter):
    return variant["time"] if counter == "time" else variant["errors"][counter]


def cells_of(variant, counter):
    """What a table says of a counter: one cell, or two for the time."""
    if counter != "time":
        return [number(variant["errors"][counter]).replace("-", "−")]
    low, high = variant["quartiles"]
    return [number(variant["time"]), f"{number(low)}–{number(high)}"]


def columns_of(text):
    """Counters and their headings, in order."""
    parts = [part.strip().partition(" = ") for part in text.split(";")]
    return {counter: heading or counter for counter, _, heading in parts}


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def remarks(measured, variants, has_times, shows_differing=False):
    """How the times were taken, and whether the pictures are what they have to be."""
    sentences = []
    if has_times:
        sentences.append(
            f"Medians and quartiles of {variants[0]['repetitions']} repetitions, the variants by turns in random order, "
            f"on one thread ({machine(measured)}, {measured['context']['compiler']}).")
    differing = [v["errors"][DIFFERING] for v in variants if DIFFERING in v["errors"]]
    if differing and not shows_differing:
        sentences.append("Pixels that differ from the reference in any bit: "
                         + ("none." if max(differing) == 0 else f"up to {number(max(differing))}%."))
    return " ".join(sentences)


def plain_table(measured, comparison, counters):
    variants = read_variants(measured, comparison)
    columns = columns_of(counters)
    head = ["variant"]
    for counter, heading in columns.items():
        head += [heading, "quartiles"] if counter == "time" else [heading]
    rows = [[v["name"], *(cell for counter in columns for cell in cells_of(v, counter))] for v in variants]
    return [markdown(head, rows), "", remarks(measured, variants, "time" in columns, DIFFERING in columns)]


def grid(measured, page, has_plot, comparison, rows_name, counter, names):
    (counter, heading), = columns_of(counter).items()
    names = columns_of(names)
    by_row = {}
    for v in read_variants(measured, comparison):
        row, _, column = v["name"].partition(": ")
        by_row.setdefault(row, {})[column] = v
    used, rows, curves = [], [], {name: [] for name in names}
    for row, by_column in by_row.items():
        cells = []
        for name in names:
            variant = by_column.get(name) or next(iter(by_column.values()))
            shown = counter if name in by_column else name
            used.append(variant)
            cell, *quartiles = cells_of(variant, shown)
            cells.append(f"{cell} ({quartiles[0]})" if quartiles else cell)
            if row.isdigit():
                curves[name].append((float(row), value_of(variant, shown)))
        rows.append([row, *cells])
    lines = [markdown([rows_name, *names.values()], rows), "", remarks(measured, used, counter == "time")]
    if has_plot:
        picture = page.with_name(f"{page.stem}-{comparison}.svg")
        plot_curves(curves, rows_name, heading, picture)
        lines = [f"![{heading} over {rows_name}: {'; '.join(names)}]({picture.name})", ""] + lines
    return lines


def plot_curves(curves, x_name, y_name, file, may_reverse=True):
    """Lines on logarithmic axes, each with its name at its right end: x grows to the left if they differ more there
    and it may."""
    points = [point for curve in curves.values() for point in curve]
    columns = sorted({x for x, _ in points})
    right = RIGHT + 8 * max(len(name) for name in curves)
    low, high = min(y for _, y in points), max(y for _, y in points)
    spread = [max(ends) / min(ends) for ends in zip(*((curve[0][1], curve[-1][1]) for curve in curves.values()))]
    is_reversed = may_reverse and spread[0] > spread[1]
    x = Axis(columns[0] / 1.1, columns[-1] * 1.1, LEFT, WIDTH - right)
    y = Axis(low / 1.3, high * 1.3, HEIGHT - BOTTOM, TOP)
    y_ticks = [f'"{t:,g}" {t}' for t in time_ticks(y.low, y.high)]
    script = axes(x, y, y_ticks, x_name, y_name, file)
    script.append(f"set rmargin at screen {1 - right / WIDTH}")
    script.append("set xtics nomirror (" + ", ".join(f'"{t:,g}" {t}' for t in columns) + ")")
    if is_reversed:
        script.append(f"set xrange [{x.high}:{x.low}]")

    ends = sorted((y.at(curve[0 if is_reversed else -1][1]), name) for name, curve in curves.items())
    places, free = {}, TOP
    for at, name in ends:  # none over another
        places[name] = max(at, free)
        free = places[name] + 15
    free = HEIGHT - BOTTOM - 6
    for _, name in reversed(ends):  # nor below the plot
        places[name] = min(places[name], free)
        free = places[name] - 15
    colors = {"11": "#7c8ca3", "12": "#0d9488"}
    others = ["#0d9488", "#7c8ca3", "#d97706", "#7c3aed"]
    seen, parts = {}, []
    for name in curves:
        first = name.partition(",")[0]
        nth = seen[first] = seen.get(first, -1) + 1  # of the curves that share a colour
        color = colors.get(first, others[list(seen).index(first) % len(others)])
        script.append(label(name, (x.to_px + 8, places[name], "left"), "sans-serif,13")
                      + f" textcolor rgb '{color}'")
        parts.append(f"'-' with linespoints linewidth 2 dashtype {nth + 1} pointtype 7 pointsize 0.5 "
                     f"linecolor rgb '{color}'")
    script.append("plot " + ", ".join(parts))
    script += ["\n".join(f"{px} {py}" for px, py in curve) + "\ne" for curve in curves.values()]
    draw(script, file)


def fill_blocks(page, block_of):
    """Writes block_of(NAME) between the lines `<!-- measured: NAME -->` and `<!-- end -->` of a page."""
    def section(match):
        return f"{match[0].splitlines()[0]}\n\n{block_of(match[1])}\n\n<!-- end -->"

    text, count = re.subn(r"<!-- measured: (\w+) -->\n.*?<!-- end -->", section, page.read_text(), flags=re.DOTALL)
    if count == 0:
        sys.exit(f"error: {page} has no line '<!-- measured: ... -->'")
    page.write_text(text)
    print(f"wrote {page}")


def machine(measured):
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return f"{measured['context']['mhz_per_cpu']} MHz"


def main():
    measured = json.loads(pathlib.Path(sys.argv[1]).read_text())
    page = pathlib.Path(sys.argv[2])

    def other_section(match):
        parts = [part.strip() for part in match[2].split("|")]
        lines = plain_table(measured, *parts) if match[1] == "table" else grid(
            measured, page, match[1] == "curves", *parts)
        return "\n".join([match[0].split("\n")[0], "", *lines, "", "<!-- end -->"])

    def section(match):
        comparison, unit, errors = (part.strip() for part in match[1].split("|"))
        plotted, = re.findall(r"\*([^;=]*[^;= ])", errors)
        columns = [error.strip().partition(" = ") for error in errors.replace("*", "").split(";")]
        errors = {counter: heading or counter for counter, _, heading in columns}
        variants = read_variants(measured, comparison)
        mark_front(variants, plotted)
        picture = page.with_name(f"{page.stem}-{comparison}.svg")
        plot(variants, unit, plotted, picture)
        return "\n".join([
            match[0].split("\n")[0], "",
            f"![{plotted} over {unit}: {', '.join(v['name'] for v in variants)}]({picture.name})", "",
            table(variants, unit, errors), "",
            f"Medians and quartiles of {variants[0]['repetitions']} repetitions, the variants by turns in random order, "
            f"on one thread ({machine(measured)}, {measured['context']['compiler']}). "
            "*Front*, the Pareto front: no other is more accurate and as fast, or as accurate and faster "
            f"(by {TIME_TOLERANCE:.0%}).", "", "<!-- end -->"])

    text = page.read_text()
    changed, count = re.subn(r"<!-- measured: (.*?) -->\n.*?<!-- end -->", section, text, flags=re.DOTALL)
    changed, others = re.subn(r"<!-- (table|grid|curves): (.*?) -->\n.*?<!-- end -->", other_section, changed,
                              flags=re.DOTALL)
    if count + others == 0:
        sys.exit(f"error: {page} has no line '<!-- measured: ... -->'")
    page.write_text(changed)
    count += len(re.findall(r"<!-- curves: ", changed))
    print(f"wrote {page} and {count} plot{'s' if count > 1 else ''}")


if __name__ == "__main__":
    main()
