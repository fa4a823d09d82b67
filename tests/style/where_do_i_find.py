#!/usr/bin/env python3
"""Checks links inside the documentation: `ctest -R "style: links"`.

Every file in the table "Where do I find" of CONTRIBUTING.md exists, and the table has at least twenty questions. Every
link to a heading leads to a heading of that page, and docs/contents.md lists every page. Sources that comments and pages
name by their files are there.
"""
import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]


def anchors(page):
    """Anchors of the headings of a page, as GitHub makes them."""
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
    for heading in re.findall(r"(?m)^#+ (.*)$", text):
        plain = re.sub(r"[`*]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)).lower()
        yield re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def files_that_are_gone(pages):
    """Sources that a comment or a page names, and that are not there. A name may leave out the first folders."""
    sources = [path for folder in ("lib", "stages", "tests") for path in (ROOT / folder).rglob("*.[ch]pp")]
    ends = {"/".join(parts[i:]) for parts in (path.relative_to(ROOT).parts for path in sources) for i in range(len(parts))}
    named = re.compile(r"(?<![\w./>-])((?:[\w-]+/)*[\w-]+\.[ch]pp)\b")
    texts = [(path, line) for path in pages for line in enumerate(path.read_text().splitlines(), 1)]
    for path in sources:
        if path.relative_to(ROOT).parts[0] != "tests":
            texts += [(path, (number, line.split("//", 1)[1])) for number, line in enumerate(path.read_text().splitlines(), 1) if "//" in line]
    for path, (number, line) in texts:
        for name in named.findall(line):
            if name not in ends and not name.rsplit("/", 1)[-1].startswith("FE"):  # sources of FEBio
                yield f"{path.relative_to(ROOT)}:{number}: there is no {name}"


def main():
    found = []
    contributing = (ROOT / "CONTRIBUTING.md").read_text()
    table = contributing.split("<!-- where:")[1].split("<!-- end where -->")[0]
    files = re.findall(r"^\| .*\? \| `([^`]+)` \|$", table, flags=re.M)
    if len(files) < 20:
        found.append(f"CONTRIBUTING.md: {len(files)} questions in \"Where do I find\"; at least 20")
    for name in files:
        if not (ROOT / name).is_file():
            found.append(f"CONTRIBUTING.md: no file {name}")

    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]
    headings = {page.resolve(): set(anchors(page)) for page in pages}
    for page in pages:
        text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
        for target, anchor in re.findall(r"\]\(([^)#\s]*)#([^)\s]+)\)", text):
            if target.startswith("http"):
                continue
            other = (page.parent / target).resolve() if target else page.resolve()
            if other in headings and anchor not in headings[other]:
                found.append(f"{page.relative_to(ROOT)}: no heading for {target}#{anchor}")

    contents = (ROOT / "docs/contents.md").read_text()
    for page in sorted((ROOT / "docs").glob("*.md")):
        if page.name != "contents.md" and f"({page.name}" not in contents:
            found.append(f"docs/contents.md does not list {page.name}")
    found += files_that_are_gone([page for page in pages if page.name != "CHANGELOG.md"])
    for line in found:
        print(line)
    print(f"{len(files)} questions, {len(pages)} pages")
    return 1 if found else 0


sys.exit(main())
