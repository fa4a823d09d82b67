# What a change makes again: only what depends on it; a comment makes nothing again.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(run runs/smoke)
macro(expect_pending what)
  run(0 ${BIN}/langer-plan pipelines/smoke.yaml)
  pending(${run} found)
  expect_equal("${found}" "${ARGN}" "${what}")
endmacro()
set(all alpha_000/post/curves.h5 alpha_000/solve/solution.h5 alpha_060/post/curves.h5 alpha_060/solve/solution.h5 fit/material.h5 mesh/mesh.h5
  report/report.html sensitivity/sensitivity.h5 table/sweep.h5)
expect_pending("at first" ${all})
run(0 make -j2 -C ${run})
expect_pending("after a run")

# what was deleted is made again, and what read it
file(REMOVE ${WORK}/project/${run}/table/sweep.h5)
expect_pending("after a result was deleted" report/report.html table/sweep.h5)
run(0 make -j2 -C ${run})

add_to(${WORK}/project/configs/solve/smoke.yaml "\n# a comment\n")
add_to(${WORK}/project/pipelines/smoke.yaml "\n# a comment\n")
expect_pending("after comments")

edit(${WORK}/project/configs/post/smoke.yaml "snapshots: [last]" "snapshots: [last, 1]")
set(posts alpha_000/post/curves.h5 alpha_060/post/curves.h5 report/report.html table/sweep.h5)
expect_pending("after a change of post" ${posts})
run(0 make -j2 -C ${run})

edit(${WORK}/project/pipelines/smoke.yaml "values: [0, 60]" "values: [0, 45]")
expect_pending("after a new angle" alpha_045/post/curves.h5 alpha_045/solve/solution.h5 report/report.html table/sweep.h5)
run(0 make -j2 -C ${run})
file(STRINGS ${WORK}/project/${run}/table/table.csv rows REGEX "^[0-9]")
list(TRANSFORM rows REPLACE ",.*" "")
expect_equal("${rows}" "0;45" "angles of the table")

edit(${WORK}/project/configs/material/abdomen_hgo_yeoh.yaml "a1: 0.269" "a1: 0.270")
expect_pending("after a new material" alpha_000/post/curves.h5 alpha_000/solve/solution.h5 alpha_045/post/curves.h5 alpha_045/solve/solution.h5
  report/report.html table/sweep.h5)
run(0 make -j2 -C ${run})

file(GLOB curve ${WORK}/project/data/abdomen*.csv)
add_to(${curve} "# one more remark\n")
expect_pending("after a change of the data" fit/material.h5 report/report.html sensitivity/sensitivity.h5)
run(0 make -j2 -C ${run})

# as mv, cp -p and unzip leave it
execute_process(COMMAND sh -c "cp '${curve}' older && echo '# one more' >> older && touch -d 2001-01-01 older && mv older '${curve}'"
  WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
expect_pending("after an older file took the place of the data" fit/material.h5 report/report.html sensitivity/sensitivity.h5)
run(0 make -j2 -C ${run})

# a rebuilt program makes nothing again, unless STRICT
file(MAKE_DIRECTORY ${WORK}/bin)
file(GLOB programs ${BIN}/langer-*)
file(COPY ${programs} DESTINATION ${WORK}/bin NO_SOURCE_PERMISSIONS FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
wait_a_tick()
file(TOUCH ${WORK}/bin/langer-post)
run(0 make -q -C ${run} BIN=${WORK}/bin)
run(1 make -q -C ${run} BIN=${WORK}/bin STRICT=1)
