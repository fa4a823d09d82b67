# A sweep over fibre angles solves members that are images of each other once; the others are copies that say so, and are made again
# when what they are copied from is.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/project/solve.yaml "mesh:
  geometry: {block: {origin: [-3, 0, -3], size: [6, 3, 6], divisions: [6, 2, 6]}}
  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.6}}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts: {ball: {on: contact, rigid: {sphere: {radius: 3, centre: [0, 6, 0]}}, friction: 0.3, motion: [{t: 1, to: [0, -0.4, 0]}]}}
fibre_angles: [0]
material: {matrix: {yeoh: {a1: 0.1, a2: 0.1, a3: 0.1}}, fibres: [{hgo: {c1: 0.3, c2: 0.5}, alpha: 0}], volume: {quadratic: {d: 1e-3}}}
path: {first: 0.5, largest: 0.5}
")
file(WRITE ${WORK}/project/p.yaml "pipeline: p
nodes:
  solve: {stage: solve, config: solve.yaml, sweep: {alpha: {key: \"fibre_angles[0]\", values: [20, 70, 110, 160], unit: deg}}}
  post: {stage: post, config: {columns: [{quantity: t}, {quantity: force}]}, solution: solve}
  table: {stage: gather, curves: post, over: alpha}
")
run(0 ${BIN}/langer-plan p.yaml)
run(0 make -C runs/p)
expect_said("mirror x = z of alpha_020/solve/solution.h5: not solved again")
expect_said("mirror x of alpha_070/solve/solution.h5: not solved again")
expect_said("mirror x of alpha_020/solve/solution.h5: not solved again")
run(0 make -q -C runs/p)
file(STRINGS ${WORK}/project/runs/p/alpha_070/solve/solution.h5 how REGEX "mirror x = z of [0-9a-f]+")
if(NOT how)
  message(FATAL_ERROR "the provenance of a copy does not say so")
endif()

# a member without siblings is solved, and has the same force
run(0 ${BIN}/langer-solve runs/p/alpha_070/solve/solve.yaml --set symmetry=none -o whole.h5 --json)
string(REGEX MATCH "\"force_N\": ([0-9]+\\.[0-9][0-9][0-9][0-9][0-9][0-9])" _ "${said}")
set(whole ${CMAKE_MATCH_1})
run(0 ${BIN}/langer-solve runs/p/alpha_070/solve/solve.yaml --mirror runs/p/alpha_020/solve/solution.h5 -o copy.h5 --json)
expect_said("\"force_N\": ${whole}")

# what is no image is solved, and says why
run(0 ${BIN}/langer-solve solve.yaml --set contacts.ball.friction=0.2 --mirror runs/p/alpha_020/solve/solution.h5 -o other.h5)
expect_said("not the image of runs/p/alpha_020/solve/solution.h5, which differs in: the configs differ in more than fibre_angles")

# the one that is solved again makes its copies again
pending(runs/p before)
expect_equal("${before}" "" "nothing is pending")
wait_a_tick()
file(TOUCH ${WORK}/project/runs/p/alpha_020/solve/solve.yaml)
run(0 make -n -C runs/p)
foreach(member 020 070 110 160)
  expect_said("-o alpha_${member}/solve/solution.h5")
endforeach()

# array jobs of one node start together: there each member solves itself
run(0 ${BIN}/langer-plan p.yaml --slurm)
file(READ ${WORK}/project/runs/p/slurm/solve.steps steps)
string(FIND "${steps}" " alpha_020" at)
expect_equal(${at} -1 "members of an array that wait for each other")
