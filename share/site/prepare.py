#!/usr/bin/env python3
"""Gathers the pages of the site: those of docs/, a gallery of the pipelines, every column and key as the program describes them.

prepare.py <project> <folder for the pages> [<langer, for columns and keys>]
Links that lead to files that are no pages become plain words; what leads nowhere is an error (mkdocs --strict).
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

project, pages = Path(sys.argv[1]), Path(sys.argv[2])
program = sys.argv[3] if len(sys.argv) > 3 else ""
docs = project / "docs"
renamed = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "share/python/README.md": "python.md"}


def linked(text, folder):
    """Links as seen from the site's only folder."""
    def target(match):
        shown, where = match[1], match[2]
        if re.match(r"https?:|#", where):
            return match[0]
        path, _, anchor = where.partition("#")
        inside = (folder / path).resolve().relative_to(project.resolve()).as_posix()
        if inside in renamed:
            new = renamed[inside]
        elif inside.startswith("docs/"):
            new = inside[5:]
        else:
            return shown[1:] if shown.startswith("!") else shown[1:-1]
        return f"{shown}({new}{'#' + anchor if anchor else ''})"
    return re.sub(r"(!?\[[^\]]*\])\(([^)\s]+)\)", target, text)


def described(what):
    if not program:
        return f"Built without the program `langer`; `langer describe {what}` prints it.\n"
    return "```text\n" + subprocess.run([program, "describe", what], check=True, capture_output=True, text=True).stdout + "```\n"


def columns():
    """`langer describe columns` as it stands; the search finds each word."""
    return "# Columns\n\nEvery column of the tables: unit, sign and meaning, as `langer describe columns` prints it.\n\n" + described("columns")


def keys():
    text = "# Keys of the configs\n\nWhat `langer describe STAGE` prints: every key with its type, range, unit, default and meaning.\n\n"
    for kind in sorted(p.name.split(".")[0] for p in (project / "configs/schema").glob("*.schema.json")):
        if kind != "pipeline":
            text += f"## {kind}\n\n" + described(kind) + "\n"
    return text


def gallery():
    text = "# Gallery\n\nEvery pipeline of the project with what it makes. `make run PIPELINE=pipelines/NAME.yaml` runs it.\n\n"
    pictures = {"indentation": "indentation.png", "indentation_angles": "paper/figure_16.png", "indentation_yeoh": "paper/figure_11.png",
                "identification": "paper/figure_4.png", "tensile_angles": "paper/figure_9.png", "sensitivity": "paper/figure_7.png",
                "mesh_influence": "paper/figure_17.png"}
    for file in sorted((project / "pipelines").glob("*.yaml")):
        lines = file.read_text().splitlines()
        said, rest = [], 0
        for rest, line in enumerate(lines):
            if not line.startswith("#"):
                break
            if not line.startswith("# yaml-language-server"):
                said.append(line[1:])
        text += f"## {file.stem}\n\n"
        prose = [s for s in said if not re.match(r"\s{2,}\S+/\S*", s)]
        makes = [s.strip() for s in said if re.match(r"\s{2,}\S+/\S*", s)]
        text += " ".join(s.strip() for s in prose) + "\n\n"
        if makes:
            text += "```text\n" + "\n".join(makes) + "\n```\n\n"
        if file.stem in pictures and (docs / pictures[file.stem]).exists():
            text += f"![what {file.stem} makes]({pictures[file.stem]})\n\n"
        cost = took(project / "runs" / file.stem)
        text += f"It takes {cost} here.\n\n" if cost else ""
        text += "??? example \"" + f"pipelines/{file.name}\"\n\n    ```yaml\n" + "".join(f"    {line}\n" for line in lines[rest:]) + "    ```\n\n"
    return text


def took(run):
    """CPU seconds of all steps of a run that is there, from their logs."""
    ends = [re.findall(r"# end: exit 0, [\d.]+ s, ([\d.]+) s of CPU", log.read_text(errors="replace")) for log in run.rglob("*.log")]
    cpu = [float(end[-1]) for end in ends if end]
    return f"{sum(cpu):.3g} s of CPU in {len(cpu)} steps" if cpu else ""


shutil.rmtree(pages, ignore_errors=True)
shutil.copytree(docs, pages, ignore=lambda folder, names: [n for n in names if n.endswith((".awk", ".mk"))])
for page in docs.rglob("*.md"):
    (pages / page.relative_to(docs)).write_text(linked(page.read_text(), page.parent))
for source, page in renamed.items():
    (pages / page).write_text(linked((project / source).read_text(), (project / source).parent))
for page, text in (("gallery.md", gallery()), ("columns.md", columns()), ("keys.md", keys())):
    (pages / page).write_text(text)
print(f"{len(list(pages.rglob('*.md')))} pages in {pages}")
