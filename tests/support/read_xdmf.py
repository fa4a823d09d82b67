# What VTK's reader of XDMF sees in solution.xmf: read_xdmf.py <solution.xmf> <solution.h5>; ends with 1 where it is not what stands in the solution.
import sys

import h5py
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

wrong = []
solution = h5py.File(sys.argv[2], "r")
grid = solution["VTKHDF"]
times = list(grid["Steps/Values"][:])
reader = vtk.vtkXdmfReader()
reader.SetFileName(sys.argv[1])
reader.UpdateInformation()
seen = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
if seen is None or list(seen) != times:
    wrong.append(f"times {seen}, in the solution {times}")
fields = 0
for step, time in enumerate(times):
    reader.UpdateTimeStep(time)
    body = reader.GetOutputDataObject(0)
    while not body.IsA("vtkUnstructuredGrid"):
        body = body.GetBlock(0)
    if not numpy.array_equal(vtk_to_numpy(body.GetPoints().GetData()), grid["Points"][:]):
        wrong.append("other points")
    if body.GetNumberOfCells() != grid["NumberOfCells"][0] or body.GetCellType(0) != grid["Types"][0]:
        wrong.append("other cells")
    corners = body.GetCell(0).GetPointIds()
    if [corners.GetId(i) for i in range(corners.GetNumberOfIds())] != list(grid["Connectivity"][: corners.GetNumberOfIds()]):
        wrong.append("other nodes in the first cell")
    for data, place in ((body.GetPointData(), "PointData"), (body.GetCellData(), "CellData")):
        rows = len(grid["Points"]) if place == "PointData" else int(grid["NumberOfCells"][0])
        for name, values in grid[place].items():
            if name == "body":
                continue
            array = data.GetArray(name)
            here = values[:] if len(values) == rows else values[step * rows : (step + 1) * rows]
            if array is None or not numpy.array_equal(vtk_to_numpy(array), here):
                wrong.append(f"{place} {name} of state {step}")
            fields += 1
if not fields:
    wrong.append("no fields")
for w in wrong:
    print("WRONG:", w)
print(f"{len(times)} states, {fields} fields in all")
sys.exit(1 if wrong else 0)
