# Meshes to other programs and back: the solution on what comes back is the same; CalculiX takes the .inp; a changed file counts.
include(${ROOT}/tests/support/run.cmake)
copy_project()
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet --set "export=[msh, inp]")
set(solve configs/solve/smoke.yaml --material configs/material/abdomen_hgo_yeoh.yaml --quiet)
run(0 ${BIN}/langer-solve ${solve} --mesh mesh.h5 -o solution.h5)
foreach(kind msh inp)
  file(WRITE ${WORK}/project/${kind}.yaml "geometry: {file: {path: mesh.${kind}}}\n")
  run(0 ${BIN}/langer-mesh ${kind}.yaml -o ${kind}.h5 --quiet)
  run(0 ${BIN}/langer-compare-h5 mesh.h5 ${kind}.h5 0 --data)
endforeach()
run(0 ${BIN}/langer-solve ${solve} --mesh inp.h5 -o solution_inp.h5)
run(0 ${BIN}/langer-compare-h5 solution.h5 solution_inp.h5 1e-12 --data)

# its own sides come before ours, further sets beside them; what does not fit is refused where it stands
file(READ ${WORK}/project/mesh.inp inp)
file(WRITE ${WORK}/project/own.inp "${inp}*NSET, NSET=top\n1\n*NSET, NSET=left side\n1, 2\n")
file(WRITE ${WORK}/project/own.yaml
  "geometry: {file: {path: own.inp, scale: 0.001}}\nsets: {low: {of: bottom, within: {plane: {axis: y, at: 0}}}}\nexport: [inp]\n")
run(2 ${BIN}/langer-mesh own.yaml -o own.h5)
expect_said("own.yaml:3:1: export: own.inp is the file that geometry names")
run(0 ${BIN}/langer-mesh own.yaml -o other.h5 -v)
expect_said("\"left side\" is called left_side here")
expect_said("5.76e-07 mm^3")
expect_said("  low              81 nodes     64 facets")
run(2 ${BIN}/langer-mesh own.yaml -o other.h5 --set "sets={left_side: {within: {plane: {axis: y, at: 0}}}}")
expect_said("found the name of a set of the file")
run(2 ${BIN}/langer-mesh own.yaml -o other.h5 --set "points={P: [0, 0.001, 0]}")
expect_said("no node is there; the nearest is")
run(2 ${BIN}/langer-solve configs/solve/smoke.yaml --material configs/material/abdomen_hgo_yeoh.yaml -o x.h5
  --set "mesh={include: configs/mesh/smoke.yaml}" --set "mesh.export=[msh]")

# a pipeline sees that the file has changed
file(WRITE ${WORK}/project/p.yaml "pipeline: p\nnodes:\n  mesh: {stage: mesh, config: inp.yaml}\n")
run(0 ${BIN}/langer-plan p.yaml)
run(0 make -C runs/p)
run(0 make -q -C runs/p)
add_to(${WORK}/project/mesh.inp "*NSET, NSET=new\n1\n")
run(1 make -q -C runs/p)

find_program(CCX ccx)
if(NOT CCX)
  message("not given to CalculiX: no ccx (calculix-ccx)")
  return()
endif()
file(WRITE ${WORK}/project/job.inp "*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=M
*ELASTIC
1., 0.3
*SOLID SECTION, ELSET=skin, MATERIAL=M
*BOUNDARY
bottom, 1, 3
*STEP
*STATIC
*BOUNDARY
top, 2, 2, 0.1
*NODE PRINT, NSET=M
U
*DSLOAD
contact, P, 0.1
*END STEP
")
run(0 ${CCX} job)
file(READ ${WORK}/project/job.dat displacements)
if(NOT displacements MATCHES "1\\.000000E-01")
  message(FATAL_ERROR "CalculiX did not move M by 0.1:\n${displacements}")
endif()
