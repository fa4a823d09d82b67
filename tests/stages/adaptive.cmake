# Tables of make adaptive from a made-up adaptive.csv: an error that is small by a change of sign is no front, none below what the truth is
# known to, and what is not reached stands there.
include(${ROOT}/tests/support/run.cmake)
find_program(PYTHON python3)
if(NOT PYTHON)
  message("not run: no python3")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
file(WRITE ${WORK}/project/adaptive.csv "scene,kind,level,value,error_percent,cpu_s,exit_code
pulled,truth,16 x 8 x 8,1,0.0,2,0
pulled,even hex8,1,1.04,4.0,0.1,0
pulled,even hex8,2,1.0001,0.01,1,0
pulled,even hex8,3,0.99,-1.0,10,0
pulled,even hex8,4,1.0025,0.25,100,0
pulled,graded hex8,2,1.002,0.2,0.1,0
pulled,cut,2%,1.02,2.0,1,0
pulled,cut,1%,1.005,0.5,4,0
pulled,cut,0.1%,,,90,5
pulled,limit,,1,0.3,0,0
")
run(0 ${PYTHON} ${ROOT}/tests/bench/adaptive.py at adaptive.csv)
expect_said("| block pulled between clamped faces | 1 ± 0.3 % | even hex8 | 0.32 | 1 | 38 | unknown | 9.4 times at 0.5 % |")
expect_said("|  |  | graded hex8 | at most 0.1 | at most 0.1 | at most 0.1 | unknown | at most 0.025 times at 0.5 % |")
expect_said("|  |  | cut | at most 1 | 2 | 4 | unknown |  |")
run(0 ${PYTHON} ${ROOT}/tests/bench/adaptive.py runs adaptive.csv)
expect_said("| pulled | even hex8 | +4 at 0.1, +0.01 at 1, -1 at 10, +0.25 at 100 |")
run(0 ${PYTHON} ${ROOT}/tests/bench/adaptive.py picture adaptive.csv)
expect_said("1.000 0.3000 1.0000")
