# Tables of make bench-peers from a made-up peers.csv: hits by chance and spheres deep in the body are no answers, failures stand there.
include(${ROOT}/tests/support/run.cmake)
find_program(PYTHON python3)
if(NOT PYTHON)
  message("not run: no python3")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
file(WRITE ${WORK}/project/peers.csv "scene,tool,cells,edge,settings,unknowns,force_N,error_percent,cpu_s,memory_MB,inside_um,words
isotropic,Langer,hex8,0.4,1 increments,,10.1,+0.100,0.10,10,0,
isotropic,Langer,hex8,0.2,4 increments,,10.4,+4.000,0.20,10,0,
isotropic,Langer,hex8,0.1,4 increments,,10.08,+0.800,0.50,10,0,
isotropic,FEBio,q,0.4,5 increments penalty 1,,10.05,-0.500,1.00,10,900,
isotropic,FEBio,q,0.4,5 increments penalty 9,,10.05,-0.500,4.00,10,9,
isotropic,FEBio,q,0.2,5 increments penalty 9,,,,300.00,10,,not done after 300 s
positive,Peer,q,0.2,5 increments penalty 9,,10.05,-0.100,0.01,10,0,
")
run(0 ${PYTHON} ${ROOT}/tests/peers/table.py levels peers.csv isotropic)
expect_said("| Langer | 0.50 (hex8 of 0.1, +0.800 %) | 0.50 (hex8 of 0.1, +0.800 %) | no run | no run |")
expect_said("| FEBio | 4.00 (q of 0.4, -0.500 %) | 4.00 (q of 0.4, -0.500 %) | 4.00 (q of 0.4, -0.500 %) | no run |")
expect_said("| best peer against Langer | 8.0 times | 8.0 times | | |")
run(0 ${PYTHON} ${ROOT}/tests/peers/table.py runs peers.csv isotropic)
expect_said("| FEBio | q | 0.2 | 5 increments penalty 9 |  |  | 300.00 | 10 |  | **not done after 300 s** |")
run(0 ${PYTHON} ${ROOT}/tests/peers/table.py picture peers.csv isotropic)
expect_said("300.00 17 3")
