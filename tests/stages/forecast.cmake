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
