# Steps that were kept are gone on from: what the advice says to change does not throw them away, and no page of the unfinished files that
# a power cut left zero makes a wrong result.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet)
set(solve ${BIN}/langer-solve configs/solve/smoke.yaml --mesh mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml
  --set path.first=0.1 --set path.largest=0.1)
run(0 ${solve} -o whole/solution.h5 --quiet)

# Stopped after its fourth step of ten. A busy machine may look too late, and the run is over: then it is begun again.
function(stop_early output)
  foreach(attempt RANGE 30)
    file(REMOVE_RECURSE ${folder}/${output})
    execute_process(COMMAND sh -c "exec \"$@\" 2> said & p=$!
while ! grep -q '^step   4' said && kill -0 $p; do sleep 0.01; done; kill -INT $p; wait $p" sh env --default-signal=INT ${solve} -v -o ${output}/solution.h5
      WORKING_DIRECTORY ${folder} RESULT_VARIABLE code ERROR_QUIET)
    if(NOT code EQUAL 0)
      break()
    endif()
  endforeach()
  expect_equal(${code} 130 "exit code after SIGINT")
endfunction()
stop_early(kept)
file(COPY ${folder}/kept/ DESTINATION ${folder}/at_four)

# settings of the solver go on from the steps, the scene's own and the mesh's do not
macro(goes_on expected)
  file(REMOVE_RECURSE ${folder}/now)
  file(COPY ${folder}/at_four/ DESTINATION ${folder}/now)
  run(0 ${solve} ${ARGN} -o now/solution.h5)
  expect_said("${expected}")
endmacro()
foreach(setting threads=2 blas_threads=2 path.smallest=1e-6 solver.newton.iterations=60 solver.newton.largest_move=0.7 solver.newton.relative=1e-5
    on_unstable=stop estimate=recovery)
  goes_on("solve: continues after " --set ${setting})
endforeach()
goes_on("these steps were made with other settings" --set threads=2)
run(0 ${BIN}/langer-compare-h5 whole/solution.h5 now/solution.h5 1e-12 --data)
goes_on("asks for 1e-14 now; it is made anew" --set solver.newton.relative=1e-14 --set solver.newton.absolute=1e-9)
goes_on("left by a run with another config or other inputs; starting anew" --set path.largest=0.05 --set path.first=0.05)
goes_on("left by a run with another config or other inputs; starting anew" --set contacts.sphere.friction=0.2)
goes_on("solve: continues after ")
run(0 ${BIN}/langer-compare-h5 whole/solution.h5 now/solution.h5 1e-12)

# no equilibrium: the advice helps, and the next run is shorter
set(hard ${solve} --set solver.newton.iterations=3 --set path.smallest=0.06)
execute_process(COMMAND ${hard} -o hard/solution.h5 WORKING_DIRECTORY ${folder} RESULT_VARIABLE code ERROR_VARIABLE said)
if(code EQUAL 4)
  expect_said("try path.smallest or solver.newton.iterations")
  run(0 ${solve} -o hard/solution.h5)
endif()

# every ninth page of the unfinished files zero: make soak takes every page
foreach(file solution.h5.part solution.h5.steps)
  file(SIZE ${folder}/at_four/${file} size)
  math(EXPR last "(${size} - 1) / 4096")
  foreach(page RANGE 0 ${last} 9)
    file(REMOVE_RECURSE ${folder}/now)
    file(COPY ${folder}/at_four/ DESTINATION ${folder}/now)
    execute_process(COMMAND dd if=/dev/zero of=${folder}/now/${file} bs=4096 count=1 seek=${page} conv=notrunc ERROR_QUIET RESULT_VARIABLE code)
    expect_equal(${code} 0 "dd")
    run(0 ${solve} -o now/solution.h5 --quiet)
    run(0 ${BIN}/langer-compare-h5 whole/solution.h5 now/solution.h5 1e-12)
  endforeach()
endforeach()

# every number that the solver wrote has a line in the list of columns
run(0 ${BIN}/langer describe columns)
string(REGEX MATCHALL "\n  [A-Za-z0-9_*]+ +[^\n]+" lines "${said}")
string(REPLACE ";" "" lines "${lines}")
file(WRITE ${folder}/post.yaml "columns: [{quantity: t}, {history: none_such}]\n")
run(2 ${BIN}/langer-post post.yaml --solution whole/solution.h5 -o curves.h5)
string(REGEX MATCH "expected one of ([a-zA-Z0-9_, ]+)" _ "${said}")
string(REPLACE ", " ";" histories "${CMAKE_MATCH_1}")
list(LENGTH histories n)
if(n LESS 12)
  message(FATAL_ERROR "the histories of a solution are ${histories}:\n${said}")
endif()
foreach(history ${histories})
  if(NOT lines MATCHES "\n  ${history} ")
    message(FATAL_ERROR "langer describe columns has no line for ${history}")
  endif()
endforeach()
