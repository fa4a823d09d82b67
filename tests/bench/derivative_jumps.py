#!/usr/bin/env python3
"""What a difference quotient of whole runs does where a node changes between slip and stick, beside the derivative of a run:

    python3 tests/bench/derivative_jumps.py build/bin docs/derivative_jumps      writes .csv and .svg (gnuplot)

The force of configs/solve/inverse_block.yaml over the coefficient of friction, 161 runs."""
import json
import os
import subprocess
import sys
import tempfile

programs, out = sys.argv[1], sys.argv[2]
root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
first, step, n = 0.2, 0.000625, 161
rows = []
with tempfile.TemporaryDirectory() as folder:
    for i in range(n):
        mu = first + i * step
        said = subprocess.run(
            [f"{programs}/langer-solve", f"{root}/configs/solve/inverse_block.yaml", "-o", f"{folder}/solution.h5", "--quiet", "--json",
             "--set", f"contacts.sphere.friction={mu!r}", "--set", "sensitivity=[contacts.sphere.friction]"] + sys.argv[3:],
            check=True, capture_output=True, text=True).stdout
        found = json.loads(said)
        rows.append((mu, found["force_N"], found["d_force_N_d_contacts_sphere_friction"]))
with open(f"{out}.csv", "w") as f:
    print("friction,force_N,derivative_N,quotient_N", file=f)
    for i, (mu, force, slope) in enumerate(rows):
        quotient = (rows[i + 1][1] - rows[i - 1][1]) / (2 * step) if 0 < i < n - 1 else float("nan")
        print(f"{mu:.6f},{force:.10g},{slope:.6g},{quotient:.6g}", file=f)
plot = f"""set terminal svg size 640,400 font 'sans,12' background rgb 'white'
set output '{out}.svg'
set datafile separator ','
set key top right
set grid lc rgb '#dddddd'
set xlabel 'coefficient of friction (-)'
set ylabel 'dF/d(friction) (N)'
plot '{out}.csv' using 1:4 skip 1 with points pt 6 ps 0.5 lc rgb '#d55e00' title 'difference quotient of whole runs', \\
     '{out}.csv' using 1:3 skip 1 with lines lw 2 lc rgb '#0072b2' title 'derivative of the run'
"""
subprocess.run(["gnuplot"], input=plot, text=True, check=True)
