# A run that ends at a limit point or is stopped where it loses stability has a failing exit code; --json and a table beside the
# output say where and what nevertheless.
include(${ROOT}/tests/support/run.cmake)
set(folder ${WORK})
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
# A clamped cap under a pressure beyond its limit point.
file(WRITE ${WORK}/cap.yaml "mesh: {geometry: {section: {of: axisymmetric, size: [20, 1], divisions: [8, 1]}}, bend: 100, cells: hex27}
supports: [{on: x_max, hold: [x, y]}]
loads: [{on: top, pressure: 2.0e-4}]
material: {matrix: {neo_hooke: {a1: 0.1666666667}}, volume: {quadratic: {d: 1.0e-2}}}
")
run(4 ${BIN}/langer-solve cap.yaml -o cap.h5 --json --quiet --set on_unstable=stop)
expect_said("\"exit_code\": 4")
expect_said("\"critical_t\": 0.")
expect_said("\"critical_kind\": \"limit point of load\"")
file(STRINGS ${WORK}/cap_critical.csv rows)
list(GET rows 0 head)
expect_equal("${head}" "critical_t,critical_load_factor,critical_kind,critical_symmetry,critical_wave_angle_deg" "the head")
list(GET rows 1 row)
if(NOT row MATCHES "^0\\.[0-9]+,0\\.[0-9]+,limit point of load,axisymmetric,$")
  message(FATAL_ERROR "the row is ${row}")
endif()
# A stiff film on a soft layer, stopped where it wrinkles.
file(WRITE ${WORK}/film.yaml "mesh:
  geometry: {section: {of: plane_strain, size: [14.9, 19], divisions: [8, 8], top: {edge: 0.5}}}
  cells: hex27
  bodies: [{name: soft, thickness: 18}, {name: film, thickness: 1}]
materials:
  soft: {material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-4}}}}
  film: {material: {matrix: {neo_hooke: {a1: 0.3}}, volume: {quadratic: {d: 1.0e-4}}}}
supports: [{on: bottom, hold: [y]}, {on: x_min, hold: [x]}]
loads: [{on: x_max, displacement: {x: -1.49}}]
")
run(4 ${BIN}/langer-solve film.yaml -o film.h5 --json --quiet --set on_unstable=stop)
expect_said("\"critical_kind\": \"bifurcation\"")
expect_said("\"critical_symmetry\": \"symmetric in x\"")
# A body that stays stable has no such words.
run(0 ${BIN}/langer-solve film.yaml -o stable.h5 --json --quiet --set "loads[0].displacement.x=-0.5")
if(said MATCHES "critical" OR EXISTS ${WORK}/stable_critical.csv)
  message(FATAL_ERROR "a stable body has a critical point:\n${said}")
endif()

# The mode of a critical point is drawn about the state before it; a stable path has none.
run(0 ${BIN}/langer-solve film.yaml -o through.h5 --quiet)
file(WRITE ${WORK}/post.yaml "columns: [{quantity: t, name: t}, {quantity: reaction_x, at: x_max, name: force}]
renders: {wave: {critical: true, amplitude: 0.05}}
")
run(0 ${BIN}/langer-post post.yaml --solution through.h5 -o drawn.h5)
if(NOT EXISTS ${WORK}/wave.svg)
  message(FATAL_ERROR "no picture of the mode:\n${said}")
endif()
run(2 ${BIN}/langer-post post.yaml --solution stable.h5 -o none.h5)
expect_said("renders.wave.critical: the path has no critical point with a mode")

# The report shows it as a body whose states are one oscillation.
file(WRITE ${WORK}/report.yaml "title: A film that wrinkles\n")
run(0 ${BIN}/langer-report report.yaml --solution through.h5 -o report.html)
file(READ ${WORK}/report.html page)
string(REGEX MATCHALL "\"n_states\":[0-9]+" states "${page}")
expect_equal("${states}" "\"n_states\":11;\"n_states\":16" "the states of the body and of its mode")
if(NOT page MATCHES "bifurcation at t = 0\\.")
  message(FATAL_ERROR "the report does not name the mode")
endif()
run(0 ${BIN}/langer-report report.yaml --solution stable.h5 -o stable.html)
file(READ ${WORK}/stable.html page)
if(page MATCHES "\"n_states\":16")
  message(FATAL_ERROR "a stable body has a mode in its report")
endif()
