# Sections through every stage: the shipped pipeline; a mesh from a file, killed and continued; plane strain; what is refused.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
run(0 ${BIN}/langer-plan pipelines/axisymmetric.yaml -o runs/axisymmetric)
run(0 make -C runs/axisymmetric VERBOSE=1)
expect_said("axisymmetric section: forces and energies are those of the whole body")
expect_said("force 10.77 N +- ")
foreach(file post/curves.csv post/render.svg report/report.html)
  if(NOT EXISTS ${folder}/runs/axisymmetric/${file})
    message(FATAL_ERROR "${file} was not made")
  endif()
endforeach()
# of the last row: force, reaction of the base, energy and work
file(STRINGS ${folder}/runs/axisymmetric/post/curves.csv rows)
list(GET rows 0 names)
list(GET rows -1 last)
string(REPLACE "," ";" names "${names}")
string(REPLACE "," ";" last "${last}")
foreach(name u_ind_mm force_N force_error_N reaction_y_bottom_N energy_N_mm work_N_mm)
  list(FIND names ${name} column)
  if(column EQUAL -1)
    message(FATAL_ERROR "no column ${name} in ${names}")
  endif()
  list(GET last ${column} ${name})
endforeach()
set(force ${force_N})
set(reaction ${reaction_y_bottom_N})
set(energy ${energy_N_mm})
set(work ${work_N_mm})
execute_process(COMMAND awk "BEGIN {exit !(${force} > 10.73 && ${force} < 10.79 && (${reaction} - ${force})^2 < 1e-12 && (${work} - ${energy})^2 < (1e-3 * ${work})^2)}"
  RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "force ${force}, reaction ${reaction}, energy ${energy}, work ${work}")
endif()

# from a mesh file, in steps so short that a kill finds it on its way
run(0 ${BIN}/langer-mesh configs/mesh/disc.yaml -o mesh.h5)
expect_said("3600 mm^3")  # pi 16.93^2 4
run(0 ${BIN}/langer show mesh.h5)
expect_said("axisymmetric")
file(WRITE ${folder}/solve.yaml "include: configs/solve/refinement_isotropic.yaml\nsymmetry: none\npath: {first: 0.02, largest: 0.02}\n")
set(solve ${BIN}/langer-solve solve.yaml --mesh mesh.h5 --quiet -o)
run(0 ${solve} whole/solution.h5)
kill_until_done(killed/solution.h5 400 200 10 ${solve} killed/solution.h5)
expect_same_curves(configs/post/axisymmetric.yaml)

# a strip sheared and pressed, in plane strain
file(WRITE ${folder}/strip.yaml "mesh: {geometry: {section: {of: plane_strain, size: [4, 2], divisions: [8, 4], top: {edge: 0.3}, thickness: 10}}}
material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-4}}}
supports: [{on: bottom, hold: [x, y]}]
loads: [{on: top, displacement: {x: 0.4, y: -0.2}}]
")
run(0 ${BIN}/langer-solve strip.yaml -o strip.h5 -v)
expect_said("plane-strain section: forces and energies are those of 10 mm along z")
file(WRITE ${folder}/strip_post.yaml "columns: [{quantity: t}, {quantity: reaction_x, at: top}, {quantity: reaction_y, at: bottom}, {quantity: balance}]\nsnapshots: [last]\n")
run(0 ${BIN}/langer-post strip_post.yaml --solution strip.h5 -o strip_curves.h5)
if(NOT EXISTS ${folder}/snapshot_0010.hdf)
  message(FATAL_ERROR "no snapshot")
endif()

run(2 ${BIN}/langer-solve configs/solve/indentation.yaml --mesh mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml -o no.h5)
expect_said("fibres in the body \"skin\", on an axisymmetric section")
run(2 ${BIN}/langer-solve configs/solve/axisymmetric.yaml -o no.h5 --set "contacts.sphere.motion[0].to[0]=0.1")
expect_said("contacts.sphere.motion[0].to: found [0.1, -1, 0], on an axisymmetric section")
expect_said("a movement along y")
run(0 ${BIN}/langer-solve configs/solve/axisymmetric.yaml -o asked.h5 --set accuracy=1%)
expect_said("force 10.7")
run(2 ${BIN}/langer-post --solution whole/solution.h5 --export scene.inp)
expect_said("a section; expected the same scene on a body in three")

# a block whose scene is the same around its axis: in its place the section, where that is asked for, with what the sides may change
file(WRITE ${folder}/block.yaml "mesh: {geometry: {indented_block: {size: [20, 2, 20], radius: 2.5, depth: 0.5, edge: 0.3}}}
material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts: {ball: {rigid: {sphere: {radius: 2.5, centre: [10, 4.5, 10]}}, motion: [{t: 1, to: [0, -0.5, 0]}]}}
symmetry: auto
path: {steps: 2}
")
run(0 ${BIN}/langer-solve block.yaml -o block/solution.h5 -v)
expect_said("the same around an axis but for its sides: reduce: auto solves a section")
expect_said("mirror x and mirror z")
run(0 ${BIN}/langer-solve block.yaml -o in_place/solution.h5 -v --set reduce=auto --set accuracy=1%)
expect_said("a section of a disc of 11.28 mm, of the block's area, takes its place")
expect_said("axisymmetric section")
run(0 ${BIN}/langer show in_place/solution.h5)
expect_said("force_error_sides")
expect_said("accuracy")
run(0 ${BIN}/langer-solve block.yaml -o beside/solution.h5 --set reduce=auto --set "contacts.ball.rigid.sphere.centre[0]=10.5")
expect_said("reduce: no indented_block here whose scene is the same around an axis")
