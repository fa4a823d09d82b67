#!/usr/bin/env python3
"""CPU seconds of each stage of a pipeline, by one or more builds side by side.

    pipeline.py PIPELINE BIN [BIN ...]      BIN: a folder with langer-plan and the stages

Each build runs the whole pipeline in a fresh folder, ROUNDS times in turn; the least of each stage
counts. gnuplot's share is part of the stage that starts it. With two builds the ratio is printed.
"""
import os
import re
import resource
import subprocess
import sys
import tempfile

ROUNDS = 3


def cpu_seconds(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, check=True, shell=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))


def recipes(folder):
    """The commands of the Makefile that langer-plan wrote, in the order of make."""
    listed = subprocess.run(["make", "-n", "-C", folder], capture_output=True, text=True,
                            check=True).stdout
    return [line.strip() for line in listed.splitlines() if re.match(r"\s*\S*langer-\w+ ", line)]


def measure(pipeline, bin_folder):
    with tempfile.TemporaryDirectory() as run:
        plan = f"{bin_folder}/langer-plan {pipeline} -o {run}"
        seconds = {"plan": cpu_seconds(plan, ".")}
        for command in recipes(run):
            stage = re.search(r"langer-(\w+) ", command).group(1)
            seconds[stage] = seconds.get(stage, 0) + cpu_seconds(command, run)
    return seconds


def main():
    pipeline, folders = sys.argv[1], [os.path.abspath(f) for f in sys.argv[2:]]
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    least = [{} for _ in folders]
    for _ in range(ROUNDS):
        for best, folder in zip(least, folders):
            for stage, seconds in measure(pipeline, folder).items():
                best[stage] = min(seconds, best.get(stage, seconds))
    print(f"{pipeline}: CPU seconds, least of {ROUNDS}")
    for stage in [*least[0], "all"]:
        values = [best.get(stage, sum(best.values())) for best in least]
        ratio = f"  {values[0] / values[1]:6.2f} times" if len(values) == 2 and values[1] else ""
        print(f"  {stage:12}" + "".join(f"{value:8.2f}" for value in values) + ratio)


if __name__ == "__main__":
    main()
