#!/usr/bin/env python3
"""The changes of list.txt, one at a time, in a copy of the tree: built, and tested until a test fails.

  tests/mutants/run.py [--check] [--only PATTERN] [--jobs N] [--keep] [--limit S] [--work FOLDER]

--check: only whether every change fits its source. --keep: leave out what FOLDER/results.tsv has. The copy and its build stay in FOLDER
(build-mutants). Ends with 1 where a change survives without a reason, does not fit or does not compile.
"""
import argparse, fnmatch, os, re, shutil, subprocess, sys, time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# the highest floor of lib (tests/floors.cmake) that the tests of a folder use; the others take the whole library
HIGHEST = {"tensor": "material", "material": "element", "mesh": "element", "contact": "solve", "element": "solve", "sensitivity": "material"}


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


def misfit(m, root):
    missing = {"means", "file", "old", "new", "tests"} - set(m)
    if missing:
        return f"without {', '.join(sorted(missing))}"
    file = root / m["file"]
    count = file.read_text().count(m["old"]) if file.exists() else 0
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


class Copy:
    """A copy of the tree with a build of its own."""

    def __init__(self, work, jobs):
        self.tree, self.build, self.jobs = work / "tree", work / "build", jobs
        self.targets = None

    def refresh(self):
        """files as in the project; those that are the same keep their time"""
        files = set(subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, text=True, capture_output=True, check=True).stdout.split("\n")) - {""}
        for name in files:
            source, to = ROOT / name, self.tree / name
            if source.is_file() and not (to.exists() and to.read_bytes() == source.read_bytes()):
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, to)
        for old in self.tree.rglob("*"):
            if old.is_file() and str(old.relative_to(self.tree)) not in files:
                old.unlink()
        beside = self.tree.parent / "shared"
        if (ROOT.parent / "shared").exists() and not beside.exists():
            beside.symlink_to((ROOT.parent / "shared").resolve())
        code, out = sh(["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"], ROOT)
        if code:
            sys.exit(out)
        self.targets = [line.split(":")[0] for line in sh("ninja -t targets all", self.build)[1].splitlines()]

    def objects(self, folder):
        """of the library, as far as the folder's tests need it; None: all of it"""
        if folder not in HIGHEST:
            return None
        floors = re.search(r"set\(floors ([^)]*)\)", (self.tree / "tests/floors.cmake").read_text()).group(1).split()
        parts = "|".join(floors[: floors.index(HIGHEST[folder]) + 1])
        return [t for t in self.targets if re.search(rf"liblanger\.dir/lib/({parts})/.*\.o$", t)]

    def make(self, folder):
        """builds test_<folder>; what the compiler said where it cannot"""
        program, objects = f"bin/test_{folder}", self.objects(folder)
        if objects is None:
            code, out = sh(["ninja", f"-j{self.jobs}", program], self.build)
            return "" if code == 0 else out
        own = [t for t in self.targets if re.search(rf"(test_{folder}|doctest_main)\.dir/.*\.o$", t)]
        code, out = sh(["ninja", f"-j{self.jobs}", *objects, *own], self.build)
        if code:
            return out
        archive = f"mutants_{folder}.a"
        (self.build / archive).unlink(missing_ok=True)
        commands = sh(f"ninja -t commands {program}", self.build)[1].splitlines()[-1].split("&&")
        link = next(c for c in commands if f"-o {program} " in c).replace("liblanger.a", archive)
        code, out = sh(["ar", "rcs", archive, *objects], self.build)
        code, out = (code, out) if code else sh(link, self.build)
        return "" if code == 0 else out

    def test(self, entry, limit):
        """what fails there; empty: nothing"""
        folder, _, file = entry.partition("/")
        command = [self.build / f"bin/test_{folder}", "--abort-after=1", "--no-intro"] + ([f"--source-file=*/{file}.cpp"] if file else [])
        code, out = sh(command, self.build / "tests", limit)
        if code is None:
            return f"{entry}: longer than {limit:.0f} s"
        if code == 0 and not re.search(r"test cases: +[1-9]", out):
            sys.exit(f"{entry}: no such tests")
        case = re.search(r"^TEST CASE:\s*(.*)", out, re.M)
        return "" if code == 0 else f"{folder}: {case.group(1).strip() if case else 'ends with ' + str(code)}"


def campaign(mutants, copy, limit, results):
    sound = {}

    def need_sound(entry):  # a test that fails without any change would kill everything
        if entry not in sound:
            start = time.time()
            if wrong := copy.make(entry.split("/")[0]) or copy.test(entry, limit):
                sys.exit(f"without any change:\n{wrong[-3000:]}")
            sound[entry] = time.time() - start

    for m in mutants:
        for entry in m["tests"].split():
            if sum(e in sound for e in m["tests"].split()) == 0:
                need_sound(entry)
        source = copy.tree / m["file"]
        kept = source.read_text()
        start, killed, tried = time.time(), "", []
        try:
            source.write_text(kept.replace(m["old"], m["new"]))
            for entry in m["tests"].split():
                if wrong := copy.make(entry.split("/")[0]):
                    killed = "DOES NOT COMPILE"
                    print(wrong[-2000:])
                    break
                tried.append(entry)
                if killed := copy.test(entry, limit):
                    break
        finally:
            source.write_text(kept)
        if killed and tried and tried[-1] not in sound and "COMPILE" not in killed:
            need_sound(tried[-1])
        row = [m["name"], m["means"], killed or ("spared: " + m["spared"] if "spared" in m else "SURVIVES"), f"{time.time() - start:.0f}"]
        print("\t".join(row), flush=True)
        with results.open("a") as out:
            out.write("\t".join(row) + "\n")


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--check", action="store_true"), p.add_argument("--keep", action="store_true")
    p.add_argument("--only", default="*"), p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--limit", type=float, default=900), p.add_argument("--work", type=Path, default=ROOT / "build-mutants")
    args = p.parse_args()
    mutants = [m for m in read_list() if fnmatch.fnmatch(m["name"], args.only)]
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
    copy = Copy(work, args.jobs)
    copy.refresh()
    campaign([m for m in mutants if m["name"] not in done], copy, args.limit, results)
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
