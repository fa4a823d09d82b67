"""Of peers.csv: the tables of docs/peers.md and its picture.
    table.py runs peers.csv isotropic      every run, failures too
    table.py levels peers.csv isotropic    the cheapest run of each tool that is right within 2 %, 1 % and what more the reference allows
    table.py picture peers.csv isotropic   gnuplot script
Right within p % is a run whose error is at most p % and stays so in all finer runs of its tool with the same cells and settings, shorter
cells or as short ones in more increments (no hit by chance), and whose sphere is in the body by no more than 10 um, 1 % of the depth."""
import csv
import re
import sys

what, file, scene = sys.argv[1:4]
rows = [r for r in csv.DictReader(open(file)) if r["scene"] == scene]
tools = list(dict.fromkeys(r["tool"] for r in rows))
DEEPEST = 10  # um


def number(text):
    try:
        return float(text) if text != "nan" else None
    except ValueError:
        return None


def series(row):
    return row["tool"], row["cells"], re.sub(r"^\d+ increments ?", "", row["settings"])


def increments(row):
    return int(re.match(r"\d*", row["settings"])[0] or 0)


def right_within(row, percent):
    finer = [r for r in rows if series(r) == series(row) and (float(r["edge"]), -increments(r)) <= (float(row["edge"]), -increments(row))]
    errors = [number(r["error_percent"]) for r in finer]
    inside = number(row["inside_um"])
    kept = all(e is None or abs(e) <= percent for e in errors)
    return number(row["error_percent"]) is not None and kept and (inside is None or inside <= DEEPEST)


def shown(text, form):
    return "" if number(text) is None else form % number(text)


if what == "runs":
    value = "apex, mm" if scene == "suction" else "force, N"
    print(f"| tool | cells | edge, mm | settings | {value} | error, % | CPU s | MB | sphere inside, um | |\n|" + " --- |" * 10)
    for r in rows:
        failed = not r["force_N"]
        cells = [r["tool"], r["cells"], r["edge"], r["settings"], shown(r["force_N"], "%.5g"), shown(r["error_percent"], "%+.2f"),
                 shown(r["cpu_s"], "%.2f"), shown(r["memory_MB"], "%.0f"), shown(r["inside_um"], "%.2g"),
                 f"**{r['words']}**" if failed else r["words"]]
        print("| " + " | ".join(cells) + " |")
elif what == "levels":
    # nearer than the last of them the reference is not known well enough
    levels = {"isotropic": [2, 1, 0.5, 0.2], "positive": [2, 1]}.get(scene, [2, 1, 0.5])
    print("| tool |" + "".join(f" within {p:g} %: CPU s |" for p in levels) + "\n|" + " --- |" * (1 + len(levels)))
    best = {}
    for tool in tools:
        line = f"| {tool} |"
        for p in levels:
            mine = [r for r in rows if r["tool"] == tool and right_within(r, p)]
            cheapest = min(mine, key=lambda r: float(r["cpu_s"]), default=None)
            best[tool, p] = float(cheapest["cpu_s"]) if cheapest else None
            line += " {cpu_s} ({cells} of {edge}, {error_percent} %) |".format(**cheapest) if cheapest else " no run |"
        print(line)
    line = "| best peer against Langer |"
    for p in levels:
        own, others = best["Langer", p], [best[t, p] for t in tools if t != "Langer" and best[t, p]]
        line += f" {min(others) / own:.1f} times |" if own and others else " |"
    print(line)
else:
    print(f"""set terminal svg size 760,480 font "sans,13" background "white"
set logscale xy
set xlabel "CPU seconds, one thread"
set ylabel "error of the force, %"
set key outside right top
set grid
set xrange [0.03:500]
set yrange [0.02:20]
set format y "%g"
set format x "%g"
set label "no answer" at graph 0.01, graph 0.965""")
    shapes = {"Langer": 7, "CalculiX": 5, "FEniCSx": 9, "GetFEM": 13, "FEBio": 11}
    colours = {"Langer": "#c1272d", "CalculiX": "#1b6ca8", "FEniCSx": "#2e8b57", "GetFEM": "#8a5fb0", "FEBio": "#c98a1b"}
    plots = []
    for tool in tools:
        mine = [r for r in rows if r["tool"] == tool and number(r["cpu_s"])]
        print(f"${tool} << EOD")
        for r in mine:
            error = number(r["error_percent"])
            inside = number(r["inside_um"]) or 0
            if error is not None and abs(error) < 15:
                print(r["cpu_s"], max(abs(error), 0.021), 1 if inside <= DEEPEST else 2)
            else:
                print(r["cpu_s"], 17, 3)
        print("9e99 9e99 1\n9e99 9e99 2\n9e99 9e99 3\nEOD")
        style = f'lc rgb "{colours[tool]}"'
        plots.append(f'${tool} using 1:($3==1?$2:1/0) with points pt {shapes[tool]} ps 0.9 {style} title "{tool}"')
        plots.append(f'${tool} using 1:($3==2?$2:1/0) with points pt {shapes[tool] - 1} ps 0.9 {style} notitle')
        plots.append(f'${tool} using 1:($3==3?$2:1/0) with points pt 2 ps 1.1 lw 2 {style} notitle')
    print("plot " + ", \\\n  ".join(plots))
