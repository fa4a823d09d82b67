# Same input, same bytes: every file of every stage, figures too, made twice; and no number depends on the threads.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
macro(make_all name)
  run(0 ${BIN}/langer-plan pipelines/smoke.yaml)
  run(0 make -j2 -C runs/smoke)
  file(RENAME ${folder}/runs/smoke ${folder}/${name})
endmacro()
make_all(first)
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)  # no second is the same
make_all(second)
file(GLOB_RECURSE files RELATIVE ${folder}/first ${folder}/first/*)
file(GLOB_RECURSE others RELATIVE ${folder}/second ${folder}/second/*)
list(FILTER files EXCLUDE REGEX "\\.log$")  # times
list(FILTER others EXCLUDE REGEX "\\.log$")
expect_equal("${others}" "${files}" "the files")
set(n 0)
foreach(file ${files})
  if(file MATCHES "\\.(h5|hdf)$")
    run(0 ${BIN}/langer-compare-h5 first/${file} second/${file} 0)
  elseif(NOT file MATCHES "\\.html$")  # a report says when its files were made
    file(SHA256 ${folder}/first/${file} one)
    file(SHA256 ${folder}/second/${file} two)
    expect_equal(${two} ${one} "${file}")
  endif()
  math(EXPR n "${n} + 1")
endforeach()
message("${n} files the same")

# with the clock stopped, whole files are the same, /provenance and all
set(ENV{SOURCE_DATE_EPOCH} 0)
make_all(third)
make_all(fourth)
foreach(file ${files})
  file(SHA256 ${folder}/third/${file} one)
  file(SHA256 ${folder}/fourth/${file} two)
  expect_equal(${two} ${one} "${file}, clock stopped")
endforeach()
unset(ENV{SOURCE_DATE_EPOCH})

# threads
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet --set "geometry.block.divisions=[20, 4, 20]" --set geometry.block.centre.edge=0.5)
foreach(threads 1 2 3 4)
  run(0 ${BIN}/langer-sensitivity configs/sensitivity/abdomen_across.yaml --material configs/material/abdomen_hgo_yeoh.yaml --quiet
    --set steps=10 --set strain.points=7 --set sobol.samples=128 --set figures=false --set threads=${threads} -o threads_${threads}/sensitivity.h5)
  run(0 ${BIN}/langer-compare-h5 threads_1/sensitivity.h5 threads_${threads}/sensitivity.h5 1e-12 --data)
  run(0 ${BIN}/langer-solve configs/solve/smoke.yaml --mesh mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml --quiet
    --set threads=${threads} -o threads_${threads}/solution.h5)
  run(0 ${BIN}/langer-compare-h5 threads_1/solution.h5 threads_${threads}/solution.h5 1e-12 --data)
  message("${threads} threads: ${said}")
  run(0 ${BIN}/langer-fit configs/fit/abdomen_yeoh.yaml --quiet --set starts=2 --set study.bootstrap=5 --set study.figures=false
    --set study.threads=${threads} -o threads_${threads}/material.h5)
  run(0 ${BIN}/langer-compare-h5 threads_1/material.h5 threads_${threads}/material.h5 1e-12 --data)
endforeach()
