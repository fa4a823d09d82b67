# Materials that are right in every number and mean something else: a bulk modulus typed for d, fibres that change the volume. The
# check, the dry run and the run warn; the advice cures it.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
set(block "mesh: {geometry: {block: {size: [1,1,1], divisions: [1,1,1]}}}
supports:
  - {on: x_min, hold: [x]}
  - {on: y_min, hold: [y]}
  - {on: z_min, hold: [z]}
")
set(solve ${BIN}/langer-solve --quiet)

macro(expect_silence text)
  string(FIND "${said}" "${text}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "expected not to read\n  ${text}\nbut it said:\n${said}")
  endif()
endmacro()

# d: 1000 with a shear modulus of 0.1 MPa
file(WRITE ${folder}/tension.yaml "${block}loads: [{on: x_max, displacement: {x: 0.1}}]
path: {steps: 2}
material:
  matrix: {neo_hooke: {a1: 0.05}}
  volume: {quadratic: {d: 1000}}
")
set(found "material.volume.quadratic.d: Poisson's ratio is -0.9")
set(advice "if 1000 MPa is the bulk modulus K, write volume.quadratic.d: 0.002")
run(0 ${BIN}/langer check tension.yaml)
expect_said("tension.yaml:10:24: ${found}")
expect_said("${advice}")
run(0 ${solve} tension.yaml --dry-run)
expect_said("warning: tension.yaml:10:24: ${found}")
run(0 ${solve} tension.yaml -o wrong.h5)
expect_said("${advice}")
set(right --set material.volume.quadratic.d=0.002)
run(0 ${solve} tension.yaml ${right} -o right.h5)
expect_silence("warning")

# the same in a file of its own, given by its name, and in one of several materials
file(WRITE ${folder}/law.yaml "matrix: {neo_hooke: {a1: 0.05}}\nvolume: {quadratic: {d: 1000}}\n")
run(0 ${BIN}/langer check law.yaml --as material)
expect_said("law.yaml:2:22: volume.quadratic.d: Poisson's ratio is -0.9")
file(WRITE ${folder}/without.yaml "${block}loads: [{on: x_max, displacement: {x: 0.1}}]\npath: {steps: 2}\n")
run(0 ${solve} without.yaml --material law.yaml -o by_file.h5)
expect_said("${found}")

# A cube pulled along stiff fibres grows by 16 %: the numbers say so, at every bulk modulus that is too small.
file(WRITE ${folder}/along.yaml "${block}loads: [{on: x_max, displacement: {x: 0.3}}]
path: {steps: 6}
material:
  matrix: {neo_hooke: {a1: 0.012}}
  fibres: [{hgo: {c1: 0.5, c2: 1}, alpha: 0}]
  volume: {quadratic: {d: 1}}
")
file(WRITE ${folder}/post.yaml "columns:\n  - {history: volume_change}\n")
run(0 ${BIN}/langer check along.yaml)
expect_said("the bulk modulus of 2 MPa is only 1 times the stiffness of the fibres at rest, 2 MPa")
expect_said("under equal tension from all sides they carry nothing")
run(0 ${solve} along.yaml -o along.h5)
expect_said("an element near (")
expect_said("changes its volume by 15.8 %: ")
string(REGEX MATCH "volume.quadratic.d: ([0-9.e-]+) keeps the volume" advised "${said}")
if(NOT advised)
  message(FATAL_ERROR "no d is advised: ${said}")
endif()
set(d ${CMAKE_MATCH_1})
run(0 ${BIN}/langer-post post.yaml --solution along.h5 -o along_post.h5 --quiet)
file(STRINGS ${folder}/along_post.csv rows)
list(GET rows -1 last)
if(NOT last MATCHES "^0\\.15[78]")
  message(FATAL_ERROR "the last change of volume is ${last}, expected 0.158")
endif()
run(0 ${solve} along.yaml --set material.volume.quadratic.d=0.1 -o stiffer.h5)
expect_said("changes its volume by 2.78 %")
run(0 ${solve} along.yaml --set material.volume.quadratic.d=${d} -o cured.h5)
expect_silence("changes its volume")

# pulled alike from all sides, the same body
file(WRITE ${folder}/all_round.yaml "${block}loads:
  - {on: x_max, pressure: -0.02}
  - {on: y_max, pressure: -0.02}
  - {on: z_max, pressure: -0.02}
path: {steps: 4}
material:
  matrix: {neo_hooke: {a1: 0.012}}
  fibres: [{hgo: {c1: 0.5, c2: 1}, alpha: 0}]
  volume: {quadratic: {d: 10}}
")
run(0 ${solve} all_round.yaml -o all_round.h5)
expect_said("under equal tension from all sides they carry nothing")
expect_said("changes its volume by ")
