# langer-layers: tables of waves and wrinkles; a wave as a test of langer-fit.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})
foreach(kind waves wrinkles)
  file(WRITE ${WORK}/${kind}.yaml "include: ${ROOT}/configs/layers/${kind}.yaml
directions: [0, 90]
direction_range: ~
figures: false
")
  run(0 ${BIN}/langer-layers ${kind}.yaml --dry-run)
  run(0 ${BIN}/langer-layers ${kind}.yaml -o ${kind}/table.h5)
  file(STRINGS ${WORK}/${kind}/table.csv rows)
  list(GET rows 0 head)
  list(LENGTH rows n)
  expect_equal(${n} 3 "a head and two directions")
  if(kind STREQUAL "waves" AND NOT head MATCHES "^angle_deg,speed_m_s,")
    message(FATAL_ERROR "columns of waves: ${head}")
  elseif(kind STREQUAL "wrinkles" AND NOT head MATCHES "^angle_deg,critical_stretch,wavelength_mm,")
    message(FATAL_ERROR "columns of wrinkles: ${head}")
  endif()
  list(GET rows 1 along)
  list(GET rows 2 across)
  string(REGEX MATCH "^[^,]*,([^,]*)" _ "${along}")
  set(along ${CMAKE_MATCH_1})
  string(REGEX MATCH "^[^,]*,([^,]*)" _ "${across}")
  set(across ${CMAKE_MATCH_1})
  # waves are faster along the fibres; a pinch across them wrinkles at a larger stretch
  if(kind STREQUAL "waves" AND NOT along GREATER across)
    message(FATAL_ERROR "speeds: ${along} along, ${across} across")
  elseif(kind STREQUAL "wrinkles" AND NOT across GREATER along)
    message(FATAL_ERROR "critical stretches: ${along} along, ${across} across")
  endif()
endforeach()

# a frequency of 0 in a measured file is named at its line
file(WRITE ${WORK}/speeds.csv "angle_deg,speed_m_s,frequency_Hz\n0,5,100\n90,4,0\n")
file(WRITE ${WORK}/fit.yaml "data: [{kind: wave, file: speeds.csv, density_kg_m3: 1100}]
law: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-6}}}
bounds: admissible
parameters: [{key: matrix.neo_hooke.a1}]
")
run(3 ${BIN}/langer-fit fit.yaml -o fit.h5)
expect_said("speeds.csv:3:6: columns.frequency: found 0; expected a number > 0 in Hz")

# the truth lies in the intervals
file(WRITE ${WORK}/truth.yaml "include: ${ROOT}/configs/fit/waves.yaml
starts: 1
")
run(0 ${BIN}/langer-fit truth.yaml -o fit/material.h5)
file(STRINGS ${WORK}/fit/parameters.csv rows)
list(REMOVE_AT rows 0)
foreach(row ${rows})
  string(REPLACE "," ";" cells "${row}")
  list(GET cells 1 truth)
  list(GET cells 4 low)
  list(GET cells 5 high)
  if(NOT (low LESS truth AND truth LESS high))
    message(FATAL_ERROR "the interval does not hold the truth: ${row}")
  endif()
endforeach()
