#!/usr/bin/env python3
"""Measures the gallery of the site: what each pipeline took, how large the errors of its results are, and a picture.

gallery.py PROJECT RUNS LANGER     RUNS holds finished runs by the names of their pipelines
Writes docs/gallery.csv and docs/gallery/NAME.png (700 pixels wide). A pipeline without a finished run keeps what it has.
Wants python3-pil, and chromium for runs that draw nothing but their report.
"""
import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image

project, runs, langer = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
folder, table = project / "docs/gallery", project / "docs/gallery.csv"
columns = ["pipeline", "steps", "cpu_s", "errors"]


def summary(file):
    return json.loads(subprocess.run([langer, "show", "--json", file], check=True, capture_output=True, text=True).stdout.splitlines()[0])


def cost(run):
    """CPU seconds and number of steps; None where a step has not ended well."""
    last = subprocess.run([langer, "times", run], check=True, capture_output=True, text=True).stdout
    found = re.search(r"(\d+) steps: (\d+) done, 0 failed or not ended, 0 not run; ([\d.]+) s of CPU", last)
    return (int(found[1]), float(found[3])) if found and found[1] == found[2] else None


def curves_of(run):
    """What the curves of each solution end with, by the path of the solution; a pipeline's post says in its first line which that is."""
    found = {}
    for file in run.rglob("*.yaml"):
        source = re.match(r"# langer-post .*--solution (\S+)", file.read_text())
        if source and (file.parent / "curves.h5").exists():
            found.setdefault(run / source[1], {}).update(summary(file.parent / "curves.h5"))
    return found


def errors(run):
    """The worst of all members, of what a run tells of its own errors: in percent of what it is an error of, where the curves have that."""
    worst, by, curves = {}, set(), curves_of(run)
    for config in run.rglob("solve.yaml"):
        by |= set(re.findall(r"^estimate: (\w+)", config.read_text(), re.M)) - {"none"}
    for file in sorted(run.rglob("*.h5")):
        said = summary(file)
        if said["schema"] == "material" and said.get("mean_error_percent") is not None:
            worst["fit, mean", "%"] = max(worst.get(("fit, mean", "%"), 0), said["mean_error_percent"])
        for key, value in said.items():
            error = re.fullmatch(r"(force|reaction_\w+|torque_\w+|von_mises_max|displacement_\w+|u_\w+)_error_(N|MPa|mm|N_mm)", key)
            if said["schema"] != "solution" or not error or not value:
                continue
            of = curves.get(file, {}).get(f"{error[1]}_{error[2]}")
            if of is not None and abs(of) < 1e-9:  # a body that was let go has no force whose error would say anything
                continue
            of = abs(of or 0)
            entry = (error[1], "%" if of else error[2].replace("_", " "))
            worst[entry] = max(worst.get(entry, 0), 100 * value / of if of else value)
    words = "; ".join(f"{what} {value:.2g} {unit}" for (what, unit), value in sorted(worst.items()))
    return words + (f" (estimate: {', '.join(sorted(by))})" if by and set(worst) - {("fit, mean", "%")} else "")


def picture(run):
    """A body before a table's figure before a solution's curve before a fit's; what a fit tells of itself only where nothing else is there."""
    found = []
    for file in run.rglob("*.png"):
        order = ["render", "map", "table", "post", "tune", "sensitivity", "fit"]
        path = file.relative_to(run).as_posix()
        aside = file.name.startswith(("correlation", "stability", "error_"))
        found.append((aside, next((i for i, word in enumerate(order) if word in path), len(order)), path))
    return run / min(found)[2] if found else page_of(run)


def page_of(run):
    """A run that draws nothing itself: the begin of its report."""
    reports = sorted(run.rglob("report.html"))
    chromium = shutil.which("chromium")
    if not reports or not chromium:
        return None
    shown = run / "report.png"
    subprocess.run([chromium, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--virtual-time-budget=8000", "--window-size=1100,900",
                    f"--screenshot={shown}", reports[0].resolve().as_uri()], check=True, capture_output=True)
    return shown


kept = {row["pipeline"]: row for row in csv.DictReader(table.open())} if table.exists() else {}
folder.mkdir(exist_ok=True)
for file in sorted((project / "pipelines").glob("*.yaml")):
    run = runs / file.stem
    took = cost(run) if (run / "Makefile").exists() else None
    if not took:
        continue
    if source := picture(run):
        kept[file.stem] = dict(zip(columns, [file.stem, took[0], f"{took[1]:.3g}", errors(run)]))
        image = Image.open(source).convert("RGB")
        image = image.resize((700, round(700 * image.height / image.width)), Image.LANCZOS)
        # the ends of a scale of colours are rare in a picture, and median cuts lose them
        image.quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(folder / f"{file.stem}.png", optimize=True)
with table.open("w", newline="") as out:
    writer = csv.DictWriter(out, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(kept[name] for name in sorted(kept))
print(f"{len(kept)} pipelines in {table}")
