# A mesh that the solve config describes gives what the same mesh from a file gives; accuracy chooses its cells.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
file(WRITE ${folder}/mesh.yaml "geometry: {indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.35}}
sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}
")
file(WRITE ${folder}/apart.yaml "include: configs/solve/refinement_table1.yaml
path: {first: 0.5, largest: 0.5}
")
file(WRITE ${folder}/together.yaml "include: apart.yaml
mesh: {include: mesh.yaml}
")
run(0 ${BIN}/langer-mesh mesh.yaml -o mesh.h5 --quiet)
run(0 ${BIN}/langer-solve apart.yaml --mesh mesh.h5 -o apart.h5 --quiet --json)
string(REGEX MATCH "\"force_N\": [0-9.]+" apart "${said}")
run(0 ${BIN}/langer-solve together.yaml -o together.h5 --quiet --json)
string(REGEX MATCH "\"force_N\": [0-9.]+" together "${said}")
if(apart STREQUAL "")
  message(FATAL_ERROR "no force was told")
endif()
expect_equal("${together}" "${apart}" "force with the mesh in the config")
run(0 ${BIN}/langer-post configs/post/force.yaml --solution together.h5 -o curves.h5 --quiet)

run(2 ${BIN}/langer-solve together.yaml --mesh mesh.h5 -o both.h5)
run(2 ${BIN}/langer-solve apart.yaml -o none.h5)
run(0 ${BIN}/langer-solve together.yaml --set accuracy=8% --dry-run)
expect_said("  estimate    about ")
run(0 ${BIN}/langer-solve together.yaml --dry-run)
if(said MATCHES "estimate")
  message(FATAL_ERROR "an estimate is forecast that nobody asked for:\n${said}")
endif()
if(said MATCHES "branch stresses")
  message(FATAL_ERROR "an elastic scene is told of branches:\n${said}")
endif()
run(0 ${BIN}/langer-solve together.yaml --dry-run --set path.seconds=10 --set "material.viscous=[{tau: 1, gamma: 0.5}]")
expect_said("  viscous     branch stresses at the Gauss points take ")
run(0 ${BIN}/langer-solve together.yaml -o good.h5 -v --set accuracy=8% --set path.first=1 --set path.largest=1)
expect_said("8 % wanted")
expect_said("+- ")
run(0 ${BIN}/langer-solve together.yaml -o dry.h5 --set fidelity=reference --dry-run)
expect_said("0.2 % wanted")
run(2 ${BIN}/langer-solve together.yaml -o bad.h5 --set mesh.geometry.indented_block.size=[3,4,30])
expect_said("mesh.geometry.indented_block.size")
