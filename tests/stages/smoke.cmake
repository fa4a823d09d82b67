# The whole pipeline on a few cells: every stage runs, a second run does nothing, results do not depend on where it ran.
include(${ROOT}/tests/support/run.cmake)
copy_project()
run(0 ${BIN}/langer-plan pipelines/smoke.yaml)
expect_said("7 nodes, 9 steps")
run(0 make -j2 -C runs/smoke)
foreach(file fit/material.h5 mesh/mesh.h5 sensitivity/sensitivity.h5 alpha_000/solve/solution.h5 alpha_060/solve/solution.h5
    alpha_000/post/curves.h5 alpha_060/post/curves.csv table/sweep.h5 table/table.csv report/report.html)
  if(NOT EXISTS ${WORK}/project/runs/smoke/${file})
    message(FATAL_ERROR "${file} was not made")
  endif()
endforeach()
file(GLOB_RECURSE parts ${WORK}/project/runs/*.part)
expect_equal("${parts}" "" "unfinished files")
file(STRINGS ${WORK}/project/runs/smoke/table/table.csv table)
list(LENGTH table rows)
expect_equal(${rows} 3 "lines of the table")
list(GET table 0 head)
if(NOT head MATCHES "^alpha_deg,.*force_N")
  message(FATAL_ERROR "the table's head is ${head}")
endif()
list(GET table 2 last)
if(NOT last MATCHES "^60,.*[0-9]\\.[0-9]")
  message(FATAL_ERROR "the table's last row is ${last}")
endif()

# again: nothing to write, nothing to make
run(0 ${BIN}/langer-plan pipelines/smoke.yaml)
expect_said("0 configs new or changed")
run(0 make -q -C runs/smoke)

# elsewhere: the same table
run(0 ${BIN}/langer-plan pipelines/smoke.yaml -o ${WORK}/elsewhere/deep/run)
run(0 make -j2 -C ${WORK}/elsewhere/deep/run)
file(READ ${WORK}/project/runs/smoke/table/table.csv here)
file(READ ${WORK}/elsewhere/deep/run/table/table.csv there)
expect_equal("${there}" "${here}" "the table made elsewhere")

# one stage alone, by hand
run(0 ${BIN}/langer-gather runs/smoke/table/gather.yaml --curves runs/smoke/alpha_000/post/curves.h5 --curves runs/smoke/alpha_060/post/curves.h5
  -o alone/sweep.h5 --json)
file(READ ${WORK}/project/alone/table.csv alone)
expect_equal("${alone}" "${here}" "the table gathered by hand")
