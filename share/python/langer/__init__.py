"""Results of Langer as arrays and tables with units; its pipelines and sweeps from Python.

>>> import langer
>>> run = langer.run("pipelines/indentation.yaml", set={"solve.contacts.sphere.friction": 0.2})
>>> run["post"].table                      # a pandas table; its units are in table.attrs["units"]
>>> run["solve"].u[-1]                     # mm, one row for each node, after the last step
>>> langer.sweep("pipelines/indentation.yaml", {"solve.contacts.sphere.friction": [0, 0.2, 0.34]}).table("post")
>>> langer.read("runs/indentation/fit/material.h5").parameters

Values are in mm, N, MPa, s and degrees, as in the files. Importing this package starts nothing; `run` and `sweep` call the programs
langer-plan, make and langer-<stage> (see `langer.program`).
"""

from ._version import version as __version__
from .arrays import Array, Quantity
from .figures import figure, plot, plot_correlation, plot_fit, plot_profiles, style
from .files import (Curve, Curves, File, Material, Mesh, Sensitivity, Snapshot, Solution, Sweep, read)
from .programs import LangerError, program
from .runs import Run, run, sweep

__all__ = ["Array", "Quantity", "File", "Mesh", "Material", "Solution", "Curve", "Curves", "Snapshot", "Sweep", "Sensitivity", "read",
           "run", "sweep", "Run", "program", "LangerError", "figure", "plot", "plot_correlation", "plot_fit", "plot_profiles", "style",
           "__version__"]
