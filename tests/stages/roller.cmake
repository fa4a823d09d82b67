# A roller of compressible rubber (K = 20 mu) is pressed on a floor until cells of mean dilatation fold at the edge of the contact. The
# message says which formulation goes further, and that one reaches the end.
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
run(4 ${BIN}/langer-solve scene.yaml -o folded.h5 --quiet)
expect_said("stopped at t = 0.")
expect_said("formulation: displacement")
run(0 ${BIN}/langer-solve scene.yaml --set formulation=displacement -o whole.h5 --quiet)

# a material that would lock gets no such advice
run(4 ${BIN}/langer-solve scene.yaml --set material.volume.quadratic.d=0.01 --set path.smallest=0.01
  --set solver.newton.iterations=3 -o other.h5 --quiet)
string(FIND "${said}" "formulation: displacement" at)
if(NOT at EQUAL -1)
  message(FATAL_ERROR "displacement cells lock at K = 2000 mu: ${said}")
endif()
