# Vibrations through the stages: the shipped pipeline; a run that is continued at the end of its path;
# pictures and tables of modes.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
run(0 ${BIN}/langer-plan pipelines/dynamic_indentation.yaml -o runs/dynamic_indentation)
run(0 make -C runs/dynamic_indentation)
file(STRINGS ${folder}/runs/dynamic_indentation/table/table.csv rows)
list(LENGTH rows n)
expect_equal(${n} 51 "rows of the table")
list(GET rows 0 names)
expect_equal("${names}" "depth_mm,frequency_Hz,storage_N_mm,loss_N_mm,phase_deg" "columns")
# Deeper is stiffer, and at 10 Hz more of the branches answer than at 1 Hz. The first and tenth row
# of each depth: 1 Hz and 13.3 Hz.
execute_process(COMMAND awk -F, "NR == 2 || NR == 11 || NR == 27 || NR == 36 {k[++n] = $3; if ($4 <= 0) exit 1}
  END {exit !(n == 4 && k[2] > k[1] && k[4] > k[3] && k[3] > 2 * k[1])}"
  INPUT_FILE ${folder}/runs/dynamic_indentation/table/table.csv RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "storage does not grow with depth and frequency: ${rows}")
endif()
foreach(file table/storage.svg table/loss.svg report/report.html)
  if(NOT EXISTS ${folder}/runs/dynamic_indentation/${file})
    message(FATAL_ERROR "${file} was not made")
  endif()
endforeach()

# What follows the path does not decide whether its steps are kept: after a refusal at its end the
# same steps serve another config, with the digits of a run from the beginning.
file(WRITE ${folder}/press.yaml "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [6, 2, 6]}}}
material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts: {ball: {on: top, friction: 0.5, rigid: {sphere: {radius: 3, centre: [0, 5, 0]}}, motion: [{t: 1, to: [0, -0.4, 0]}]}}
path: {first: 0.25, largest: 0.25}
estimate: none
dynamics: {density_kg_m3: 1100}
modes: {count: 4}
harmonic: {frequencies: [10, 100]}
")
file(MAKE_DIRECTORY ${folder}/direct ${folder}/continued)
run(0 ${BIN}/langer-solve press.yaml -o direct/solution.h5)
run(2 ${BIN}/langer-solve press.yaml --set harmonic.face=top --set "harmonic.along=[0, 1, 0]" -o continued/solution.h5)
expect_said("harmonic.face: found a face that touches an indenter")
run(0 ${BIN}/langer-solve press.yaml -o continued/solution.h5)
foreach(file modes.csv harmonic.csv)
  file(READ ${folder}/direct/${file} direct)
  file(READ ${folder}/continued/${file} continued)
  expect_equal("${continued}" "${direct}" "${file} of a continued run")
endforeach()

file(WRITE ${folder}/post.yaml "columns: [{quantity: force}]\nrenders: {mode: {mode: 4}}\n")
run(0 ${BIN}/langer-post post.yaml --solution direct/solution.h5 -o direct/curves.h5)
run(2 ${BIN}/langer-post post.yaml --set renders.mode.mode=5 --solution direct/solution.h5 -o direct/curves.h5)
expect_said("renders.mode.mode: found 5, and the solution has 4 modes")
file(WRITE ${folder}/gather.yaml "rows: modes\n")
run(0 ${BIN}/langer-gather gather.yaml --curves direct/solution.h5 -o gathered/sweep.h5)
run(2 ${BIN}/langer-gather gather.yaml --curves direct/curves.h5 -o gathered/other.h5)
expect_said("curves.h5 has no /modes")
