"""make bench-peers: one indentation on the same cells by Langer, CalculiX, GetFEM, FEniCSx and, where it is installed, FEBio.

    run.py <folder of Langer's programs> <folder of the results> [scene ...]       scenes: isotropic positive strip suction hold

strip, suction and hold are boxes without contact (box_scenes.py), for Langer and FEniCSx. What is compared is a force, of suction the
height of the apex in mm; the column is force_N in all of them.

peers.csv has one line per run: force, its error, CPU seconds (user and system, one thread), memory, how far the sphere is in the body.
A run that is there already is not run again; PEERS_TOOLS names those that run. Who takes more than LIMIT CPU seconds is stopped,
which is a result like any other."""
import csv
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

LIMIT = float(os.environ.get("PEERS_LIMIT", 150))
TOOLS = os.environ.get("PEERS_TOOLS", "Langer CalculiX GetFEM FEniCSx FEBio").split()
here = Path(__file__).resolve().parent
root, programs, folder = here.parents[1], Path(sys.argv[1]).resolve(), Path(sys.argv[2])
scenes = sys.argv[3:] or ["isotropic", "positive", "strip", "suction", "hold"]
folder.mkdir(parents=True, exist_ok=True)
PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable  # Debian's, which has the peers
# N at 1 mm: what hex8 of 0.125 to 0.0707 contact radii extrapolate to at a length of 0 (make work-precision)
REFERENCE = {"isotropic": 10.765, "positive": 12.671}
# of the boxes: what the finest runs of hex27 extrapolate to
REFERENCE.update(strip=4.112, suction=0.4961, hold=4.546)
COLUMNS = ["scene", "tool", "cells", "edge", "settings", "unknowns", "force_N", "error_percent", "cpu_s", "memory_MB", "inside_um", "words"]

table = folder / "peers.csv"
done = {}
if table.exists():
    for row in csv.DictReader(open(table)):
        if row["force_N"]:
            row["error_percent"] = f"{100 * (float(row['force_N']) / REFERENCE[row['scene']] - 1):+.3f}"
        done[row["scene"], row["tool"], row["cells"], row["edge"], row["settings"]] = row


def measured(command, where, log):
    """CPU seconds (of a run below 3 s the median of five), memory in MB, exit code, what was said; stopped after LIMIT CPU seconds"""
    first = measured_once(command, where, log)
    if first[2] or first[0] > 3:
        return first
    return sorted([first] + [measured_once(command, where, log) for _ in range(4)], key=lambda run: run[0])[2]


def measured_once(command, where, log):
    def limits():
        resource.setrlimit(resource.RLIMIT_CPU, (int(LIMIT), int(LIMIT) + 5))

    one = {v: "1" for v in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")}
    with open(log, "w") as out:
        child = subprocess.Popen([str(c) for c in command], cwd=where, stdout=out, stderr=subprocess.STDOUT, preexec_fn=limits,
                                 env={**os.environ, **one})
        _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, child.returncode, open(log, errors="replace").read()


def record(scene, tool, cells, edge, settings, run):
    key = (scene, tool, cells, f"{edge:g}", settings)
    if key in done or tool not in TOOLS:
        return
    try:
        cpu, memory, found = run()
    except subprocess.CalledProcessError as e:
        cpu, memory, found = float("nan"), float("nan"), {"words": f"{Path(str(e.cmd[0])).name} ended with {e.returncode}"}
    force = found.get("force")
    row = dict(zip(COLUMNS, key))
    row.update(unknowns=found.get("unknowns", ""), cpu_s=f"{cpu:.3f}", memory_MB=f"{memory:.0f}")
    row.update(words=found.get("words", "").replace(",", ";"))
    if force is not None:
        row.update(force_N=f"{force:.5g}", error_percent=f"{100 * (force / REFERENCE[scene] - 1):+.3f}")
        row.update(inside_um=f"{1000 * found['penetration']:.2g}")
    new = not table.exists()
    with open(table, "a", newline="") as out:
        writer = csv.DictWriter(out, COLUMNS)
        if new:
            writer.writeheader()
        writer.writerow(row)
    print("{scene} {tool} {cells} {edge} {settings}: ".format(**row) + (f"{force:.5g} N ({row['error_percent']} %), " if force else "") +
          f"{cpu:.2f} s, {memory:.0f} MB {row['words']}", flush=True)


def ended(cpu, code, said):
    if cpu > LIMIT - 2 or code in (-signal.SIGXCPU, -signal.SIGKILL):
        return f"not done after {LIMIT:g} s"
    return f"ended with {code}: " + " ".join(said.strip().splitlines()[-1:])[:100]


def said_json(cpu, code, said):
    lines = [line for line in said.splitlines() if line.startswith("{")]
    if not lines:
        return {"words": ended(cpu, code, said)}
    return json.loads(lines[-1])


# Langer: meshes and decks, and its own runs

CONFIG = {"isotropic": "refinement_isotropic", "positive": "refinement_positive"}
BLOCK = """geometry: {indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: %g}}
sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}
cells: %s
"""


def call(*command):
    subprocess.run([str(c) for c in command], cwd=root, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def mesh_of(cells, edge):
    mesh = (folder / f"{cells}_{edge:g}.h5").resolve()
    if not mesh.exists():
        config = folder / f"{cells}_{edge:g}.yaml"
        config.write_text(BLOCK % (edge, cells))
        call(programs / "langer-mesh", config.resolve(), "-o", mesh, "--quiet")
    return mesh


def langer(scene, cells, edge, increments, output=None, extra=()):
    mesh, solution = mesh_of(cells, edge), (output or folder / "langer.h5").resolve()
    command = [programs / "langer-solve", f"configs/solve/{CONFIG[scene]}.yaml", "--mesh", mesh, "-o", solution, "--quiet", "--json",
               "--set", f"path.first={1 / increments}", "--set", f"path.largest={1 / increments}", *extra]
    cpu, memory, code, said = measured(command, root, folder / "langer.log")
    if code:
        return cpu, memory, {"words": ended(cpu, code, said)}
    force = re.search(r'"force_N": ([-0-9.e+]+)', said)
    return cpu, memory, {"force": float(force[1]), "penetration": 0.0}


def deck_of(scene, cells, edge, increments, d, ending="inp"):
    deck = (folder / f"{scene}_{cells}_{edge:g}_{increments}_{d:g}.{ending}").resolve()
    if deck.exists():
        return deck
    solution = deck.with_suffix(".h5")
    # Langer solves it by the way: the deck says its answer. CalculiX takes no fibres here: the others read theirs by name
    law = ["--set", f"material.volume.quadratic.d={d}"]
    if ending == "inp" and scene != "isotropic":
        law += ["--set", "material.fibres=[]", "--set", "fibre_angles=[]", "--set", "symmetry=none"]
    if not solution.exists():
        langer(scene, cells, edge, increments, solution, law)
    call(programs / "langer-post", "--solution", solution, "--export", deck, "--quiet")
    return deck


# boxes without contact

STRIP_YAML = """mesh:
  geometry: {{block: {{size: [30, 1, 10], divisions: [{divisions}]}}}}
  cells: {cells}
supports: [{{on: x_min, hold: [x, y, z]}}, {{on: x_max, hold: [y, z]}}]
loads: [{{on: x_max, displacement: {{x: {to}}}}}]
material:
  matrix: {{yeoh: {{a1: 0.269, a2: 0.376, a3: 0.415}}}}
  fibres: [{{hgo: {{c1: 0.317, c2: 0.319}}, alpha: 45}}]
  volume: {{quadratic: {{d: 1.0e-6}}}}{viscous}
stability: off
path: {{{path}}}
"""
BRANCHES = "\n  viscous: [{gamma: 0.5, tau: 1}, {gamma: 0.3, tau: 10}]"
SUCTION_YAML = """mesh:
  geometry: {{block: {{origin: [-6, 0, -6], size: [12, 4, 12], divisions: [{divisions}]}}}}
  cells: {cells}
  sets:
    hole: {{of: top, within: {{box: {{from: [-2, 0, -2], to: [2, 4, 2]}}}}}}
    left: {{of: top, within: {{box: {{from: [-6, 0, -6], to: [-2, 4, 6]}}}}}}
    right: {{of: top, within: {{box: {{from: [2, 0, -6], to: [6, 4, 6]}}}}}}
    front: {{of: top, within: {{box: {{from: [-6, 0, -6], to: [6, 4, -2]}}}}}}
    back: {{of: top, within: {{box: {{from: [-6, 0, 2], to: [6, 4, 6]}}}}}}
  points: {{apex: [0, 4, 0]}}
supports:
  - {{on: bottom, hold: [x, y, z]}}
  - {{on: left, hold: [x, y, z]}}
  - {{on: right, hold: [x, y, z]}}
  - {{on: front, hold: [x, y, z]}}
  - {{on: back, hold: [x, y, z]}}
loads: [{{on: hole, pressure: -0.03}}]
material:
  matrix: {{yeoh: {{a1: 0.012, a2: 0.03, a3: 0.01}}}}
  volume: {{quadratic: {{d: 1.0e-6}}}}
stability: off
path: {{{path}}}
"""


def box_config(scene, cells, edge, increments):
    parts = [max(1, round(length / edge)) for length in ((12, 4, 12) if scene == "suction" else (30, 1, 10))]
    path = f"first: {1 / increments}, largest: {1 / increments}"
    if scene == "suction":
        return SUCTION_YAML.format(divisions=", ".join(map(str, parts)), cells=cells, path=path)
    to, viscous = "6", ""
    if scene == "hold":  # increments: of the ramp and of the hold together, as in fenicsx_box.py
        to, viscous = "[{s: 1, to: 6}, {s: 11, to: 6}]", BRANCHES
        path = f"seconds: 11, first: {2 / increments}, largest: {2 / increments}"
    return STRIP_YAML.format(divisions=", ".join(map(str, parts)), cells=cells, path=path, to=to, viscous=viscous)


def langer_box(scene, cells, edge, increments):
    config, solution = (folder / f"box.{ending}" for ending in ("yaml", "h5"))
    config.write_text(box_config(scene, cells, edge, increments))
    command = [programs / "langer-solve", config.resolve(), "-o", solution.resolve(), "--quiet", "--json"]
    cpu, memory, code, said = measured(command, root, folder / "langer.log")
    if code:
        return cpu, memory, {"words": ended(cpu, code, said)}
    column = "{quantity: u_y, at: apex}" if scene == "suction" else "{quantity: reaction_x, at: x_max}"
    post = folder / "box_post.yaml"
    post.write_text(f"columns: [{column}]\n")
    call(programs / "langer-post", post.resolve(), "--solution", solution.resolve(), "-o", (folder / "box_post.h5").resolve())
    value = float(list(csv.reader(open(folder / "box_post.csv")))[-1][0])
    return cpu, memory, {"force": abs(value), "penetration": 0.0}


def fenicsx_box(scene, edge, increments):
    cpu, memory, code, said = measured([PYTHON, here / "fenicsx_box.py", scene, edge, increments], here, folder / "fenicsx_box.log")
    return cpu, memory, said_json(cpu, code, said)


def box(scene, runs, peers):
    """runs of Langer: cells, edge, increments; of FEniCSx: edge, increments"""
    for cells, edge, steps in runs:
        record(scene, "Langer", cells, edge, f"{steps} increments", lambda: langer_box(scene, cells, edge, steps))
    if "FEniCSx" in TOOLS and subprocess.run([PYTHON, "-c", "import dolfinx"], capture_output=True).returncode == 0:
        fenicsx_box(scene, max(edge for edge, _ in peers), peers[0][1])  # compiles its kernels: not counted
        for edge, steps in peers:
            record(scene, "FEniCSx", "Q2/P1", edge, f"{steps} increments d=1e-06", lambda: fenicsx_box(scene, edge, steps))


# CalculiX

def last_total(text, name):
    found = re.findall(r"total force.*?set %s .*?\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)" % re.escape(name.upper()), text)
    return [float(x) for x in found[-1]] if found else None


def calculix(scene, edge, increments, d, stiffness, cells="hex27"):
    import scene as peers
    import numpy as np

    deck = deck_of(scene, cells, edge, increments, d)
    text = re.sub(r"(PRESSURE-OVERCLOSURE=LINEAR\n)\S+", rf"\g<1>{stiffness:g}", deck.read_text())
    job = folder / "calculix.inp"
    job.write_text(text)
    for old in ("dat", "sta", "frd"):
        job.with_suffix("." + old).unlink(missing_ok=True)
    cpu, memory, code, said = measured(["ccx", "-i", "calculix"], folder, folder / "calculix.log")
    steps = job.with_suffix(".sta").read_text().splitlines() if job.with_suffix(".sta").exists() else []
    reached = [line.split() for line in steps if re.match(r"\s+\d+\s+\d+\s+\d+\s+\d+\s", line)]
    unknowns = re.search(r"number of equations\s+(\d+)", said)
    result = {"unknowns": int(unknowns[1]) if unknowns else ""}
    if code or not reached or float(reached[-1][5]) < 1 - 1e-9:
        t = reached[-1][5] if reached else "0"
        why = f"not done after {LIMIT:g} s" if cpu > LIMIT - 2 or code == -signal.SIGXCPU else "stalls"
        return cpu, memory, {**result, "words": f"{why} at t = {float(t):.3g}"}
    out = job.with_suffix(".dat").read_text()
    scene_of = peers.read_deck(job)
    result["force"] = abs(scene_of.share * last_total(out, "RIGID_sphere")[1])
    moved = {}
    for line in re.split(r"displacements .*?set CONTACT.*\n", out)[-1].splitlines()[1:]:
        values = line.split()
        if len(values) == 4 and values[0].isdigit():
            moved[int(values[0])] = [float(x) for x in values[1:]]
        elif moved:
            break
    nodes = [line.split(",") for line in text.split("*ELEMENT")[0].splitlines() if re.match(r"\d+,", line)]
    places = {int(c[0]): [float(x) for x in c[1:]] for c in nodes}
    x = np.array([np.array(places[n]) + u for n, u in moved.items()])
    result["penetration"] = peers.penetration(scene_of, x, 1.0)
    return cpu, memory, result


# the Python ones

def script(name, scene, edge, increments, d, *settings):
    deck = deck_of(scene, "hex8", edge, increments, d)
    order = [d, *settings, increments]
    cpu, memory, code, said = measured([PYTHON, here / name, deck, scene, *order], here, folder / f"{name}.log")
    return cpu, memory, said_json(cpu, code, said)


# FEBio: the force it logs; nothing here where febio4 is not on the PATH

def febio(scene, cells, edge, increments, d):
    deck = deck_of(scene, cells, edge, increments, d, "feb")
    cpu, memory, code, said = measured(["febio4", "-i", deck.name], folder, folder / "febio.log")
    file = folder / "sphere_force.csv"
    if code or "N O R M A L" not in said or not file.exists():
        return cpu, memory, {"words": ended(cpu, code, said)}
    last = [line for line in file.read_text().splitlines() if line and not line.startswith("*")][-1].split(",")
    share = re.search(r"forces here are 1/(\S+) of", deck.read_text())
    return cpu, memory, {"force": abs(float(last[-2]) * (float(share[1]) if share else 1)), "penetration": float("nan")}


def isotropic():
    s = "isotropic"
    for edge, steps in [(0.8, 1), (0.8, 2), (0.8, 4), (0.5, 2), (0.5, 4), (0.3536, 4), (0.25, 5), (0.1768, 5)]:
        record(s, "Langer", "hex27", edge, f"{steps} increments", lambda: langer(s, "hex27", edge, steps))
    for edge, steps in [(0.35, 4), (0.25, 4), (0.175, 4), (0.15, 4), (0.125, 4), (0.1, 4)]:
        record(s, "Langer", "hex8", edge, f"{steps} increments", lambda: langer(s, "hex8", edge, steps))
    if "CalculiX" in TOOLS and shutil.which("ccx"):
        for d in (1e-2, 1e-3):
            for edge in (0.8, 0.5, 0.3536, 0.25, 0.1768):
                record(s, "CalculiX", "C3D20R", edge, f"5 increments d={d:g} penalty 540", lambda: calculix(s, edge, 5, d, 540))
        for edge in (0.5, 0.3536, 0.25):
            record(s, "CalculiX", "C3D20R", edge, "5 increments d=0.01 penalty 5400", lambda: calculix(s, edge, 5, 1e-2, 5400))
        record(s, "CalculiX", "C3D20R", 0.5, "10 increments d=1e-06 penalty 540", lambda: calculix(s, 0.5, 10, 1e-6, 540))
        for d in (1e-2, 1e-6):
            record(s, "CalculiX", "C3D8", 0.35, f"10 increments d={d:g} penalty 540", lambda: calculix(s, 0.35, 10, d, 540, "hex8"))
    if "FEniCSx" in TOOLS and subprocess.run([PYTHON, "-c", "import dolfinx"], capture_output=True).returncode == 0:
        script("fenicsx.py", s, 0.8, 4, 1e-6, 1e3)  # compiles its kernels, which are kept: not counted
        for edge in (0.8, 0.5, 0.3536, 0.25, 0.1768):
            for steps, penalty in [(4, 1e3), (4, 3e3), (4, 1e4)] if edge < 0.8 else [(2, 1e3), (4, 3e3), (4, 1e4)]:
                record(s, "FEniCSx", "Q2/P1", edge, f"{steps} increments d=1e-06 penalty {penalty:g}",
                       lambda: script("fenicsx.py", s, edge, steps, 1e-6, penalty))
    if "GetFEM" in TOOLS and subprocess.run([PYTHON, "-c", "import getfem"], capture_output=True).returncode == 0:
        for edge in (0.8, 0.5, 0.3536, 0.25):
            record(s, "GetFEM", "Q2/Q1", edge, "4 increments d=1e-06 penalty 1000",
                   lambda: script("getfem_.py", s, edge, 4, 1e-6, "q2", 1e3))
        record(s, "GetFEM", "Q2/Q1", 0.5, "10 increments d=1e-06 penalty 10000",
                   lambda: script("getfem_.py", s, 0.5, 10, 1e-6, "q2", 1e4))
        record(s, "GetFEM", "Q2/Q1", 0.5, "10 increments d=1e-06 augmented",
                   lambda: script("getfem_.py", s, 0.5, 10, 1e-6, "q2", "augmented"))
        for edge in (0.35, 0.25, 0.175, 0.125):
            record(s, "GetFEM", "Q1/P0", edge, "4 increments d=1e-06 penalty 1000",
                   lambda: script("getfem_.py", s, edge, 4, 1e-6, "q1", 1e3))
    if "FEBio" in TOOLS and shutil.which("febio4"):
        for cells, edge in [("hex8", 0.35), ("hex8", 0.25), ("hex8", 0.175), ("hex27", 0.5)]:
            record(s, "FEBio", cells, edge, "10 increments d=0.001", lambda: febio(s, cells, edge, 10, 1e-3))


def positive():
    """c1 = +0.317, fibres at 30 degrees, friction 0.34: no mirror plane, so that the peers take the whole body"""
    s = "positive"
    for cells, edge, steps in [("hex27", 0.8, 4), ("hex27", 0.5, 4), ("hex27", 0.5, 10), ("hex27", 0.3536, 10),
                               ("hex8", 0.25, 10), ("hex8", 0.15, 10), ("hex8", 0.1, 10)]:
        record(s, "Langer", cells, edge, f"{steps} increments", lambda: langer(s, cells, edge, steps))
    if "CalculiX" in TOOLS and shutil.which("ccx"):
        none = float("nan"), float("nan"), {"words": "has no such law: fibres want a neo-Hookean matrix"}
        record(s, "CalculiX", "C3D20R", 0.8, "", lambda: none)
    if "FEniCSx" in TOOLS and subprocess.run([PYTHON, "-c", "import dolfinx"], capture_output=True).returncode == 0:
        script("fenicsx.py", s, 0.8, 1, 1e-6, 1e3)
        for edge, penalty in [(0.8, 1e3), (0.8, 1e4), (0.5, 1e3), (0.5, 1e4), (0.3536, 1e3)]:
            record(s, "FEniCSx", "Q2/P1", edge, f"10 increments d=1e-06 penalty {penalty:g}",
                   lambda: script("fenicsx.py", s, edge, 10, 1e-6, penalty))
    if "GetFEM" in TOOLS and subprocess.run([PYTHON, "-c", "import getfem"], capture_output=True).returncode == 0:
        for edge in (0.8, 0.5):
            record(s, "GetFEM", "Q2/Q1", edge, "10 increments d=1e-06 penalty 1000",
                   lambda: script("getfem_.py", s, edge, 10, 1e-6, "q2", 1e3))
    if "FEBio" in TOOLS and shutil.which("febio4"):
        record(s, "FEBio", "hex8", 0.25, "10 increments d=0.001", lambda: febio(s, "hex8", 0.25, 10, 1e-3))


def strip():
    """a clamped strip with fibres at 45 degrees, pulled by a fifth"""
    box("strip", [("hex27", 2.5, 2), ("hex27", 1.25, 2), ("hex27", 1, 2), ("hex27", 0.625, 2), ("hex27", 0.5, 2), ("hex27", 0.5, 4), ("hex27", 0.3333, 4),
                  ("hex8", 0.5, 2), ("hex8", 0.25, 2)],
        [(2.5, 2), (1.25, 2), (1, 2), (0.625, 2), (0.5, 2), (0.5, 4)])


def suction():
    """soft isotropic skin sucked into a square hole of 4 mm"""
    box("suction", [("hex27", 1, 3), ("hex27", 1, 5), ("hex27", 0.6667, 3), ("hex27", 0.6667, 5), ("hex27", 0.5, 5), ("hex27", 0.3333, 5), ("hex8", 0.5, 5),
                    ("hex8", 0.4, 3), ("hex8", 0.3333, 3), ("hex8", 0.3333, 5), ("hex8", 0.25, 5)],
        [(1, 3), (1, 5), (0.6667, 2), (0.6667, 3), (0.6667, 5), (0.5, 3), (0.5, 5)])


def hold():
    """the strip with two viscous branches, pulled in 1 s and held for 10 s"""
    box("hold", [("hex27", 2.5, 16), ("hex27", 1.25, 16), ("hex27", 1, 16), ("hex27", 1, 64), ("hex27", 0.5, 32), ("hex27", 0.5, 64)],
        [(2.5, 16), (1.25, 16), (1, 16), (1, 32), (1, 64), (0.5, 32)])


for scene in scenes:
    {"isotropic": isotropic, "positive": positive, "strip": strip, "suction": suction, "hold": hold}[scene]()
