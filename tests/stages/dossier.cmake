# langer dossier: evidence of a run as Markdown or HTML. Its numbers are those of the files; what is missing is said with a command, and
# is gone when that is done.
include(${ROOT}/tests/support/run.cmake)
set(ENV{PATH} "${BIN}:$ENV{PATH}")
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})
run(0 ${BIN}/langer new fit skin)
set(folder ${WORK}/skin)
file(WRITE ${folder}/pipeline.yaml "pipeline: skin
nodes:
  fit: {stage: fit, config: {include: fit.yaml, study: {profiles: false, bootstrap: 0, stability: false, candidates: [], figures: false}}}
  solve: {stage: solve, config: solve.yaml, material: fit}
")
file(WRITE ${folder}/solve.yaml "mesh: {geometry: {block: {origin: [0, 0, 0], size: [10, 2, 4], divisions: [6, 2, 3]}}}
supports: [{on: x_min, hold: [x, y, z]}]
loads: [{on: x_max, displacement: {x: 1, y: 0, z: 0}}]
fibre_angles: [0]
path: {steps: 2}
")

# before the run: nothing but what is missing
run(0 ${BIN}/langer-plan pipeline.yaml -o run --quiet)
run(0 ${BIN}/langer dossier run)
expect_said("**Missing:** solve/solution.h5 is not made. `make -C run`")
expect_said("**Missing:** the run has no solution")
run(0 make -C run)
run(0 ${BIN}/langer dossier run --use "compare two ointments" --question "which is stiffer?" --risk "low, low")
set(dossier "${said}")
expect_said("Context of use: compare two ointments")
expect_said("## 4 Calculation verification")
expect_said("The thirteen factors of ASME V&V 40-2018.")
expect_said("**Missing:** a sensitivity analysis")
expect_said("--tests build/Testing/Temporary/LastTest.log`")
expect_said("All 2 steps are up to date")
# numbers of the files
run(0 ${BIN}/langer show --json run/fit/material.h5)
string(REGEX MATCH "\"c1_MPa\": ([-0-9.e]+)" _ "${said}")
execute_process(COMMAND awk "BEGIN { printf \"%.5g\", ${CMAKE_MATCH_1} }" OUTPUT_VARIABLE c1)
set(said "${dossier}")
expect_said("| fit/material.h5 | c1 | MPa | ${c1} |")

# a changed config, and a gap that is filled
edit(${folder}/solve.yaml "x: 1," "x: 1.1,")
run(0 ${BIN}/langer-plan pipeline.yaml -o run --quiet)
run(0 ${BIN}/langer dossier run)
expect_said("would be made again, since")
expect_said("loads[0].displacement.x: 1 -> 1.1")
file(WRITE ${WORK}/LastTest.log "Start testing: Jan 01 00:00 UTC
1/3 Test: solve:the force is that of Hertz to 1e-3
Test Passed.
2/3 Test: layout
Test Passed.
3/3 Test: contact:no node is inside
Test Failed.
")
run(0 ${BIN}/langer dossier run --tests ../LastTest.log)
expect_said("3 tests ran on Jan 01 00:00 UTC, 1 failed")
expect_said("| solve | the force is that of Hertz to 1e-3 |")
expect_said("| contact | 0 | 1 | 0 |")

# a page; no file of another kind is replaced, no other kind is written
run(0 ${BIN}/langer dossier run -o dossier.html --use "a < b & c")
run(0 ${BIN}/langer dossier run -o dossier.html)
run(0 ${BIN}/langer dossier run -o dossier.html --use "a < b & c")
file(READ ${folder}/dossier.html page)
string(FIND "${page}" "Context of use: a &lt; b &amp; c" at)
if(at EQUAL -1 OR NOT page MATCHES "<table>.*</table>")
  message(FATAL_ERROR "the page is\n${page}")
endif()
file(WRITE ${folder}/mine.html "<!DOCTYPE html>my own")
run(3 ${BIN}/langer dossier run -o mine.html)
expect_said("was not made by langer")
run(2 ${BIN}/langer dossier run -o dossier.pdf)
expect_said("the name of an .md or .html file")
run(3 ${BIN}/langer dossier .)
expect_said("there is no Makefile of langer-plan")
run(3 ${BIN}/langer dossier run --tests solve.yaml)
expect_said("no test in it")
