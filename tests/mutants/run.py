#!/usr/bin/env python3
"""The changes of list.txt, one at a time: what depends on the changed file is compiled, linked with the rest of a build, and tested until a
test fails.

  tests/mutants/run.py [--check] [--only PATTERN,...] [--jobs N] [--keep] [--limit S] [--build FOLDER] [--work FOLDER]

--only: names, in this order. --check: only whether every change fits its source. --keep: leave out what WORK/results.tsv has. BUILD is
a whole build of these sources (build), which stays as it is. Ends with 1 where a change survives without a reason or does not compile.
"""
import argparse, fnmatch, json, os, re, shlex, shutil, subprocess, sys, time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def read_list():
    mutants, names = [], set()
    for number, line in enumerate((ROOT / "tests/mutants/list.txt").read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        if line.startswith("["):
            mutants.append({"name": line.strip("[]")})
            if line in names:
                sys.exit(f"list.txt:{number}: {line} stands twice")
            names.add(line)
        else:
            key, value = line.split(None, 1)
            mutants[-1][key] = value
    return mutants


def pattern(old):
    """of a piece of code, wherever a formatter breaks its lines"""
    words = re.findall(r"\w+|[^\w\s]", old)
    return re.compile(r"\s*".join(map(re.escape, words)))


def misfit(m, root):
    missing = {"means", "file", "old", "new", "tests"} - set(m)
    if missing:
        return f"without {', '.join(sorted(missing))}"
    file = root / m["file"]
    count = len(pattern(m["old"]).findall(file.read_text())) if file.exists() else 0
    return "" if count == 1 else f"its text stands {count} times in {m['file']}: {m['old']}"


def sh(command, cwd, limit=None):
    """(exit code or None where it took longer than limit, output); whatever it started ends with it"""
    p = subprocess.Popen(command, cwd=cwd, shell=isinstance(command, str), text=True, errors="replace", stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, start_new_session=True)
    try:
        out, _ = p.communicate(timeout=limit)
        return p.returncode, out
    except subprocess.TimeoutExpired:
        os.killpg(p.pid, 9)
        return None, p.communicate()[0]


class Build:
    """Objects of a whole build, of which some are compiled again with a changed file before the others' include folders."""

    def __init__(self, root, build, work, jobs):
        self.root, self.build, self.work, self.jobs = root, build, work, jobs
        self.commands = {}  # object -> (source, command)
        for entry in json.loads((build / "compile_commands.json").read_text()):
            words = [w for w in shlex.split(entry["command"]) if w != "-Werror"]  # a change may leave a name without use
            self.commands[words[words.index("-o") + 1]] = (Path(entry["file"]), words)
        self.depend = {}  # object -> files
        for line in sh("ninja -t deps", build)[1].splitlines():
            if line.startswith("    "):
                self.depend[here].add(os.path.normpath(build / line.strip()))
            elif ":" in line:
                here = line.split(":")[0]
                self.depend[here] = set()
        self.library = [o for o in self.commands if "liblanger.dir/" in o]
        self.symbols, self.program = {}, work / "bin/test_changed"
        self.program.parent.mkdir(exist_ok=True)
        if not (work / "lib").exists():
            (work / "lib").symlink_to(build / "lib")  # where programs look for langer_gmsh.so, beside their bin

    def names(self, objects):
        """defines and needs symbols, of each object"""
        new = [o for o in objects if o not in self.symbols]
        for at in range(0, len(new), 50):
            for o in new[at: at + 50]:
                self.symbols[o] = (set(), set())
            for line in sh(["nm", "-A", *new[at: at + 50]], self.build)[1].splitlines():
                where, _, rest = line.partition(":")
                words = rest.split()
                if where in self.symbols and len(words) > 1:
                    self.symbols[where][words[-2] == "U"].add(words[-1])

    def needed(self, own):
        """objects of the library that these need"""
        self.names(own + self.library)
        by_symbol = {s: o for o in self.library for s in self.symbols[o][0]}
        found, rest = set(), list(own)
        while rest:
            for o in {by_symbol[s] for s in self.symbols[rest.pop()][1] if s in by_symbol} - found:
                found.add(o), rest.append(o)
        return sorted(found)

    def changed(self, file, text):
        """begins a change"""
        self.overlay = self.work / "changed"
        shutil.rmtree(self.overlay, ignore_errors=True)
        self.file, self.again = self.root / file if file else None, {}
        if file:
            (self.overlay / file).parent.mkdir(parents=True)
            (self.overlay / file).write_text(text)

    def compile(self, o):
        source, words = self.commands[o]
        to = self.again[o] = self.overlay / (o.replace("/", "_"))
        words = list(words)
        words[words.index("-o") + 1] = str(to)
        if self.file and self.file.suffix == ".cpp":
            changed = self.overlay / self.file.relative_to(self.root)
            if source != self.file:  # several sources that are compiled as one
                together = self.overlay / source.name
                together.write_text(source.read_text().replace(f'"{self.file}"', f'"{changed}"'))
                changed = together
            words[words.index(str(source))] = str(changed)
        elif "/test_" in o:  # their precompiled header holds the unchanged one
            for at in [i for i, w in enumerate(words) if w.endswith("cmake_pch.hxx")][::-1]:
                del words[at - 1: at + 1]
        at = next(i for i, w in enumerate(words) if w.startswith("-I"))
        words[at:at] = [f"-I{self.overlay / 'lib'}"]
        code, out = sh(words, self.build)
        return "" if code == 0 else out

    def make(self, entry):
        """a program with the tests of this entry; what the compiler said where it cannot"""
        folder, _, file = entry.partition("/")
        of = [o for o in self.commands if re.search(rf"/test_{folder}\.dir/.*\.o$", o)]
        # where several sources are compiled as one, the program has all of the folder and runs those of the file
        own = [o for o in of if o.endswith(f"/{file}.cpp.o")] or of
        own += [o for o in self.commands if "/doctest_main.dir/" in o]
        objects = self.needed(own) + own
        todo = [o for o in objects if o not in self.again and str(self.file) in self.depend[o]] if self.file else []
        with ThreadPoolExecutor(self.jobs) as pool:
            if wrong := "".join(pool.map(self.compile, todo)):
                return wrong
        line = sh(f"ninja -t commands bin/test_{folder}", self.build)[1].splitlines()[-1]
        link = shlex.split(next(c for c in line.split("&&") if f"-o bin/test_{folder} " in c))
        link = [w for w in link if not w.endswith(".o") and w != "liblanger.a"]
        at = link.index("-o")
        link[at + 1: at + 2] = [str(self.program), *(str(self.again.get(o, o)) for o in objects)]
        code, out = sh(link, self.build)
        return "" if code == 0 else out

    def test(self, entry, limit):
        """what fails there; empty: nothing"""
        _, _, file = entry.partition("/")
        code, out = sh([self.program, "--abort-after=1", "--no-intro", f"--source-file=*{file and f'/{file}.cpp'}"], self.build / "tests", limit)
        folder = entry.split("/")[0]
        if code is None:
            return f"{entry}: longer than {limit:.0f} s"
        if code == 0 and not re.search(r"test cases: +[1-9]", out):
            sys.exit(f"{entry}: no such tests")
        # other cases are named too, by their messages: the one that fails stands last before its error
        cases = re.findall(r"^TEST CASE:\s*(.*)", re.split(r" (?:FATAL )?ERROR: ", out, maxsplit=1)[0], re.M)
        return "" if code == 0 else f"{folder}: {cases[-1].strip() if cases else 'ends with ' + str(code)}"


def campaign(mutants, build, limit, results):
    sound = set()

    def need_sound(entry):  # a test that fails without any change would kill everything
        if entry not in sound:
            build.changed(None, "")
            if wrong := build.make(entry) or build.test(entry, limit):
                sys.exit(f"without any change:\n{wrong[-3000:]}")
            sound.add(entry)

    for m in mutants:
        start, killed = time.time(), ""
        text = (ROOT / m["file"]).read_text()
        build.changed(m["file"], pattern(m["old"]).sub(lambda _: m["new"], text))
        for entry in m["tests"].split():
            if wrong := build.make(entry):
                killed = "DOES NOT COMPILE"
                print(wrong[-2000:])
                break
            if killed := build.test(entry, limit):
                need_sound(entry)
                break
        row = [m["name"], m["means"], killed or ("spared: " + m["spared"] if "spared" in m else "SURVIVES"), f"{time.time() - start:.0f}"]
        print("\t".join(row), flush=True)
        with results.open("a") as out:
            out.write("\t".join(row) + "\n")


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--check", action="store_true"), p.add_argument("--keep", action="store_true")
    p.add_argument("--only", default="*"), p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--limit", type=float, default=900), p.add_argument("--build", type=Path, default=ROOT / "build")
    p.add_argument("--work", type=Path, default=ROOT / "build-mutants")
    args = p.parse_args()
    everything = read_list()
    mutants = []
    for pattern in args.only.split(","):
        mutants += [m for m in everything if m not in mutants and fnmatch.fnmatch(m["name"], pattern)]
    misfits = [f"{m['name']}: {why}" for m in mutants if (why := misfit(m, ROOT))]
    if misfits or not mutants:
        sys.exit("\n".join(misfits) or f"no change is named {args.only}")
    if args.check:
        return print(f"{len(mutants)} changes fit")
    work = args.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    results = work / "results.tsv"
    if not args.keep:
        results.unlink(missing_ok=True)
    done = {line.split("\t")[0] for line in results.read_text().splitlines()} if results.exists() else set()
    campaign([m for m in mutants if m["name"] not in done], Build(ROOT, args.build.resolve(), work, args.jobs), args.limit, results)
    rows = [line.split("\t") for line in results.read_text().splitlines()]
    with (work / "mutants.md").open("w") as out:
        out.write("| change | means | noticed by | s |\n| --- | --- | --- | --- |\n")
        out.writelines(f"| {' | '.join(row)} |\n" for row in rows)
    bad = [row[0] for row in rows if row[2] in ("SURVIVES", "DOES NOT COMPILE")]
    spared = sum(row[2].startswith("spared") for row in rows)
    print(f"{len(rows)} changes: {len(rows) - len(bad) - spared} noticed, {spared} spared with a reason, {len(bad)} not noticed{': ' if bad else ''}{', '.join(bad)}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
