# What devices report: suction and release of a viscous section gives R0 to R9, an indentation a stiffness, a radius and a loop. They hold
# among each other as their definitions say, and what the path does not reach is refused.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)

# 1 s of suction by 0.01 MPa, 1 s without; the path stops 0.1 s after each change
file(WRITE ${folder}/suction.yaml "mesh:
  geometry: {section: {of: axisymmetric, size: [8, 3], divisions: [8, 3]}}
  points: {apex: [0, 3, 0]}
  sets:
    hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}
    rim: {of: top, within: {cylinder: {axis: y, radius: 3, beyond: 2}}}
supports: [{on: bottom, hold: [x, y]}, {on: rim, hold: [y]}]
material:
  matrix: {neo_hooke: {a1: 0.02}}
  volume: {quadratic: {d: 0.01}}
  viscous: [{gamma: 1, tau: 0.4}]
loads: [{on: hole, pressure: [{t: 0.005, to: -0.01}, {t: 0.05, to: -0.01}, {t: 0.5, to: -0.01}, {t: 0.505, to: 0}, {t: 0.55, to: 0}, {t: 1, to: 0}]}]
path: {first: 0.005, largest: 0.05, seconds: 2}
stability: off
")
file(WRITE ${folder}/post.yaml "columns:
  - {quantity: time}
  - {quantity: u_y, at: apex, name: height}
  - {quantity: applied_pressure}
readings:
  cutometer: {suction_of: height, suction: 1, release: 1}
")
run(0 ${BIN}/langer-solve suction.yaml -o suction/solution.h5 --quiet)
run(0 ${BIN}/langer-post post.yaml --solution suction/solution.h5 -o suction/curves.h5 --json --quiet)
string(REGEX MATCH "{.*}" json "${said}")
foreach(what R0_mm R1_mm R2 R4_mm R5 R6 R7 Ue_mm Uv_mm Uf_mm Ur_mm Ua_mm)
  string(JSON ${what} GET "${json}" cutometer_${what})
endforeach()
execute_process(COMMAND awk "function same(a, b) { return (a - b)^2 < 1e-18 + 1e-18 * b^2 }
  BEGIN { exit !(${Ue_mm} > 0.01 && same(${Ue_mm} + ${Uv_mm}, ${Uf_mm}) && same(${R0_mm}, ${Uf_mm}) && same(${R1_mm}, ${Uf_mm} - ${Ua_mm}) &&
    same(${R2}, ${Ua_mm} / ${Uf_mm}) && same(${R5}, ${Ur_mm} / ${Ue_mm}) && same(${R6}, ${Uv_mm} / ${Ue_mm}) && same(${R7}, ${Ur_mm} / ${Uf_mm}) &&
    same(${R4_mm}, ${R1_mm}) && ${R2} > 0.5 && ${R2} < 1 && ${R7} > 0.3 && ${R7} < ${R2}) }" RESULT_VARIABLE code)
expect_equal(${code} 0 "R0 to R7 do not hold among each other:\n${json}")
file(STRINGS ${folder}/suction/curves.csv rows)
list(GET rows 0 head)
expect_equal("${head}" "time_s,height_mm,applied_pressure_MPa" "columns")
# the history of the scene: 0.01 MPa from 0.01 to 1 s, none from 1.01 s on
execute_process(COMMAND awk -F, "NR > 1 && $1 > 0.0101 && $1 < 0.9999 { ++on; off += ($3 + 0.01)^2 > 1e-20 } NR > 1 && $1 > 1.0101 { ++released; off += $3^2 > 1e-20 }
  END { exit !(on > 5 && released > 5 && off == 0) }" INPUT_FILE ${folder}/suction/curves.csv RESULT_VARIABLE code)
expect_equal(${code} 0 "the pressure applied in suction/curves.csv")

# the report is headed by the suction and the height of the apex, and its table begins with what was asked for
file(WRITE ${folder}/report.yaml "title: Cup\n")
run(0 ${BIN}/langer-report report.yaml --solution suction/solution.h5 --curves suction/curves.h5 -o report.html --quiet)
file(READ ${folder}/report.html page)
execute_process(COMMAND awk "BEGIN { printf \"%.3g\", ${Uf_mm} }" OUTPUT_VARIABLE height)
string(FIND "${page}" "Suction of 0.01 MPa (100 mbar) on a body of revolution, 8 mm in radius and 3 mm high: the apex rises by ${height}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "the report is not headed by the suction")
endif()
string(FIND "${page}" "\"columns\":[{\"name\":\"\",\"unit\":\"\"},{\"name\":\"time\"" at)
if(at EQUAL -1)
  string(REGEX MATCH "\"tables\":.*" tables "${page}")
  string(SUBSTRING "${tables}" 0 400 tables)
  message(FATAL_ERROR "the table does not begin with what was asked for: ${tables}")
endif()

# the path does not stop where a height is needed; it is shorter than a cycle; a key that is none
edit(${folder}/post.yaml "release: 1}" "release: 1, immediate: 0.12}")
run(2 ${BIN}/langer-post post.yaml --solution suction/solution.h5 -o no.h5)
expect_said("no state at 0.12 s")
expect_said("a waypoint of the pressure at t = 0.06 makes the path stop there")
edit(${folder}/post.yaml "release: 1, immediate: 0.12}" "release: 3}")
run(2 ${BIN}/langer-post post.yaml --solution suction/solution.h5 -o no.h5)
expect_said("a cycle of 4 s from 0 s on, and the solution lasts 2 s")
edit(${folder}/post.yaml "suction_of: height" "suction_of: hight")
run(2 ${BIN}/langer-post post.yaml --solution suction/solution.h5 -o no.h5)
expect_said("post.yaml:6:")
expect_said("readings.cutometer.suction_of: \"hight\"; expected the name of a column")

# an indenter, out and back
file(WRITE ${folder}/ball.yaml "mesh: {geometry: {section: {of: axisymmetric, size: [8, 3], divisions: [24, 8]}}}
supports: [{on: bottom, hold: [x, y]}]
material: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 0.01}}}
contacts: {ball: {on: top, rigid: {sphere: {radius: 3, centre: [0, 6, 0]}}, motion: [{t: 0.5, to: [0, -0.4, 0]}, {t: 1, to: [0, 0, 0]}]}}
path: {first: 0.05, largest: 0.05}
stability: off
")
file(WRITE ${folder}/ball_post.yaml "columns: [{quantity: u_ind}, {quantity: force}, {quantity: contact_radius}]
readings:
  stiffness: {slope_of: force, over: u_ind, at: 0.2}
  radius: {value_of: contact_radius, over: force, at: 0.01}
  cycle: {hysteresis_of: force, over: u_ind}
")
run(0 ${BIN}/langer-solve ball.yaml -o ball/solution.h5 --quiet)
run(0 ${BIN}/langer-post ball_post.yaml --solution ball/solution.h5 -o ball/curves.h5 --json --quiet)
string(REGEX MATCH "{.*}" json "${said}")
string(JSON stiffness GET "${json}" stiffness_N_per_mm)
string(JSON radius GET "${json}" radius_mm)
string(JSON loss GET "${json}" cycle_loss_N_mm)
string(JSON ratio GET "${json}" cycle_ratio)
# elastic and without friction: the way back is the way out
execute_process(COMMAND awk "BEGIN { exit !(${stiffness} > 0.1 && ${stiffness} < 10 && ${radius} > 0.2 && ${radius} < 2 && ${ratio} < 1e-6 && ${ratio} > -1e-6) }"
  RESULT_VARIABLE code)
expect_equal(${code} 0 "stiffness ${stiffness} N/mm, radius ${radius} mm, loss ${loss}, ratio ${ratio}")
edit(${folder}/ball_post.yaml "at: 0.2}" "at: 0.7}")
run(2 ${BIN}/langer-post ball_post.yaml --solution ball/solution.h5 -o no.h5)
expect_said("0.7 mm, which u_ind never reaches")
