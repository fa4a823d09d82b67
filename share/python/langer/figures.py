"""Figures in the style of the house: sizes in mm, colours that colour-blind readers tell apart, units in the labels."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Iterator, Sequence

import numpy as np

from .arrays import with_unit
from .files import Curve, Material

colours = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]


def _matplotlib() -> Any:
    try:
        import matplotlib
    except ImportError as missing:
        raise ImportError("figures need matplotlib: apt install python3-matplotlib, or pip install matplotlib") from missing
    return matplotlib


@contextmanager
def style(font: str = "sans-serif", size: float = 8) -> Iterator[None]:
    """The house's style for what is drawn inside: `with langer.style(size=9): ...`; size in points."""
    matplotlib = _matplotlib()
    rules = {"font.family": font, "font.sans-serif": ["Liberation Sans", "Arial", "Helvetica", "DejaVu Sans"], "font.size": size,
             "axes.labelsize": size, "xtick.labelsize": size, "ytick.labelsize": size, "legend.fontsize": size, "axes.titlesize": size,
             "axes.prop_cycle": matplotlib.cycler(color=colours), "axes.spines.top": False, "axes.spines.right": False,
             "axes.grid": True, "grid.color": "#d8d8d8", "grid.linewidth": 0.5, "axes.axisbelow": True, "lines.linewidth": 1.2,
             "lines.markersize": 3.5, "axes.linewidth": 0.7, "xtick.major.width": 0.7, "ytick.major.width": 0.7, "legend.frameon": False,
             "savefig.dpi": 300, "figure.dpi": 110, "pdf.fonttype": 42, "svg.fonttype": "none"}
    with matplotlib.rc_context(rules):
        yield


@contextmanager
def figure(width: float = 85, height: float | None = None, file: Any = None, *, font: str = "sans-serif", size: float = 8,
           decimal: str = ".") -> Iterator[Any]:
    """Axes of a figure `width` mm wide (85: a column of most journals; height 0.75 of it), saved to `file` at the end.

    decimal: the sign between integer and fraction of the tick labels, "." or ",".

    >>> with langer.figure(85, file="force.pdf", decimal=",") as axes:
    ...     langer.plot(run["post"].table, "u_ind", "force", axes=axes)
    """
    if decimal not in (".", ","):
        raise ValueError(f"decimal: found {decimal!r}, expected '.' or ','")
    with style(font, size):
        import matplotlib.pyplot as plt
        drawing, axes = plt.subplots(figsize=(width / 25.4, (height or 0.75 * width) / 25.4), layout="constrained")
        yield axes
        if decimal == ",":
            _commas(drawing)
        if file is not None:
            drawing.savefig(file)
            plt.close(drawing)


def _commas(drawing: Any) -> None:
    from matplotlib.ticker import ScalarFormatter

    class Comma(ScalarFormatter):
        def __call__(self, value: float, place: Any = None) -> str:
            return super().__call__(value, place).replace(".", ",")

    for axes in drawing.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if type(axis.get_major_formatter()) is ScalarFormatter:
                axis.set_major_formatter(Comma())


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    _matplotlib()
    import matplotlib.pyplot as plt
    return plt.gca()


def plot(what: Any, x: str | None = None, y: str | Sequence[str] | None = None, *, axes: Any = None, **line: Any) -> Any:
    """Draws columns of a table over another, or a `Curve`; the labels have the units. Returns the axes.

    A column that has another with its error beside it (force and force_error) gets a band.
    """
    axes = _axes(axes)
    if isinstance(what, Curve):
        axes.plot(np.asarray(what.x), np.asarray(what.y), **{"label": what.name, **line})
        axes.set_xlabel(with_unit(what.x_label, what.x.unit))
        axes.set_ylabel(with_unit(what.y_label, what.y.unit))
        return axes
    if x is None or y is None:
        raise ValueError("plot(table, x, y): the names of the columns are missing")
    units = what.attrs.get("units", {})
    names = [y] if isinstance(y, str) else list(y)
    for name in [x] + names:
        if name not in what:
            raise KeyError(f"there is no column {name}; one of {', '.join(map(str, what.columns))}")
    kinds = {units.get(name, "-") for name in names}
    if len(kinds) > 1:
        raise ValueError(f"columns of different units on one axis: {', '.join(f'{n} in {units.get(n)}' for n in names)}")
    for name in names:
        drawn, = axes.plot(what[x], what[name], **{"label": name, **line})
        if f"{name}_error" in what:
            axes.fill_between(what[x], what[name] - what[f"{name}_error"], what[name] + what[f"{name}_error"], color=drawn.get_color(),
                              alpha=0.2, linewidth=0)
    axes.set_xlabel(with_unit(x, units.get(x, "-")))
    axes.set_ylabel(with_unit(names[0] if len(names) == 1 else "", units.get(names[0], "-")).strip())
    if len(names) > 1:
        axes.legend()
    return axes


def plot_fit(material: Material, *, axes: Any = None) -> Any:
    """Measured points and the fitted law of every test."""
    axes = _axes(axes)
    tests = material.tests
    for k, (name, test) in enumerate(tests.items()):
        colour = colours[k % len(colours)]
        ways = [way for way in "xz" if f"stress_{way}" in test]
        for way in ways:
            of = (f"{name}: " if len(tests) > 1 else "") + (f"along {way}, " if len(ways) > 1 else "")
            axes.plot(test["first"], test[f"stress_{way}"], "o" if way == "x" else "s", color=colour, markerfacecolor="none",
                      label=of + "measured")
            axes.plot(test["first"], test[f"model_{way}"], "-" if way == "x" else "--", color=colour, label=of + "law")
    axes.set_xlabel("stretch along x")
    axes.set_ylabel(with_unit("stress", "MPa"))
    axes.legend()
    return axes


def plot_correlation(material: Material, *, axes: Any = None) -> Any:
    """The correlation of the fitted parameters, each number in its cell."""
    axes = _axes(axes)
    table = material.correlation
    axes.grid(False)
    axes.imshow(table.to_numpy(), cmap="RdBu_r", vmin=-1, vmax=1)
    for i in range(len(table)):
        for j in range(len(table)):
            value = table.iat[i, j]
            axes.text(j, i, f"{value:.2f}", ha="center", va="center", color="white" if abs(value) > 0.6 else "black")
    axes.set_xticks(range(len(table)), table.columns, rotation=45, ha="right")
    axes.set_yticks(range(len(table)), table.index)
    return axes


def plot_profiles(material: Material, *, axes: Any = None, threshold: float = 3.84) -> Any:
    """Profiles of all parameters, each over its distance from the fitted value in standard errors, and where they end the 95 % interval."""
    axes = _axes(axes)
    fitted = material.parameters
    for name, profile in material.profiles.items():
        step = fitted.loc[name, "standard_error"] if name in fitted.index else 1.0
        middle = fitted.loc[name, "value"] if name in fitted.index else 0.0
        order = np.argsort(np.asarray(profile["value"]))
        axes.plot((np.asarray(profile["value"])[order] - middle) / (step or 1.0), np.asarray(profile["rise"])[order], label=name)
    axes.axhline(threshold, color="#555555", linewidth=0.8, linestyle="--")
    axes.annotate("95 %", (0.01, threshold), xycoords=("axes fraction", "data"), va="bottom")
    axes.set_ylim(0, 2.5 * threshold)
    axes.set_xlabel("distance from the fitted value (standard errors)")
    axes.set_ylabel("rise of χ²")
    axes.legend()
    return axes
