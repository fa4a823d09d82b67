#!/usr/bin/env python3
"""make adaptive: cells cut where the error comes from, against even and graded cells, in six scenes without friction.

    adaptive.py run <folder of the programs> <folder of the results>    every level of every scene, into adaptive.csv and commands.txt there
    adaptive.py at <adaptive.csv>         CPU seconds to 2, 1, 0.5 and 0.25 %, a line for each scene and kind of cells
    adaptive.py runs <adaptive.csv>       every run: its error at its CPU seconds
    adaptive.py picture <adaptive.csv>    gnuplot script

A run of langer-solve counts from its start to its end, with all its levels, estimates and files; below 2 s of CPU the median of three.
ONLY="punch far": only these are run, what adaptive.csv has of the others stays.
The truth of a scene is that of finer cells than those compared (`known`)."""
import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path


KINDS = ["even hex8", "even hex27", "graded hex8", "graded hex27", "cut"]
NAMES = ["scene", "kind", "level", "value", "error_percent", "cpu_s", "exit_code"]
TITLES = {
    "pulled": "block pulled between clamped faces", "sheared": "block sheared between clamped faces", "pads": "two pads on a layer, one pulled",
    "punch": "flat punch, rounded edge", "far": "small sphere off the middle", "paper": "the paper's sphere, no friction"}
SHEAR = ["supports=[{on: bottom, hold: [x, y, z]}, {on: top, hold: [y, z]}]", "loads=[{on: top, displacement: {x: 1.5}}]"]
PAD = ", sets: {pad: {of: top, within: {box: {from: [4, 4, -4], to: [12, 4, 4]}}}, fixed: {of: top, within: {box: {from: [-12, 4, -4], to: [-4, 4, 4]}}}}"
PUNCH = ["contacts.sphere.rigid={cylinder: {radius: 2, edge: 0.3, face: [0, 4, 0]}}", "contacts.sphere.motion[0].to=[0, -0.5, 0]"]
FAR = ["contacts.sphere.rigid={sphere: {radius: 1, centre: [6, 21, 0]}}", "contacts.sphere.motion[0].to=[0, -0.4, 0]",
       "material.volume.quadratic.d=1.0e-3"]


# Meshes: values of the config


def lines(a, b, n, crowd, power):
    """n cells from a to b that grow shorter towards the ends in `crowd` (< is a, > is b): the i-th line from there is at a distance of i^power"""
    half = 2 ** (power - 1)
    at = {"<": lambda s: s**power, ">": lambda s: 1 - (1 - s) ** power,
          "<>": lambda s: half * s**power if s <= 0.5 else 1 - half * (1 - s) ** power}[crowd]
    return [a + (b - a) * at(i / n) for i in range(n + 1)]


def joined(*parts):
    return list(parts[0]) + [x for part in parts[1:] for x in part[1:]]


def held_lines(n, power):
    return lines(0, 10, 4 * n, "<>", power), lines(0, 4, 2 * n, "<>", power), lines(0, 6, 2 * n, "<>", power)


def pad_lines(n, power):
    x = joined(lines(-20, -12, n, ">", power), lines(-12, -4, 2 * n, "<>", power), lines(-4, 4, 2 * n, "<>", power),
               lines(4, 12, 2 * n, "<>", power), lines(12, 20, n, "<", power))
    z = joined(lines(-12, -4, n, ">", power), lines(-4, 4, 2 * n, "<>", power), lines(4, 12, n, "<", power))
    return x, lines(0, 4, n, ">", power), z


def write_inp(path, axes, cells):
    """a block on these grid lines, with its six faces as sets of nodes"""
    step = 2 if cells == "hex27" else 1
    if step == 2:
        axes = [joined([a[0]], *([p, (p + q) / 2, q] for p, q in zip(a, a[1:]))) for a in axes]
    shape = [len(a) for a in axes]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    nodes = [tuple(step * c for c in corner) for corner in corners]
    if step == 2:  # in Abaqus' order; langer-solve adds the middles of facets and cells
        pairs = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        nodes += [tuple(p + q for p, q in zip(corners[a], corners[b])) for a, b in pairs]
    number, cells_text = {}, []
    for i in range(0, shape[0] - 1, step):
        for j in range(0, shape[1] - 1, step):
            for k in range(0, shape[2] - 1, step):
                cell = [number.setdefault((i + a, j + b, k + c), len(number) + 1) for a, b, c in nodes]
                words = [str(w) for w in [len(cells_text) + 1] + cell]
                cells_text.append(",\n".join(", ".join(words[w : w + 16]) for w in range(0, len(words), 16)))
    faces = {"x_min": (0, 0), "x_max": (0, shape[0] - 1), "bottom": (1, 0), "top": (1, shape[1] - 1), "z_min": (2, 0), "z_max": (2, shape[2] - 1)}
    with open(path, "w") as out:
        out.write("*NODE\n")
        for at, n in number.items():
            out.write(f"{n}, " + ", ".join(f"{axis[i]:.12g}" for axis, i in zip(axes, at)) + "\n")
        out.write(f"*ELEMENT, TYPE={'C3D20' if step == 2 else 'C3D8'}, ELSET=body\n" + "\n".join(cells_text) + "\n")
        for face, (axis, i) in faces.items():
            inside = [str(n) for at, n in number.items() if at[axis] == i]
            out.write(f"*NSET, NSET={face}\n" + "\n".join(", ".join(inside[w : w + 12]) for w in range(0, len(inside), 12)) + "\n")


def graded(folder, of, n, cells, power=2, further=""):
    path = (folder / f"{of.__name__}_{n}_{power}_{cells}.inp").resolve()
    write_inp(path, of(n, power), cells)
    return [f"mesh={{geometry: {{file: {{path: {path}}}}}, cells: {cells}{further}}}"]


def even(half, height, n, cells):
    return [f"mesh={{geometry: {{block: {{origin: [-{half}, 0, -{half}], size: [{2 * half}, {height}, {2 * half}], divisions: {list(n)}}}}}, cells: {cells}}}"]


def divided(n, cells):
    return [f"mesh.geometry.block.divisions={list(n)}", f"mesh.cells={cells}"]


def under(half, height, tool, edge, cells):
    return [f"mesh={{geometry: {{indented_block: {{origin: [-{half}, 0, -{half}], size: [{2 * half}, {height}, {2 * half}], {tool}, edge: {edge}}}}}, "
            f"cells: {cells}}}"]


def levels(folder):
    """scene -> config, values, what is measured, {kind: [(level, values)]}, and its truth: (levels, ratio) or (value, uncertainty)"""
    def words(n):
        return " x ".join(str(i) for i in n)

    scenes = {}
    for name, values, at in (("pulled", [], "x_max"), ("sheared", SHEAR, "top")):
        scenes[name] = ("held_block", values, at, {
            "even hex8": [(words((10 * k, 4 * k, 6 * k)), divided((10 * k, 4 * k, 6 * k), "hex8")) for k in (1, 2, 3, 4, 6)],
            "even hex27": [(words((10 * k, 4 * k, 6 * k)), divided((10 * k, 4 * k, 6 * k), "hex27")) for k in (1, 2)],
            "graded hex8": [(words((4 * n, 2 * n, 2 * n)), graded(folder, held_lines, n, "hex8")) for n in (2, 4, 6, 8)],
            "graded hex27": [(words((4 * n, 2 * n, 2 * n)), graded(folder, held_lines, n, "hex27")) for n in (1, 2, 3)],
            "cut": [(p, []) for p in (("4%", "2%", "1%", "0.5%") + (("0.25%",) if name == "pulled" else ()))],
            "truth": [(words((4 * n, 2 * n, 2 * n)), graded(folder, held_lines, n, "hex27")) for n in (4, 6)]}, 1.5**1.5 - 1)
    off = ["estimate=none", "accuracy=null"]
    scenes["pads"] = ("pads", [], "pad", {
        "even hex8": [(words((10 * n, n, 6 * n)), off + divided((10 * n, n, 6 * n), "hex8")) for n in (2, 3, 4, 6, 8)],
        "even hex27": [(words((10 * n, n, 6 * n)), off + divided((10 * n, n, 6 * n), "hex27")) for n in (1, 2, 3, 4)],
        "graded hex8": [(words((8 * n, n, 4 * n)), off + graded(folder, pad_lines, n, "hex8", 2, PAD)) for n in (2, 4, 6, 8)],
        "graded hex27": [(words((8 * n, n, 4 * n)), off + graded(folder, pad_lines, n, "hex27", 2, PAD)) for n in (1, 2, 3)],
        "cut": [(p, []) for p in ("40%", "20%", "10%")],
        "truth": [(words((8 * n, n, 4 * n)), off + graded(folder, pad_lines, n, "hex27", 2, PAD)) for n in (3, 4)]}, (4 / 3) ** 1.5 - 1)
    for name, values, half, height, tool, start, sizes, edges8, edges27, asked, truth, ratio in (
            ("punch", PUNCH, 15, 4, "radius: 2.5, depth: 0.8", (15, 2, 15), ((15, 2, 15), (30, 4, 30), (60, 8, 60), (90, 12, 90)),
             (0.35, 0.25, 0.175, 0.125, 0.0875, 0.0625), (0.5, 0.35, 0.25, 0.175), ("20%", "5%", "2.5%"), (0.14, 0.1), None),
            ("far", FAR, 20, 20, "radius: 1, depth: 0.4, under: [6, 0]", (10, 5, 10), ((20, 10, 20), (40, 20, 40)),
             (0.5, 0.35, 0.25, 0.175, 0.125), (0.7, 0.5, 0.35), ("10%", "5%", "2.5%", "1.5%", "1%"), (0.25, 0.2), None),
            ("paper", [], 15, 4, "radius: 2.5, depth: 1", (15, 2, 15), ((15, 2, 15), (30, 4, 30), (60, 8, 60), (90, 12, 90)),
             (0.35, 0.25, 0.175, 0.125, 0.1), (0.7, 0.5, 0.35, 0.25), ("10%", "2%", "0.5%"), (), None)):
        scenes[name] = ("accuracy_elsewhere", values, None, {
            "even hex8": [(words(n), even(half, height, n, "hex8")) for n in sizes if n[0] > 20 or name != "far"],  # longer ones are refused
            "even hex27": [(words(n), even(half, height, n, "hex27")) for n in sizes[: 1 if name == "far" else 2]],
            "graded hex8": [(f"edge {e}", under(half, height, tool, e, "hex8")) for e in edges8],
            "graded hex27": [(f"edge {e}", under(half, height, tool, e, "hex27")) for e in edges27],
            "cut": [(p, even(half, height, start, "hex8")) for p in asked],
            "truth": [(f"edge {e}", under(half, height, tool, e, "hex27")) for e in truth]}, ratio)
    return scenes


# Runs


def once(command, log):
    """CPU seconds, exit code, what was said to stdout"""
    with open(log, "w") as errors:
        child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        said = child.stdout.read().decode()
        _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime + used.ru_stime, child.returncode, said


def last_json(said):
    found = [line for line in said.splitlines() if line.startswith("{")]
    return json.loads(found[-1]) if found else {}


def run(programs, folder):
    root = Path(__file__).resolve().parents[2]
    programs, folder = programs.resolve(), folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    solution, spent, path = folder / "solution.h5", 0, folder / "adaptive.csv"
    scenes = levels(folder)
    wanted = os.environ.get("ONLY", " ".join(scenes)).split()
    kept = [r for r in csv.DictReader(open(path)) if r["scene"] not in wanted] if path.exists() else []
    with open(folder / "commands.txt", "w") as commands, open(path, "w", newline="") as table:
        writer = csv.DictWriter(table, NAMES)
        writer.writeheader()
        for scene, (config, values, at, meshes, ratio) in scenes.items():
            writer.writerows(r for r in kept if r["scene"] == scene)
            if scene not in wanted:
                continue
            rows = []
            for kind in ["truth"] + KINDS:
                for level, mesh in meshes[kind]:
                    asked = ["estimate=dual", f"accuracy={level}"] if kind == "cut" else []
                    sets = [word for value in values + mesh + asked for word in ("--set", value)]
                    command = [str(programs / "langer-solve"), str(root / f"configs/solve/{config}.yaml"), "-o", str(solution), "--json", *sets]
                    commands.write(f"{scene}, {kind}, {level}: langer-solve configs/solve/{config}.yaml -o solution.h5"
                                   + "".join(f" --set '{value}'" for value in sets[1::2]) + "\n")
                    commands.flush()
                    for left in folder.glob("solution.h5*"):
                        left.unlink()
                    runs = [once(command, folder / "said.txt")]
                    while runs[0][0] < 2 and len(runs) < 3 and kind != "truth":
                        runs.append(once(command, folder / "said.txt"))
                    cpu, code, said = sorted(runs)[len(runs) // 2]
                    spent += sum(r[0] for r in runs)
                    value = None
                    if at and not code:  # the reaction of the set that is moved
                        which = f"columns=[{{quantity: reaction_x, at: {at}}}]"
                        post = once([str(programs / "langer-post"), str(root / "configs/post/last_state.yaml"), "--solution", str(solution),
                                     "-o", str(folder / "curves.h5"), "--json", "--quiet", "--set", which], folder / "post.txt")
                        value = abs(last_json(post[2])[f"reaction_x_{at}_N"])
                    elif not code:
                        value = last_json(said)["force_N"]
                    rows.append(dict(zip(NAMES, (scene, kind, level, value, None, cpu, code))))
                    print(f"{scene}, {kind}, {level}: {value} N, {cpu:.2f} s" + (f", ended with {code}" if code else ""), flush=True)
            if any(r["value"] is None for r in rows if r["kind"] == "truth"):
                sys.exit(f"{scene}: its truth was not solved; see {folder}/said.txt")
            truth, unsure = known(scene, [r["value"] for r in rows if r["kind"] == "truth"], ratio,
                                  [(float(r["level"].split()[1]), r["value"]) for r in rows if r["kind"] == "graded hex8" and "edge" in r["level"]])
            rows.append(dict(zip(NAMES, (scene, "limit", "", truth, 100 * unsure / truth, 0, 0))))
            for r in rows:
                if r["value"] and r["kind"] != "limit":
                    r["error_percent"] = f"{100 * (r['value'] / truth - 1):.4f}"
                if r["kind"] == "limit":
                    r["error_percent"] = f"{r['error_percent']:.4f}"
                r["cpu_s"] = f"{r['cpu_s']:.3f}"
                r["value"] = r["value"] and f"{r['value']:.6g}"
                writer.writerow(r)
            table.flush()
    print(f"{spent:.0f} s of CPU")


def known(scene, finest, ratio, hex8):
    """a scene's truth and how far it may be off: the limit of two meshes of `ratio` = (h1 / h2)^p - 1 and its distance from the finer one. Without
    a ratio the finer one, and the larger of its distances from the other and from the limit, of order 2, of the two finest meshes of hex8"""
    if scene == "paper":
        return 10.763, 0.0003 * 10.763  # docs/work_precision.md: fitted to four meshes of hex8 by make work-precision
    coarse, fine = finest
    if ratio:
        limit = fine + (fine - coarse) / ratio
        return limit, abs(limit - fine)
    (edge, value), (shorter, nearer) = hex8[-2:]
    return fine, max(abs(fine - coarse), abs(nearer + (nearer - value) / ((edge / shorter) ** 2 - 1) - fine))


# Tables and the picture


def read(path):
    """scene -> its truth, how far that may be off in %, kind -> [(CPU s, error in %, level)] by CPU; what found no answer is left out"""
    found = {}
    for r in csv.DictReader(open(path)):
        scene = found.setdefault(r["scene"], {"kinds": {}})
        if r["kind"] == "limit":
            scene["truth"], scene["unsure"] = float(r["value"]), float(r["error_percent"])
        elif r["kind"] in KINDS and r["error_percent"]:
            scene["kinds"].setdefault(r["kind"], []).append((float(r["cpu_s"]), float(r["error_percent"]), r["level"]))
    for scene in found.values():
        for runs in scene["kinds"].values():
            runs.sort()
    return found


def front(runs, unsure):
    """[(CPU s, error in %)]: the largest error of a run and of all dearer ones of its kind: what is right by a change of sign does not count"""
    return [(runs[i][0], max([unsure] + [abs(e) for _, e, _ in runs[i:]])) for i in range(len(runs))]


def cost(points, percent):
    """CPU seconds at which the front comes to this error, between two runs on a line in logarithms; whether it was there from the first run on.
    None: not reached"""
    for i, (cpu, error) in enumerate(points):
        if error <= percent:
            if i == 0:
                return cpu, True
            before, larger = points[i - 1]
            part = math.log(larger / percent) / math.log(larger / error)
            return before * (cpu / before) ** part, False
    return None


def seconds(cpu):
    return f"{cpu:.2g}" if cpu < 10 else f"{cpu:.0f}"


def shown(reached):
    return "not reached" if reached is None else ("at most " if reached[1] else "") + seconds(reached[0])


def beside(points, cut):
    """what these cells cost over what cut ones cost, at 0.5 % or the least error that both reach"""
    percent = max(0.5, points[-1][1], cut[-1][1])
    own, other = cost(points, percent), cost(cut, percent)
    bound = {(False, False): "", (True, False): "at most ", (False, True): "at least ", (True, True): "some "}[own[1], other[1]]
    return f"{bound}{own[0] / other[0]:.2g} times at {percent:.2g} %"


def at(scenes):
    goals = [2, 1, 0.5, 0.25]
    print("| scene | truth, N | cells | " + " | ".join(f"CPU s to {p:g} %" for p in goals) + " | cost over that of cut cells |")
    print("|" + " --- |" * (4 + len(goals)))
    for name, scene in scenes.items():
        fronts = {kind: front(runs, scene["unsure"]) for kind, runs in scene["kinds"].items()}
        for i, (kind, points) in enumerate(fronts.items()):
            known = f"{scene['truth']:.5g} ± {scene['unsure']:.2g} %" if i == 0 else ""
            over = beside(points, fronts["cut"]) if kind != "cut" and "cut" in fronts else ""
            print(f"| {TITLES[name] if i == 0 else ''} | {known} | {kind} | " +
                  " | ".join(shown(cost(points, p)) if p > scene["unsure"] else "unknown" for p in goals) + f" | {over} |")


def every(scenes):
    print("| scene | cells | error, % at CPU s |\n| --- | --- | --- |")
    for name, scene in scenes.items():
        for kind, runs in scene["kinds"].items():
            print(f"| {name} | {kind} | " + ", ".join(f"{e:+.2g} at {seconds(cpu)}" for cpu, e, _ in runs) + " |")


def picture(scenes):
    colours = {"even": "#8a8a8a", "graded": "#1b6ca8", "cut": "#c1272d"}
    print("""set terminal svg size 1020,700 font "sans,12" background "white"
set multiplot
set logscale xy
set grid lt 1 lw 0.5 lc rgb "#dddddd"
set xrange [0.02:60]
set yrange [0.02:100]
set format x "%g"
set format y "%g"
set key off
set lmargin 6.5
set rmargin 1.5
set tmargin 1.8
set bmargin 2.8
set size 0.333,0.44""")
    for i, (name, scene) in enumerate(scenes.items()):
        unsure = scene["unsure"]
        print(f'set origin {0.333 * (i % 3):.3f},{0.56 if i < 3 else 0.11}')
        print(f'set title "{TITLES[name]}" offset 0,-0.6')
        print('set ylabel "error, % of the force" offset 1.5' if i % 3 == 0 else 'unset ylabel')
        print('set xlabel "CPU seconds, one thread" offset 0,0.4' if i >= 3 else 'unset xlabel')
        print(f'set object 1 rect from graph 0, graph 0 to graph 1, first {unsure:.4f} fc rgb "#eeeeee" fs solid noborder behind')
        plots = ['0.5 with lines dt 3 lc rgb "black"']
        for kind, runs in scene["kinds"].items():
            data = f"${name}_{kind.replace(' ', '_')}"
            points = front(runs, unsure)
            print(f"{data} << EOD")
            for (cpu, error, _), (_, most) in zip(runs, points):
                print(f"{cpu:.3f} {max(abs(error), unsure):.4f} {most:.4f}")
            print("EOD")
            colour, dash = colours[kind.split()[0]], 2 if "hex27" in kind else 1
            plots.append(f'{data} using 1:3 with lines lw {2 if kind == "cut" else 1.2} dt {dash} lc rgb "{colour}"')
            plots.append(f'{data} using 1:2 with points pt {SHAPES[kind]} ps 0.7 lc rgb "{colour}"')
        print("plot " + ", \\\n  ".join(plots))
    print("""unset object 1
unset title
unset xlabel
unset ylabel
unset border
unset tics
unset grid
set size 1,0.11
set origin 0,0
set margins 0,0,0,0
set key center center horizontal samplen 3 width 1 maxrows 2 maxcols 4
plot """ + ", \\\n  ".join(
        f'1/0 with linespoints pt {SHAPES[kind]} ps 0.8 lw {2 if kind == "cut" else 1.2} dt {2 if "hex27" in kind else 1} '
        f'lc rgb "{colours[kind.split()[0]]}" title "{WORDS[kind]}"' for kind in KINDS)
          + """, \\
  1/0 with lines dt 3 lc rgb "black" title "0.5 %", 1/0 with boxes fs solid lc rgb "#eeeeee" title "truth not known better"
unset multiplot""")


SHAPES = {"even hex8": 7, "even hex27": 6, "graded hex8": 5, "graded hex27": 4, "cut": 9}
WORDS = {"even hex8": "even hex8", "even hex27": "even hex27", "graded hex8": "graded hex8", "graded hex27": "graded hex27",
         "cut": "hex8 cut where the error comes from"}

if __name__ == "__main__":
    if sys.argv[1] == "run":
        run(Path(sys.argv[2]), Path(sys.argv[3]))
    else:
        {"at": at, "runs": every, "picture": picture}[sys.argv[1]](read(sys.argv[2]))
