"""The files of Langer, read: arrays with units, pandas tables. What is in which file: docs/schema.md."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator

import numpy as np

from .arrays import Array, Quantity
from .checks import check_kind, check_own_values, check_whole

if TYPE_CHECKING:
    import pandas as pd


def _h5py() -> Any:
    try:
        import h5py
    except ImportError as missing:
        raise ImportError("reading files of Langer needs h5py: apt install python3-h5py, or pip install h5py") from missing
    return h5py


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as missing:
        raise ImportError("tables need pandas: apt install python3-pandas, or pip install pandas") from missing
    return pandas


def _text(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.shape == ():
        return _text(value[()])
    return value.item() if isinstance(value, np.generic) else value


def table_of(columns: dict[str, Any], units: dict[str, str]) -> "pd.DataFrame":
    """A pandas table whose units stand in `table.attrs["units"]`."""
    table = _pandas().DataFrame({name: np.asarray(values) for name, values in columns.items()})
    table.attrs["units"] = dict(units)
    return table


class File:
    """One HDF5 file of Langer. `file["history/force_ind"]` is a dataset with its unit; `print(file.tree())` shows which there are."""

    def __init__(self, path: str | os.PathLike[str]):
        self.path = Path(path)
        with self._open() as f:
            self.attributes: dict[str, Any] = {name: _text(value) for name, value in f.attrs.items()}
            check_kind(self.path, self.attributes)
            check_own_values(self.path, f, _h5py())

    def _open(self) -> Any:
        if not self.path.exists():
            raise FileNotFoundError(f"{self.path}: there is no such file")
        check_whole(self.path)
        try:
            return _h5py().File(self.path, "r")
        except OSError as trouble:
            raise OSError(f"{self.path}: not an HDF5 file, or one that is being written ({trouble})") from None

    @property
    def schema(self) -> str:
        """Kind of file: "solution", "curves", ..."""
        return str(self.attributes.get("schema", ""))

    @property
    def stage(self) -> str:
        """The stage that made it."""
        return str(self.attributes.get("stage", ""))

    def __getitem__(self, name: str) -> Any:
        with self._open() as f:
            if name not in f:
                raise KeyError(f"{self.path}: there is no {name}; print(file.tree()) shows what there is")
            found = f[name]
            if isinstance(found, _h5py().Group):
                return {key: self[f"{name}/{key}"] for key in found}
            return self._value(found)

    @staticmethod
    def _value(dataset: Any, rows: Any = Ellipsis) -> Any:
        values = dataset[()] if dataset.shape == () else dataset[rows]
        if isinstance(values, bytes) or getattr(values, "dtype", np.dtype("f8")).kind in "SO":
            return _text(values) if dataset.shape == () else [_text(v) for v in values]
        attributes = {key: _text(value) for key, value in dataset.attrs.items()}
        unit = str(attributes.pop("unit", "-"))
        return Quantity(values, unit) if dataset.shape == () else Array(values, unit, attributes)

    def __contains__(self, name: str) -> bool:
        with self._open() as f:
            return name in f

    def __iter__(self) -> Iterator[str]:
        """Names of all datasets."""
        names: list[str] = []
        h5py = _h5py()
        with self._open() as f:
            f.visititems(lambda name, thing: names.append(name) if isinstance(thing, h5py.Dataset) else None)
        return iter(names)

    def tree(self) -> str:
        """Every dataset with its shape and unit, one a line."""
        lines = []
        with self._open() as f:
            for name in self:
                unit = _text(f[name].attrs.get("unit", b""))
                lines.append(f"{name}  {f[name].shape}  {unit}".rstrip())
        return "\n".join(lines)

    @property
    def config(self) -> str:
        """The effective config (YAML) from which this file can be made again."""
        return str(self["provenance/config"]) if "provenance/config" in self else ""

    @property
    def provenance(self) -> dict[str, Any]:
        """Who made it, when, where, by which command."""
        return self["provenance"] if "provenance" in self else {}

    @property
    def summary(self) -> dict[str, Quantity]:
        """The numbers that `langer show` prints and sweeps gather."""
        return self["summary"] if "summary" in self else {}

    def __repr__(self) -> str:
        return f"<{self.schema or 'HDF5'} {self.path}>"

    def _repr_html_(self) -> str:
        import html
        rows = "".join(f"<tr><td>{html.escape(k)}</td><td>{html.escape(str(v))}</td></tr>" for k, v in self.summary.items())
        return f"<b>{html.escape(self.schema)}</b> {html.escape(str(self.path))}<table>{rows}</table>"


def _first_cells(connectivity: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    return connectivity.reshape(len(offsets) - 1, -1)


class Mesh(File):
    """A grid: mesh.h5, and what snapshots and solutions have of it."""

    @property
    def points(self) -> Array:
        """Reference positions (n, 3), mm."""
        return Array(self["VTKHDF/Points"], "mm")

    @property
    def cells(self) -> np.ndarray:
        """Nodes of each cell (e, 8), (e, 27) or (e, 15), in VTK's order."""
        return _first_cells(np.asarray(self["VTKHDF/Connectivity"]), np.asarray(self["VTKHDF/Offsets"]))

    @property
    def bodies(self) -> Array:
        """Which body each cell belongs to; `bodies.attributes["names"]` has the names."""
        return self["VTKHDF/CellData/body"]

    @property
    def sets(self) -> dict[str, np.ndarray]:
        """Node numbers of every named set."""
        return {name: np.asarray(nodes) for name, nodes in (self["sets/nodes"] if "sets/nodes" in self else {}).items()}


class Snapshot(Mesh):
    """One state, with its fields."""

    @property
    def point_data(self) -> dict[str, Array]:
        """Fields at nodes; symmetric tensors as 11 22 33 12 23 13."""
        return self["VTKHDF/PointData"]

    @property
    def cell_data(self) -> dict[str, Array]:
        return self["VTKHDF/CellData"]


class Solution(Mesh):
    """solution.h5, also an unfinished solution.h5.part. Steps count from 0; -1 is the last."""

    @property
    def steps(self) -> int:
        with self._open() as f:
            return int(f["VTKHDF/Steps"].attrs["NSteps"])

    @property
    def t(self) -> Array:
        """The path parameter of each step."""
        return self["history/t"][:self.steps]

    def field(self, name: str, step: int | None = None) -> Array:
        """A field of nodes or cells: (steps, rows, ...), or of one step (rows, ...)."""
        with self._open() as f:
            for kind in ("PointData", "CellData"):
                place = f.get(f"VTKHDF/{kind}/{name}")
                if place is None:
                    continue
                rows = f["VTKHDF/Points"].shape[0] if kind == "PointData" else f["VTKHDF/Offsets"].shape[0] - 1
                if place.shape[0] == rows and self.steps != 1:  # once for all steps: frames, bodies
                    return self._value(place)
                if step is None:
                    whole = self._value(place)
                    return whole[:self.steps * rows].reshape((self.steps, rows) + whole.shape[1:])
                if not -self.steps <= step < self.steps:
                    raise IndexError(f"{self.path}: step {step} of {self.steps}")
                begin = (step % self.steps) * rows
                return self._value(place, slice(begin, begin + rows))
            known = list(f["VTKHDF/PointData"]) + list(f["VTKHDF/CellData"])
        raise KeyError(f"{self.path}: there is no field {name}; one of {', '.join(known)}")

    @property
    def u(self) -> Array:
        """Displacements (steps, n, 3), mm."""
        return self.field("u")

    @property
    def stress(self) -> Array:
        """Cauchy stress of the cells (steps, e, 3, 3), MPa, where the solve config has `cell_stress`; the mean over their Gauss points.

        `field("principal_stress_1")` (steps, e) and `field("principal_direction_1")` (steps, e, 3) stand beside it with
        `cell_stress: principal`: 1 is the greatest, 3 the least.
        """
        try:
            flat = self.field("stress")
        except KeyError:
            raise KeyError(f"{self.path}: no stress tensors; the solve config asks for them with cell_stress: tensor") from None
        return flat.reshape(flat.shape[:2] + (3, 3))

    @property
    def indenters(self) -> list[str]:
        with self._open() as f:
            return list(f["contact"]) if "contact" in f else []

    @property
    def force(self) -> Array:
        """Force on the indenter, or on all of them (steps, 3), N."""
        return self["history/force_ind"][:self.steps]

    @property
    def travel(self) -> Array:
        """Motion of the first indenter (steps, 3), mm."""
        return self["history/u_ind"][:self.steps]

    def contact(self, name: str | None = None) -> dict[str, Any]:
        """Of an indenter: nodes (k), r (steps, k, 3) N on the body, status (steps, k) 0 open, 1 stick, 2 slip, gap (steps, k) mm."""
        if not self.indenters:
            raise KeyError(f"{self.path}: a scene without contact")
        return self[f"contact/{name or self.indenters[0]}"]

    @property
    def history(self) -> "pd.DataFrame":
        """One row for each step: what the solver recorded; vectors as name_x, name_y, name_z."""
        columns: dict[str, np.ndarray] = {}
        units: dict[str, str] = {}
        for name, values in self["history"].items():
            if not isinstance(values, Array):
                continue
            parts = [(name, values)] if values.ndim == 1 else [(f"{name}_{'xyz'[k]}", values[:, k]) for k in range(values.shape[1])]
            for part, numbers in parts:
                columns[part], units[part] = np.asarray(numbers)[:self.steps], values.unit
        return table_of(columns, units)


@dataclass
class Curve:
    """One curve: `x` and `y` are arrays with units; the labels say what they are."""
    name: str
    x: Array
    y: Array
    x_label: str = ""
    y_label: str = ""


class Curves(File):
    """curves.h5 of langer-post: a table over the steps, and curves of one column over another."""

    @property
    def table(self) -> "pd.DataFrame":
        with self._open() as f:
            order = str(_text(f["columns"].attrs["order"])).split()
        columns = self["columns"]
        return table_of({name: columns[name] for name in order}, {name: columns[name].unit for name in order})

    @property
    def curves(self) -> dict[str, Curve]:
        found = {}
        for name, parts in (self["curves"] if "curves" in self else {}).items():
            x, y = parts["x"], parts["y"]
            found[name] = Curve(name, x, y, x.attributes.get("label", "x"), y.attributes.get("label", name))
        return found


class Material(File):
    """material.h5: a law, and what the fit told about it."""

    @property
    def law(self) -> dict[str, Any]:
        """Nested as in YAML: law["matrix"]["0"]["yeoh"]["a1"]."""
        return self["material"]

    def _order(self, group: str) -> list[str]:
        with self._open() as f:
            return str(_text(f[group].attrs.get("order", " ".join(f[group])))).split()

    @property
    def parameters(self) -> "pd.DataFrame":
        """One row for each fitted parameter: value, lower, upper, standard_error, unit."""
        rows = self["fit/parameters"]
        names = self._order("fit/parameters")
        columns = {key: [float(rows[n][key]) for n in names] for key in ("value", "lower", "upper", "standard_error")}
        table = _pandas().DataFrame({**columns, "unit": [rows[n]["value"].unit for n in names]}, index=names)
        table.index.name = "parameter"
        return table

    def _matrix(self, name: str) -> "pd.DataFrame":
        names = self._order("fit/parameters")
        return _pandas().DataFrame(np.asarray(self[name]), index=names, columns=names)

    @property
    def correlation(self) -> "pd.DataFrame":
        return self._matrix("fit/correlation")

    @property
    def covariance(self) -> "pd.DataFrame":
        return self._matrix("fit/covariance")

    @property
    def tests(self) -> dict[str, "pd.DataFrame"]:
        """Measured and fitted stresses of every test; attrs: kind and measure."""
        found = {}
        for name in self._order("tests"):
            parts = self[f"tests/{name}"]
            columns = {k: v for k, v in parts.items() if isinstance(v, Array) and v.ndim == 1 and len(v) == len(parts["first"])}
            found[name] = table_of(columns, {k: v.unit for k, v in columns.items()})
            with self._open() as f:
                found[name].attrs.update({k: _text(v) for k, v in f[f"tests/{name}"].attrs.items()})
        return found

    @property
    def profiles(self) -> dict[str, dict[str, Array]]:
        """Of `study:`: value, rise (of chi-square, 3.84 ends the interval) and interval of each parameter."""
        return self["identifiability/profiles"] if "identifiability/profiles" in self else {}


class Sweep(File):
    """sweep.h5 of langer-gather: one row for each member."""

    @property
    def members(self) -> list[str]:
        return str(self["members"]).split("\n") if isinstance(self["members"], str) else list(self["members"])

    @property
    def axes(self) -> list[str]:
        with self._open() as f:
            return list(f["axis"]) if "axis" in f else []

    @property
    def table(self) -> "pd.DataFrame":
        columns: dict[str, Any] = {}
        units: dict[str, str] = {}
        for name in self.axes:
            axis = self[f"axis/{name}"]
            words = str(axis.attributes.get("words", "")).split()
            columns[name] = [words[int(i)] for i in axis] if words else axis
            units[name] = axis.unit
        for name, values in self["values"].items():
            columns[name], units[name] = values, values.unit
        return table_of(columns, units)


class Sensitivity(File):
    """sensitivity.h5."""

    @property
    def parameters(self) -> list[str]:
        with self._open() as f:
            return str(_text(f["parameters"].attrs["order"])).split()

    def effects(self, name: str = "mu_star") -> "pd.DataFrame":
        """An index of every parameter over the strain: one column for each parameter."""
        values = self[name]
        strain = np.asarray(self["strain"])
        return _pandas().DataFrame(np.asarray(values).T, index=strain, columns=self.parameters)


_kinds: dict[str, type[File]] = {"mesh": Mesh, "material": Material, "solution": Solution, "curves": Curves, "snapshot": Snapshot,
                                 "sweep": Sweep, "sensitivity": Sensitivity}
_endings = [("per_MPa", "1/MPa"), ("mm2", "mm^2"), ("mm3", "mm^3"), ("MPa2", "MPa^2"), ("mm", "mm"), ("N", "N"), ("MPa", "MPa"),
            ("deg", "deg"), ("s", "s"), ("MB", "MB"), ("percent", "percent")]


def _read_csv(path: Path) -> "pd.DataFrame":
    table = _pandas().read_csv(path, comment="#")
    units, names = {}, {}
    for head in table.columns:
        for ending, unit in _endings:
            if head.endswith("_" + ending) and len(head) > len(ending) + 1:
                names[head], units[head[:-len(ending) - 1]] = head[:-len(ending) - 1], unit
                break
        else:
            units[head] = "-"
    if len(set(names.get(h, h) for h in table.columns)) == len(table.columns):
        table = table.rename(columns=names)
    table.attrs["units"] = units
    return table


def read(path: str | os.PathLike[str]) -> Any:
    """Reads a result by its kind.

    .h5, .hdf, .vtkhdf, .part   the class of its schema: Solution, Curves, Material, Sweep, Mesh, Snapshot, Sensitivity
    .csv                        a pandas table; what its heads say of units is in `attrs["units"]`, and left out of the names

    Raises FileNotFoundError; OSError where it is damaged (its checksum tells) or no HDF5 file; ValueError where no program of Langer
    wrote it, or one of another version, or its values are in other units or in another file.
    """
    path = Path(path)
    if path.suffix == ".csv":
        if not path.exists():
            raise FileNotFoundError(f"{path}: there is no such file")
        return _read_csv(path)
    file = File(path)
    kind = _kinds.get(file.schema)
    if kind is None:
        raise ValueError(f"{path}: no file of Langer (its root has no schema that is known: \"{file.schema}\")")
    return kind(path)
