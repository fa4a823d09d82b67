#!/usr/bin/env python3
"""Checks that no name of an anonymous namespace is defined twice in a folder: `ctest -R "style: names"`.

Without ccache, several sources of a folder are compiled as one (LANGER_UNITY in CMakeLists.txt). Two functions of the
same name and parameters, or two constants or types of the same name, would then be one definition too many. A build with
ccache does not see it, a user's first build does.
"""
import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]

FUNCTION = re.compile(r"^(?:template <.*>\n)?(?:\[\[\w+\]\] )?(?:[\w:][\w:<>,&*\[\] ]*?[ &*])(\w+)\(((?:[^()]|\([^()]*\))*)\)[^;{]*\{", re.M)
CONSTANT = re.compile(r"^(?:static |inline )?(?:constexpr|const) [\w:<>,\* ]+?[ &*](\w+)(?:\[\w*\])? ?[={]", re.M)
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)", re.M)  # an alias may be repeated
ANONYMOUS = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.M | re.S)
OWN_NAMESPACE = re.compile(r"^namespace \w+_tests \{$", re.M)
NOT_NAMES = {"if", "for", "while", "switch", "return", "operator"}


def parameter_types(text):
    """The parameters without their names and defaults: what distinguishes two functions of one name."""
    types = []
    for one in re.split(r",(?![^<]*>)", " ".join(text.split())):
        one = one.split("=")[0].strip()
        types.append(re.sub(r"\b\w+$", "", one).strip() if re.search(r"[&*> ]\w+$", one) else one)
    return ",".join(types)


def definitions(text):
    """What the anonymous namespaces of a source define, each as one text; of tests inside a namespace of their own nothing."""
    if OWN_NAMESPACE.search(text):
        return
    for part in ANONYMOUS.findall(text):
        for match in FUNCTION.finditer(part):
            if match[1] not in NOT_NAMES:
                yield f"{match[1]}({parameter_types(match[2])})"
        for pattern in (CONSTANT, TYPE):
            for match in pattern.finditer(part):
                yield match[1]


def main():
    where = defaultdict(lambda: defaultdict(list))
    for path in sorted((ROOT / "lib").rglob("*.cpp")) + sorted((ROOT / "tests").rglob("*.cpp")):
        for name in set(definitions(path.read_text(errors="replace"))):
            where[path.parent][name].append(path.name)
    n = sum(len(names) for names in where.values())
    if n < 500:
        sys.exit(f"only {n} definitions found: this script no longer reads the sources")
    found = [f"{folder.relative_to(ROOT)}: {name} is defined in {' and '.join(files)}; rename one or share it; or, in tests, put all of a source into a namespace called after it"
             for folder, names in sorted(where.items()) for name, files in sorted(names.items()) if len(files) > 1]
    print(f"{n} definitions in {len(where)} folders")
    for line in found:
        print(line)
    return 1 if found else 0


sys.exit(main())
