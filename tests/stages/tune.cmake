# A refinement study whose levels are a grid: one line of the pipeline. Nothing is told for less than the reference is known to.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})
file(WRITE ${WORK}/solve.yaml "mesh: {geometry: {indented_disc: {size: [8, 2], radius: 2.5, depth: 0.5}}}
material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}
supports: [{on: bottom, hold: [x, y]}]
contacts: {ball: {rigid: {sphere: {radius: 2.5, centre: [0, 4.5, 0]}}, motion: [{t: 1, to: [0, -0.5, 0]}]}}
stability: off
")
file(WRITE ${WORK}/post.yaml "columns: [{quantity: u_ind}, {quantity: force}]\n")
file(WRITE ${WORK}/tune.yaml "quantities: [force]
reference:
  fitted:
    members: [{member: [0.2-0.25], length: 0.2}, {member: [0.14-0.25], length: 0.14}, {member: [0.1-0.25], length: 0.1}]
wanted: [20, 1.0e-9]
")
file(WRITE ${WORK}/pipeline.yaml "pipeline: study
nodes:
  solve: {stage: solve, config: solve.yaml, sweep: {level: {grid: {mesh.geometry.indented_disc.edge: [0.4, 0.2, 0.14, 0.1], path.largest: [0.5, 0.25]}}}}
  post: {stage: post, config: post.yaml, solution: solve}
  front: {stage: tune, config: tune.yaml, curves: post, over: level}
")
run(0 ${BIN}/langer-plan pipeline.yaml -o run)
run(0 make -C run)
expect_said("1e-09 %: not known, the reference itself is not that accurate")
expect_said("  20 %: 0.")
file(STRINGS ${WORK}/run/front/cheapest.csv rows)
list(GET rows 2 last)
expect_equal("${last}" "force,1e-09,,,," "what is told for less than is known")
file(STRINGS ${WORK}/run/front/levels.csv rows)
list(LENGTH rows n)
expect_equal(${n} 9 "levels and a head")
file(STRINGS ${WORK}/run/front/error_force.csv rows)
list(GET rows 0 head)
expect_equal("${head}" "level,cpu_s,error_percent,error_low,error_high" "columns of the picture")
file(READ ${WORK}/run/front/error_force.gp script)
if(NOT script MATCHES "with yerrorbars")
  message(FATAL_ERROR "no bars in the picture:\n${script}")
endif()
