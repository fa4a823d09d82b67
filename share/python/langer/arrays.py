"""Numbers that know their unit."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np


class Array(np.ndarray):
    """A numpy array with `unit` and `attributes`, as the file has them.

    A part of an array keeps both. What is computed from it is a plain array: the unit of a product would be another one.
    """

    unit: str
    attributes: dict[str, Any]

    def __new__(cls, values: Any, unit: str = "-", attributes: Mapping[str, Any] | None = None) -> "Array":
        array = np.asarray(values).view(cls)
        array.unit = unit
        array.attributes = dict(attributes or {})
        return array

    def __array_finalize__(self, source: Any) -> None:
        self.unit = getattr(source, "unit", "-")
        self.attributes = getattr(source, "attributes", {})

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, out: Any = None, **more: Any) -> Any:
        plain = tuple(x.view(np.ndarray) if isinstance(x, Array) else x for x in inputs)
        if out is not None:
            more["out"] = tuple(x.view(np.ndarray) if isinstance(x, Array) else x for x in out)
        return getattr(ufunc, method)(*plain, **more)

    def __repr__(self) -> str:
        return f"{np.asarray(self)!r} {self.unit}" if self.unit != "-" else repr(np.asarray(self))

    def __reduce__(self) -> Any:
        return (Array, (np.asarray(self), self.unit, self.attributes))


class Quantity(float):
    """A number with its unit: `10.78 N`."""

    unit: str

    def __new__(cls, value: float, unit: str = "-") -> "Quantity":
        number = super().__new__(cls, value)
        number.unit = unit
        return number

    def __repr__(self) -> str:
        return f"{float(self):.6g}" + ("" if self.unit in ("", "-") else f" {self.unit}")

    __str__ = __repr__

    def __reduce__(self) -> Any:
        return (Quantity, (float(self), self.unit))


def with_unit(label: str, unit: str) -> str:
    """`travel (mm)`; a pure number has no unit to show."""
    return label if unit in ("", "-") else f"{label} ({unit})"
