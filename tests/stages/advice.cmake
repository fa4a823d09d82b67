# Advice that langer-solve gives where a path ends is followed, and works.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(folder ${WORK}/project)
file(MAKE_DIRECTORY ${folder})

# A cube whose nominal stress has a maximum, under a dead traction beyond it: a limit point.
function(write_cube traction)
  file(WRITE ${folder}/cube.yaml "mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}
material: {matrix: {yeoh: {a1: 0.1, a2: -0.02}}, volume: {quadratic: {d: 0.1}}}
supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, traction: {x: ${traction}}}]
path: {first: 0.1, largest: 0.1}
")
endfunction()
write_cube(0.25)
run(4 ${BIN}/langer-solve cube.yaml -o solution.h5)
expect_said("shorter increments do not pass a limit point")
if(said MATCHES "try path.smallest")
  message(FATAL_ERROR "advice that cannot help at a limit point:\n${said}")
endif()
if(NOT said MATCHES "in proportion to t: (0.[0-9]+) times")
  message(FATAL_ERROR "no share of the load:\n${said}")
endif()
set(share ${CMAKE_MATCH_1})
execute_process(COMMAND awk "BEGIN { print ${share} * 0.25 }" OUTPUT_VARIABLE reached OUTPUT_STRIP_TRAILING_WHITESPACE)
write_cube(${reached})
run(0 ${BIN}/langer-solve cube.yaml -o reached.h5)
# what is said of tangents of iterations is no statement about the state
if(said MATCHES "the body is unstable")
  message(FATAL_ERROR "a stable bar is called unstable:\n${said}")
endif()

# steps and seconds together, and an increment that fails: the path ends, and a signal ends it before
file(WRITE ${folder}/hard.yaml "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [6, 2, 6]}}}
material: {matrix: {neo_hooke: {a1: 0.012}}, fibres: [{hgo: {c1: 0.06, c2: 20}, alpha: 20}], volume: {quadratic: {d: 1.0e-4}}}
supports: [{on: bottom, hold: [x, y, z]}]
loads: [{on: top, displacement: {x: [{s: 1, to: 6}]}}]
path: {steps: 2, seconds: 1, smallest: 0.05}
stability: off
")
execute_process(COMMAND ${BIN}/langer-solve hard.yaml -o hard.h5 WORKING_DIRECTORY ${folder} TIMEOUT 300
  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT code MATCHES "^[04]$")
  message(FATAL_ERROR "steps and seconds: ended with ${code}; it said:\n${said}")
endif()

# A volume that grows and shrinks again: its pressure turns where the volume does, which is no limit
# point. A volume above a face that is held cannot be given.
function(write_bag on volume)
  file(WRITE ${folder}/bag.yaml "mesh: {geometry: {block: {size: [4, 4, 4], divisions: [2, 2, 2]}}}
material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1}}}
supports: [{on: bottom, hold: [x, y, z]}]
loads:
  - {on: ${on}, volume: ${volume}}
")
endfunction()
write_bag(top "[{t: 0.5, to: 1}, {t: 1, to: 0}]")
run(0 ${BIN}/langer-solve bag.yaml -o bag.h5)
if(said MATCHES "limit point")
  message(FATAL_ERROR "a volume that turns around is called a limit point:\n${said}")
endif()
write_bag(bottom 1)
run(2 ${BIN}/langer-solve bag.yaml -o held.h5)
expect_said("bag.yaml:5:6: loads[0].on: found \"bottom\", which is held along its normal everywhere")
