#!/usr/bin/env python3
"""Changes one operator, number or statement of the mechanics at a time, and looks for a test that notices.

  tests/mutants/operators.py [--files GLOB,...] [--only PATTERN] [--limit N] [--jobs N] [--work FOLDER]

All changes are compiled into one copy of the tree. An environment variable chooses the one that acts:
a statement `a = b + c;` becomes `if (mutant(7)) { a = b - c; } else { a = b + c; }`. The copy is built
once. Then each test case runs alone and records which changes it reaches, and each change runs the test
cases that reach it, the fastest first, until one fails. A change that no test case notices survives.
The table is WORK/operators.md.

--files: sources below lib/ (default: FILES below). --only: changes whose place matches one of these
patterns, such as '*adhesion.cpp:*,*bonds.cpp:*'. --limit: at most so many changes, spread evenly.
--again: only those that survived in the last table, to be tried by other --programs or by test
cases that take --longest seconds. The table is WORK/again.md.
"""
import argparse
import fnmatch
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FILES = [
    "mechanics/material/*.cpp", "mechanics/element/*.cpp", "mechanics/contact/*.cpp",
    "mechanics/assembly/*.cpp", "mechanics/dynamics/*.cpp", "mechanics/solve/*.cpp",
    "mechanics/nonlinear/newton.cpp", "mechanics/nonlinear/load_path.cpp",
]
# Programs whose test cases are tried.
PROGRAMS = [
    "tensor", "material", "element", "contact", "solve", "scene", "run", "store", "dynamics",
    "vibration", "mortar", "accuracy",
]
LONGEST = 5.0  # [s]; a test case that takes longer is left out

GUARD = """// Which change of tests/mutants/operators.py acts; which are reached.
#pragma once
namespace langer::mutants {
extern int active;
extern unsigned char reached[];
inline bool mutant(int n) {
  reached[n] = 1;
  return n == active;
}
}  // namespace langer::mutants
using langer::mutants::mutant;
"""
GUARD_SOURCE = """#include "core/base/mutant.hpp"

#include <cstdio>
#include <cstdlib>

namespace langer::mutants {
int active = 0;
unsigned char reached[{count}];
namespace {
void write_reached() {
  const char* path = std::getenv("LANGER_MUTANTS_REACHED");
  if (!path) return;
  if (std::FILE* file = std::fopen(path, "ab")) {
    std::fwrite(reached, 1, sizeof reached, file);
    std::fclose(file);
  }
}
__attribute__((constructor(101))) void read_environment() {
  if (const char* text = std::getenv("LANGER_MUTANT")) active = std::atoi(text);
  std::atexit(write_reached);
}
}  // namespace
}  // namespace langer::mutants
"""


def masked(text):
    """The text with comments, strings, characters and preprocessor lines blanked, of the same length."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    quoted = r'R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
    text = re.sub(rf"//[^\n]*|/\*(?:.|\n)*?\*/|{quoted}", lambda m: '"' + blank(m)[1:] if m.group()[0] == '"' else blank(m), text)
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\\n|\\.)*", blank, text, flags=re.M)


class Statement:
    def __init__(self, start, end):
        self.start, self.end = start, end  # without the semicolon


def statements(code):
    """Statements in bodies of functions, as ranges of the masked code, and conditions of if and while."""
    found, conditions = [], []
    scopes = ["outside"]
    starts = [0]  # where the statement of each scope begins
    depths = [0]  # of parentheses
    spoiled = [False]  # the statement holds the body of a lambda
    i = 0
    while i < len(code):
        c = code[i]
        if c in "([":
            depths[-1] += 1
        elif c in ")]":
            depths[-1] -= 1
            if depths[-1] == 0 and c == ")":
                head = re.match(r"\s*(?:else\s+)?(if|while|for)\s*(?:constexpr\s*)?\(", code[starts[-1]:i])
                if head and scopes[-1] == "body":
                    opening = starts[-1] + head.end()
                    conditions.append((head.group(1), opening, i))
                    starts[-1] = i + 1
        elif c == "{":
            before = code[starts[-1]:i]
            last = before.rstrip()
            if depths[-1] == 0 and re.search(r"\b(namespace|struct|class|enum|union)\b[^()]*$", before):
                kind = "outside"
            elif re.search(r"\)\s*(const|noexcept|override|final|mutable|->\s*[\w:<>]+|\s)*$", last) or not last or \
                    re.search(r"\b(else|do|try)$", last) or re.search(r"\]$", last) or \
                    (scopes[-1] != "body" and re.search(r"\)\s*:\s", last)):
                kind = "body"
            else:
                kind = "list"
            if depths[-1] > 0 or (kind == "body" and last and re.search(r"[=\]]", last.split("\n")[-1]) and scopes[-1] == "body"):
                spoiled[-1] = spoiled[-1] or kind == "body"
            scopes.append(kind)
            starts.append(i + 1)
            depths.append(0)
            spoiled.append(False)
        elif c == "}":
            kind = scopes.pop()
            starts.pop(), depths.pop(), spoiled.pop()
            if not scopes:
                raise ValueError("unbalanced braces")
            if kind != "list" and depths[-1] == 0 and not spoiled[-1]:
                starts[-1] = i + 1
        elif c == ";" and depths[-1] == 0:
            if scopes[-1] == "body" and not spoiled[-1]:
                found.append(Statement(starts[-1], i))
            starts[-1] = i + 1
            spoiled[-1] = False
        i += 1
    return found, conditions


SWAPS = [
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "),
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "),
    (r" == ", " != "), (r" != ", " == "), (r" && ", " || "), (r" \|\| ", " && "),
    (r" \+= ", " -= "), (r" -= ", " += "),
    (r"std::max\(", "std::min("), (r"std::min\(", "std::max("),
    (r"(?<=[(,=?:] )-(?=[\w(])|(?<=\()-(?=[\w(])|(?<=return )-(?=[\w(])", ""),
]


def changed_number(text):
    if re.fullmatch(r"\d+", text):
        return "0" if text == "1" else str(int(text) + 1)
    return f"(2 * {text})" if float(text.rstrip("f")) != 0 else "1."


def variants(code, text, start, end):
    """The text of a range with one operator or number changed, each."""
    all_of = []
    for pattern, by in SWAPS:
        for match in re.finditer(pattern, code[start:end]):
            if code[start:end][match.start():match.end()].strip() in ("*", "<", ">") and \
                    re.search(r"\b(auto|const|int|double|bool|std::\w+)\s*$", code[start:end][:match.start()]):
                continue  # a pointer or a template
            a, b = start + match.start(), start + match.end()
            all_of.append((a, text[start:a] + by + text[b:end], f"{text[a:b].strip()} -> {by.strip() or 'nothing'}"))
    for match in re.finditer(r"(?<![\w.<\[>])(\d+\.?\d*(?:e[+-]?\d+)?)(?![\w.>])", code[start:end]):
        a, b = start + match.start(), start + match.end()
        by = changed_number(match.group())
        all_of.append((a, text[start:a] + by + text[b:end], f"{match.group()} -> {by}"))
    return all_of


DECLARATION = re.compile(
    r"(?P<const>const )?(?P<type>double|int|bool|long|std::size_t|Vec3|Vec6|Mat3|Mat6|VecX|MatX|std::vector<[^=]*>|[A-Z]\w+)"
    r" (?P<name>\w+) =\s+(?P<value>.+)", re.S)


def top_level_comma(text):
    depth = 0
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            return True
    return False


class Mutant:
    def __init__(self, number, place, what):
        self.number, self.place, self.what = number, place, what


class Source:
    """A file with its changes; those that do not compile are taken out of it."""

    def __init__(self, path):
        self.path = path
        self.text = path.read_text()
        self.code = masked(self.text)
        self.pieces = []  # start, end, list of (variant, what, place), kind
        found, conditions = statements(self.code)
        for kind, start, end in conditions:
            if kind == "for":
                parts = self.code[start:end].split(";")
                if len(parts) != 3:
                    continue  # over a range
                start, end = start + len(parts[0]) + 1, start + len(parts[0]) + 1 + len(parts[1])
            elif ";" in self.code[start:end] or re.search(r"\b(auto|const)\b|[^=!<>]=[^=]", self.code[start:end]):
                continue  # declares a name
            self.add("condition", start, end)
        for s in found:
            start = s.start + len(self.code[s.start:s.end]) - len(self.code[s.start:s.end].lstrip())
            body = self.code[start:s.end]
            if '"' in body or len(body) > 500 or re.match(
                    r"(else\b|case\b|default\b|static_assert|throw|using|static|constexpr|break|continue|goto|public|private|v\()", body):
                continue
            if re.match(r"return\b", body):
                if body.strip() != "return":
                    self.add("return", start, s.end)
            elif DECLARATION.fullmatch(body):
                if top_level_comma(body):
                    continue  # several names
                self.add("declaration", start, s.end)
            elif re.match(r"(const|auto|double|int|bool)\b", body):
                continue
            elif re.search(r"[^=!<>]=[^=]|\+\+|--|\w\(", body) and not re.match(r"[\w:<>, ]+[&*]?\s+[&*]?\w+\s*(\(|=|\{|\[)", body):
                self.add("statement", start, s.end)

    def add(self, kind, start, end):
        line = lambda at: self.text.count("\n", 0, at) + 1
        found = [(new, what, line(at)) for at, new, what in variants(self.code, self.text, start, end)]
        if kind == "statement":
            found.append((None, "left out: " + " ".join(self.text[start:end].split())[:60], line(start)))
        if found:
            self.pieces.append([kind, start, end, found])

    def write(self, target, first, refused):
        """The file with the changes numbered from `first` on; returns them, the lines of each, and the
        next number. Those that are left out keep their numbers, so that other files stay the same."""
        out, at, mutants, lines = ['#include "core/base/mutant.hpp"\n'], 0, [], {}
        next_number = first

        def here():
            return "".join(out).count("\n") + 1

        name = str(self.path.relative_to(ROOT / "lib"))
        for kind, start, end, found in sorted(self.pieces, key=lambda p: p[1]):
            if start < at:
                continue  # inside the piece before
            kept = []
            for new, what, line in found:
                if (name, line, what) not in refused:
                    kept.append((new, what, line, next_number))
                next_number += 1
            if not kept:
                continue
            out.append(self.text[at:start])
            original = self.text[start:end]
            branches = []
            for new, what, line, number in kept:
                mutants.append(Mutant(number, f"{name}:{line}", what))
                branches.append((number, new, (name, line, what)))

            def put(text, key=None):
                begin = here()
                out.append(text.replace("\n", " ") + "\n")
                if key:
                    lines[begin] = key

            everything = [key for _, _, key in branches]
            begin = here()
            if kind == "statement":
                put("\n{")
                for number, new, key in branches:
                    put(f"if (mutant({number})) {{ {new + ';' if new else ''} }} else", key)
                put("{")
                out.append(original + ";\n}}")
                end += 1
            elif kind == "return":
                put("\n{")
                for number, new, key in branches:
                    put(f"if (mutant({number})) {{ {new}; }}", key)
                out.append(original + ";\n}")
                end += 1
            elif kind == "condition":
                for number, new, key in branches:
                    put(f"mutant({number}) ? static_cast<bool>({new}) :", key)
                out.append(f"static_cast<bool>({original})")
            else:
                parts = DECLARATION.fullmatch(original)
                if not parts:
                    branches = []
                    del mutants[len(mutants) - len(kept):]
                    out.append(original)
                else:
                    head = original[:parts.start("value")]
                    out.append(f"{head}[&]() -> {parts['type']} {{\n")
                    for number, new, key in branches:
                        value = DECLARATION.fullmatch(new)
                        value = value["value"] if value else new[parts.start("value"):]
                        put(f"if (mutant({number})) return {value};", key)
                    out.append(f"return {parts['value']}; }}()")
            for line in range(begin, here() + 1):
                lines.setdefault(line, everything)
            at = end
        out.append(self.text[at:])
        write_if_new(target, "".join(out).encode())
        return mutants, lines, next_number


def write_if_new(path, content):
    """A file that stays the same is not compiled again."""
    if path.exists() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


class Tree:
    def __init__(self, work):
        self.root = work / "tree"
        self.build = self.root / "build"

    def copy(self, changed):
        """All files but those that are about to be changed; what is the same stays untouched."""
        skip = {source.path for source in changed}
        names = ["CMakeLists.txt", "LICENSE", "README.md", "CITATION.cff", "Makefile"]
        files = [ROOT / name for name in names if (ROOT / name).exists()]
        for folder in ("lib", "stages", "tests", "cmake", "share", "configs", "data", "pipelines", "docs"):
            files += [f for f in (ROOT / folder).rglob("*") if f.is_file() and f not in skip]
        for file in files:
            if file.name != "CMakeLists.txt" or file.parent != ROOT:
                write_if_new(self.root / file.relative_to(ROOT), file.read_bytes())
        # warnings of changed files are no errors, and all flags of the others stay: ccache knows them
        names = " ".join(str(f.relative_to(ROOT)) for f in sorted(skip))
        project = (ROOT / "CMakeLists.txt").read_text()
        project += f'\nset_source_files_properties({names} PROPERTIES COMPILE_OPTIONS "-w")\n'
        write_if_new(self.root / "CMakeLists.txt", project.encode())

    def options(self):
        """as the build beside it was configured"""
        cache = ROOT / "build/CMakeCache.txt"
        lines = cache.read_text().splitlines() if cache.exists() else []
        return ["-D" + line for line in lines if line.startswith("LANGER_WERROR:")]


def write_all(tree, sources, refused):
    mutants, lines, number = [], {}, 1
    for source in sources:
        target = tree.root / source.path.relative_to(ROOT)
        more, where, number = source.write(target, number, refused)
        mutants += more
        lines[str(source.path.relative_to(ROOT))] = where
    write_if_new(tree.root / "lib/core/base/mutant.hpp", GUARD.encode())
    write_if_new(tree.root / "lib/core/base/mutant.cpp", GUARD_SOURCE.replace("{count}", "100000").encode())
    return mutants, lines


def build(tree, sources, programs, jobs):
    """Builds the copy; changes that do not compile are left out, and it is built again."""
    # remembered from an earlier build; what fits again is only tried in a new WORK
    memory = tree.root.parent / "refused.txt"
    refused = {tuple(line.split("\t")) for line in memory.read_text().splitlines()} if memory.exists() else set()
    refused = {(name, int(line), what) for name, line, what in refused}
    for _ in range(12):
        mutants, lines = write_all(tree, sources, refused)
        if not (tree.build / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", tree.root, "-B", tree.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            *tree.options()],
                           check=True, stdout=subprocess.DEVNULL)
        done = subprocess.run(["cmake", "--build", tree.build, "--parallel", str(jobs), "--target",
                               *(f"test_{p}" for p in programs), "--", "-k", "0"], text=True, capture_output=True)
        if done.returncode == 0:
            return mutants
        new = set()
        # an error may be shown at its place in a header; the lines above it then name ours
        for match in re.finditer(r"^(?:In file included from )?\S*?(lib/\S+?\.[ch]pp):(\d+)[:,]", done.stdout, re.M):
            where = lines.get(match.group(1), {}).get(int(match.group(2)))
            if where and "warning" not in done.stdout[match.end():match.end() + 20]:
                new |= {where} if isinstance(where, tuple) else set(where)
        new -= refused
        if not new:
            sys.exit("the copy does not compile:\n" + done.stdout[-6000:])
        refused |= new
        memory.write_text("".join(f"{name}\t{line}\t{what}\n" for name, line, what in sorted(refused)))
        print(f"{len(new)} changes do not compile and are left out", flush=True)
    sys.exit("too many rounds")


def run(command, folder, environment, limit):
    try:
        done = subprocess.run(command, cwd=folder, env={**os.environ, **environment}, timeout=limit,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return done.returncode
    except subprocess.TimeoutExpired:
        return None


def test_cases(program):
    listed = subprocess.run([program, "--list-test-cases", "--no-colors"], text=True, capture_output=True).stdout
    # a name may go over several lines in the source, but not in the list
    return [l for l in listed.splitlines() if l and not l.startswith("[doctest]") and not l.startswith("===")]


def escaped(case):
    """as a filter of doctest: it divides at commas and knows stars"""
    return case.replace(",", "?").replace("\\", "?")


def reached_by(tree, programs, jobs, longest):
    """(seconds, program, case, numbers of changes) for each test case that passes and is fast"""
    folder = tree.build / "tests"
    reach = tree.root.parent / "reach"
    shutil.rmtree(reach, ignore_errors=True)
    reach.mkdir()
    todo = [(p, c) for p in programs for c in test_cases(tree.build / f"bin/test_{p}")]

    def one(item):
        index, (program, case) = item
        file = reach / str(index)
        start = os.times()
        begin = time.time()
        code = run([tree.build / f"bin/test_{program}", f"--test-case={escaped(case)}", "--no-intro"], folder,
                   {"LANGER_MUTANTS_REACHED": str(file), "OMP_NUM_THREADS": "1"}, 4 * longest)
        seconds = time.time() - begin
        if code != 0 or seconds > longest or not file.exists():
            return (program, case, code, seconds), None
        numbers = {n for n, b in enumerate(file.read_bytes()) if b}
        return None, (seconds, program, case, numbers)

    with ThreadPoolExecutor(jobs) as pool:
        answers = list(pool.map(one, enumerate(todo)))
    for left, _ in answers:
        if left:
            print(f"left out: {left[0]}: {left[1][:70]}: {'too slow' if left[2] in (None, 0) else 'fails'}", flush=True)
    return sorted((found for _, found in answers if found), key=lambda t: t[0])


def judged(mutant, cases, tree):
    folder = tree.build / "tests"
    reaching = [c for c in cases if mutant.number in c[3]]
    for seconds, program, case, _ in reaching:
        code = run([tree.build / f"bin/test_{program}", f"--test-case={escaped(case)}", "--no-intro", "--abort-after=1"],
                   folder, {"LANGER_MUTANT": str(mutant.number), "OMP_NUM_THREADS": "1"}, 20 * seconds + 10)
        if code != 0:
            return "no end" if code is None else f"{program}: {case}"
    return "SURVIVES" if reaching else "NOT REACHED"


def survivors(table):
    """(place, change) of the changes that a table has no test for"""
    found = set()
    for line in table.read_text().splitlines():
        match = re.fullmatch(r"\| (\S+) \| `(.*)` \| (SURVIVES|NOT REACHED) \|", line)
        if match:
            found.add((match.group(1), match.group(2)))
    return found


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--files", default=",".join(FILES))
    p.add_argument("--only", default="*")
    p.add_argument("--limit", type=int)
    p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--programs", default=",".join(PROGRAMS))
    p.add_argument("--again", action="store_true")
    p.add_argument("--longest", type=float, default=LONGEST, help="seconds of a test case that is tried")
    p.add_argument("--seconds", type=float, help="stop after this time of trying changes")
    p.add_argument("--count", type=int, metavar="LEAST", help="only count the changes; fails below LEAST")
    p.add_argument("--work", type=Path, default=ROOT / "build-mutants")
    args = p.parse_args()
    paths = sorted({f for pattern in args.files.split(",") for f in (ROOT / "lib").glob(pattern)})
    sources = [Source(f) for f in paths]
    if args.count is not None:
        total = 0
        for source in sources:
            n = sum(len(piece[3]) for piece in source.pieces)
            total += n
            print(f"{n:5} {source.path.relative_to(ROOT)}")
        print(f"{total:5} in all")
        return total < args.count
    tree = Tree(args.work.resolve())
    tree.root.mkdir(parents=True, exist_ok=True)
    tree.copy(sources)
    programs = args.programs.split(",")
    mutants = build(tree, sources, programs, args.jobs)
    print(f"{len(mutants)} changes in {len(sources)} files", flush=True)
    cases = reached_by(tree, programs, args.jobs, args.longest)
    print(f"{len(cases)} test cases", flush=True)
    chosen = [m for m in mutants if any(fnmatch.fnmatch(m.place, p) for p in args.only.split(","))]
    if args.again:
        before = survivors(tree.root.parent / "operators.md")
        chosen = [m for m in chosen if (m.place, m.what) in before]
    if args.limit and len(chosen) > args.limit:
        chosen = [chosen[i * len(chosen) // args.limit] for i in range(args.limit)]
    rows, begin = [], time.time()

    def one(mutant):
        if args.seconds and time.time() - begin > args.seconds:
            return
        verdict = judged(mutant, cases, tree)
        rows.append((mutant, verdict))
        if verdict in ("SURVIVES", "NOT REACHED"):
            print(f"{verdict} {mutant.place}: {mutant.what}", flush=True)

    with ThreadPoolExecutor(args.jobs) as pool:
        list(pool.map(one, chosen))
    rows.sort(key=lambda row: row[0].number)
    table = tree.root.parent / ("again.md" if args.again else "operators.md")
    with table.open("w") as out:
        out.write("| place | change | noticed by |\n| --- | --- | --- |\n")
        for mutant, verdict in rows:
            out.write(f"| {mutant.place} | `{mutant.what}` | {verdict.replace('|', '/')} |\n")
    count = lambda word: sum(verdict == word for _, verdict in rows)
    print(f"{len(rows)} of {len(chosen)} changes tried: {len(rows) - count('SURVIVES') - count('NOT REACHED')} noticed, "
          f"{count('SURVIVES')} survive, {count('NOT REACHED')} not reached by a fast test case; table: {table}")


if __name__ == "__main__":
    sys.exit(main())
