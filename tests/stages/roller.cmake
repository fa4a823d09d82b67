# A roller of compressible rubber (K = 20 mu) is pressed on a floor by a third of its radius. Both formulations reach the end, with the same
# force within 1 %.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
file(COPY ${ROOT}/tests/support/inp/roller.inp DESTINATION ${folder})
file(WRITE ${folder}/scene.yaml "mesh: {geometry: {file: {path: roller.inp}}}
supports:
  - {on: middle, hold: [x]}
  - {on: front, hold: [z]}
  - {on: back, hold: [z]}
loads:
  - {on: hub, displacement: {x: 0, y: -10.5}}
contacts:
  floor:
    on: tread
    rigid: {plane: {point: [0, -35, 0], normal: [0, 1, 0]}}
    motion: [{t: 1, to: [0, 0, 0]}]
path: {first: 0.02, largest: 0.05}
material:
  matrix: {neo_hooke: {a1: 0.0466102}}
  volume: {quadratic: {d: 1.090909}}
")
foreach(formulation mean_dilatation displacement)
  execute_process(COMMAND ${BIN}/langer-solve scene.yaml --set formulation=${formulation} -o ${formulation}.h5 --json
    WORKING_DIRECTORY ${folder} RESULT_VARIABLE code OUTPUT_VARIABLE json ERROR_VARIABLE said)
  expect_equal(${code} 0 "exit code with ${formulation}: ${said}")
  string(JSON force GET "${json}" force_N)
  string(REGEX MATCH "^[0-9]+" ${formulation} "${force}")
  message("${formulation}: ${force} N")
endforeach()
math(EXPR difference "100 * (${displacement} - ${mean_dilatation})")
if(difference LESS 0 OR difference GREATER mean_dilatation)
  message(FATAL_ERROR "mean_dilatation ${mean_dilatation} N, displacement ${displacement} N")
endif()
