"""Is a file whole, and can this version read it? The checks of the programs, in the same order.

A finished file ends with a seal: one line with a checksum of everything before it. A file without one is read on trust, as tools that
edit HDF5 files cut it off.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path
from typing import Any

_begin = b"\nlanger seal:"
_older_begin = b"\nlanger seal "  # up to version 0.2.0, with a weaker checksum
_length = len(_begin) + 16 + 1  # the beginning, 16 hexadecimal digits, a line break
_block = 1 << 20
_mask = (1 << 64) - 1
_prime = 0x100000001B3
_start = 0xCBF29CE484222325

units = "mm N MPa s deg"
versions = {"mesh": (1, 3), "material": (1, 1), "solution": (1, 3), "curves": (1, 1), "sweep": (1, 1), "sensitivity": (1, 1),
            "snapshot": (1, 1)}

_known: dict[tuple[str, int, int, int], bool] = {}  # files whose seal was compared before: reading it takes 30 ms for each MB


def _words(block: bytes) -> Any:
    """The block as numbers of eight bytes; the last one is filled up with zeros."""
    if len(block) % 8:
        block += bytes(8 - len(block) % 8)
    return memoryview(block).cast("Q")


def _checksum(block: bytes, h: int) -> int:
    h = ((h ^ len(block)) * _prime) & _mask
    h ^= h >> 32
    for word in _words(block):
        h = ((h ^ word) * _prime) & _mask
        h ^= h >> 32
    return h


def _older_checksum(block: bytes, h: int) -> int:
    for word in _words(block):
        h = ((h ^ word) * _prime) & _mask
    return h


def _fits_seal(path: Path, size: int) -> bool:
    with path.open("rb") as file:
        file.seek(size - _length)
        seal = file.read(_length)
        if not seal.startswith((_begin, _older_begin)):
            return True
        checksum = _checksum if seal.startswith(_begin) else _older_checksum
        file.seek(0)
        h, rest = _start, size - _length
        while rest > 0:
            block = file.read(min(rest, _block))
            if not block:
                return False
            h = checksum(block, h)
            rest -= len(block)
    return seal[len(_begin):len(_begin) + 16] == b"%016x" % h


def _has_seal(path: Path, size: int) -> bool:
    with path.open("rb") as file:
        file.seek(max(0, size - _length))
        return file.read(_length).startswith((_begin, _older_begin))


def _is_being_written(part: Path) -> bool:
    """Whether a run holds the journal of this unfinished file."""
    try:
        journal = os.open(part.with_suffix(".steps"), os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(journal, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
    finally:
        os.close(journal)


def check_whole(path: Path) -> None:
    """Raises OSError where the file was damaged after it was written, or is what a killed run left."""
    if not path.is_file():
        raise OSError(f"{path}: no plain file (a folder, pipe or device)")
    status = path.stat()
    key = (str(path.resolve()), status.st_ino, status.st_size, status.st_mtime_ns)
    if path.suffix == ".part" and not _has_seal(path, status.st_size) and not _is_being_written(path):
        raise OSError(f"{path}: left by a run that was killed, so nothing shows whether it is whole; run the same command again, it "
                      "continues from the steps that are whole")
    if key not in _known:
        _known[key] = status.st_size < _length or _fits_seal(path, status.st_size)
    if not _known[key]:
        raise OSError(f"{path}: damaged: its content does not fit its checksum; make it again, or copy it again from where it was made")


def check_kind(path: Path, attributes: dict[str, Any]) -> None:
    """Raises ValueError where the units or the version of the file are others than this package reads."""
    if "schema" not in attributes:
        return
    found = attributes.get("units", units)
    if found != units:
        raise ValueError(f"{path}: units {found}; expected {units}: convert the values")
    schema = str(attributes["schema"])
    if schema not in versions:
        return
    if "schema_version" not in attributes:
        raise ValueError(f"{path}: no schema_version: not a file of Langer")
    oldest, newest = versions[schema]
    version = int(attributes["schema_version"])
    if not oldest <= version <= newest:
        raise ValueError(f"{path}: {schema}, version {version}; expected {oldest} to {newest}: written by another version of Langer, "
                         "make it again")


def check_own_values(path: Path, file: Any, h5py: Any) -> None:
    """Raises ValueError where a name of the file leads into another file."""
    seen = set()

    def look(group: Any) -> None:
        address = h5py.h5o.get_info(group.id).addr
        if address in seen:  # a group may have several names, also one inside of itself
            return
        seen.add(address)
        for name in group:
            link = group.get(name, getlink=True)
            place = f"{path}: {group.name.rstrip('/')}/{name}"
            if isinstance(link, h5py.ExternalLink):
                raise ValueError(f"{place} is a link into another file; copy the data into this file (h5copy)")
            if isinstance(link, h5py.SoftLink):
                continue  # what it leads to is looked at under its own name
            thing = group[name]
            if isinstance(thing, h5py.Group):
                look(thing)
            elif isinstance(thing, h5py.Dataset) and (thing.external or thing.is_virtual):
                raise ValueError(f"{place} keeps its values in another file; copy them into this file (h5repack)")
    look(file)
