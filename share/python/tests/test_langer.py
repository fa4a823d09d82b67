"""What the package promises. `LANGER_PROJECT` is a folder with pipelines/ and configs/ in which runs may be made."""

import math
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import langer
from langer.runs import changed, yaml_text


@pytest.fixture(scope="session")
def project():
    folder = os.environ.get("LANGER_PROJECT")
    if not folder:
        pytest.skip("no LANGER_PROJECT")
    before = os.getcwd()
    os.chdir(folder)
    yield Path(folder)
    os.chdir(before)



asked = {"fit.starts": 1, "solve.cell_stress": "principal"}


@pytest.fixture(scope="session")
def run(project):
    return langer.run("pipelines/smoke.yaml", set=asked, folder="runs/python")


def test_a_part_keeps_the_unit_and_a_result_does_not():
    force = langer.Array([1.0, 2.0, 3.0], "N", {"label": "force"})
    assert force[1:].unit == "N" and force[1:].attributes == {"label": "force"}
    assert type(force * force) is np.ndarray and type(np.sqrt(force)) is np.ndarray
    assert (2 * force).tolist() == [2, 4, 6]
    again = pickle.loads(pickle.dumps(force))
    assert again.unit == "N" and again.tolist() == force.tolist()


def test_a_quantity_is_a_number_with_its_unit():
    force = langer.Quantity(10.78, "N")
    assert force + 1 == 11.78 and str(force) == "10.78 N" and str(langer.Quantity(0.3)) == "0.3"


@pytest.mark.parametrize("value, text", [
    (0.2, "0.2"), (1e-6, "1e-06"), (True, "true"), (None, "null"), ("3%", "3%"), ("displacement", "displacement"), ("0.2", '"0.2"'),
    ("true", '"true"'), ([0, 60], "[0, 60]"), (np.array([1.5, 2]), "[1.5, 2.0]"), (np.float64(2), "2.0"), ({"a": [1]}, '{"a": [1]}'),
    ("a: b", '"a: b"')])
def test_values_as_yaml(value, text):
    assert yaml_text(value) == text


def test_a_changed_pipeline_says_what_was_asked_for():
    import yaml
    text = "pipeline: p\nnodes:\n  solve: {stage: solve, set: {threads: 1, a.b: 1e-6}, sweep: {alpha: {key: \"fibre_angles[0]\", values: [0, 60]}}}\n"
    solve = yaml.safe_load(changed(text, {"solve.threads": 2, "solve.accuracy": "3%"}, {"solve.path.first": [0.1, 0.5], "half:solve.x[1]": [1]}))["nodes"]["solve"]
    assert solve["set"] == {"threads": 2, "accuracy": "3%", "a.b": "1e-6"}
    assert solve["sweep"]["first"] == {"key": "path.first", "values": [0.1, 0.5]} and solve["sweep"]["half"]["key"] == "x[1]"
    other = yaml.safe_load(changed(text, {}, {"alpha:solve.fibre_angles[0]": [30]}))
    assert other["nodes"]["solve"]["sweep"]["alpha"]["values"] == [30]


def test_a_run_knows_its_files(run):
    assert set(run.nodes) == {"fit", "mesh", "sensitivity", "solve", "post", "table", "report"}
    assert [dict(m) for m in run.files("solve")] == [{"alpha": 0}, {"alpha": 60}]
    assert run.report.name == "report.html" and run.report.exists()
    assert (run.times()["exit"] == 0).all() and len(run.times()) == 9
    with pytest.raises(KeyError, match="alpha=0; alpha=60"):
        run["solve"]
    with pytest.raises(KeyError, match="one of fit, "):
        run["solv"]


def test_a_second_run_does_nothing(run, project):
    made = run.read("solve", alpha=0).path.stat().st_mtime_ns
    again = langer.run("pipelines/smoke.yaml", set=asked, folder="runs/python", progress=False)
    assert again.read("solve", alpha=0).path.stat().st_mtime_ns == made


def test_a_solution_is_in_equilibrium(run):
    solution = run.read("solve", alpha=60)
    assert isinstance(solution, langer.Solution) and solution.steps == len(solution.t) == len(solution.history)
    assert solution.points.unit == "mm" and solution.cells.shape[1] == 8 and solution.cells.max() < len(solution.points)
    assert solution.u.shape == (solution.steps, len(solution.points), 3) and solution.u.unit == "mm"
    contact = solution.contact("sphere")
    # the force on the sphere is minus that on the body, and held by the bottom
    assert np.allclose(contact["r"].sum(axis=1), -solution.force, atol=1e-9)
    bottom = solution["history/reactions/bottom"][:, 1]
    assert np.allclose(bottom, solution.force[:, 1], rtol=1e-5)
    assert solution.history.attrs["units"]["force_ind_y"] == "N"
    assert solution.field("von_mises", -1).shape == (len(solution.cells),) and solution.field("von_mises").unit == "MPa"
    assert np.array_equal(solution.field("u", 0), solution.u[0])
    assert solution.field("e_x").shape == (len(solution.cells), 3)
    with pytest.raises(KeyError, match="there is no field v; one of"):
        solution.field("v")
    with pytest.raises(IndexError):
        solution.field("u", solution.steps)


def test_stress_tensors_of_cells(run, project):
    solution = run.read("solve", alpha=60)
    stress = solution.stress
    assert stress.unit == "MPa" and stress.shape == (solution.steps, len(solution.cells), 3, 3)
    assert np.array_equal(stress, np.swapaxes(stress, 2, 3))
    s = np.asarray(stress)
    pressure = np.trace(s, axis1=2, axis2=3) / 3
    assert np.allclose(pressure, solution.field("pressure"), atol=1e-9)
    deviator = s - pressure[..., None, None] * np.eye(3)
    assert np.allclose(np.sqrt(1.5 * (deviator**2).sum(axis=(2, 3))), solution.field("von_mises"), atol=1e-9)
    values = np.linalg.eigvalsh(s)  # ascending
    for k in (1, 2, 3):
        value, along = np.asarray(solution.field(f"principal_stress_{k}")), np.asarray(solution.field(f"principal_direction_{k}"))
        assert np.allclose(value, values[..., 3 - k], atol=1e-9)
        assert np.allclose(s @ along[..., None], value[..., None, None] * along[..., None], atol=1e-9)
    without = langer.run("pipelines/smoke.yaml", set={"fit.starts": 1}, folder="runs/without", progress=False)
    with pytest.raises(KeyError, match="cell_stress"):
        without.read("solve", alpha=60).stress


def test_tables_agree_with_their_csv(run):
    curves = run.read("post", alpha=60)
    table, text = curves.table, langer.read(curves.path.with_suffix(".csv"))
    assert table.attrs["units"]["force"] == "N" and text.attrs["units"]["force"] == "N"
    assert np.allclose(table["force"], text["force"], rtol=1e-6) and list(table.columns) == list(text.columns)
    assert curves.curves["force"].y.unit == "N"
    solution = run.read("solve", alpha=60)
    assert math.isclose(table["force"].iloc[-1], solution.force[-1, 1], rel_tol=1e-12)
    sweep = run["table"].table
    assert sweep["alpha"].tolist() == [0, 60] and math.isclose(sweep["force"].iloc[1], table["force"].iloc[-1], rel_tol=1e-12)
    over = run.table("post")
    assert over["alpha"].tolist() == [0, 60] and math.isclose(over["force"].iloc[1], table["force"].iloc[-1], rel_tol=1e-12)


def test_a_fit_tells_its_parameters(run):
    fit = run["fit"]
    parameters = fit.parameters
    assert (parameters["lower"] <= parameters["value"]).all() and (parameters["value"] <= parameters["upper"]).all()
    assert parameters.loc["a1", "unit"] == "MPa"
    sizes = np.sqrt(np.diag(fit.covariance))
    known = parameters["standard_error"].notna()
    assert np.allclose(sizes[known], parameters["standard_error"][known])
    test = next(iter(fit.tests.values()))
    assert len(test) > 5 and test.attrs["units"]["stress_x"] == "MPa"
    assert (np.abs(test["stress_x"] - test["model_x"]).max()) < 0.05 * test["stress_x"].max()
    assert "a1" in fit.config and fit.provenance["config"] == fit.config


def test_every_file_of_a_run_can_be_read(run):
    for node in run.nodes:
        for path in run.files(node).values():
            if path.suffix != ".html":
                file = langer.read(path)
                assert file.tree() and file.schema and repr(file) and file._repr_html_()
    assert isinstance(run["mesh"], langer.Mesh) and len(run["mesh"].sets["top"]) > 4
    effects = run["sensitivity"].effects()
    assert list(effects.columns) == run["sensitivity"].parameters and effects.index.is_monotonic_increasing
    snapshot = langer.read(next(run.read("post", alpha=0).path.parent.glob("*.hdf")))
    assert isinstance(snapshot, langer.Snapshot) and snapshot.point_data["sigma"].shape[1] == 6


def test_what_is_wrong_is_said(project, tmp_path):
    with pytest.raises(langer.LangerError, match='there is no node "solv".*did you mean "solve"') as wrong:
        langer.run("pipelines/smoke.yaml", set={"solv.friction": 1})
    assert wrong.value.code == 2
    with pytest.raises(langer.LangerError, match="friction"):
        langer.run("pipelines/smoke.yaml", set={"solve.contacts.sphere.friction": -1}, folder=tmp_path / "a")
    with pytest.raises(langer.LangerError, match='varied by the axis "alpha"'):
        langer.run("pipelines/smoke.yaml", set={"solve.fibre_angles[0]": 30}, folder=tmp_path / "b")
    with pytest.raises(langer.LangerError, match="expected node.key"):
        langer.run("pipelines/smoke.yaml", set={"starts": 1}, folder=tmp_path / "b")
    with pytest.raises(FileNotFoundError):
        langer.read("none.h5")
    (tmp_path / "text.h5").write_text("no HDF5")
    with pytest.raises(OSError, match="not an HDF5 file"):
        langer.read(tmp_path / "text.h5")


def test_a_file_with_one_flipped_bit_is_refused(run, tmp_path):
    """Anywhere in the file: in its values, its names, its attributes and its last byte before the seal."""
    whole = run.read("solve", alpha=0).path.read_bytes()
    content = len(whole) - len(b"\nlanger seal:0123456789abcdef\n")
    for place in (0, 100, content // 3, content // 2, content - 1):
        for bit in (0, 7):
            bytes_ = bytearray(whole)
            bytes_[place] ^= 1 << bit
            damaged = tmp_path / f"flipped_{place}_{bit}.h5"
            damaged.write_bytes(bytes_)
            with pytest.raises(OSError, match="damaged: its content does not fit its checksum; make it again"):
                langer.read(damaged)
    (tmp_path / "cut.h5").write_bytes(whole[:content // 2] + whole[content:])
    with pytest.raises(OSError, match="damaged"):
        langer.read(tmp_path / "cut.h5")
    copied = tmp_path / "whole.h5"
    copied.write_bytes(whole)
    assert langer.read(copied).steps == run.read("solve", alpha=0).steps
    copied.write_bytes(bytes([whole[0] ^ 1]) + whole[1:])  # it was whole when it was read the first time
    with pytest.raises(OSError, match="damaged"):
        langer.read(copied)


def test_a_file_that_a_killed_run_left_is_refused(run, tmp_path):
    left = tmp_path / "solution.h5.part"
    left.write_bytes(run.read("solve", alpha=0).path.read_bytes()[:-len(b"\nlanger seal:0123456789abcdef\n")])
    with pytest.raises(OSError, match="left by a run that was killed.*run the same command again"):
        langer.read(left)


def test_other_versions_units_and_files_are_refused(run, tmp_path):
    h5py = pytest.importorskip("h5py")

    def changed_copy(name, change):
        path = tmp_path / name
        path.write_bytes(run.read("solve", alpha=0).path.read_bytes())
        with h5py.File(path, "r+") as file:  # cuts off the seal: from here on the file is read on trust
            change(file)
        return path

    def set_attribute(name, value):
        return lambda file: file.attrs.__setitem__(name, value)

    assert langer.read(changed_copy("same.h5", lambda file: None)).steps == run.read("solve", alpha=0).steps
    with pytest.raises(ValueError, match="solution, version 99; expected 1 to 3.*make it again"):
        langer.read(changed_copy("newer.h5", set_attribute("schema_version", 99)))
    with pytest.raises(ValueError, match="units m N Pa s rad; expected mm N MPa s deg: convert"):
        langer.read(changed_copy("metres.h5", set_attribute("units", "m N Pa s rad")))

    def link_elsewhere(file):
        del file["history/t"]
        file["history/t"] = h5py.ExternalLink(str(run["mesh"].path), "VTKHDF/Points")

    with pytest.raises(ValueError, match="history/t is a link into another file"):
        langer.read(changed_copy("linked.h5", link_elsewhere))

    def store_elsewhere(file):
        del file["history/t"]
        file["history"].create_dataset("t", (4,), "u1", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])

    with pytest.raises(ValueError, match="history/t keeps its values in another file"):
        langer.read(changed_copy("external.h5", store_elsewhere))


def test_a_solve_that_fails_raises_what_it_said(project, tmp_path):
    with pytest.raises(langer.LangerError) as failed:
        langer.run("pipelines/smoke.yaml", set={"solve.solver.newton.iterations": 1, "solve.path.smallest": 0.4}, folder=tmp_path / "run")
    assert failed.value.code == 4 and "solve" in str(failed.value)


def test_figures_have_the_size_that_was_asked_for(run, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    table = run.read("post", alpha=60).table
    with langer.figure(85, 60, file=tmp_path / "force.png", decimal=",") as axes:
        langer.plot(table, "u_ind", "force", axes=axes)
        assert axes.get_xlabel() == "u_ind (mm)" and axes.get_ylabel() == "force (N)"
        plt.gcf().canvas.draw()
    height, width = plt.imread(tmp_path / "force.png").shape[:2]
    assert (width, height) == (int(85 / 25.4 * 300), int(60 / 25.4 * 300))
    with langer.figure(85, file=tmp_path / "fit.pdf") as axes:
        langer.plot_fit(run["fit"], axes=axes)
    assert (tmp_path / "fit.pdf").read_bytes()[:5] == b"%PDF-"
    with langer.figure(85, file=tmp_path / "c.svg") as axes:
        langer.plot_correlation(run["fit"], axes=axes)
    with langer.figure(85, file=tmp_path / "p.svg") as axes:
        langer.plot_profiles(run["fit"], axes=axes)
    with langer.figure(85, decimal=",") as axes:
        axes.plot([0, 0.25, 0.5], [0, 1, 2])
    plt.gcf().canvas.draw()
    assert "0,2" in [t.get_text() for t in plt.gcf().axes[0].get_xticklabels()]
    with pytest.raises(ValueError, match="different units"):
        langer.plot(table, "u_ind", ["force", "u_ind"])


def test_the_version_is_that_of_the_programs():
    import subprocess
    said = subprocess.run([langer.program("langer"), "--version"], capture_output=True, text=True, check=True).stdout
    assert said.split()[1] == langer.__version__
