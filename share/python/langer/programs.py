"""Where the programs are, and how they are called."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from typing import Sequence


class LangerError(RuntimeError):
    """A program ended with another exit code than 0; the text is what it said."""

    def __init__(self, message: str, code: int = 1, log: str = ""):
        super().__init__(message)
        self.code, self.log = code, log


def program(name: str = "langer") -> str:
    """Path of a program: in $LANGER_BIN, beside an installed package, in build/bin of a checkout, on the PATH; the first that is there."""
    places = [os.environ.get("LANGER_BIN", "")]
    for above in Path(__file__).resolve().parents:
        places += [str(above / "bin"), str(above / "build" / "bin")]
    for place in places:
        if place and os.access(os.path.join(place, name), os.X_OK) and not os.path.isdir(os.path.join(place, name)):
            return os.path.join(place, name)
    found = shutil.which(name)
    if found:
        return found
    raise FileNotFoundError(f"{name}: not found beside this package nor on the PATH; set LANGER_BIN to the folder of the programs")


def called(command: Sequence[str], cwd: str | os.PathLike[str] | None = None) -> str:
    """What a program says on both streams; raises LangerError with it where it fails."""
    done = subprocess.run(list(command), cwd=cwd, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        raise LangerError(done.stdout.strip() or f"{command[0]} ended with {done.returncode}", done.returncode)
    return done.stdout
