#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures where lesson 14's time goes, and writes it into docs/roofline.md: a few minutes.

roofline.py [--quick] [--as-measured]

--quick measures briefly; --as-measured takes what was measured before, and only writes. What stands
between the lines `<!-- measured: NAME -->` and `<!-- end -->` of the page is replaced; the names are
those of the functions below that begin with `block_`.

Operations and bytes are counted by valgrind's callgrind, which knows no AVX-512: in a program for
AVX2, with 8 lanes. It says how often each instruction is executed, objdump what that instruction is.
"""

import collections
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/accuracy"))
sys.dont_write_bytecode = True
from report import BOTTOM, HEIGHT, LEFT, TOP, WIDTH, Axis, axes, draw, fill_blocks, label, markdown, number

PAGE = ROOT / "docs/roofline.md"
MEASURED = ROOT / "build/release/roofline.json"
PROGRAM, COUNTED = ROOT / "build/release/tests/roofline", ROOT / "build/v3/14_simd"
SCENES = ("unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb")
LINE = 64  # bytes of a cache line

# Where a step's instructions are: collecting begins and ends with these functions, of 8 lanes. Parts of shadow
# maps are drawn in the midst of shading, and left out there.
STEPS = {
    "triangles": ["rasterbook::BinnedTriangles::BinnedTriangles<*"],
    "depths and ids": ["void rasterbook::draw_id<rasterbook::Floats<8>*"],
    "shading": ["void rasterbook::shade_visible<*", "void rasterbook::draw_tile<rasterbook::Floats<8>*"],
    "shadow map parts": ["void rasterbook::draw_tile<rasterbook::Floats<8>*"],
}
COLORS = {"triangles": "#7c8ca3", "depths and ids": "#d97706", "shading": "#0d9488", "shadow map parts": "#9333ea"}

FLOATS = re.compile(r"v?(?:add|addsub|sub|mul|div|sqrt|min|max|u?comi|cmp\w*|round|cvt\w*)(?:ps|pd|ss|sd|si|dq|qq)$")
INTEGERS = re.compile(r"vp(?:add|sub|mull|muldq|muludq|cmpeq|cmpgt|mins|maxs|minu|maxu|abs)[bwdq]?$")


def operations_of(mnemonic, operands):
    """How many numbers an instruction computes: none if it moves, shuffles, or computes an address."""
    registers = 32 if "ymm" in operands else 16
    if INTEGERS.match(mnemonic):
        return registers // (8 if mnemonic.endswith("dq") else {"b": 1, "w": 2, "d": 4, "q": 8}[mnemonic[-1]])
    if not FLOATS.match(mnemonic):
        return 0
    if "cvt" in mnemonic:
        if re.search("s[sdi]2|2si", mnemonic):
            return 1
        return registers // (8 if "pd" in mnemonic else 4)
    if mnemonic.endswith(("ss", "sd")):
        return 1
    return registers // (8 if mnemonic.endswith("pd") else 4)


def instructions_of(program):
    """Of each address: operations, and how many arithmetic instructions: with 16 lanes there are half as many of the
    widest."""
    text = subprocess.run(["objdump", "-d", "-M", "intel", "--no-show-raw-insn", program], text=True, check=True,
                          capture_output=True).stdout
    found = {}
    for line in re.finditer(r"^ +([0-9a-f]+):\t(?:\{\w+\} )?(\S+) *(.*)$", text, re.MULTILINE):
        operations = operations_of(line[2], line[3])
        found[int(line[1], 16)] = (operations, 0 if operations == 0 else 0.5 if "ymm" in line[3] else 1)
    return found


def costs_of(file):
    """What callgrind counted at each address of the program itself: {address: [instructions, misses ...]}."""
    costs = collections.defaultdict(lambda: [0] * 9)
    address, is_call, is_own, objects = 0, False, False, {}
    for line in file.read_text().splitlines():
        if found := re.match(r"(c?)ob=(\(\d+\))(.*)", line):  # a name comes once, and then its number
            if found[3]:
                objects[found[2]] = found[3]
            if not found[1]:
                is_own = objects[found[2]].endswith(COUNTED.name)
        elif line.startswith("calls="):
            is_call = True  # the next line has what the called function costs
        elif line[:1] in "0+-*" and line:
            position, _, *numbers = line.split()
            if position.startswith("0x"):
                address = int(position, 16)
            elif position != "*":
                address += int(position, 16 if "x" in position else 10)
            if not is_call and is_own:
                for i, cost in enumerate(numbers):
                    costs[address][i] += int(cost)
            is_call = False
    return costs


def cache(name):
    """Size, ways and line of a cache, as valgrind takes them."""
    get = lambda what: subprocess.run(["getconf", f"{name}_{what}"], text=True, capture_output=True).stdout.strip()
    return f"{get('SIZE')},{get('ASSOC')},{LINE}"


def count(scene, step):
    """Draws a frame under valgrind, which writes what a step of it executes and moves."""
    out = COUNTED.with_name(f"callgrind_{scene}_{step.replace(' ', '_')}")
    subprocess.run(
        ["valgrind", "--tool=callgrind", "--dump-instr=yes", "--cache-sim=yes", f"--D1={cache('LEVEL1_DCACHE')}",
         f"--LL={cache('LEVEL2_CACHE')}", f"--callgrind-out-file={out}",
         *(f"--toggle-collect={function}" for function in STEPS[step]),
         COUNTED, "--model", scene, "--size", "1280x720", "--threads", "1", "--width", "8",
         "--out", COUNTED.with_name("roofline.bmp")],
        check=True, capture_output=True)
    return out


def counted(scene, step, instructions):
    """What a step of a frame executes, and moves."""
    costs = costs_of(count(scene, step))
    total = dict.fromkeys(("instructions", "arithmetic", "operations", "slots", "beyond L1", "beyond L2"), 0)
    for address, (executed, *_, read_1, write_1, _, read_2, write_2) in costs.items():
        operations, slots = instructions.get(address, (0, 0))
        total["instructions"] += executed
        total["operations"] += executed * operations
        total["arithmetic"] += executed * (operations > 0)
        total["slots"] += executed * slots
        total["beyond L1"] += LINE * (read_1 + write_1)
        total["beyond L2"] += LINE * (read_2 + write_2)
    return {"counted": scene, "step": step, **total}


def rows_of(measured, key):
    return [row for row in measured if key in row]


def speeds(measured, limit):
    return {int(row["name"]): row["per ns"] for row in measured if row.get("limit") == limit}


def cache_roofs(measured):
    """Bytes per ns that are read from each level: of a size that fits into it, and not into the one before."""
    read = speeds(measured, "read")
    return {"L1": read[1 << 15], "L2": read[1 << 19], "L3": read[1 << 23], "memory": read[1 << 27]}


def peaks(measured):
    return speeds(measured, "multiply and add")


def block_memory(measured):
    return markdown(["KiB", "bytes per ns"],
                    [[f"{size // 1024:,}", number(speed)] for size, speed in speeds(measured, "read").items()])


def block_arithmetic(measured):
    names = ("multiply and add", "divide")
    columns = [speeds(measured, name) for name in names]
    return markdown(["lanes", *(f"{name}, operations per ns" for name in names)],
                    [[str(lanes), *(number(column[lanes]) for column in columns)] for lanes in columns[0]])


def shadow_parts_ms(scene):
    """What drawing a tile takes longer the first time: none where there are no shadows."""
    return max(scene["shading"] - scene["shading again"], 0) if scene["shadow fragments"] else 0


def steps_of(measured):
    """Each step of each scene: its time, and what was counted of it."""
    steps = []
    for scene in rows_of(measured, "frame"):
        parts = shadow_parts_ms(scene)
        ms = {"triangles": scene["casters"] + scene["triangles"], "depths and ids": scene["ids"],
              "shading": scene["shading"] - parts, "shadow map parts": parts}
        for row in rows_of(measured, "counted"):
            if row["counted"] == scene["scene"] and row["operations"] > 0:
                steps.append({**row, "ms": ms[row["step"]]})
    return steps


def block_frames(measured):
    rows = []
    for scene in rows_of(measured, "frame"):
        parts = shadow_parts_ms(scene)
        rows.append([f"`{scene['scene']}`", *(f"{ms:.2f}" if ms < 1 else number(ms) for ms in (
            scene["frame"], scene["casters"], scene["triangles"], scene["ids"], parts,
            scene["shading"] - parts, scene["rest"])), f"{scene['tested']:,.0f}", f"{scene['shaded']:,.0f}"])
    return markdown(["scene", "frame, ms", "casters", "triangles", "depths and ids", "shadow map parts",
                     "shading", "rest", "fragments tested", "pixels shaded"], rows)


def bounds_of(step, measured):
    """Milliseconds that a step takes at least (Eq. 14.6)."""
    roofs, peak = cache_roofs(measured), peaks(measured)[16]
    return {"16 lanes": 1e-6 * step["operations"] / peak, "own widths": 1e-6 * step["slots"] / (peak / 16),
            "L2": 1e-6 * step["beyond L1"] / roofs["L2"], "L3": 1e-6 * step["beyond L2"] / roofs["L3"],
            "memory": 1e-6 * step["beyond L2"] / roofs["memory"]}


def block_steps(measured):
    rows = []
    for step in steps_of(measured):
        bounds = bounds_of(step, measured)
        share = max(bounds[name] for name in ("own widths", "L2", "memory")) / step["ms"]
        rows.append([f"{step['step']}, `{step['counted']}`", number(step["ms"]), number(1e-6 * step["operations"]),
                     f"{100 * step['arithmetic'] / step['instructions']:.0f}",
                     number(1e-6 * step["beyond L1"]), number(1e-6 * step["beyond L2"]),
                     *(number(bounds[name]) for name in ("16 lanes", "own widths", "L2", "memory")),
                     f"{100 * share:.0f}"])
    return markdown(["step", "ms", "million operations", "arithmetic instructions, %", "MB beyond L1", "MB beyond L2",
                     "at least, ms: 16 lanes", "own widths", "L2", "memory", "bound, % of the time"], rows)


def block_roofline(measured):
    """Operations per ns over operations per byte from beyond the L2 cache."""
    roofs, peak = cache_roofs(measured), peaks(measured)
    steps = steps_of(measured)
    points = [(s, s["operations"] / s["beyond L2"], 1e-6 * s["operations"] / s["ms"]) for s in steps]
    right = 116
    x = Axis(0.5, max(p[1] for p in points) * 1.6, LEFT, WIDTH - right)
    y = Axis(min(*(p[2] for p in points), peak[1]) / 1.6, peak[16] * 1.5, HEIGHT - BOTTOM, TOP)
    ticks = [m * 10.0**e for e in range(-1, 4) for m in (1, 2, 5) if y.low <= m * 10.0**e <= y.high]
    picture = PAGE.with_name(f"{PAGE.stem}-steps.svg")
    script = axes(x, y, [f'"{t:g}" {t:g}' for t in ticks], "operations per byte from beyond L2", "operations per ns",
                  picture)
    script.append(f"set rmargin at screen {1 - right / WIDTH}")
    lines, data = [], []

    def add(style, where):
        lines.append(f"'-' with {style}")
        data.append("\n".join(f"{a} {b}" for a, b in where) + "\ne")

    for lanes, height in peak.items():
        add("lines linewidth 1.5 dashtype 2 linecolor rgb '#94a3b8'", [(x.low, height), (x.high, height)])
        name = f"{lanes} lane{'s' if lanes > 1 else ''}"
        script.append(label(name, (x.to_px + 8, y.at(height), "left"), "sans-serif,13"))
    for level in ("L3", "memory"):
        ridge = peak[16] / roofs[level]
        start = max(x.low, y.low / roofs[level])
        add("lines linewidth 2 linecolor rgb '#94a3b8'", [(start, start * roofs[level]), (ridge, peak[16])])
        at = x.low * (ridge / x.low) ** 0.86  # between the roofs of 8 and 16 lanes
        script.append(label(level, (x.at(at) + 10, y.at(at * roofs[level]) + 2, "left"), "sans-serif,13"))
    shapes = dict(zip(SCENES, (7, 5, 9, 13)))  # disc, square, triangle, diamond
    for step, across, up in points:
        add(f"points pointtype {shapes[step['counted']]} pointsize 0.9 linecolor rgb '{COLORS[step['step']]}'",
            [(across, up)])
    in_px = lambda axis, px: axis.low * (axis.high / axis.low) ** ((px - axis.from_px) / (axis.to_px - axis.from_px))
    for i, (step, color) in enumerate(COLORS.items()):  # below on the right, where no step is
        at = x.to_px - 136, HEIGHT - BOTTOM - 68 + 18 * i
        script.append(label(step, (at[0] + 12, at[1], "left"), "sans-serif,13"))
        add(f"points pointtype 7 pointsize 0.9 linecolor rgb '{color}'", [(in_px(x, at[0]), in_px(y, at[1]))])
    script.append("plot " + ", ".join(lines))
    draw(script + data, picture)
    return (f"![Operations per ns over operations per byte from beyond L2: the steps of four scenes under the roofs of "
            f"memory, L3 and arithmetic]({picture.name})\n\n*Disc*: `unlit.glb`; *square*: `textured.gltf`; *triangle*: "
            "`bumpy.glb`; *diamond*: `toon.glb`.")


def block_machine(measured):
    context, = rows_of(measured, "machine")
    return (f"{context['machine']}, {context['compiler']}; caches of {context['caches']}. "
            f"The load of the machine was {context['load'][0]:.1f} before and {context['load'][1]:.1f} after, for "
            f"{context['cores']} cores.")


def machine():
    cpu = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    compiler = re.search(r"CMAKE_CXX_COMPILER:\w+=(.*)", (ROOT / "build/release/CMakeCache.txt").read_text())
    version = subprocess.run([compiler[1], "--version"], text=True, capture_output=True).stdout.splitlines()[0]
    sizes = [int(cache(name).split(",")[0]) // 1024 for name in ("LEVEL1_DCACHE", "LEVEL2_CACHE")]
    return {"machine": cpu[1] if cpu else os.uname().machine, "compiler": version,
            "caches": f"{sizes[0]} KiB (L1) and {sizes[1]:,} KiB (L2)",
            "cores": os.cpu_count()}


def measure(options):
    """Builds both programs, and runs them. Each line that is measured is an object of JSON."""
    for preset, target in (("release", "roofline"), ("v3", "14_simd")):
        subprocess.run(["cmake", "--preset", preset], cwd=ROOT, check=True, capture_output=True)
        subprocess.run(["cmake", "--build", "--preset", preset, "--target", target], cwd=ROOT, check=True)
    print("how fast: some minutes", flush=True)
    load = os.getloadavg()[0]
    lines = subprocess.run([PROGRAM, *options], text=True, stdout=subprocess.PIPE, check=True).stdout.splitlines()
    measured = [{**machine(), "load": [load, os.getloadavg()[0]]}, *map(json.loads, lines)]
    print("how much: a minute", flush=True)
    instructions = instructions_of(COUNTED)
    measured += [counted(scene, step, instructions) for scene in SCENES for step in STEPS]
    for step, functions in STEPS.items():
        if not any(row["operations"] for row in rows_of(measured, "counted") if row["step"] == step):
            sys.exit(f"error: callgrind saw nothing of {step}: has {functions[0]} another name now?")
    MEASURED.write_text("\n".join(map(json.dumps, measured)) + "\n")


def main():
    options = sys.argv[1:]
    if set(options) - {"--quick", "--as-measured"}:
        sys.exit(__doc__)
    if "--as-measured" not in options:
        measure(options)
    measured = [json.loads(line) for line in MEASURED.read_text().splitlines()]
    fill_blocks(PAGE, lambda name: globals()[f"block_{name}"](measured))


if __name__ == "__main__":
    main()
