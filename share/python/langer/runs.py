"""Pipelines and sweeps from Python: what `langer-plan` and `make` do, with progress where there is a notebook or a terminal."""

from __future__ import annotations

import difflib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence

from .files import File, _pandas, read
from .programs import LangerError, called, program

if TYPE_CHECKING:
    import pandas as pd


def yaml_text(value: Any) -> str:
    """A value as YAML in one line: numbers and words plain, texts that look like something else in quotes."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(k))}: {yaml_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(yaml_text(v) for v in value) + "]"
    if isinstance(value, str) and re.fullmatch(r"[A-Za-z_][\w./+-]*( [\w./+-]+)*|[\d.]+ ?%", value) and value not in ("true", "false", "null"):
        return value
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value))
    return json.dumps(value)


def _yaml() -> Any:
    try:
        import yaml
    except ImportError as missing:
        raise ImportError("set and sweep need PyYAML: apt install python3-yaml, or pip install PyYAML") from missing
    return yaml


def _child(mapping: Any, key: str) -> Any:
    return next((value for name, value in mapping.value if name.value == key), None)


def _put(mapping: Any, key: str, value: Any) -> Any:
    """Sets a key of a map of YAML and returns its value."""
    mapping.value = [(name, old) for name, old in mapping.value if name.value != key]
    mapping.value.append((_yaml().ScalarNode("tag:yaml.org,2002:str", key, style='"'), value))
    return value


def _map_at(mapping: Any, key: str) -> Any:
    found = _child(mapping, key)
    return found if found is not None else _put(mapping, key, _yaml().MappingNode("tag:yaml.org,2002:map", []))


def _swept_by(node: Any, key: str) -> str:
    """The axis of a node that varies this key, or ""."""
    sweep = _child(node, "sweep")
    for axis, given in sweep.value if sweep is not None else []:
        for word in ("key", "keys"):
            named = _child(given, word)
            names = [] if named is None else [named.value] if isinstance(named.value, str) else [item.value for item in named.value]
            if key in names:
                return str(axis.value)
    return ""


def changed(text: str, set: Mapping[str, Any], sweep: Mapping[str, Sequence[Any]]) -> str:
    """A pipeline's text with other values and further axes; what is not named stays as it is written."""
    yaml = _yaml()
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    nodes = _child(root, "nodes")

    def node_of(path: str) -> tuple[Any, str]:
        name, dot, key = path.partition(".")
        known = [n.value for n, _ in nodes.value]
        if not dot or not key:
            raise LangerError(f'found "{path}"; expected node.key, for example solve.friction', 2)
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            raise LangerError(f'there is no node "{name}"; one of {", ".join(known)}' + (f'; did you mean "{near[0]}"?' if near else ""), 2)
        return _child(nodes, name), key

    for path, value in set.items():
        node, key = node_of(path)
        axis = _swept_by(node, key)
        if axis:
            raise LangerError(f'{path} is varied by the axis "{axis}": sweep={{"{axis}:{path}": [...]}} gives it other values', 2)
        _put(_map_at(node, "set"), key, yaml.compose(yaml_text(value), Loader=yaml.SafeLoader))
    for path, values in sweep.items():
        axis, _, key_path = path.rpartition(":")
        node, key = node_of(key_path)
        axis = axis or re.sub(r"\[\d+\]$", "", key).rpartition(".")[2]
        _put(_map_at(node, "sweep"), axis, yaml.compose(f'{{key: "{key}", values: {yaml_text(list(values))}}}', Loader=yaml.SafeLoader))
    return str(yaml.serialize(root, Dumper=yaml.SafeDumper, width=10**6, allow_unicode=True))


class _Progress:
    """A bar of steps that are done: in a notebook, on a terminal, or nowhere."""

    def __init__(self, title: str, total: int, wanted: bool | None):
        self.title, self.total, self.handle, self.begin = title, total, None, time.monotonic()
        self.where = None if wanted is False else self._place(wanted)

    @staticmethod
    def _place(wanted: bool | None) -> str | None:
        if "IPython" in sys.modules:
            from IPython import get_ipython
            if type(get_ipython()).__name__ == "ZMQInteractiveShell":
                return "notebook"
        return "terminal" if wanted or sys.stderr.isatty() else None

    def show(self, done: int, now: str, ended: bool = False) -> None:
        text = f"{self.title}: {done} of {self.total} steps, {time.monotonic() - self.begin:.0f} s" + (f"; {now}" if now else "")
        if self.where == "notebook":
            import html
            from IPython.display import HTML, display
            bar = HTML(f'<progress value="{done}" max="{max(1, self.total)}"></progress> {html.escape(text)}')
            if self.handle is None:
                self.handle = display(bar, display_id=True)
            else:
                self.handle.update(bar)
        elif self.where == "terminal":
            sys.stderr.write("\r\033[K" + text[:110] + ("\n" if ended else "") if sys.stderr.isatty() else (text + "\n" if ended else ""))
            sys.stderr.flush()


def _label(text: str) -> Any:
    try:
        return int(text) if re.fullmatch(r"-?\d+", text) else float(text)
    except ValueError:
        return text


class Run:
    """The folder of a run. `run["solve"]` reads the file of a node; `run.read("solve", alpha=60)` that of a member of a sweep."""

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        makefile = self.folder / "Makefile"
        if not makefile.exists():
            raise FileNotFoundError(f"{self.folder}: no folder of a run (it has no Makefile of langer-plan)")
        self._files: dict[str, dict[tuple[tuple[str, Any], ...], Path]] = {}
        for line in makefile.read_text().splitlines():
            rule = re.match(r"(\S+): .*\| \$\(BIN\)/langer-", line)
            if not rule:
                continue
            *folders, node, _ = Path(rule[1]).parts
            member = tuple((axis, _label(label)) for axis, _, label in (part.rpartition("_") for part in folders))
            self._files.setdefault(node, {})[member] = self.folder / rule[1]

    @property
    def nodes(self) -> list[str]:
        return list(self._files)

    def files(self, node: str) -> dict[tuple[tuple[str, Any], ...], Path]:
        """The files of a node by member; a member is a tuple such as (("alpha", 60),), and () where nothing is varied."""
        if node not in self._files:
            raise KeyError(f"{self.folder}: there is no node {node}; one of {', '.join(self.nodes)}")
        return dict(self._files[node])

    def read(self, node: str, **member: Any) -> Any:
        """The file of a node, of the one member that the values name."""
        files = self.files(node)
        wanted = {m: p for m, p in files.items() if all(dict(m).get(axis) == value for axis, value in member.items())}
        if len(wanted) != 1:
            known = "; ".join(", ".join(f"{a}={v!r}" for a, v in m) for m in files) or "it is there once"
            raise KeyError(f"{node}: {len(wanted)} files for {member or 'no member named'}; members: {known}")
        path = next(iter(wanted.values()))
        return path if path.suffix == ".html" else read(path)

    def __getitem__(self, node: str) -> Any:
        return self.read(node)

    def members(self, node: str) -> Iterator[tuple[dict[str, Any], Any]]:
        """({axis: value}, file) of every member."""
        for member in self.files(node):
            yield dict(member), self.read(node, **dict(member))

    def table(self, node: str) -> "pd.DataFrame":
        """One row for each member of a node: the values of its axes, then the numbers of its summary."""
        rows, units = [], {}
        for member, file in self.members(node):
            summary = file.summary if isinstance(file, File) else {}
            units.update({name: number.unit for name, number in summary.items()})
            rows.append({**member, **{name: float(number) for name, number in summary.items()}})
        table = _pandas().DataFrame(rows)
        table.attrs["units"] = units
        return table

    @property
    def report(self) -> Path | None:
        """The page of the run, where its pipeline has one."""
        pages = [p for files in self._files.values() for p in files.values() if p.suffix == ".html"]
        return pages[0] if pages else None

    def times(self) -> "pd.DataFrame":
        """What each step took, from its log: exit, wall (s), cpu (s), MB."""
        rows = []
        for files in self._files.values():
            for path in files.values():
                log = path.with_suffix(".log")
                end = re.findall(r"^# end: exit (\d+), ([\d.]+) s, ([\d.]+) s of CPU, (\d+) MB", log.read_text(), re.M) if log.exists() else []
                last = [float(x) for x in end[-1]] if end else [float("nan")] * 4
                rows.append([str(path.relative_to(self.folder).with_suffix(""))] + last)
        return _pandas().DataFrame(rows, columns=["step", "exit", "wall", "cpu", "MB"])

    def __repr__(self) -> str:
        return f"<run {self.folder}: {', '.join(self.nodes)}>"


def _pending(folder: Path) -> list[Path]:
    """What make would make, in its order."""
    said = subprocess.run(["make", "-n", "-C", str(folder)], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return [folder / name for name in re.findall(r" -o (\S+)$", said.stdout, re.M)]


def _made_since(path: Path, begin: float) -> bool:
    try:
        return path.stat().st_mtime >= begin
    except FileNotFoundError:
        return False


def _make(folder: Path, jobs: int, progress: bool | None) -> None:
    pending = _pending(folder)
    if not pending:
        return
    bar, begin = _Progress(folder.name, len(pending), progress), time.time() - 0.02
    with tempfile.TemporaryFile("w+") as said:
        make = subprocess.Popen(["make", "-C", str(folder), f"-j{jobs}"], stdout=said, stderr=subprocess.STDOUT)
        try:
            while make.poll() is None:
                done = [p for p in pending if _made_since(p, begin)]
                running = [p for p in pending if p not in done and _made_since(p.with_suffix(".log"), begin)]
                bar.show(len(done), ", ".join(str(p.relative_to(folder).parent) for p in running[:3]))
                time.sleep(0.1)
        except BaseException:
            make.send_signal(signal.SIGINT)
            make.wait()
            raise
        said.seek(0)
        text = said.read()
    bar.show(sum(_made_since(p, begin) for p in pending), "", True)
    if make.returncode != 0:
        failed = subprocess.run([program(), "times", "--failed", str(folder)], text=True, capture_output=True, check=False).stdout.strip()
        code = re.search(r"exit (\d+)", failed)
        raise LangerError(failed or text.strip(), int(code[1]) if code else make.returncode, text)


def run(pipeline: str | os.PathLike[str], set: Mapping[str, Any] | None = None, sweep: Mapping[str, Sequence[Any]] | None = None, *,
        folder: str | os.PathLike[str] | None = None, jobs: int | None = None, progress: bool | None = None) -> Run:
    """Runs a pipeline: what is new or changed, as `make run` does.

    pipeline  YAML file; the paths in it are relative to the working directory
    set       values in place of those of the file: {"solve.contacts.sphere.friction": 0.2}, node first
    sweep     what to vary: {"solve.contacts.sphere.friction": [0, 0.2, 0.34]}; "mu:solve..." calls the axis mu
    folder    of the run; runs/<name of the pipeline> where it is not given
    jobs      steps at the same time; the number of processors where it is not given
    progress  True: show it whatever stands behind stderr; False: never

    Raises LangerError with what the program said; its `code` is 2 for a wrong config, 4 where a solve does not converge.
    """
    if not os.path.isfile(pipeline):
        raise FileNotFoundError(f"{os.fspath(pipeline)}: there is no such pipeline")
    with tempfile.TemporaryDirectory(prefix="langer_") as beside:
        file = Path(pipeline)
        if set or sweep:  # under its own name, which the Makefile tells
            file = Path(beside) / file.name
            file.write_text(changed(Path(pipeline).read_text(), set or {}, sweep or {}))
        try:
            said = called([program("langer-plan"), str(file)] + (["-o", os.fspath(folder)] if folder is not None else []))
        except LangerError as wrong:
            words = str(wrong)
            if file != Path(pipeline):
                words = words.replace(str(file), f"{os.fspath(pipeline)} as changed")
            if "there is no such file" in words and Path(pipeline).resolve().parent != Path.cwd():
                words += f"\n  hint: paths in a pipeline are relative to the working directory, {Path.cwd()}"
            raise LangerError(words, wrong.code) from None
    planned = re.search(r"^plan: (.+): \d+ nodes, \d+ steps", said, re.M)
    if not planned:
        raise LangerError(said.strip())
    where = Path(planned[1])
    _make(where, jobs or os.cpu_count() or 1, progress)
    return Run(where)


def sweep(pipeline: str | os.PathLike[str], vary: Mapping[str, Sequence[Any]], **more: Any) -> Run:
    """Runs a pipeline for all combinations of the values in `vary`; `.table(node)` of what it returns has a row for each.

    >>> langer.sweep("pipeline.yaml", {"solve.contacts.sphere.friction": [0, 0.3]}).table("post")
    """
    return run(pipeline, sweep=vary, **more)
