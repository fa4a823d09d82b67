#!/usr/bin/env python3
"""Checks words of messages and pages against docs/glossary.md: `ctest -R "style: words"`.

WORDS are expressions that a technical writer would not use, each with a better one. They are refused in the pages of docs/,
README.md and CONTRIBUTING.md, and in the texts of lib/ and stages/. Sentences of the pages must stay short.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]

WORDS = {
    r"\b(tell|tells|told|telling)\b": "say, report, identify",
    r"\bbeside\b": "next to, together with, compared with",
    r"\b(goes on|go on with|going on with)\b": "continue",
    r"\b(dear|dearer)\b": "expensive, more expensive",
    r"\b(nobody|whoever|somebody)\b": "no one, or name the person",
    r"\bin place of\b": "instead of",
    r"\b(stands? twice|lies in|stands in)\b": "is duplicate, is in",
    r"\bnearer\b": "closer, more accurate",
    r"\b(of what|by what) (is|it|the)\b": "name the thing",
}
MEAN_WORDS = 17.0       # in a sentence of the pages
LONG_SHARE = 0.07       # of sentences above LONG_WORDS
LONG_WORDS = 30

# Where a listed word is a name: a shipped scene, a key, a quotation.
ALLOWED = [
    re.compile(r"^\| (beside|thin|corner) \|"),
]


def listed(*folders, pattern):
    out = subprocess.run(["git", "-C", str(ROOT), "ls-files", *folders], capture_output=True, text=True).stdout
    return [ROOT / name for name in out.split("\n") if re.search(pattern, name)]


def prose(text):
    """The text of a page without code, tables, headings and link targets."""
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    for pattern in (r"(?m)^(    |\t).*$", r"(?m)^\s*\|.*$", r"<[^>]+>", r"(?m)^#.*$"):
        text = re.sub(pattern, "", text)
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)


def sentence_lengths(page):
    for paragraph in re.split(r"\n\s*\n|(?m:^\s*[-*] )", prose(page.read_text())):
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z`*\[])", " ".join(paragraph.split())):
            words = re.findall(r"[A-Za-z][\w'-]*", sentence)
            if len(words) > 3:
                yield len(words)


def main():
    found = []
    pages = listed("README.md", "CONTRIBUTING.md", "docs", pattern=r"\.md$")
    for page in pages:
        for number, line in enumerate(page.read_text().split("\n"), 1):
            if any(allowed.match(line) for allowed in ALLOWED):
                continue
            for pattern, better in WORDS.items():
                if match := re.search(pattern, line):
                    found.append(f"{page.relative_to(ROOT)}:{number}: \"{match[0]}\"; better: {better}")
    for source in listed("lib", "stages", pattern=r"\.(cpp|hpp)$"):
        for number, line in enumerate(source.read_text(errors="replace").split("\n"), 1):
            if line.strip().startswith(("//", "#")):
                continue
            for literal in re.findall(r'"((?:\\.|[^"\\])*)"', line):
                for pattern, better in WORDS.items():
                    if match := re.search(pattern, literal):
                        found.append(f"{source.relative_to(ROOT)}:{number}: \"{match[0]}\"; better: {better}")
    lengths = [n for page in pages for n in sentence_lengths(page)]
    mean = sum(lengths) / len(lengths)
    share = sum(n > LONG_WORDS for n in lengths) / len(lengths)
    print(f"{len(lengths)} sentences, mean {mean:.1f} words, {100 * share:.1f} % above {LONG_WORDS} words")
    if mean > MEAN_WORDS:
        found.append(f"sentences have {mean:.1f} words on average; at most {MEAN_WORDS}")
    if share > LONG_SHARE:
        found.append(f"{100 * share:.1f} % of the sentences have more than {LONG_WORDS} words; at most {100 * LONG_SHARE:.0f} %")
    for line in found[:80]:
        print(line)
    print(f"{len(found)} findings")
    return 1 if found else 0


sys.exit(main())
