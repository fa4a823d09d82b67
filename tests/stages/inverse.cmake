# Fits of scenes as a user runs them: side by side, killed and gone on with, refused without harm to what was there.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
set(scene "mesh: {geometry: {indented_disc: {size: [16, 4], radius: 2.5, depth: 1, edge: 0.2}}}
supports: [{on: bottom, hold: [x, y]}]
contacts:
  sphere: {on: top, rigid: {sphere: {radius: DIAMETER, centre: [0, CENTRE, 0]}}, motion: [{t: 1, to: [0, -1, 0]}]}
material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}
stability: off
path: {first: 0.1, largest: 0.1}
")
string(REPLACE DIAMETER 2.5 small "${scene}")
string(REPLACE CENTRE 6.5 small "${small}")
string(REPLACE DIAMETER 4 large "${scene}")
string(REPLACE CENTRE 8 large "${large}")
file(WRITE ${folder}/post.yaml "columns: [{quantity: u_ind}, {quantity: force}]\n")
foreach(size small large)
  file(WRITE ${folder}/${size}.yaml "${${size}}")
  run(0 ${BIN}/langer-solve ${size}.yaml -o ${size}/solution.h5 --quiet)
  run(0 ${BIN}/langer-post post.yaml --solution ${size}/solution.h5 -o ${size}/curves.h5 --quiet)
endforeach()
set(law "law: {matrix: {yeoh: {a1: 0.05, a2: 0.01, a3: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}
parameters:
  - {key: matrix.yeoh.a1, lower: 0.001, upper: 1}
  - {key: matrix.yeoh.a2, lower: 0, upper: 1}
  - {key: matrix.yeoh.a3, lower: 0, upper: 1}
draft: false
")
set(two "data:
  - {kind: scene, solve: small.yaml, file: small/curves.h5, name: small, columns: {u_ind: u_ind, force: force}, standard_deviation: 2.0e-3}
  - {kind: scene, solve: large.yaml, file: large/curves.h5, name: large, columns: {u_ind: u_ind, force: force}, standard_deviation: 2.0e-3}
")
file(WRITE ${folder}/fit.yaml "${two}${law}")

macro(expect_same a b what)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${folder}/${a} ${folder}/${b} RESULT_VARIABLE differ)
  if(NOT differ EQUAL 0)
    message(FATAL_ERROR "${what}: ${a} and ${b} differ")
  endif()
endmacro()

# side by side the same digits
run(0 ${BIN}/langer-fit fit.yaml -o whole/material.h5)
run(0 ${BIN}/langer-fit fit.yaml --set jobs=2 -o beside/material.h5)
foreach(table parameters fit_small fit_large)
  expect_same(whole/${table}.csv beside/${table}.csv "jobs: 2")
endforeach()

# killed once some runs are kept: the next fit goes on with them, to the same digits
file(WRITE ${WORK}/kill.sh "cd ${folder}
\"$@\" 2> said & p=$!
while kill -0 $p 2>/dev/null && [ \"$(stat -c %s killed/material.h5.runs 2>/dev/null || echo 0)\" -lt 3000 ]; do sleep 0.01; done
kill -KILL $p; wait $p; echo code $?\n")
execute_process(COMMAND sh ${WORK}/kill.sh ${BIN}/langer-fit fit.yaml -o killed/material.h5 OUTPUT_VARIABLE code)
if(NOT code MATCHES "code 137")
  message(FATAL_ERROR "the fit ended before it was killed: ${code}")
endif()
if(NOT EXISTS ${folder}/killed/material.h5.runs OR EXISTS ${folder}/killed/material.h5)
  message(FATAL_ERROR "a killed fit keeps its runs, and has no result")
endif()
run(0 ${BIN}/langer-fit fit.yaml -o killed/material.h5)
expect_said(" cached runs of an earlier fit")
if(EXISTS ${folder}/killed/material.h5.runs)
  message(FATAL_ERROR "the runs of a fit that is done are still there")
endif()
foreach(table parameters fit_small fit_large)
  expect_same(whole/${table}.csv killed/${table}.csv "killed and gone on with")
endforeach()

# what does not fit is named at its line, and what was there stays
file(SHA256 ${folder}/whole/material.h5 before)
macro(expect_refused code text said_at)
  file(WRITE ${folder}/bad.yaml "${text}")
  run(${code} ${BIN}/langer-fit bad.yaml -o whole/material.h5)
  expect_said("${said_at}")
  file(SHA256 ${folder}/whole/material.h5 after)
  if(NOT before STREQUAL after)
    message(FATAL_ERROR "a fit that was refused (${said_at}) changed an earlier result")
  endif()
endmacro()
set(one "data: [{kind: scene, solve: small.yaml, file: short.csv, columns: {u_ind: travel_mm, force: force_N}}]\n")
file(WRITE ${folder}/short.csv "travel_mm,force_N\n0.5,0.1\n0.7,0.2\n0.9,0.3\n1.2,0.5\n")
expect_refused(3 "${one}${law}" "short.csv:5:1")
file(WRITE ${folder}/short.csv "travel_mm,force_MPa\n0.5,0.1\n0.7,0.2\n0.9,0.3\n")
string(REPLACE force_N force_MPa pressed "${one}")
expect_refused(3 "${pressed}${law}" "the unit MPa of the column")
file(WRITE ${folder}/short.csv "travel_mm,force_N\n0.5,0.1\n0.7,0.2\n0.9,0.3\n")
string(REPLACE "force: force_N" "reaction_x: force_N}, on: pad, moved: pad, columns: {reaction_x: force_N, displacement: travel_mm" without "${one}")
string(REPLACE "columns: {u_ind: travel_mm, reaction_x: force_N}, " "" without "${without}")
expect_refused(2 "${without}${law}" pad)
string(REPLACE "matrix.yeoh.a1" "matrix.gent.mu" stranger "${law}")
expect_refused(2 "${one}${stranger}" "parameters[0].key")
# a scene that cannot start: what holds it is not there
string(REPLACE "on: bottom" "on: botom" loose "${small}")
file(WRITE ${folder}/loose.yaml "${loose}")
string(REPLACE small.yaml loose.yaml unheld "${one}")
expect_refused(2 "${unheld}${law}" "loose.yaml:2:13: supports[0].on")
# nor one whose indenter begins inside the body
string(REPLACE "centre: [0, 6.5, 0]" "centre: [0, 3.5, 0]" deep "${small}")
file(WRITE ${folder}/deep.yaml "${deep}")
string(REPLACE small.yaml deep.yaml inside "${one}")
expect_refused(2 "${inside}${law}" "deep.yaml:4:21: contacts.sphere.rigid: starts")

# what a fit leaves open, by derivatives and by sets of its parameters that an ordinary sweep runs: the same deviation, the same parameter first
file(COPY ${ROOT}/data/synthetic_yeoh.csv DESTINATION ${folder})
file(WRITE ${folder}/tension.yaml "data: [{file: synthetic_yeoh.csv, strain_to: 0.5}]\n${law}study: {bootstrap: 60, profiles: false, stability: false}\n")
string(REGEX REPLACE "\nmaterial: [^\n]*" "" without_law "${small}")
file(WRITE ${folder}/press.yaml "${without_law}")
file(WRITE ${folder}/press_linear.yaml "${without_law}uncertainty: linear\n")
file(WRITE ${folder}/open.yaml "pipeline: open
nodes:
  fit: {stage: fit, config: tension.yaml}
  solve: {stage: solve, config: press_linear.yaml, material: fit}
  post: {stage: post, config: post.yaml, solution: solve}
  table: {stage: gather, config: {columns: [force, force_deviation, force_deviation_without_a1, force_deviation_without_a2]}, curves: post}
  set: {stage: sample, material: fit, sweep: {sample: {samples: 60}}}
  solve_set: {stage: solve, config: press.yaml, material: set}
  post_set: {stage: post, config: post.yaml, solution: solve_set}
  spread:
    stage: gather
    config: {columns: [force], figures: {band: {x: u_ind, y: [force]}}}
    curves: post_set
    material: fit
    over: sample
")
run(0 ${BIN}/langer-plan open.yaml -o open --slurm)
file(STRINGS ${folder}/open/slurm/set.steps steps)
list(LENGTH steps n)
expect_equal(${n} 60 "steps of the node set that Slurm gets")
run(0 make -C open)
file(STRINGS ${folder}/open/spread/spread.csv rows)
execute_process(COMMAND awk -F, "NR==FNR {if (FNR==2) {f=$1; d=$2; a1=$3; a2=$4}; next} FNR==2 {
    printf \"%d %d %d\", ($3/f > 0.95 && $3/f < 1.05), ($4/d > 0.75 && $4/d < 1.33), (a1 < a2) == ($7 < $8)}"
  open/table/table.csv open/spread/spread.csv WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE agree)
expect_equal("${agree}" "1 1 1" "force, deviation, order of the parameters, by samples beside those by derivatives; ${rows}")
file(STRINGS ${folder}/open/spread/band.csv rows)
list(GET rows 0 heads)
expect_equal("${heads}" "u_ind_mm,force_mean_N,force_deviation_N,force_lower_95_N,force_upper_95_N" "columns of the band")
# a set that the fit does not have
file(WRITE ${folder}/sample.yaml "number: 1\n")
run(2 ${BIN}/langer-sample sample.yaml --material open/fit/material.h5 --set number=61 -o none.h5)
expect_said("number: 61, and open/fit/material.h5 has 60 sets")
# A curve that begins 0.4 mm before the path does: its end is beyond that of the path, and no optimum can be reached. What
# was reached is kept under names of its own.
string(REPLACE "to: [0, -1, 0]" "to: [0, -1.4, 0]" deep "${small}")
file(WRITE ${folder}/deep.yaml "${deep}")
run(0 ${BIN}/langer-solve deep.yaml -o deep/solution.h5 --quiet)
run(0 ${BIN}/langer-post post.yaml --solution deep/solution.h5 -o deep/curves.h5 --quiet)
execute_process(COMMAND awk -F, "NR==1 {print \"u_ind_mm,force_N\"} NR>1 && $1>0.45 {print $1-0.4 \",\" $2}" deep/curves.csv
  WORKING_DIRECTORY ${folder} OUTPUT_FILE ${folder}/shifted.csv COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${folder}/shifted.yaml "data: [{kind: scene, solve: small.yaml, file: shifted.csv, name: shifted,
  columns: {u_ind: u_ind_mm, force: force_N}, standard_deviation: 1.0e-3}]
law: {matrix: {yeoh: {a1: 0.01, a2: 0.01, a3: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}
parameters: [{key: matrix.yeoh.a1, lower: 0.001, upper: 1}, {key: \"data[0].touch_offset\", lower: -1, upper: 1}]
draft: false
")
run(4 ${BIN}/langer-fit shifted.yaml -o shifted/material.h5)
expect_said("no optimum after")
expect_said("reached.csv")
foreach(file reached.csv reached_fit_shifted.csv)
  if(NOT EXISTS ${folder}/shifted/${file})
    message(FATAL_ERROR "a search without an optimum wrote no ${file}")
  endif()
endforeach()
foreach(file material.h5 parameters.csv)
  if(EXISTS ${folder}/shifted/${file})
    message(FATAL_ERROR "a search without an optimum wrote ${file}")
  endif()
endforeach()

# A fit knows one body and rigid indenters.
file(WRITE ${folder}/fold.yaml "data: [{kind: scene, solve: ${ROOT}/configs/solve/fold.yaml, file: fold.csv, columns: {t: t, force: force_N}}]
law: {matrix: {yeoh: {a1: 0.01, a2: 0.01, a3: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}
parameters: [{key: matrix.yeoh.a1, lower: 0.001, upper: 1}]
")
file(WRITE ${folder}/fold.csv "t,force_N\n0,0\n0.2,0.02\n0.4,0.05\n0.6,0.1\n")
run(2 ${BIN}/langer-fit fold.yaml -o fold/material.h5)
expect_said("has several bodies or `against`; expected one body, and rigid indenters")
