# Ctrl-C, SIGTERM, a second run in the same place, readers that leave: nothing is lost, and everybody is told.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet)
set(solve ${BIN}/langer-solve configs/solve/smoke.yaml --mesh mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml
  --set path.first=0.0025 --set path.largest=0.0025 -o)
run(0 ${solve} whole/solution.h5 --quiet)

# Programs are watched by what they have said and stopped (SIGSTOP) where a test needs them to be somewhere, however slow the machine.
#   runs p  freeze p  thaw p  said p text    a shell without job control starts background jobs with SIGINT ignored; env gives it back
file(WRITE ${WORK}/watch.sh [=[
state() { sed -n 's/^State:[^A-Z]*\(.\).*/\1/p' /proc/$1/status 2>/dev/null; }
runs() { case $(state $1) in ''|Z|X) return 1;; esac; }
freeze() { kill -STOP $1; while runs $1 && [ "$(state $1)" != T ]; do sleep 0.01; done; }
thaw() { kill -CONT $1; while [ "$(state $1)" = T ]; do sleep 0.01; done; }
said() { while runs $1 && ! grep -q "$2" said; do sleep 0.02; done; }
delivered() { while runs $1 && ! grep -q '^ShdPnd:[[:space:]]*0*$' /proc/$1/status; do sleep 0.01; done; }  # no signal waits for $1
]=])

# a signal once the first steps are in: the step is finished and kept, the next run continues from there
macro(stop_by signal expected)
  file(WRITE ${WORK}/stop.sh "cd ${WORK}; . ./watch.sh; cd ${folder}
\"$@\" 2> said & p=$!
said $p '^step   3'; freeze $p; before=$(grep -c '^step' said)
kill -${signal} $p; thaw $p
wait $p; code=$?
echo steps $(($(grep -c '^step' said) - before)); exit $code\n")
  execute_process(COMMAND sh ${WORK}/stop.sh env --default-signal=INT ${solve} ${signal}/solution.h5 -v RESULT_VARIABLE code OUTPUT_VARIABLE steps)
  file(READ ${folder}/said said)
  expect_equal(${code} ${expected} "exit code after SIG${signal}")
  if(NOT steps MATCHES "^steps [01]\n")
    message(FATAL_ERROR "after SIG${signal}: ${steps}")
  endif()
  expect_said("stopped by SIG${signal} at t = 0.")
  expect_said("kept: ${signal}/solution.h5.part (the next run continues from there)")
  if(EXISTS ${folder}/${signal}/solution.h5 OR EXISTS ${folder}/${signal}/solution.h5.lock)
    message(FATAL_ERROR "SIG${signal} left more than the unfinished file")
  endif()
  run(0 ${solve} ${signal}/solution.h5)
  expect_said("solve: continues after ")
  run(0 ${BIN}/langer-compare-h5 whole/solution.h5 ${signal}/solution.h5 1e-12)
endmacro()
stop_by(INT 130)
stop_by(TERM 143)

# while errors are estimated: no scene is waited for, the steps are kept, and the next run makes the estimate or ends without it
set(estimated ${BIN}/langer-solve configs/solve/accuracy_isotropic.yaml --set accuracy=0.5% -v -o)
file(WRITE ${WORK}/estimate.sh "cd ${WORK}; . ./watch.sh; cd ${folder}
\"$@\" 2> said & p=$!
said $p 'errors: scene 2 of 5'; freeze $p; before=$(grep -c iteration said)
kill -INT $p; thaw $p
wait $p; code=$?
echo iterations $(($(grep -c iteration said) - before)); exit $code\n")
execute_process(COMMAND sh ${WORK}/estimate.sh env --default-signal=INT ${estimated} estimated/solution.h5
  RESULT_VARIABLE code OUTPUT_VARIABLE iterations)
file(READ ${folder}/said said)
expect_equal(${code} 130 "exit code after SIGINT in an estimate")
if(NOT iterations MATCHES "^iterations [01]\n" OR said MATCHES "scene 3 of 5" OR EXISTS ${folder}/estimated/solution.h5)
  message(FATAL_ERROR "an estimate went on after SIGINT: ${iterations}${said}")
endif()
expect_said("stopped by SIGINT while its errors were estimated; the path is at its end")
expect_said("kept: all 4 steps in estimated/solution.h5.part (the next run continues with the estimate, --set estimate=none ends without it)")
file(COPY ${folder}/estimated/ DESTINATION ${folder}/without)
run(0 ${estimated} estimated/solution.h5 --json)
expect_said("solve: continues after 4 steps, at t = 1")
expect_said("solve: force 10.")
expect_said("\"force_error_N\"")
string(REGEX MATCH "\"force_N\": [0-9.]+" force "${said}")
run(0 ${estimated} without/solution.h5 --set estimate=none --json)
expect_said("solve: continues after 4 steps, at t = 1")
if(said MATCHES "force_error")
  message(FATAL_ERROR "an estimate that nobody asked for:\n${said}")
endif()
expect_said("${force}")

# what a whole path says, it says after a stop too
file(WRITE ${folder}/far.yaml "mesh: {geometry: {block: {origin: [-8, 0, -8], size: [16, 4, 16], divisions: [4, 2, 4]}}}
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1e-3}}}
supports: [{on: y_min, hold: [x, y, z]}]
contacts: {s: {on: y_max, rigid: {sphere: {radius: 3, centre: [0, 8, 0]}}, motion: [{t: 1, to: [0, -0.5, 0]}]}}
path: {steps: 300}\n")
file(WRITE ${WORK}/far.sh "cd ${WORK}; . ./watch.sh; cd ${folder}
\"$@\" 2> said & p=$!
said $p '^step   3'; freeze $p; kill -INT $p; thaw $p; wait $p\n")
set(far ${BIN}/langer-solve far.yaml -o far/solution.h5)
execute_process(COMMAND sh ${WORK}/far.sh env --default-signal=INT ${far} -v RESULT_VARIABLE code)
expect_equal(${code} 130 "exit code after SIGINT")
run(0 ${far} --quiet)
expect_said("solve: warning: contacts.s: the indenter never touches the body: nearest at t = 1, 0.5 mm from (0, 4, 0)")

# a second signal ends a long step at once, with the same code, and the steps before it are kept; while the program is stopped
# between the two, only the clock goes on
set(long ${BIN}/langer-solve configs/solve/smoke.yaml --mesh fine.h5 --material configs/material/abdomen_hgo_yeoh.yaml -v -o twice/solution.h5)
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o fine.h5 --quiet --set "geometry.block.divisions=[40, 8, 40]" --set geometry.block.centre.edge=0.25)
file(WRITE ${WORK}/twice.sh "cd ${WORK}; . ./watch.sh; cd ${folder}
\"$@\" 2> said & p=$!
said $p 'iteration 0'  # it is in the first step
kill -INT $p; delivered $p
while runs $p; do freeze $p; sleep 0.3; kill -INT $p; thaw $p; delivered $p; done
wait $p\n")
execute_process(COMMAND sh ${WORK}/twice.sh env --default-signal=INT ${long} RESULT_VARIABLE code)
file(READ ${folder}/said said)
expect_equal(${code} 130 "exit code after two signals")
expect_said("ended by SIGINT")
if(said MATCHES "\nstep")
  message(FATAL_ERROR "the second signal waited for the step:\n${said}")
endif()

# other programs end at once; what was there stays
file(SHA256 ${folder}/mesh.h5 before)
foreach(signal INT TERM)
  execute_process(COMMAND env --default-signal=INT timeout -s ${signal} 0.05 ${BIN}/langer-fit configs/fit/abdomen.yaml -o mesh.h5
    WORKING_DIRECTORY ${folder} RESULT_VARIABLE code ERROR_VARIABLE said)
  expect_equal(${code} 124 "timeout's word that langer-fit was still running")
  execute_process(COMMAND env --default-signal=INT timeout --preserve-status -s ${signal} 0.05 ${BIN}/langer-fit configs/fit/abdomen.yaml -o mesh.h5
    WORKING_DIRECTORY ${folder} RESULT_VARIABLE code ERROR_VARIABLE said)
  if(NOT (signal STREQUAL INT AND code EQUAL 130) AND NOT (signal STREQUAL TERM AND code EQUAL 143))
    message(FATAL_ERROR "SIG${signal} ended langer-fit with ${code}")
  endif()
endforeach()
file(SHA256 ${folder}/mesh.h5 after)
expect_equal(${after} ${before} "the old file")

# two runs of one output: the second names the first, which is stopped meanwhile, and ends; the first does not notice
file(WRITE ${WORK}/two.sh "cd ${WORK}; . ./watch.sh; cd ${folder}
\"$@\" --quiet 2> first & p=$!
while runs $p && ! [ -s two/solution.h5.lock ]; do sleep 0.01; done; freeze $p
\"$@\"; second=$?
thaw $p; wait $p; echo pid $p first $? second $second\n")
file(MAKE_DIRECTORY ${folder}/two)
execute_process(COMMAND sh ${WORK}/two.sh ${solve} two/solution.h5 OUTPUT_VARIABLE said ERROR_VARIABLE said)
string(REGEX MATCH "pid ([0-9]+) first 0 second 3" _ "${said}")
set(pid ${CMAKE_MATCH_1})
cmake_host_system_information(RESULT host QUERY HOSTNAME)
if(NOT pid OR NOT said MATCHES "two/solution.h5: is being written by another run, pid ${pid} on [^ ]+ since 20..-..-..T..:..:..Z: langer-solve configs/solve/smoke.yaml")
  message(FATAL_ERROR "two runs of one output said:\n${said}")
endif()
run(0 ${BIN}/langer-compare-h5 whole/solution.h5 two/solution.h5)
file(GLOB_RECURSE locks ${folder}/*.lock)
list(FILTER locks EXCLUDE REGEX "mesh.h5.lock|twice")  # of the programs that were ended at once
expect_equal("${locks}" "" "locks left behind")
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet)  # a lock nobody holds is in nobody's way
if(EXISTS ${folder}/mesh.h5.lock)
  message(FATAL_ERROR "the lock was not removed")
endif()

# readers that leave early, and outputs that take nothing
function(shell expected words)
  execute_process(COMMAND bash -c "set -o pipefail; ${words}" WORKING_DIRECTORY ${folder} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL ${expected})
    message(FATAL_ERROR "${words}\nended with ${code}, expected ${expected}:\n${said}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()
list(JOIN solve " " words)
shell(0 "${words} head/solution.h5 2>&1 | head -1 | grep -q solve:")
run(0 ${BIN}/langer-compare-h5 whole/solution.h5 head/solution.h5)
foreach(stage mesh fit sensitivity solve post gather)
  shell(0 "${BIN}/langer-${stage} --describe | head -1")
  shell(0 "${BIN}/langer-${stage} --help | head -1")
  shell(3 "${BIN}/langer-${stage} --describe > /dev/full")
  expect_said("stdout: cannot be written")
endforeach()
shell(0 "${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --json | true")
shell(0 "${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 2> /dev/full")
shell(3 "${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --json > /dev/full")
expect_said("stdout: cannot be written")
