# What ParaView itself makes of a folder's solution.xdmf (as by a double click), solution.xmf and series.pvd: pvpython read_paraview.py <folder>; ends with 1 where fields or times are missing.
import os
import sys

from paraview.simple import OpenDataFile, PVDReader, XDMFReader

wrong = []
for name, opened, point, cell in (("solution.xdmf", OpenDataFile, ("u", 3), ("J", 1)),
                                  ("solution.xdmf", OpenDataFile, ("reaction", 3), ("stress", 9)),
                                  ("solution.xmf", lambda f: XDMFReader(FileNames=[f]), ("u", 3), ("J", 1)),
                                  ("solution.xmf", lambda f: XDMFReader(FileNames=[f]), ("reaction", 3), ("stress", 9)),
                                  ("solution.xmf", lambda f: XDMFReader(FileNames=[f]), ("u", 3), ("principal_direction_1", 3)),
                                  ("series.pvd", lambda f: PVDReader(FileName=f), ("sigma", 6), ("sigma", 6))):
    file = os.path.join(sys.argv[1], name)
    source = opened(file)
    source.UpdatePipelineInformation()
    times = list(source.TimestepValues)
    if times != sorted(times) or times[-1] != 1:
        wrong.append(f"{name}: times {times}")
    source.UpdatePipeline(times[-1])
    for data, (array, components) in ((source.PointData, point), (source.CellData, cell)):
        found = data.GetArray(array)
        if found is None or found.GetNumberOfComponents() != components:
            wrong.append(f"{name}: {array} is not there with {components} components")
        elif components == 6 and [found.GetComponentName(i) for i in range(6)] != ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]:
            wrong.append(f"{name}: ParaView takes the components of {array} for {[found.GetComponentName(i) for i in range(6)]}")
    print(f"{name}: {len(times)} times")
for w in wrong:
    print("WRONG:", w)
sys.exit(1 if wrong else 0)
