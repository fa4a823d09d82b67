# What VTK's reader of XML grids sees in series.pvd: read_series.py <series.pvd> <snapshot of the last state>; ends with 1 where it is not the same.
import os
import sys
import xml.etree.ElementTree as ElementTree

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

wrong = []
folder = os.path.dirname(sys.argv[1])
states = [(float(d.get("timestep")), d.get("file")) for d in ElementTree.parse(sys.argv[1]).iter("DataSet")]
names = None
for time, file in states:
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(folder, file))
    reader.Update()
    grid = reader.GetOutput()
    told = grid.GetFieldData().GetArray("TimeValue")
    if told is None or told.GetValue(0) != time:
        wrong.append(f"{file}: its time is not {time}")
    here = [[data.GetArrayName(i) for i in range(data.GetNumberOfArrays())] for data in (grid.GetPointData(), grid.GetCellData())]
    if names is not None and here != names:
        wrong.append(f"{file}: other fields than the state before")
    names = here
    for data in (grid.GetPointData(), grid.GetCellData()):
        tensors = data.GetTensors()
        if tensors is None or tensors.GetName() != "sigma" or tensors.GetNumberOfComponents() != 6:
            wrong.append(f"{file}: sigma is not the active tensor")
    if grid.GetPointData().GetVectors() is None or grid.GetPointData().GetVectors().GetName() != "u":
        wrong.append(f"{file}: u is not the active vector")
if [t for t, _ in states] != sorted(t for t, _ in states) or states[0][0] != 0 or states[-1][0] != 1:
    wrong.append("times do not go from 0 to 1")

reader = vtk.vtkHDFReader()
reader.SetFileName(sys.argv[2])
reader.Update()
snapshot = reader.GetOutput()
for there, own in ((snapshot.GetPointData(), grid.GetPointData()), (snapshot.GetCellData(), grid.GetCellData())):
    for i in range(own.GetNumberOfArrays()):
        name = own.GetArrayName(i)
        if there.GetArray(name) is None or not numpy.array_equal(vtk_to_numpy(own.GetArray(i)), vtk_to_numpy(there.GetArray(name)), equal_nan=True):
            wrong.append(f"{name}: the last state is not the snapshot")
if not numpy.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(snapshot.GetPoints().GetData())):
    wrong.append("the points are not those of the snapshot")
contact = vtk_to_numpy(grid.GetPointData().GetArray("contact_pressure_sphere"))
if not contact.max() > 0 or contact.min() < 0:
    wrong.append("no contact pressure")
try:
    import meshio
    mesh = meshio.read(os.path.join(folder, states[-1][1]))
    if len(mesh.points) != grid.GetNumberOfPoints() or "sigma" not in mesh.point_data:
        wrong.append("meshio reads something else")
except ImportError:
    print("not read by meshio, which is not installed")
for w in wrong:
    print("WRONG:", w)
print(f"{len(states)} states, {sum(map(len, names))} fields each")
sys.exit(1 if wrong else 0)
