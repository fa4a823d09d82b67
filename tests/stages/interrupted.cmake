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
  execute_process(COMMAND sh ${WORK}/stop.sh env --default-signal=INT ${solve} ${signal}/solution.h5 RESULT_VARIABLE code OUTPUT_VARIABLE steps)
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
shell(0 "${words} head/solution.h5 2>&1 | head -1 | grep -q hexahedra")
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
