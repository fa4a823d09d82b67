# Words for the scripts of tests/stages.   ROOT the project, BIN its programs, WORK a folder of the test's own
cmake_minimum_required(VERSION 3.25)

# as from a terminal: what a `make test` hands down is not the tests' own, and a make beneath it would say more
foreach(inherited MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES)
  unset(ENV{${inherited}})
endforeach()

# run(<exit code> <command>...): runs it in ${folder} (default ${WORK}/project) and leaves what it said in ${said}
macro(run expected)
  if(NOT folder)
    set(folder ${WORK}/project)
  endif()
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${folder} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL ${expected})
    message(FATAL_ERROR "${ARGN}\nended with ${code}, expected ${expected}; it said:\n${said}")
  endif()
endmacro()

macro(expect_said text)
  string(FIND "${said}" "${text}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "expected to read\n  ${text}\nbut it said:\n${said}")
  endif()
endmacro()

macro(expect_equal found expected what)
  if(NOT "${found}" STREQUAL "${expected}")
    message(FATAL_ERROR "${what}: found\n${found}\nexpected\n${expected}")
  endif()
endmacro()

# What Open MPI's modules leave as they are unloaded has no name by which the leak check of a build with sanitizers could leave it out.
macro(without_leaks_of_mpi)
  if(SANITIZED)
    set(ENV{ASAN_OPTIONS} "$ENV{ASAN_OPTIONS}:detect_leaks=0")
  endif()
endmacro()

# a copy of everything a pipeline reads, so that a test may change it
macro(copy_project)
  file(REMOVE_RECURSE ${WORK})
  file(COPY ${ROOT}/configs ${ROOT}/pipelines ${ROOT}/data DESTINATION ${WORK}/project)
endmacro()

# Times of files are those of the last tick of a clock, every 10 ms at worst; what changes within the tick in which something was made
# from it does not pass for newer.
macro(wait_a_tick)
  execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.05)
endmacro()

macro(add_to file text)
  wait_a_tick()
  file(APPEND "${file}" "${text}")
endmacro()

macro(edit file from to)
  wait_a_tick()
  file(READ ${file} before)
  string(REPLACE "${from}" "${to}" after "${before}")
  if(before STREQUAL after)
    message(FATAL_ERROR "${file} does not hold: ${from}")
  endif()
  file(WRITE ${file} "${after}")
endmacro()

# the programs' outputs that make would make again, without their folders' common part
macro(pending run result)
  execute_process(COMMAND make -n -C ${run} WORKING_DIRECTORY ${WORK}/project OUTPUT_VARIABLE commands ERROR_VARIABLE commands)
  string(REGEX MATCHALL "-o [^\n]+" outputs "${commands}")
  list(TRANSFORM outputs REPLACE "^-o " "")
  list(SORT outputs)
  set(${result} "${outputs}")
endmacro()

# kill_until_done(<what it writes> <first milliseconds> <more each time> <attempts> <command>...): kills the command after a while, lets
# it go on and kills it again; ${kept} is how often it had written steps. A slow or busy machine: the last attempt is left alone.
macro(kill_until_done output first more attempts)
  set(kept 0)
  set(slower 1)
  if(SANITIZED)
    set(slower 10)  # such a build takes a second before its first step
  endif()
  math(EXPR milliseconds "${slower} * ${first}")
  foreach(attempt RANGE 1 ${attempts})
    math(EXPR whole "${milliseconds} / 1000")
    math(EXPR part "${milliseconds} % 1000 + 1000")
    string(SUBSTRING ${part} 1 3 part)
    execute_process(COMMAND timeout --foreground -s KILL ${whole}.${part} ${ARGN} WORKING_DIRECTORY ${folder} OUTPUT_QUIET ERROR_QUIET)
    if(EXISTS ${folder}/${output})
      break()
    endif()
    if(EXISTS ${folder}/${output}.part)
      math(EXPR kept "${kept} + 1")
    endif()
    math(EXPR milliseconds "${milliseconds} + ${slower} * ${more}")
  endforeach()
  if(NOT EXISTS ${folder}/${output})
    run(0 ${ARGN})
  endif()
  message("killed ${kept} times with steps kept")
endmacro()

# expect_same_curves(<post config>): whole/solution.h5 and killed/solution.h5 have the same curves, to the last digit
macro(expect_same_curves post)
  foreach(run whole killed)
    run(0 ${BIN}/langer-post ${post} --solution ${run}/solution.h5 -o ${run}/curves.h5 --quiet)
  endforeach()
  file(READ ${folder}/whole/curves.csv whole)
  file(READ ${folder}/killed/curves.csv killed)
  expect_equal("${killed}" "${whole}" "curves of the run that was killed")
endmacro()
