# A run killed again and again continues where it was, and ends with the same curves as a run left alone.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o mesh.h5 --quiet)
set(solve ${BIN}/langer-solve configs/solve/smoke.yaml --mesh mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml --quiet
  --set path.first=0.005 --set path.largest=0.005 -o)
run(0 ${solve} whole/solution.h5)
kill_until_done(killed/solution.h5 100 30 27 ${solve} killed/solution.h5)
if(kept EQUAL 0)
  message(FATAL_ERROR "no attempt was killed on its way: the scene is too small for this test")
endif()
expect_same_curves(configs/post/smoke.yaml)
