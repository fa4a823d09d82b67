#!/usr/bin/env python3
"""CPU seconds that --dry-run forecasts beside those that langer-solve takes: the first solve of every shipped pipeline.

    forecast_pipelines.py <folder of the programs> <table.csv>

The table has one row per pipeline. Printed are the number of them that is forecast within a factor
of 1.5, and the others. Solves that take more than LIMIT seconds are left out.
"""
import csv
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

LIMIT = 60
NEAR = 1.5
BEFORE = ("mesh", "fit", "sample")  # stages that a solve may need


def cpu_seconds(command, folder):
    """of a command, and what it printed; nothing if it takes too long"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run("exec " + command, shell=True, cwd=folder, capture_output=True, text=True, timeout=LIMIT, check=True)
    except subprocess.TimeoutExpired:
        return None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime")), done.stdout


def first_solve(run):
    """its command, after those before it have run"""
    listed = subprocess.run(["make", "-n", "-C", run], capture_output=True, text=True, check=True).stdout
    for line in listed.splitlines():
        stage = re.search(r"langer-(\w+) ", line)
        if not stage:
            continue
        if stage.group(1) == "solve":
            return re.sub(r" --log \S+", "", line.strip()) + " --quiet"
        if stage.group(1) in BEFORE and cpu_seconds(line.strip() + " --quiet", run) is None:
            return None
    return None


def measure(programs, pipeline):
    with tempfile.TemporaryDirectory() as run:
        subprocess.run([programs / "langer-plan", pipeline, "-o", run, "--quiet"], check=True)
        command = first_solve(run)
        if command is None:
            return None
        dry = cpu_seconds(command + " --dry-run --json", run)
        taken = cpu_seconds(command, run)
        if dry is None or taken is None:
            return None
        return float(re.search(r'"cpu_s": ([0-9.e+-]+)', dry[1]).group(1)), taken[0]


def main():
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    programs, table = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    rows = []
    for pipeline in sorted(pathlib.Path("pipelines").glob("*.yaml")):
        found = measure(programs, pipeline)
        if found:
            rows.append((pipeline.stem, *found))
    with open(table, "w", newline="") as file:
        csv.writer(file).writerows([("pipeline", "forecast_s", "taken_s")] + rows)
    far = [row for row in rows if not 1 / NEAR <= row[1] / row[2] <= NEAR]
    print("| scene | forecast s | taken s | ratio |\n| --- | --- | --- | --- |")
    print(f"| first solves of {len(rows)} pipelines, of which {len(rows) - len(far)} within a factor of {NEAR} | | | |")
    for name, forecast, taken in far:
        print(f"| `{name}` | {forecast:.2g} | {taken:.2g} | {forecast / taken:.2f} |")


main()
