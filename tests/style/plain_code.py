#!/usr/bin/env python3
"""Checks that C++ sources can be skimmed: `ctest -R "style: code"`.

Refused everywhere: a line of more than 100 columns (unless a text or a link does not fit), two statements joined by a
comma, a conditional operator inside another one on the same line. Counted over all lines of code: conditional operators
and lines with several statements, which must not become more frequent than LIMITS.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]

# Per 1000 lines of code. Code bases that are easy to read have 2 to 4 and 1 to 7.
LIMITS = {"conditional operators": 10.0, "lines with several statements": 3.0}
COMMENT_SHARE = 0.10
COLUMNS = 100


def sources():
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "lib", "stages"], capture_output=True, text=True)
    return [ROOT / name for name in listed.stdout.split("\n") if re.search(r"\.(cpp|hpp)$", name)]


def without_texts(line):
    """The line without comments, and with empty string and character literals."""
    line = re.sub(r'"(\\.|[^"\\])*"', '""', line)
    line = re.sub(r"'(\\.|[^'\\])'", "' '", line)
    return line.split("//")[0]


CAPTURES = re.compile(r"= \[[^\]]*(\]|$)")
JOINED = re.compile(r"^[\w\.\->\[\]\(\)]+ [-+*/|&]?= [^;]*, [\w\.\->\[\]]+ [-+*/|&]?= ")


def main():
    found = []
    counts = dict.fromkeys(LIMITS, 0)
    code_lines = comment_lines = 0
    for path in sources():
        name = path.relative_to(ROOT)
        for number, raw in enumerate(path.read_text(errors="replace").split("\n"), 1):
            text = raw.strip()
            if not text:
                continue
            is_comment = text.startswith("//")
            if len(raw) > COLUMNS and '"' not in raw and not is_comment:
                found.append(f"{name}:{number}: {len(raw)} columns; at most {COLUMNS}")
            if is_comment:
                comment_lines += 1
                continue
            code_lines += 1
            plain = without_texts(text)
            conditionals = len(re.findall(r"(?<=\s)\?(?=\s)", plain))
            counts["conditional operators"] += conditionals
            if conditionals > 1:
                found.append(f"{name}:{number}: two conditional operators; write if and else")
            if JOINED.match(CAPTURES.sub("= []", plain)):
                found.append(f"{name}:{number}: statements joined by a comma; write one on each line")
            if plain.count(";") > 1 and not re.match(r"for ?\(", plain):
                counts["lines with several statements"] += 1
    for what, limit in LIMITS.items():
        rate = 1000 * counts[what] / max(code_lines, 1)
        print(f"{what}: {rate:.1f} per 1000 lines, at most {limit}")
        if rate > limit:
            found.append(f"lib and stages: {what}: {rate:.1f} per 1000 lines; at most {limit}")
    share = comment_lines / max(code_lines + comment_lines, 1)
    print(f"lines of comment: {100 * share:.1f} %, at least {100 * COMMENT_SHARE:.0f} %")
    if share < COMMENT_SHARE:
        found.append("lib and stages: too few comments")
    for line in found[:60]:
        print(line)
    return 1 if found else 0


sys.exit(main())
