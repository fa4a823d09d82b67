#!/usr/bin/env python3
"""Gathers the pages of the site: those of docs/, a gallery of the pipelines, every column and key as the program describes them.

prepare.py <project> <folder for the pages> [<langer, for columns and keys>]
Links that lead to files that are no pages become plain words; what leads nowhere is an error (mkdocs --strict).
"""
import csv
import html
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


def key_rows(kind):
    """The keys that `langer describe KIND` prints: depth, path from the top, type, meaning."""
    path = []
    for line in subprocess.run([program, "describe", kind], check=True, capture_output=True, text=True).stdout.splitlines():
        if found := re.match(r"( *)(\S+)  +(.*?)(?:  +(.*))?$", line):
            depth = len(found[1]) // 2
            path = path[:depth] + [found[2]]
            yield depth, path, found[3], found[4] or ""


def keys_of(kind):
    """One page for a kind of config. Each key has an anchor, such as keys_solve.html#contacts.friction."""
    text = (f"# Keys of {kind}\n\nEvery key of a config of `langer-{kind}`: type, range, unit, default and meaning. "
            "Each key is a link to itself.\n\n<div class=\"keys\">\n")
    if kind == "material":
        text = text.replace("a config of `langer-material`", "a material")
    seen = set()
    for depth, path, kind_of_value, says in key_rows(kind):
        anchor = ".".join(path)
        name = f"<code>{html.escape(path[-1])}</code>"
        if anchor not in seen:
            seen.add(anchor)
            name = f'<a href="#{anchor}">{name}</a>'
            begin = f'<div id="{anchor}" style="--depth: {depth}">'
        else:
            begin = f'<div style="--depth: {depth}">'
        text += f'{begin}{name}<span class="kind">{html.escape(kind_of_value)}</span><div class="says">{html.escape(says)}</div></div>\n'
    return text + "</div>\n"


def keys():
    """The page that leads to the keys of each kind, and these pages by their names."""
    text = "# Keys of the configs\n\n"
    if not program:
        return {"keys.md": text + "Built without the program `langer`; `langer describe STAGE` prints them.\n"}
    kinds = subprocess.run([program, "schema", "--list"], check=True, capture_output=True, text=True).stdout.split()
    kinds.remove("pipeline")
    text += "Every key with its type, range, unit, default and meaning, as `langer describe STAGE` prints it. Top keys of each kind:\n\n"
    found = {f"keys_{kind}.md": keys_of(kind) for kind in kinds}
    for kind in kinds:
        top = ", ".join(f"[`{path[0]}`](keys_{kind}.md#{path[0]})" for depth, path, _, _ in key_rows(kind) if depth == 0)
        text += f"- [**{kind}**](keys_{kind}.md): {top}\n"
    return found | {"keys.md": text}


def card(name, words):
    """A link to a part of the gallery, with its picture and first sentence."""
    picture = ""
    if (docs / "gallery" / f"{name}.png").exists():
        picture = f'<img src="gallery/{name}.png" alt="" loading="lazy">'
    sentence = re.split(r"(?<=[.?]) ", words.replace("`", ""))[0].rstrip(".")
    return f'<a class="card" href="#{name}">{picture}<b>{name}</b><span>{html.escape(sentence)}</span></a>\n'


def gallery():
    begin = ("# Gallery\n\nEvery pipeline of the project. Choose one to see what it makes, what it took on one core, how large the errors of its "
             "results are, and its config. `make run PIPELINE=pipelines/NAME.yaml` runs it; `make gallery` measures this page again.\n\n")
    cards, text, measured = "", "", {}
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
        words = " ".join(s.strip() for s in prose)
        cards += card(file.stem, words)
        text += words + "\n\n"
        if makes:
            text += "```text\n" + "\n".join(makes) + "\n```\n\n"
        if (docs / "gallery" / f"{file.stem}.png").exists():
            text += f"![what {file.stem} makes](gallery/{file.stem}.png)\n\n"
        if row := measured.get(file.stem):
            text += "| cost | error |\n| --- | --- |\n"
            text += f"| {row['cpu_s']} s of CPU, {row['steps']} steps | {row['errors'] or 'not estimated: set `estimate` in the solve'} |\n\n"
        else:
            text += f"Its cost and errors are not measured: `make gallery GALLERY={file.stem}` does it.\n\n"
        text += "??? example \"" + f"pipelines/{file.name}\"\n\n    ```yaml\n" + "".join(f"    {line}\n" for line in lines[rest:]) + "    ```\n\n"
        text += configs_of(lines)
    return begin + f'<div class="cards">\n{cards}</div>\n\n' + text


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
shutil.copy(Path(__file__).parent / "site.css", pages)
for page, text in ({"gallery.md": gallery(), "columns.md": columns()} | keys()).items():
    (pages / page).write_text(text)
print(f"{len(list(pages.rglob('*.md')))} pages in {pages}")
