# A design of experiments through a pipeline: the sweep's members, the table, effects that are known. Meshes stand for runs.
include(${ROOT}/tests/support/run.cmake)
copy_project()
file(WRITE ${WORK}/project/design.yaml "
pipeline: design
nodes:
  mesh:
    stage: mesh
    config: {geometry: {block: {origin: [0, 0, 0], size: [4, 1, 1], divisions: [2, 1, 1]}}}
    sweep:
      sample:
        design:
          parameters:
            - {key: \"geometry.block.size[0]\", name: length, lower: 4, upper: 8, unit: mm}
            - {key: \"geometry.block.size[1]\", name: height, lower: 0.5, upper: 1, unit: mm}
          one_at_a_time: {steps: 2}
          morris: {trajectories: 4, levels: 4}
          figures: true
  table: {stage: gather, config: {columns: [longest_edge]}, curves: mesh, over: sample}
")
run(0 ${BIN}/langer-plan design.yaml)
run(0 make -j2 -C runs/design)
expect_said("longest_edge: Morris mu")
# two cells along x: the longest edge is half the length
file(STRINGS ${WORK}/project/runs/design/table/effects.csv rows)
list(GET rows 1 length)
list(GET rows 2 height)
if(NOT length MATCHES "^longest_edge,mm,length,mm,4,8,(2|1\\.9999999|2\\.0000000)" OR NOT height MATCHES "^longest_edge,mm,height,mm,0\\.5,1,0,0,0,0,0,0,0,0,")
  message(FATAL_ERROR "the effects are\n${length}\n${height}")
endif()
file(STRINGS ${WORK}/project/runs/design/table/table.csv table)
list(GET table 0 head)
expect_equal("${head}" "sample,length_mm,height_mm,longest_edge_mm" "the table's head")
if(NOT EXISTS ${WORK}/project/runs/design/table/effects_longest_edge.svg)
  message(FATAL_ERROR "no figure of the effects")
endif()
# a member too few is refused
run(2 ${BIN}/langer-gather runs/design/table/gather.yaml --curves runs/design/sample_001/mesh/mesh.h5 -o alone/sweep.h5)
