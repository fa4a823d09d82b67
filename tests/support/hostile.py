"""Hostile folders, each read by a program of Langer under strace.

  python3 tests/support/hostile.py FOLDER_OF_THE_PROGRAMS SCRATCH_FOLDER [WORDS OF A NAME]

A row is a folder that somebody might send: a mesh with a script in it, a run whose Makefile names other people's files, a link in the
place of an output, a pipe instead of a table. The rules are the same for all of them:
  - the program starts no other program (figures: gnuplot, which gets no words of the files as commands);
  - it opens nothing for writing outside of out/, the folder of its output, nor renames anything there;
  - every file outside of out/ is afterwards what it was before, and there are no new ones;
  - it ends with 2 or 3 (a bad config, a bad input) within 10 s. Rows whose folder is harmless once the trick fails end with 0.
"""

import hashlib
import os
import re
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

PATIENCE = 10 if os.environ.get("SANITIZED", "") in ("", "OFF", "0") else 60  # s
rows = []  # (name, function that fills the folder and returns the command, exit codes, programs that it may start, words it must say)


def row(name, exits=(2, 3), starts=(), says=""):
    def add(make):
        rows.append((name, make, exits, starts, says))
        return make
    return add


# ---- what sound folders hold, from which the hostile ones are made ------------------------------------------------------------------

BLOCK = "geometry: {block: {size: [2, 2, 2], divisions: [2, 2, 2]}}\n"
MATERIAL = "matrix: {yeoh: {a1: 0.02, a2: 0.02}}\nvolume: {quadratic: {d: 1.0e-1}}\n"
SOLVE = """material: {include: material.yaml}
supports: [{on: y_min, hold: [x, y, z]}]
loads: [{on: y_max, displacement: {y: 0.1}}]
path: {steps: 1}
"""
POST = """columns:
  - {quantity: eps_yy, at: y_max, name: strain}
  - {quantity: reaction_y, at: y_max, name: force}
"""
FIGURE = "figures: {force: {x: strain, y: [force]}}\n"
FIT = """data: [{file: pull.csv, strain: engineering}]
law: {matrix: {yeoh: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}
parameters: [{key: matrix.yeoh.a1, lower: 0, upper: 1}]
"""
PULL = "strain,nominal_stress_MPa\n0,0\n0.1,0.02\n0.2,0.05\n0.3,0.09\n0.4,0.16\n"
SCRIPT = 'SystemCall "touch pwned";\n'
bin_folder = Path()
sound = Path()  # solved once: mesh.h5, solution.h5, curves.h5, m.h5 and the finished run crate/


def program(name):
    return str(bin_folder / name)


def call(*command, cwd):
    done = subprocess.run(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"a sound folder fails: {' '.join(map(str, command))}\n{done.stdout}")


def write(folder, **files):
    """name_ending="text": name.ending"""
    for name, text in files.items():
        (folder / re.sub(r"_([a-z0-9]+)$", r".\1", name)).write_text(text)


def make_sound():
    sound.mkdir()
    write(sound, mesh_yaml=BLOCK, material_yaml=MATERIAL, solve_yaml=SOLVE, post_yaml=POST, fit_yaml=FIT, pull_csv=PULL)
    call(program("langer-mesh"), "mesh.yaml", "-o", "mesh.h5", cwd=sound)
    call(program("langer-solve"), "solve.yaml", "--mesh", "mesh.h5", "-o", "solution.h5", cwd=sound)
    call(program("langer-post"), "post.yaml", "--solution", "solution.h5", "-o", "curves.h5", cwd=sound)
    call(program("langer-fit"), "fit.yaml", "-o", "m.h5", cwd=sound)
    project = sound / "project"
    project.mkdir()
    write(project, fit_yaml=FIT, pull_csv=PULL, mesh_yaml=BLOCK,
          p_yaml="pipeline: p\nnodes:\n  mesh: {stage: mesh, config: mesh.yaml}\n  fit: {stage: fit, config: fit.yaml}\n")
    call(program("langer-plan"), "p.yaml", cwd=project)
    call("make", "-C", "runs/p", cwd=project)


def copy(folder, *names):
    for name in names:
        (shutil.copytree if (sound / name).is_dir() else shutil.copy2)(sound / name, folder / name)


def link(folder, name, to="../victim.txt"):
    place = folder / name
    place.parent.mkdir(parents=True, exist_ok=True)
    place.symlink_to(to)


# ---- meshes -------------------------------------------------------------------------------------------------------------------------

NODES = "".join(f"{i + 1} {i % 2} {i // 2 % 2} {i // 4}\n" for i in range(8))
MSH = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n" + NODES + "$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 4 3 5 6 8 7\n$EndElements\n"
FACET = "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n"
CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))  # seen from outside, counter-clockwise
HALVES = [half for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
STL = "solid s\n" + "".join(FACET.format("".join("vertex {} {} {}\n".format(*CUBE[k]) for k in half)) for half in HALVES) + "endsolid s\n"


def mesh_row(name, file, content=None, more="", **kinds):
    """A mesh config that names `file`; `content` is a text, bytes, or a function that puts something else there."""
    @row("mesh: " + name, **kinds)
    def _(folder):
        (folder / "mesh.yaml").write_text('geometry: {file: {path: "%s"%s}}\n' % (file.replace("\\", "\\\\").replace('"', '\\"'), more))
        if callable(content):
            content(folder / file)
        elif isinstance(content, bytes):
            (folder / file).write_bytes(content)
        elif content is not None:
            (folder / file).write_text(content)
        return [program("langer-mesh"), "mesh.yaml", "-o", "out/mesh.h5"]


def beside(content, script):
    def put(path):
        path.write_text(content)
        Path(str(path) + ".opt").write_text(script)
        path.with_suffix(".opt").write_text(script)
        (path.parent / ".gmshrc").write_text(script)
        (path.parent / ".gmsh-options").write_text(script)
    return put


mesh_row("a script instead of $MeshFormat", "m.msh", "// a mesh\n" + SCRIPT)
mesh_row("a script before $MeshFormat", "m.msh", SCRIPT + MSH)
mesh_row("a script behind the mesh", "m.msh", MSH + SCRIPT, exits=(0, 2, 3))
mesh_row("options beside the mesh", "m.msh", beside(MSH, SCRIPT), exits=(0, 2, 3))
mesh_row("options beside a surface", "m.stl", beside(STL, SCRIPT), ", edge: 0.5", exits=(0, 2, 3))
mesh_row("a script with the name of a surface", "m.stl", SCRIPT, ", edge: 1")
mesh_row("a script of gmsh", "m.geo", SCRIPT + "Point(1) = {0, 0, 0};\n", ", edge: 1")
mesh_row("a script with the name of a solid", "m.step", SCRIPT, ", edge: 1")
mesh_row("a script with the name of a boundary representation", "m.brep", SCRIPT, ", edge: 1")
mesh_row("node 2147483648", "m.msh", MSH.replace("5 6 8 7\n", "5 6 8 2147483648\n"))
mesh_row("node -1", "m.msh", MSH.replace("5 6 8 7\n", "5 6 8 -1\n"))
mesh_row("more nodes than fit a memory", "m.msh", MSH.replace("$Nodes\n8\n", "$Nodes\n999999999999\n"))
mesh_row("a binary surface of 4 billion triangles", "m.stl", bytes(80) + b"\xff\xff\xff\xff" + bytes(50), ", edge: 1")
mesh_row("a pipe", "m.msh", lambda path: os.mkfifo(path))
mesh_row("a pipe as a surface", "m.stl", lambda path: os.mkfifo(path), ", edge: 1")
mesh_row("a pipe for Abaqus", "m.inp", lambda path: os.mkfifo(path))
mesh_row("a folder", "m.msh", lambda path: path.mkdir())
mesh_row("a device without end", "m.msh", lambda path: path.symlink_to("/dev/zero"))
mesh_row("a file of passwords", "m.inp", lambda path: path.symlink_to("/etc/passwd"))
mesh_row("an Abaqus mesh that includes a file of passwords", "m.inp", "*INCLUDE, INPUT=/etc/passwd\n")
mesh_row("an Abaqus mesh that includes itself", "m.inp", "*INCLUDE, INPUT=m.inp\n")
mesh_row("an Abaqus mesh that includes a pipe", "m.inp", lambda path: (path.write_text("*INCLUDE, INPUT=p.inp\n"), os.mkfifo(path.parent / "p.inp")))
mesh_row("a name that a shell would run", "$(touch pwned)`touch pwned`;touch pwned.msh", SCRIPT)


# ---- configs ------------------------------------------------------------------------------------------------------------------------

def config_row(name, text, more=lambda folder: None, **kinds):
    @row("config: " + name, **kinds)
    def _(folder):
        (folder / "mesh.yaml").write_text(text) if text is not None else None
        more(folder)
        return [program("langer-mesh"), "mesh.yaml", "-o", "out/mesh.h5"]


LAUGHS = "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}' if i else 'ha'] * 9)}]\n" for i in range(12))
config_row("a billion laughs", LAUGHS)
config_row("an anchor inside itself", "geometry: &a {block: *a}\n")
config_row("an include of itself", "include: mesh.yaml\n", says="includes itself")
config_row("an include in a circle", "include: b.yaml\n", lambda f: write(f, b_yaml="include: mesh.yaml\n"), says="includes itself")
config_row("an include that doubles 40 times", "include: i0.yaml\n",
           lambda f: [write(f, **{f"i{k}_yaml": f"a{k}: {{include: i{k + 1}.yaml}}\nb{k}: {{include: i{k + 1}.yaml}}\n"}) for k in range(40)])
config_row("an include of a device without end", "include: /dev/zero\n")
config_row("an include of a pipe", "include: p.yaml\n", lambda f: os.mkfifo(f / "p.yaml"))
config_row("an include of a folder", "include: d.yaml\n", lambda f: (f / "d.yaml").mkdir())
config_row("an include of a file of passwords", "include: /etc/passwd\n")
config_row("a pipe", None, lambda f: os.mkfifo(f / "mesh.yaml"), says="this is a pipe")
config_row("a device without end", None, lambda f: link(f, "mesh.yaml", "/dev/zero"), says="this is a device")
config_row("100 000 brackets", "a: " + "[" * 100000)
config_row("a sparse file of 50 GB", None, lambda f: os.truncate(os.open(f / "mesh.yaml", os.O_CREAT | os.O_WRONLY), 50 << 30))
config_row("a tag of another language", "geometry: !!python/object/apply:os.system ['touch pwned']\n")
config_row("a name that moves the cursor", 'sets: {"a\\e[2Jb\\n": {}}\n' + BLOCK)


@row("config: a value of --set that a shell would run")
def _(folder):
    write(folder, mesh_yaml=BLOCK)
    return [program("langer-mesh"), "mesh.yaml", "-o", "out/mesh.h5", "--set", "geometry.block.size=$(touch pwned)`touch pwned`"]


# ---- tables -------------------------------------------------------------------------------------------------------------------------

def table_row(name, put, **kinds):
    @row("table: " + name, **kinds)
    def _(folder):
        write(folder, fit_yaml=FIT)
        put(folder / "pull.csv")
        return [program("langer-fit"), "fit.yaml", "-o", "out/m.h5"]


def sparse(path, size):
    with open(path, "wb") as file:
        file.truncate(size)


table_row("a pipe", lambda path: os.mkfifo(path), says="this is a pipe")
table_row("a folder", lambda path: path.mkdir(), says="this is a folder")
table_row("a device without end", lambda path: path.symlink_to("/dev/zero"), says="this is a device")
table_row("a socket", lambda path: bind(path), says="this is a socket")
table_row("a sparse file of 500 GB", lambda path: sparse(path, 500 << 30), says="memory")
table_row("a file of passwords", lambda path: path.symlink_to("/etc/passwd"))
table_row("one line of 8 MB", lambda path: path.write_text("strain,stress_MPa\n" + "1," * 4000000))
table_row("bytes of zero", lambda path: path.write_bytes(PULL.encode() + bytes(1000)))
table_row("a link in a circle", lambda path: path.symlink_to("pull.csv"))
table_row("a header that is a pipe", lambda path: (path.write_text("0,0\n1,1\n"), os.mkfifo(path.with_suffix(".yaml"))))
table_row("a header that includes itself", lambda path: (path.write_text(PULL), path.with_suffix(".yaml").write_text("include: pull.yaml\n")))


def bind(path):
    """A socket; the name of one may have 108 letters at most, so it is bound from within its folder."""
    before = os.getcwd()
    os.chdir(path.parent)
    socket.socket(socket.AF_UNIX).bind(path.name)
    os.chdir(before)


# ---- HDF5 ---------------------------------------------------------------------------------------------------------------------------

def h5_row(name, change, command=("langer-solve", "solve.yaml", "--mesh", "mesh.h5", "-o", "out/solution.h5"), file="mesh.h5", **kinds):
    @row("hdf5: " + name, **kinds)
    def _(folder):
        copy(folder, "solve.yaml", "post.yaml", "material.yaml", "mesh.h5", "solution.h5", "curves.h5", "m.h5")
        (folder / "gather.yaml").write_text("columns: [force]\n")
        (folder / "report.yaml").write_text("title: a page\n")
        change(folder / file)
        return [program(command[0]), *command[1:]]


def hostile(kind, path="/VTKHDF/Points", target=""):
    def change(file):
        call(program("langer-hostile-h5"), sound / file.name, file, kind, path, target, cwd=file.parent)
    return change


def cut(file):
    data = file.read_bytes()
    file.write_bytes(data[:len(data) // 2])


def flip(file):
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


POST_COMMAND = ("langer-post", "post.yaml", "--solution", "solution.h5", "-o", "out/curves.h5")
h5_row("half of a mesh", cut)
h5_row("one flipped bit", flip, says="damaged")
h5_row("a mesh whose points are a link into another file", hostile("external_link", target="solution.h5"), says="another file")
h5_row("a mesh whose points are a link to a file of passwords", hostile("external_link", target="/etc/passwd"))
h5_row("a mesh whose points are a link to themselves", hostile("soft_cycle"))
h5_row("a mesh whose points are a link to nothing", hostile("soft_link", target="/nowhere"))
h5_row("a mesh whose points are the root of the file", hostile("group_cycle"))
h5_row("a mesh whose points are a file of passwords", hostile("external_storage", target="/etc/passwd"), says="another file")
h5_row("a mesh whose points are those of another file", hostile("virtual", target="solution.h5"), says="another file")
h5_row("a mesh of a trillion points", hostile("huge"))
h5_row("a mesh whose points are a text", hostile("text"))
h5_row("a solution of which half is there", cut, POST_COMMAND, "solution.h5")
h5_row("a solution with a history in another file", hostile("external_storage", "/history/t", "/etc/passwd"), POST_COMMAND, "solution.h5")
h5_row("a solution with displacements that lead elsewhere", hostile("external_link", "/VTKHDF/PointData/u", "/etc/passwd"), POST_COMMAND,
       "solution.h5")
h5_row("a file that is shown with a circle of groups", hostile("group_cycle", "/summary"), ("langer", "show", "curves.h5"), "curves.h5",
       exits=(0, 2, 3))
h5_row("curves that lead elsewhere, gathered", hostile("external_link", "/columns/force", "/etc/passwd"),
       ("langer-gather", "gather.yaml", "--curves", "curves.h5", "-o", "out/sweep.h5"), "curves.h5", exits=(0, 2, 3))
h5_row("curves that lead elsewhere, on a page", hostile("external_storage", "/columns/force", "/etc/passwd"),
       ("langer-report", "report.yaml", "--curves", "curves.h5", "-o", "out/report.html"), "curves.h5")
h5_row("a text with the name of a mesh", lambda file: file.write_text("no HDF5"))


# ---- outputs that are links ---------------------------------------------------------------------------------------------------------

def output_row(name, entry, command, starts=(), make=link, **kinds):
    @row("output: " + name, starts=starts, **kinds)
    def _(folder):
        copy(folder, "mesh.yaml", "solve.yaml", "material.yaml", "fit.yaml", "pull.csv", "mesh.h5", "solution.h5", "curves.h5")
        (folder / "post.yaml").write_text(POST + FIGURE + "snapshots: [last]\nseries: true\n")
        (folder / "gather.yaml").write_text("columns: [force]\n")
        (folder / "report.yaml").write_text("title: a page\n")
        make(folder, "out/" + entry)
        return [program(command[0]), *command[1:]]


MESH = ("langer-mesh", "mesh.yaml", "-o", "out/mesh.h5")
SOLVE_COMMAND = ("langer-solve", "solve.yaml", "--mesh", "mesh.h5", "-o", "out/solution.h5")
FIT_COMMAND = ("langer-fit", "fit.yaml", "-o", "out/m.h5")
GATHER = ("langer-gather", "gather.yaml", "--curves", "curves.h5", "-o", "out/sweep.h5")
REPORT = ("langer-report", "report.yaml", "--curves", "curves.h5", "-o", "out/report.html")
for what, entry, command in (
        ("mesh.h5", "mesh.h5", MESH), ("mesh.h5.part", "mesh.h5.part", MESH), ("mesh.h5.lock", "mesh.h5.lock", MESH),
        ("solution.h5.part", "solution.h5.part", SOLVE_COMMAND), ("solution.h5.steps", "solution.h5.steps", SOLVE_COMMAND),
        ("solution.xdmf.part", "solution.xdmf.part", SOLVE_COMMAND),
        ("curves.csv", "curves.csv", POST_COMMAND), ("curves.csv.part", "curves.csv.part", POST_COMMAND),
        ("a script of gnuplot", "force.gp.part", POST_COMMAND), ("a picture", "force.svg", POST_COMMAND),
        ("a snapshot", "snapshot_0001.hdf.part", POST_COMMAND),
        ("parameters.csv", "parameters.csv", FIT_COMMAND), ("a card", "abaqus.inp.part", FIT_COMMAND),
        ("m.h5.part", "m.h5.part", FIT_COMMAND), ("table.csv.part", "table.csv.part", GATHER), ("report.html.part", "report.html.part", REPORT),
        ("a log", "mesh.log", MESH + ("--log", "out/mesh.log")),
        ("a deck", "scene.inp", ("langer-post", "--solution", "solution.h5", "--export", "out/scene.inp")),
        ("a deck.part", "scene.feb.part", ("langer-post", "--solution", "solution.h5", "--export", "out/scene.feb"))):
    output_row("a link for " + what, entry, command, says="is a link to")
output_row("a link to a folder for the series", "series", POST_COMMAND, make=lambda f, name: link(f, name, "../home"), says="is a link to")
output_row("a pipe for a log", "mesh.log", MESH + ("--log", "out/mesh.log"), make=lambda f, name: ((f / "out").mkdir(), os.mkfifo(f / name)))
output_row("a pipe for a lock", "mesh.h5.lock", MESH, make=lambda f, name: ((f / "out").mkdir(), os.mkfifo(f / name)))
output_row("a hard link for a lock", "mesh.h5.lock", MESH, make=lambda f, name: ((f / "out").mkdir(), os.link(f / "victim.txt", f / name)))
output_row("a hard link for a part", "mesh.h5.part", MESH, exits=(0,), make=lambda f, name: ((f / "out").mkdir(), os.link(f / "victim.txt", f / name)))


@row("output: a figure whose words are commands of gnuplot", exits=(0,), starts=("gnuplot",))
def _(folder):
    copy(folder, "solution.h5")
    words = "`touch pwned` '.system('touch pwned').' \\\"; system \\\"touch pwned\\\"\\n!touch pwned\\nset output '|touch pwned'"
    (folder / "post.yaml").write_text(POST + f'figures: {{force: {{title: "{words}", x: strain, y: [force], x_label: "{words}"}}}}\n')
    return [program("langer-post"), "post.yaml", "--solution", "solution.h5", "-o", "out/curves.h5"]


# ---- pipelines ----------------------------------------------------------------------------------------------------------------------

def plan_row(name, text="pipeline: p\nnodes: {mesh: {stage: mesh, config: mesh.yaml}}\n", file="p.yaml", more=lambda folder: None, extra=(),
             folder_name="out/run", **kinds):
    @row("pipeline: " + name, **kinds)
    def _(folder):
        write(folder, mesh_yaml=BLOCK, fit_yaml=FIT, pull_csv=PULL)
        (folder / file).write_text(text)
        more(folder)
        return [program("langer-plan"), file, "-o", folder_name, "--snakemake", "--slurm", *extra]


EVIL = "$(shell touch pwned)"
NODE = "pipeline: p\nnodes: {mesh: {stage: mesh, config: mesh.yaml%s}}\n"
plan_row("a line break in its file's name", file="pl\nevil:\n\ttouch PWN.yaml", says="control character")
plan_row("a carriage return in its file's name", file="pl\revil.yaml", says="control character")
plan_row("a line break in the run's folder", folder_name="out/a\nevil:\n\ttouch pwned", says="control character")
plan_row("a command in its file's name", file="`touch pwned`$(touch pwned);#.yaml", exits=(0, 3))
for key in ("../../home/x", "a;touch pwned", "`touch pwned`", EVIL, "a\\nevil:", ""):
    plan_row(f"called {key}", f'pipeline: "{key}"\nnodes: {{mesh: {{stage: mesh, config: mesh.yaml}}}}\n')
    plan_row(f"with a node called {key}", f'pipeline: p\nnodes: {{"{key}": {{stage: mesh, config: mesh.yaml}}}}\n')
    plan_row(f"with a value {key}", NODE % f', sweep: {{size: {{key: geometry.block.size, values: ["{key}", b]}}}}')
    plan_row(f"with a variant {key}", NODE % f', sweep: {{size: {{variants: {{"{key}": {{}}}}}}}}')
    plan_row(f"with a config {key}.yaml", f'pipeline: p\nnodes: {{mesh: {{stage: mesh, config: "{key}.yaml"}}}}\n')
plan_row("with a stage that is a command", f'pipeline: p\nnodes: {{mesh: {{stage: "{EVIL}", config: mesh.yaml}}}}\n')
plan_row("with data in a folder that make would run", "pipeline: p\nnodes: {fit: {stage: fit, config: fit.yaml}}\n",
         more=lambda f: ((f / EVIL).mkdir(), (f / EVIL / "pull.csv").write_text(PULL), (f / "fit.yaml").write_text(FIT.replace("pull.csv", f'"{EVIL}/pull.csv"'))))
plan_row("with a port that is a pipe", "pipeline: p\nnodes: {solve: {stage: solve, config: {path: {steps: 1}}, mesh: ./m.h5}}\n", more=lambda f: os.mkfifo(f / "m.h5"))
plan_row("with a port that is a file of passwords", "pipeline: p\nnodes: {solve: {stage: solve, config: {path: {steps: 1}}, mesh: /etc/passwd}}\n")
plan_row("with --set to a command", extra=("--set", f"mesh.body={EVIL}\nevil:"))
plan_row("into a run whose Makefile is a link", more=lambda f: link(f, "out/run/Makefile", "../../victim.txt"), says="is a link to")
plan_row("into a run whose Makefile.part is a link", more=lambda f: link(f, "out/run/Makefile.part", "../../victim.txt"), says="is a link to")
plan_row("into a run whose Snakefile is a link", more=lambda f: link(f, "out/run/Snakefile", "../../victim.txt"), says="is a link to")
plan_row("into a run one of whose folders is a link", more=lambda f: link(f, "out/run/mesh", "../../home"), says="is a link to")
plan_row("into a run one of whose configs is a link", more=lambda f: link(f, "out/run/mesh/mesh.yaml", "../../../victim.txt"), says="is a link to")


# ---- runs ---------------------------------------------------------------------------------------------------------------------------

def run_row(name, change, command=("langer", "crate", "out/runs/p"), **kinds):
    """A finished run in out/, with data in out/ too; secret.txt and home/ lie outside of it."""
    @row("run: " + name, **kinds)
    def _(folder):
        shutil.copytree(sound / "project", folder / "out", symlinks=True)
        change(folder / "out" / "runs" / "p")
        asks_root = command[1] == "crate" and "--root" not in command
        return [program(command[0]), *command[1:], *(("--root", "out") if asks_root else ())]


def edited(text_before, text_after):
    def change(run):
        for name in ("Makefile", "mesh/mesh.yaml"):
            path = run / name
            status = path.stat()
            path.write_text(path.read_text().replace(text_before, text_after))
            os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
    return change


MESH_RULE = "mesh/mesh.h5: mesh/mesh.yaml"
run_row("a crate of a run that is as it was made", lambda run: None, exits=(0,), says="copied out/runs/p/inputs.d/up2/pull.csv")
run_row("a Makefile that depends on a secret", edited(MESH_RULE, MESH_RULE + " ../../../secret.txt"), says="which no config of this run names")
run_row("a Makefile that depends on a secret by a detour", edited(MESH_RULE, MESH_RULE + " ../q/../../../secret.txt"))
run_row("a Makefile that depends on an absolute path", edited(MESH_RULE, MESH_RULE + " /etc/hostname"))
run_row("a Makefile that makes a file elsewhere", edited(MESH_RULE, "../../../home/mesh.h5: mesh/mesh.yaml"))
run_row("a Makefile that makes a file elsewhere, its times", edited(MESH_RULE, "../../../home/mesh.h5: mesh/mesh.yaml"), ("langer", "times", "out/runs/p"))
run_row("a Makefile whose config lies elsewhere", edited(MESH_RULE, "mesh/mesh.h5: ../../../secret.txt"), ("langer", "explain", "out/runs/p"))
run_row("a Makefile with an unknown stage", edited("langer-mesh", "langer-nothing"), ("langer", "explain", "out/runs/p"))
run_row("a Makefile with a rule without a config", edited(MESH_RULE + " ", "mesh/mesh.h5: "), ("langer", "explain", "out/runs/p"))
run_row("a Makefile that is a pipe", lambda run: ((run / "Makefile").unlink(), os.mkfifo(run / "Makefile")), ("langer", "times", "out/runs/p"))
run_row("a log that is a pipe", lambda run: ((run / "mesh/mesh.log").unlink(), os.mkfifo(run / "mesh/mesh.log")), ("langer", "times", "out/runs/p"), exits=(0, 3))
run_row("a link to a secret in the run", lambda run: link(run, "secret.csv", "../../../secret.txt"), says="is a link to")
run_row("data that are a link to a secret", lambda run: ((run.parents[1] / "pull.csv").unlink(), link(run.parents[1], "pull.csv", "../secret.txt")))
run_row("data in a folder that is a link", lambda run: in_linked_folder(run))
run_row("metadata that are a link", lambda run: link(run, "ro-crate-metadata.json", "../../../victim.txt"), says="is a link to")
run_row("metadata whose .part is a link", lambda run: link(run, "ro-crate-metadata.json.part", "../../../victim.txt"), says="is a link to")
run_row("a script whose .part is a link", lambda run: link(run, "reproduce.part", "../../../victim.txt"), says="is a link to")
run_row("a folder of inputs that is a link", lambda run: link(run, "inputs.d", "../../../home"), says="is a link to")
run_row("a copy whose place is a link", lambda run: link(run, "inputs.d/up2/pull.csv", "../../../../../victim.txt"), says="is a link to")
run_row("data outside of the root", lambda run: None, ("langer", "crate", "out/runs/p", "--root", "out/runs"), says="is outside of the folder")


def in_linked_folder(run):
    """The data are the same, but they are reached through a link."""
    project = run.parents[1]
    (project.parent / "data").mkdir()
    shutil.move(project / "pull.csv", project.parent / "data" / "pull.csv")
    link(project, "pull.csv", "../data/pull.csv")


# ---- running them -------------------------------------------------------------------------------------------------------------------

def states(folder):
    """What lies outside of out/: kind and content of everything."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if name.parts[0] == "out":
            continue
        if path.is_symlink():
            found[str(name)] = "link to " + os.readlink(path)
        elif path.is_file():
            size = path.stat().st_size
            found[str(name)] = hashlib.sha256(path.read_bytes()).hexdigest() if size < 100 << 20 else f"{size} bytes"
        else:
            found[str(name)] = "no file"
    return found


WRITES = re.compile(r"O_WRONLY|O_RDWR|O_CREAT|O_TRUNC|O_APPEND")
QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"')


def faults_in(trace, folder, starts, first_program):
    """What the calls of a program show that they should not."""
    out = os.path.realpath(folder / "out")
    scratch = os.path.realpath(folder / "tmp")  # TMPDIR, which has to be empty at the end
    allowed = (out + os.sep, scratch + os.sep, "/dev/null", "/dev/tty", "/proc/self/", "/proc/thread-self/")
    faults = []
    started = 0
    for line in trace.splitlines():
        line = re.sub(r"^\d+ +", "", line)
        if re.search(r"= -1 E[A-Z]+", line) or "<unfinished" in line and "execve" not in line:
            continue
        if line.startswith("execve"):
            started += 1
            name = QUOTED.search(line).group(1) if QUOTED.search(line) else line
            if started > 1 and os.path.basename(name) not in starts and not name.startswith(str(bin_folder)):
                faults.append("starts " + name)
        elif line.startswith(("open", "creat")) or "resumed>" in line and "open" in line:
            if not WRITES.search(line) and not line.startswith("creat"):
                continue
            opened = re.search(r"= \d+<([^>]*)>", line)
            place = opened.group(1).replace(" (deleted)", "") if opened else line
            if re.search(r"/fd/\d+$", place):
                continue
            if not (place + os.sep).startswith(allowed) and place not in allowed and not place.startswith(("/dev/pts/", "/proc/" )):
                faults.append("opens for writing: " + place)
        elif line.startswith(("rename", "link", "symlink")):
            words = QUOTED.findall(line)
            where = re.search(r"AT_FDCWD<([^>]*)>", line)
            to = os.path.join(where.group(1) if where else str(folder), words[-1]) if words else ""
            if not (os.path.realpath(os.path.dirname(to)) + os.sep).startswith((out + os.sep, scratch + os.sep)):
                faults.append("renames or links: " + line)
    return faults


def check(number, name, make, exits, starts, says, scratch):
    folder = scratch / f"{number:03}"
    for part in ("out", "home", "tmp"):
        (folder / part).mkdir(parents=True)
    (folder / "victim.txt").write_text("my thesis\n")
    (folder / "secret.txt").write_text("my passwords\n")
    os.utime(folder / "secret.txt", (0, 0))  # older than anything that is made
    shutil.rmtree(folder / "out")  # rows make it where it has to hold something
    command = make(folder)
    before = states(folder)
    victim = (folder / "victim.txt").read_bytes()
    log = scratch / f"{number:03}.strace"
    environment = {**os.environ, "TMPDIR": str(folder / "tmp"), "HOME": str(folder / "home"), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    # The leak check of a build with sanitizers traces the program as strace does, and cannot.
    environment["ASAN_OPTIONS"] = environment.get("ASAN_OPTIONS", "") + ":detect_leaks=0"
    calls = "trace=execve,execveat,open,openat,openat2,creat,rename,renameat,renameat2,link,linkat,symlink,symlinkat"
    begin = time.monotonic()
    with subprocess.Popen(["strace", "-f", "-y", "-qq", "-s", "4096", "-e", calls, "-e", "signal=none", "-o", str(log), *command], cwd=folder,
                          env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True) as run:
        try:
            said = run.communicate(timeout=PATIENCE)[0].decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, 9)
            said = run.communicate()[0].decode(errors="replace")
            return [f"no end within {PATIENCE} s: {said}"], time.monotonic() - begin
    seconds = time.monotonic() - begin
    trace = log.read_text(errors="replace")
    faults = faults_in(trace, folder, starts, command[0])
    if trace.count("execve(") == 0:
        faults.append("strace saw nothing: " + said)
    if run.returncode not in exits:
        faults.append(f"ended with {run.returncode}, expected {exits}: {said}")
    if says and says not in said:
        faults.append(f"does not say \"{says}\": {said}")
    if "this is a bug" in said or re.search(r"[\x00-\x08\x0b-\x1f\x7f]", said.replace("\r\n", "\n")):
        faults.append(f"says {said!r}")
    after = states(folder)
    for path in sorted(set(before) | set(after)):
        if before.get(path) != after.get(path):
            faults.append(f"{path}: {before.get(path, 'was not there')}, now {after.get(path, 'gone')}")
    if (folder / "victim.txt").read_bytes() != victim:
        faults.append("victim.txt was overwritten")
    for place in (folder / "out").rglob("*") if (folder / "out").exists() else ():
        if place.is_file() and not place.is_symlink() and b"my passwords" in place.read_bytes():
            faults.append(f"{place} holds the secret")
    if not faults:
        shutil.rmtree(folder)
        log.unlink()
    return faults, seconds


def main():
    global bin_folder, sound
    bin_folder = Path(sys.argv[1]).resolve()
    scratch = Path(sys.argv[2]).resolve()
    words = sys.argv[3:]
    sound = scratch / "sound"
    if sound.exists():
        shutil.rmtree(sound)
    make_sound()
    wrong = 0
    slowest = (0, "")
    for number, (name, *what) in enumerate(rows):
        if words and not all(word in name for word in words):
            continue
        shutil.rmtree(scratch / f"{number:03}", ignore_errors=True)
        faults, seconds = check(number, name, *what, scratch)
        slowest = max(slowest, (seconds, name))
        if faults:
            wrong += 1
            print(f"{number:03} {name}")
            for fault in faults[:5]:
                print("    " + fault.strip().replace("\n", "\n    "))
    used = os.times()
    print(f"{len(rows)} hostile folders, {wrong} wrong; slowest {slowest[0]:.1f} s ({slowest[1]}); "
          f"{used.children_user + used.children_system:.0f} s of CPU")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
