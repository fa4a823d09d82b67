# Mistakes that newcomers made in six first journeys: each is said before anything is solved, and its advice works.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(project ${WORK}/project)
file(MAKE_DIRECTORY ${project})

# solve(<config> <code> <text>): a dry run says the text
function(solve yaml code text)
  file(WRITE ${project}/solve.yaml "${yaml}")
  run(${code} ${BIN}/langer-solve solve.yaml --dry-run -o solution.h5)
  expect_said("${text}")
  set(said "${said}" PARENT_SCOPE)
endfunction()

set(block "mesh:
  geometry: {block: {origin: [-4, 0, -4], size: [8, 4, 8], divisions: [8, 4, 8]}}
  sets:
    Base: {of: bottom, within: {box: {from: [-4, 0, -4], to: [4, 0, 4]}}}
    tip: {of: bottom, within: {cylinder: {axis: y, radius: 0.1}}}
material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}
")
set(sphere "contacts:
  sphere:
    on: top
    rigid: {sphere: {radius: 3, centre: [0, 7, 0]}}
    motion: [{t: 1, to: [0, -0.5, 0]}]
")

# a body that nothing holds, and one that stands on a line of nodes
solve("${block}${sphere}supports: []\n" 2 "one indenter only pushes it away")
solve("${block}${sphere}supports: [{on: tip, hold: [x, y, z]}]\n" 0 "only contact keeps it from tipping over")
solve("${block}${sphere}supports: [{on: bottom, hold: [x, y, z]}]\n" 0 "time ")
if(said MATCHES "tipping")
  message(FATAL_ERROR "a body that is held is warned of:\n${said}")
endif()

# another case of letters
solve("${block}supports: [{on: base, hold: [x, y, z]}]\nloads: [{on: top, displacement: {x: 1}}]\n" 2 "did you mean \"Base\"")

# millibar for MPa
solve("${block}supports: [{on: bottom, hold: [x, y, z]}]\nloads: [{on: top, pressure: -300}]\n" 0 "300 MPa is 15000 times the modulus")

# a node with two values: where it is
solve("${block}supports: [{on: bottom, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 1}}]\n" 2
  "at (4, 0, -4) mm")

# a surface in metres
set(corners "0.01 0 0|-0.01 0 0|0 0.01 0|0 -0.01 0|0 0 0.01|0 0 -0.01")
string(REPLACE "|" ";" corners "${corners}")
set(stl "solid octahedron\n")
foreach(face "0;2;4" "2;1;4" "1;3;4" "3;0;4" "2;0;5" "1;2;5" "3;1;5" "0;3;5")
  string(APPEND stl "facet normal 0 0 0\nouter loop\n")
  foreach(corner ${face})
    list(GET corners ${corner} place)
    string(APPEND stl "vertex ${place}\n")
  endforeach()
  string(APPEND stl "endloop\nendfacet\n")
endforeach()
file(WRITE ${project}/octahedron.stl "${stl}endsolid octahedron\n")
function(mesh yaml code text)
  file(WRITE ${project}/mesh.yaml "${yaml}")
  run(${code} ${BIN}/langer-mesh mesh.yaml -o mesh.h5)
  expect_said("${text}")
  set(said "${said}" PARENT_SCOPE)
endfunction()
mesh("{geometry: {file: {path: octahedron.stl, edge: 15}}, cells: tet15}\n" 3 "then scale: 1000 next to edge")
mesh("{geometry: {file: {path: octahedron.stl, edge: 8, scale: 1000}}, cells: tet15}\n" 0 "1333")
mesh("{geometry: {file: {path: body.ply, edge: 4}}}\n" 2 "save them as .stl")

# micrometres for mm; and a file without a force, below what the machine writes about itself
set(rows "\"Specimen\";\"arm 3\"\n\"Gauge length\";\"40,00\"\n\n")
set(numbers "\"(s)\";\"(mm)\";\"(N)\"\n0;0;0\n1;0,4;0,1\n2;0,8;0,25\n3;1,2;0,42\n4;1,6;0,63\n5;2;0,9\n")
file(WRITE ${project}/arm.csv "${rows}\"Time\";\"Extension\";\"Load\"\n${numbers}")
file(WRITE ${project}/deaf.csv "${rows}\"Time\";\"Extension\"\n\"(s)\";\"(mm)\"\n0;0\n1;0,4\n2;0,8\n")
function(fit file thickness code text)
  file(WRITE ${project}/fit.yaml "data:
  - {file: ${file}, kind: uniaxial, gauge_length: 40, width: 10, thickness: ${thickness}}
law: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}
parameters: [{key: matrix.neo_hooke.a1, start: 0.01, lower: 1.0e-6, upper: 1}]
")
  run(${code} ${BIN}/langer-fit fit.yaml -o fit.h5)
  expect_said("${text}")
  set(said "${said}" PARENT_SCOPE)
endfunction()
fit(arm.csv 1520 0 "1520 mm is 152 times the width")
fit(arm.csv 1.52 0 "a1")
if(said MATCHES "micrometres")
  message(FATAL_ERROR "a thin specimen is warned of:\n${said}")
endif()
fit(deaf.csv 1.52 3 "deaf.csv:4:1: columns: found Time, Extension")

# a pushed indenter: its travel has an error bar in each row, and a state is found by six digits of its place
file(WRITE ${project}/pushed.yaml "mesh:
  geometry: {section: {of: axisymmetric, size: [8, 4], divisions: [8, 4]}}
  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 3}}}}
material: {matrix: {yeoh: {a1: 0.012, a2: 0.03}}, volume: {quadratic: {d: 1.0e-2}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts:
  ball:
    on: contact
    rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}
    control: {force: [{t: 0.111111111, to: 0.01}, {t: 1, to: 0.1}]}
estimate: refinement
path: {largest: 0.2}
")
run(0 ${BIN}/langer-solve pushed.yaml -o pushed.h5)
expect_said("force 0.1 N, as given")
file(WRITE ${project}/post.yaml "columns:
  - {quantity: u_ind, zero_at: t=0.111111}
  - {history: travel_ball, name: depth}
")
run(0 ${BIN}/langer-post post.yaml --solution pushed.h5 -o curves.h5 --quiet)
file(STRINGS ${project}/curves.csv rows LIMIT_COUNT 1)
expect_equal("${rows}" "u_ind_mm,u_ind_error_mm,depth_mm,depth_error_mm" "names of the columns")
