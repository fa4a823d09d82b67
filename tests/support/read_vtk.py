# What a VTK reader sees in the files for ParaView: read_vtk.py <snapshot.hdf> <solution.h5> <mesh.h5>
# Prints one line per array and ends with 1 where something is not as docs/schema.md has it.
import math
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

wrong = []
vtk.vtkObject.GlobalWarningDisplayOff()  # VTK before 9.3 says that it does not know temporal files


def expect(ok, what):
    if not ok:
        wrong.append(what)


def read(path):
    reader = vtk.vtkHDFReader()
    expect(reader.CanReadFile(path), f"{path}: not readable")
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    expect(grid.GetNumberOfCells() > 0, f"{path}: no cells")
    expect(all(grid.GetCellType(i) == vtk.VTK_HEXAHEDRON for i in range(grid.GetNumberOfCells())), f"{path}: cells that are no hexahedra")
    for place, data in (("point", grid.GetPointData()), ("cell", grid.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            print(path.split("/")[-1], place, array.GetName(), array.GetNumberOfComponents(), *map("{:.4g}".format, array.GetRange(-1)))
    return reader, grid


def array(data, name, components):
    found = data.GetArray(name)
    expect(found is not None, f"no array {name}")
    if found is None:
        return None
    expect(found.GetNumberOfComponents() == components, f"{name}: {found.GetNumberOfComponents()} components, expected {components}")
    return vtk_to_numpy(found)


def volume(grid):
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


snapshot, solution, mesh = sys.argv[1:4]
_, grid = read(snapshot)
points, cells = grid.GetPointData(), grid.GetCellData()
u = array(points, "u", 3)
sigma = array(points, "sigma", 6)
von_mises = array(points, "von_mises", 1)
if sigma is not None and von_mises is not None:  # VTK's order: xx yy zz xy yz xz
    s = sigma.T
    by_hand = (0.5 * ((s[0] - s[1]) ** 2 + (s[1] - s[2]) ** 2 + (s[2] - s[0]) ** 2) + 3 * (s[3] ** 2 + s[4] ** 2 + s[5] ** 2)) ** 0.5
    expect(abs(by_hand - von_mises).max() < 1e-9 * max(von_mises.max(), 1e-9), "von_mises does not follow from sigma")
fibre, deformed = array(cells, "fibre_1", 3), array(cells, "fibre_1_deformed", 3)
if fibre is not None:
    expect(abs((fibre**2).sum(axis=1) - 1).max() < 1e-12, "fibres that are no unit vectors")
    expect(deformed is None or ((deformed**2).sum(axis=1) > 0.2).all(), "deformed fibres that have vanished")
status = array(points, "contact_status_sphere", 1)
expect(status is None or set(status) <= {-1, 0, 1, 2}, "contact_status: other values than -1 to 2")
expect(status is None or (status > 0).any(), "no node in contact")
# the points carry the reference; warped by u each cell's volume is near J times its own
warp = vtk.vtkWarpVector()
warp.SetInputData(grid)
warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "u")
warp.Update()
J = array(cells, "J", 1)
ratio = volume(warp.GetOutput()) / volume(grid)
expect(abs(ratio - J).max() < 0.05, f"J and the warped volumes differ by {abs(ratio - J).max()}")

_, body = read(mesh)
for axis in ("e_x", "e_y", "e_z"):
    array(body.GetCellData(), axis, 3)
reader, first = read(solution)
expect(array(first.GetPointData(), "u", 3) is not None, "solution: no u")
if hasattr(reader, "GetNumberOfSteps"):  # VTK 9.3 and later
    n = reader.GetNumberOfSteps()
    print("steps", n)
    expect(n > 1, "solution: no time series")
    reader.SetStep(n - 1)
    reader.Update()
    last = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("u"))
    expect(abs(last - u).max() < 1e-12, "the last step of the solution is not the snapshot's")
else:
    print("steps: this VTK reads the first one only", vtk.VTK_VERSION)

for what in wrong:
    print("WRONG:", what)
sys.exit(1 if wrong else 0)
