# Words for the scripts of tests/stages.   ROOT the project, BIN its programs, WORK a folder of the test's own
cmake_minimum_required(VERSION 3.25)

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

# a copy of everything a pipeline reads, so that a test may change it
macro(copy_project)
  file(REMOVE_RECURSE ${WORK})
  file(COPY ${ROOT}/configs ${ROOT}/pipelines ${ROOT}/data DESTINATION ${WORK}/project)
endmacro()

macro(edit file from to)
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
