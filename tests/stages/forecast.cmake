# What --dry-run forecasts for homogeneous bodies, whose stability is examined on the mesh: CPU time and memory within a factor of 2.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(folder ${WORK}/project)
file(MAKE_DIRECTORY ${folder})

# pulled: the cells show that the body is stable; compressed: only a factor of the mesh does
foreach(scene "pulled;3;40, 20, 20" "compressed;-1;24, 12, 12")
  list(GET scene 0 name)
  list(GET scene 1 to)
  list(GET scene 2 divisions)
  file(WRITE ${folder}/${name}.yaml "mesh: {geometry: {block: {size: [40, 20, 20], divisions: [${divisions}]}}}
supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: ${to}}}]
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}
path: {steps: 5}
")
  run(0 ${BIN}/langer-solve ${name}.yaml --dry-run --quiet --json)
  string(REGEX REPLACE ".*\"cpu_s\": ([0-9.e+-]+).*" "\\1" forecast "${said}")
  file(WRITE ${folder}/timed.sh "TIMEFORMAT='taken %U %S'\ntime ${BIN}/langer-solve ${name}.yaml -o ${name}.h5 --quiet\n")
  run(0 bash timed.sh)
  if(NOT said MATCHES "taken ([0-9.]+) ([0-9.]+)")
    message(FATAL_ERROR "no time in:\n${said}")
  endif()
  execute_process(COMMAND awk "BEGIN { r = ${forecast} / (${CMAKE_MATCH_1} + ${CMAKE_MATCH_2}); print (r > 0.5 && r < 2) ? \"within\" : r }"
    OUTPUT_VARIABLE ratio OUTPUT_STRIP_TRAILING_WHITESPACE)
  expect_equal("${ratio}" within "${name}: forecast over taken")
endforeach()

# cells that are cut to an accuracy: the first mesh is solved to know how many are needed
file(WRITE ${folder}/cut.yaml "mesh:
  geometry: {block: {origin: [-20, 0, -12], size: [40, 4, 24], divisions: [20, 4, 12]}}
  sets:
    pad: {of: top, within: {box: {from: [4, 4, -4], to: [12, 4, 4]}}}
supports: [{on: bottom, hold: [x, y, z]}, {on: pad, hold: [y, z]}]
loads: [{on: pad, displacement: {x: -1}}]
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}
path: {first: 0.25, largest: 0.25}
estimate: dual
accuracy: 10%
")
run(0 ${BIN}/langer-solve cut.yaml --dry-run)
expect_said("cells, from the error on the first 960")
expect_said("of CPU more, on other meshes")

# One hexahedron that stands for a body has no error of cells: nothing is solved, and the states on the mesh are forecast.
file(READ ${folder}/pulled.yaml pulled)
file(WRITE ${folder}/alike.yaml "${pulled}estimate: dual\naccuracy: 1%\n")
run(0 ${BIN}/langer-solve alike.yaml --dry-run)
expect_said("the states on the mesh take")
if(said MATCHES "are not forecast")
  message(FATAL_ERROR "a homogeneous body was solved for its forecast:\n${said}")
endif()

# bonds of an adhesion let go in short increments
file(READ ${ROOT}/configs/solve/pull_off.yaml pull_off)
file(WRITE ${folder}/pull_off.yaml "${pull_off}")
run(0 ${BIN}/langer-solve pull_off.yaml --dry-run)
expect_said("with short ones while bonds let go")
