# A real Slurm on this machine, started and stopped here: a sweep sent by slurm/submit, a member that fails, a member that is
# requeued in the middle and goes on where it stopped; and make with LAUNCH=srun inside an allocation.
# Skipped with a word where slurm-wlm and munge are not installed, or the test is not root.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
execute_process(COMMAND bash ${ROOT}/tests/support/slurm.sh ${WORK} ${BIN} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
message("${said}")
if(code EQUAL 77)
  return()
endif()
expect_equal(${code} 0 "exit code of tests/support/slurm.sh")
