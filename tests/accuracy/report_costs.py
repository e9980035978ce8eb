#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts what costs.cpp measured into its page: report_costs.py MEASURED.json PAGE.md.

What stands between the lines `<!-- measured: NAME -->` and `<!-- end -->` is replaced; the names
are those of the functions below that begin with `block_`.
"""

import json
import math
import pathlib
import statistics
import sys

from report import BOTTOM, HEIGHT, LEFT, RIGHT, TIME_TOLERANCE, TOP, WIDTH, Axis, axes, draw, label, machine, number
from report import fill_blocks, place_labels

DIALS = ("samples per pixel", "texture filter", "shadow map", "PCF taps")


def completed(measured):
    """With each frame's levels by name, its median time, and both errors with equal weight."""
    for frame in measured["frames"]:
        frame |= {knob["name"]: knob["levels"][level] for knob, level in zip(measured["knobs"], frame["levels"])}
        frame["rounds"], frame["ms"] = frame["ms"], statistics.median_low(frame["ms"])
        frame["both"] = math.sqrt((frame["still"]**2 + frame["moving"]**2) / 2)
    measured["combinations"] = [frame for frame in measured["frames"] if "is combined" in frame]
    return measured


def frame_of(measured, end, knob=None, level=None):
    """The cheapest frame or the most exact one, with one choice made otherwise."""
    levels = [knob_["levels"].index(level) if knob_ is knob else knob_[end] for knob_ in measured["knobs"]]
    return next(frame for frame in measured["frames"] if frame["levels"] == levels)


def thousandths(value):
    """Of a change: with its sign, and 0 for what is none in so many digits."""
    text = f"{1000 * value:.2f}"
    return "0" if float(text) == 0 else text.replace("-", "−")


def milliseconds(value):
    text = f"{value:.1f}"
    return "0" if float(text) == 0 else text.replace("-", "−")


def front_of(frames):
    """The Pareto front in order of time: no other frame has a smaller error and is as fast."""
    return sorted(
        (f for f in frames if not any(
            g["both"] < f["both"] and g["ms"] <= f["ms"] * (1 + TIME_TOLERANCE) for g in frames)),
        key=lambda f: f["ms"])


def table(head, alignments, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join(alignments) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def dials(frame):
    return [frame[dial] for dial in DIALS]


def errors(frame):
    return [number(frame["still"]), number(frame["moving"]), number(frame["both"])]


def block_presets(measured, _):
    frames = [f for f in measured["frames"] if "preset" in f]
    frames.sort(key=lambda f: ("fast", "balanced", "exact").index(f["preset"]))
    return table(["`--quality`", *DIALS, "ms", "still", "moving", "error"],
                 ["---"] + ["---:"] * 8,
                 [[f"`{f['preset']}`", *dials(f), number(f["ms"]), *errors(f)] for f in frames])


def block_steps(measured, _):
    rows = []
    for knob in measured["knobs"]:
        for level, following in zip(knob["levels"], knob["levels"][1:]):
            cells = [f"{knob['name']}: {level} → {following}", knob["lesson"]]
            for end in ("cheapest", "most exact"):
                before, after = frame_of(measured, end, knob, level), frame_of(measured, end, knob, following)
                more = statistics.median_low([b - a for a, b in zip(before["rounds"], after["rounds"])])
                cells += [milliseconds(more), thousandths(before["still"] - after["still"]),
                          thousandths(before["moving"] - after["moving"])]
            rows.append(cells)
    return table(["step", "lesson", "cheapest frame: ms", "still", "moving", "most exact one: ms", "still", "moving"],
                 ["---", "---"] + ["---:"] * 6, rows)


def block_ends(measured, _):
    rows = []
    for end in ("cheapest", "most exact"):
        frame = frame_of(measured, end)
        deviation = statistics.median_low([abs(ms - frame["ms"]) for ms in frame["rounds"]])
        rows.append([f"{end} frame", number(frame["ms"]), number(deviation), *errors(frame)])
    return table(["frame", "ms", "± ms", "still", "moving", "error"], ["---"] + ["---:"] * 5, rows)


def block_front(measured, page):
    frames = measured["combinations"]
    front = front_of(frames)
    picture = page.with_name(f"{page.stem}-front.svg")
    plot(frames, front, picture)
    rows = [[*dials(f), number(f["ms"]), *errors(f), f"`{f['preset']}`" if "preset" in f else ""] for f in front]
    return "\n".join([
        f"![Error over milliseconds per frame: {len(frames)} frames, and their Pareto front]"
        f"({picture.name})", "",
        table([*DIALS, "ms", "still", "moving", "error", ""], ["---:"] * 8 + ["---"], rows), "",
        "Medians of the processor's time in 15 rounds, in 7 with several samples; each draws all frames in a "
        "random order, on one thread of a machine that does other work, too "
        f"({machine(measured)}, {measured['context']['compiler']}). The Pareto front of {len(frames)} frames: no "
        f"other has a smaller error and is as fast (by {TIME_TOLERANCE:.0%})."])


def plot(frames, front, file):
    """All frames as dots, the front as a line, and rings around the presets."""
    low_ms, high_ms = min(f["ms"] for f in frames), max(f["ms"] for f in frames)
    low_error, high_error = min(f["both"] for f in frames), max(f["both"] for f in frames)
    x = Axis(low_ms / 1.35, high_ms * 1.9, LEFT, WIDTH - RIGHT)
    y = Axis(low_error / 1.7, high_error * 1.5, HEIGHT - BOTTOM, TOP)
    ticks = [m * 10.0**e for e in range(-5, 0) for m in (1, 2, 5) if y.low <= m * 10.0**e <= y.high]
    at = {id(f): (x.at(f["ms"]), y.at(f["both"])) for f in frames}
    presets = [f for f in frames if "preset" in f]
    dots = [("", *at[id(f)]) for f in frames]  # no label lies on one
    places = place_labels([(f["preset"], *at[id(f)]) for f in presets] + dots, [at[id(f)] for f in front])
    y_ticks = [f'"{t:g}" {t:g}' for t in ticks]
    script = axes(x, y, y_ticks, "ms per frame", "error", file)
    script += [label(f["preset"], place, "sans-serif:Bold,14") for f, place in zip(presets, places)]
    for samples in ("1", "4", "16"):  # above all of them
        xs, ys = zip(*(at[id(f)] for f in frames if f["samples per pixel"] == samples))
        name = f"{samples} sample{'' if samples == '1' else 's'} per pixel"
        script.append(label(name, ((min(xs) + max(xs)) / 2, min(ys) - 16, "center")))
    data = lambda fs: "\n".join(f"{f['ms']} {f['both']}" for f in fs) + "\ne"
    script.append(
        "plot '-' with points pointtype 7 pointsize 0.4 linecolor rgb '#7c8ca3', "
        "'-' with lines linewidth 2 dashtype 2 linecolor rgb '#0d9488', "
        "'-' with points pointtype 7 pointsize 0.7 linecolor rgb '#0d9488', "
        "'-' with points pointtype 6 pointsize 1.4 linewidth 2 linecolor rgb '#0d9488'")
    script += [data(frames), data(front), data(front), data(presets)]
    draw(script, file)


def main():
    measured = completed(json.loads(pathlib.Path(sys.argv[1]).read_text()))
    page = pathlib.Path(sys.argv[2])
    fill_blocks(page, lambda name: globals()[f"block_{name}"](measured, page))


if __name__ == "__main__":
    main()
