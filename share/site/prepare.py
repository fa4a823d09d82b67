#!/usr/bin/env python3
"""Gathers the pages of the site: those of docs/, a gallery of the pipelines, every column and key as the program describes them.

prepare.py <project> <folder for the pages> [<langer, for columns and keys>]
Links that lead to files that are no pages become plain words; what leads nowhere is an error (mkdocs --strict).
"""
import csv
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
    text = ("# Gallery\n\nEvery pipeline of the project: what it makes, what it took on one core, how large the errors of its results are as far as it "
            "estimates them, and its config. `make run PIPELINE=pipelines/NAME.yaml` runs it; `make gallery` measures this page again.\n\n")
    measured = {}
    if (docs / "gallery.csv").exists():
        with (docs / "gallery.csv").open() as table:
            measured = {row["pipeline"]: row for row in csv.DictReader(table)}
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
        if (docs / "gallery" / f"{file.stem}.png").exists():
            text += f"![what {file.stem} makes](gallery/{file.stem}.png)\n\n"
        if row := measured.get(file.stem):
            text += "| cost | error |\n| --- | --- |\n"
            text += f"| {row['cpu_s']} s of CPU, {row['steps']} steps | {row['errors'] or 'not asked for: `estimate` in the solve tells it'} |\n\n"
        else:
            text += f"Its cost and errors are not measured: `make gallery GALLERY={file.stem}` does it.\n\n"
        text += "??? example \"" + f"pipelines/{file.name}\"\n\n    ```yaml\n" + "".join(f"    {line}\n" for line in lines[rest:]) + "    ```\n\n"
        text += configs_of(lines)
    return text


def configs_of(lines):
    """The configs that a pipeline names, folded."""
    text = ""
    for path in dict.fromkeys(re.findall(r"(configs/\w+/[\w.]+\.yaml)", "\n".join(lines))):
        if (project / path).exists() and "/schema/" not in path:
            body = [line for line in (project / path).read_text().splitlines() if not line.startswith("# yaml-language-server")]
            text += f"??? example \"{path}\"\n\n    ```yaml\n" + "".join(f"    {line}\n" for line in body) + "    ```\n\n"
    return text


def equations():
    """KaTeX as Debian has it, into the site: nothing is fetched."""
    katex = Path("/usr/share/javascript/katex")
    (pages / "katex").mkdir()
    if not katex.exists():
        print("equations stay as they are written: no libjs-katex")
        for name in ("katex.min.css", "katex.min.js", "auto-render.js", "begin.js"):
            (pages / "katex" / name).write_text("")
        return
    for name in ("katex.min.css", "katex.min.js", "contrib/auto-render.js"):
        shutil.copy(katex / name, pages / "katex")
    shutil.copytree(katex / "fonts", pages / "katex/fonts", ignore=lambda folder, names: [n for n in names if not n.endswith((".woff2", ".ttf"))])
    (pages / "katex/begin.js").write_text(
        'renderMathInElement(document.body, {delimiters: [{left: "\\\\[", right: "\\\\]", display: true}], throwOnError: false});\n')


shutil.rmtree(pages, ignore_errors=True)
shutil.copytree(docs, pages, ignore=lambda folder, names: [n for n in names if n.endswith((".awk", ".mk"))])
for page in docs.rglob("*.md"):
    (pages / page.relative_to(docs)).write_text(linked(page.read_text(), page.parent))
for source, page in renamed.items():
    (pages / page).write_text(linked((project / source).read_text(), (project / source).parent))
equations()
for page, text in (("gallery.md", gallery()), ("columns.md", columns()), ("keys.md", keys())):
    (pages / page).write_text(text)
print(f"{len(list(pages.rglob('*.md')))} pages in {pages}")
