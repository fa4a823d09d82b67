#!/usr/bin/env python3
"""Lists the command behind each table of measured numbers in the documentation: `make measure`, `ctest -R "style: tables"`.

A section with such a table names its command: in a text or an example, in a marker `<!-- name: from make target -->`, or for the
whole page before its first heading. A marker's target is one of the Makefile, so that the table can be written again.
"""
import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
WORDS = r"(?:make|ctest|cmake|python3|langer-\w+|langer|build/\S+)"
COMMAND = re.compile(rf"`({WORDS} [^`]*)`|^(?:    |\t)(?:\$ )?({WORDS} .*)|<!-- \w+: from (make [\w-]+)", re.M)
NUMBER = re.compile(r"\|\s*[+−-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?: ?(?:± ?[\d.]+|%|s|ms|N|mm|MPa|MB|GB))*\s*(?=\|)")


def commands_in(text):
    return [next(part for part in found if part) for found in COMMAND.findall(text)]


def measured_cells(text):
    """Cells of tables that are a number with decimals, a percentage or a time."""
    rows = [line for line in text.splitlines() if line.startswith("|")]
    return sum(1 for row in rows for cell in NUMBER.findall(row) if re.search(r"\.|e|%|s", cell))


def main():
    targets = set(re.findall(r"(?m)^([\w -]+):(?!=)", (ROOT / "Makefile").read_text() + (ROOT / "docs/measure.mk").read_text()))
    targets = {word for line in targets for word in line.split()}
    missing, tables = [], 0
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        begin, *sections = re.split(r"(?m)^## ", page.read_text())
        of_page = commands_in(begin)
        for target in re.findall(r"<!-- \w+: from make ([\w-]+)", page.read_text()):
            if target not in targets:
                missing.append(f"{page.name}: the Makefile has no target {target}")
        for section in sections:
            title, _, body = section.partition("\n")
            if measured_cells(body) < 4:
                continue
            tables += 1
            commands = commands_in(body) or of_page
            if not commands:
                missing.append(f"{page.name}, {title}: a table without the command that measured it")
                continue
            print(f"{page.name:26} {title[:44]:46} {'; '.join(dict.fromkeys(commands[:3]))}")
    for line in missing:
        print(line)
    print(f"{tables} sections with measured numbers, {len(missing)} findings")
    return 1 if missing or tables < 20 else 0


sys.exit(main())
