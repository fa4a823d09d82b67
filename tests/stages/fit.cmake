# langer-fit and langer-sensitivity as programs: what they write, what they refuse, and that a refusal leaves old results alone.
#   cmake -DROOT=<project> -DBIN=<programs> -DWORK=<folder> -P fit.cmake
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

function(run expected_code expected_text)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE said)
  if(NOT code EQUAL expected_code)
    message(FATAL_ERROR "${ARGN}\nended with ${code}, expected ${expected_code}\n${out}${said}")
  endif()
  string(FIND "${out}${said}" "${expected_text}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${ARGN}\nsaid\n${out}${said}\nwithout \"${expected_text}\"")
  endif()
endfunction()

# the three laws of Table 1
run(0 "a1 and c1 are correlated" ${BIN}/langer-fit ${ROOT}/configs/fit/abdomen.yaml -o hgo_yeoh/material.h5)
run(0 "starts with a negative slope" ${BIN}/langer-fit ${ROOT}/configs/fit/abdomen_yeoh.yaml -o yeoh/material.h5)
run(0 "\"mean_error_percent\": 2.3" ${BIN}/langer-fit ${ROOT}/configs/fit/abdomen_hgo.yaml -o hgo/material.h5 --json)
file(STRINGS ${WORK}/hgo_yeoh/fit.csv lines)
list(LENGTH lines count)
list(GET lines 0 header)
if(NOT count EQUAL 32 OR NOT header STREQUAL "strain,cauchy_stress_MPa,model_MPa,error_percent")
  message(FATAL_ERROR "fit.csv has ${count} lines and the columns ${header}")
endif()

# a file of somebody else with the name of one that a search without an optimum leaves
file(WRITE ${WORK}/own/reached.csv "mine\n")
run(0 "" ${BIN}/langer-fit ${ROOT}/configs/fit/abdomen_yeoh.yaml -o own/material.h5 --quiet)
file(READ ${WORK}/own/reached.csv kept)
if(NOT kept STREQUAL "mine\n")
  message(FATAL_ERROR "a fit changed a file that it did not make: ${kept}")
endif()

# where a search ends without an optimum, its own reason is the error of the run
file(WRITE ${WORK}/foreign/reached.csv "mine\n")
file(WRITE ${WORK}/foreign/specimens.csv "id\nA\nB\nC\n")
foreach(specimen A 2 B 3 C 4)
  if(specimen MATCHES "[ABC]")
    set(name ${specimen})
  else()
    file(WRITE ${WORK}/foreign/${name}_tension.csv
         "strain,nominal_stress_MPa\n0,0\n0.1,0.00${specimen}\n0.2,0.01${specimen}\n0.3,0.02${specimen}\n0.4,0.03${specimen}\n")
  endif()
endforeach()
file(WRITE ${WORK}/foreign/fit.yaml "specimens: {table: specimens.csv, data: \"{id}_{test}.csv\"}\n"
     "law: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1e-6}}}\n"
     "bounds: admissible\nparameters: [{key: matrix.neo_hooke.a1, lower: 0.0001, upper: 0.001, start: 0.0005}]\n")
foreach(text "what the search reached is not kept" "is outside its bounds 0.0001 to 0.001")
  run(4 "${text}" ${BIN}/langer-fit foreign/fit.yaml -o foreign/population.h5)
endforeach()
file(READ ${WORK}/foreign/reached.csv kept)
if(NOT kept STREQUAL "mine\n")
  message(FATAL_ERROR "a search without an optimum changed a file that it did not make: ${kept}")
endif()

# equal inputs give equal files
set(ENV{SOURCE_DATE_EPOCH} 0)
foreach(copy 1 2)
  run(0 "" ${BIN}/langer-fit ${ROOT}/configs/fit/abdomen.yaml -o same/material.h5 --quiet)
  file(SHA256 ${WORK}/same/material.h5 hash_${copy})
endforeach()
if(NOT hash_1 STREQUAL hash_2)
  message(FATAL_ERROR "two fits of one config differ")
endif()

# sensitivity from a fit, from a file, with the fit's own bounds
run(0 "" ${BIN}/langer-sensitivity ${ROOT}/configs/sensitivity/abdomen.yaml --material hgo_yeoh/material.h5 -o s/sensitivity.h5)
run(0 "mu_star_a1_zone3" ${BIN}/langer-sensitivity ${ROOT}/configs/sensitivity/abdomen.yaml
    --material ${ROOT}/configs/material/abdomen_hgo_yeoh.yaml -o s2/sensitivity.h5 --json)
file(STRINGS ${WORK}/s/sensitivity_zones.csv lines)
list(LENGTH lines count)
if(NOT count EQUAL 16)
  message(FATAL_ERROR "5 parameters in 3 zones made ${count} lines")
endif()
file(WRITE ${WORK}/own_bounds.yaml "{}\n")
run(0 "3 parameters" ${BIN}/langer-sensitivity own_bounds.yaml --material yeoh/material.h5 -o s3/sensitivity.h5)
run(2 "the material was not fitted" ${BIN}/langer-sensitivity own_bounds.yaml
    --material ${ROOT}/configs/material/abdomen_yeoh.yaml -o s4/sensitivity.h5)
file(WRITE ${WORK}/unknown.yaml "parameters:\n  - {key: matrix.yeoh.a9, around: 0.5}\n")
run(2 "unknown.yaml:2:6: parameters[0].key: the material has no number \"matrix.yeoh.a9\"" ${BIN}/langer-sensitivity unknown.yaml
    --material yeoh/material.h5 -o s4/sensitivity.h5)

# bad curves: exit code 3, the place, and what was there stays
file(SHA256 ${WORK}/yeoh/material.h5 before)
file(READ ${ROOT}/configs/fit/abdomen_yeoh.yaml config)
foreach(case "nan|0.1,nan|curve.csv:3:5: found nan; expected a finite number"
             "cells|0.1|curve.csv:3:1: found 1 cells"
             "few|0.1,0.2|curve.csv: curve: 2 points in the fitted range; expected as many as there are parameters (3)")
  string(REPLACE "|" ";" case "${case}")
  list(GET case 0 name)
  list(GET case 1 line)
  list(GET case 2 message)
  file(WRITE ${WORK}/${name}/curve.csv "strain,cauchy_stress_MPa\n0,0\n${line}\n")
  string(REPLACE "../../data/abdomen_socci2007_reconstructed.csv" "curve.csv" changed "${config}")
  file(WRITE ${WORK}/${name}/fit.yaml "${changed}")
  run(3 "${message}" ${BIN}/langer-fit ${name}/fit.yaml -o yeoh/material.h5)
endforeach()
file(WRITE ${WORK}/absent.yaml "${changed}")
run(3 "data[0].file" ${BIN}/langer-fit absent.yaml -o yeoh/material.h5)
file(SHA256 ${WORK}/yeoh/material.h5 after)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "a refused fit has touched the result that was there")
endif()

# the axes of an equibiaxial test in one file, or each in its own with a grid of its own: the same numbers
set(both "lx,px_MPa,lz,pz_MPa\n")
set(along "lx,px_MPa\n")
set(across "lz,pz_MPa\n")
foreach(row "1.02;0.0021;1.03;0.0022" "1.05;0.0058;1.06;0.0046" "1.1;0.0131;1.09;0.0070" "1.15;0.0212;1.14;0.0112" "1.2;0.0304;1.21;0.0177")
  list(JOIN row "," line)
  string(APPEND both "${line}\n")
  string(REGEX MATCH "^([^,]*,[^,]*),(.*)$" _ "${line}")
  string(APPEND along "${CMAKE_MATCH_1}\n")
  string(APPEND across "${CMAKE_MATCH_2}\n")
endforeach()
foreach(file both along across)
  file(WRITE ${WORK}/${file}.csv "${${file}}")
endforeach()
set(law "law: {matrix: {yeoh: {a1: 0.02, a2: 0.01}}, fibres: [{hgo: {c1: 0.01, c2: 0.5}, alpha: 0}], volume: {quadratic: {d: 1e-3}}}
parameters: [{key: matrix.yeoh.a1}, {key: \"fibres[0].hgo.c1\"}]
bounds: admissible
starts: 1
")
file(WRITE ${WORK}/one.yaml "data: [{file: both.csv, kind: equibiaxial, stress: nominal,
  columns: {strain_x: lx, strain_z: lz, stress_x: px_MPa, stress_z: pz_MPa}}]\n${law}")
file(WRITE ${WORK}/two.yaml "data:
  - {file: along.csv, kind: equibiaxial, stress: nominal, columns: {strain_x: lx, stress_x: px_MPa}}
  - {file: across.csv, kind: equibiaxial, stress: nominal, columns: {strain_x: lz, stress_x: pz_MPa}, fibre_angle: 90}\n${law}")
foreach(files one two)
  execute_process(COMMAND ${BIN}/langer-fit ${files}.yaml -o ${files}.h5 --json --quiet WORKING_DIRECTORY ${WORK}
    OUTPUT_VARIABLE said ERROR_VARIABLE warned COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "\"a1_MPa\".*" ${files} "${said}")
endforeach()
if(NOT one OR NOT one STREQUAL two)
  message(FATAL_ERROR "one file: ${one}\ntwo files: ${two}\n${said}")
endif()

# a record of ramps and holds: without its first cycle, which is another material's, the made-up truth is found
set(record_keys --set "data[0].compare_from=88.4" --set starts=1 --set "study={profiles: false, bootstrap: 0, stability: false, candidates: [], figures: false}")
execute_process(COMMAND ${BIN}/langer-fit ${ROOT}/configs/fit/relaxation_invivo_two.yaml ${record_keys} -o record/material.h5 --json
  WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE json ERROR_QUIET)
foreach(known "gamma;0.55;0.67" "tau_s;0.42;0.56" "gamma_2;0.395;0.407" "tau_2_s;14.6;15.5")
  list(GET known 0 name)
  list(GET known 1 low)
  list(GET known 2 high)
  if(NOT json MATCHES "\"${name}\": ([0-9.]+)" OR CMAKE_MATCH_1 LESS low OR CMAKE_MATCH_1 GREATER high)
    message(FATAL_ERROR "${name} is not within ${low} to ${high} in\n${json}")
  endif()
endforeach()
set(measured ${ROOT}/../shared/data/skin_invivo_relaxation.csv)
if(EXISTS ${measured})
  run(0 "the law misses the curves" ${BIN}/langer-fit ${ROOT}/configs/fit/relaxation_invivo_two.yaml --set "data[0].file=${measured}" --set starts=1
    --set "study={profiles: false, bootstrap: 0, stability: false, candidates: [], figures: false}" -o record_measured/material.h5)
else()
  message(STATUS "no record measured in vivo here: only the made-up one was fitted")
endif()

# a law that describes the data worse than their mean is written, and is no success
file(WRITE ${WORK}/stiff.csv "stretch,nominal_stress_MPa\n1,0\n1.1,0.0055\n1.2,0.0101\n1.3,0.0142\n")
set(stiff "law: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 1e-6}}}\nparameters: [{key: matrix.neo_hooke.a1, lower: 0.5, upper: 2}]\n")
file(WRITE ${WORK}/stiff.yaml "data: [{file: stiff.csv}]\n${stiff}")
run(4 "the law describes the data worse than their mean does; expected R2 above 0" ${BIN}/langer-fit stiff.yaml -o stiff/material.h5)
run(0 "neo_hooke" ${BIN}/langer show stiff/material.h5)
# one test of several that the law describes so badly is warned of
file(WRITE ${WORK}/soft.csv "stretch,nominal_stress_MPa\n1,0\n1.1,0.09\n1.2,0.17\n1.3,0.23\n")
file(WRITE ${WORK}/large.csv "stretch,nominal_stress_MPa\n1,0\n1.1,0.28\n1.2,0.51\n1.3,0.70\n")
file(WRITE ${WORK}/both.yaml "data: [{file: soft.csv}, {file: large.csv}]\n${stiff}noise: white\n")
run(0 "the law describes this test worse than its mean does" ${BIN}/langer-fit both.yaml -o both/material.h5)

# compression that counts positive is refused by every program that reads the data, and the key that is named cures it
file(WRITE ${WORK}/pressed.csv "stretch,nominal_stress_kPa\n1,0\n0.9,6.69136\n0.8,15.25\n0.7,27.818\n")
set(pressed "law: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1e-6}}}\nbounds: admissible\nparameters: [{key: matrix.neo_hooke.a1}]\n")
file(WRITE ${WORK}/pressed.yaml "data: [{file: pressed.csv}]\n${pressed}")
run(3 "pressed.csv: stress_sign: found a stretch of 0.7 with a stress of" ${BIN}/langer-fit pressed.yaml -o pressed/material.h5)
run(3 "stress_sign: -1 in the item of `data`" ${BIN}/langer check pressed.yaml)
file(WRITE ${WORK}/turned.yaml "data: [{file: pressed.csv, stress_sign: -1}]\n${pressed}")
run(0 "\"a1_MPa\": 0.0" ${BIN}/langer-fit turned.yaml -o turned/material.h5 --json)

# a workbook
string(ASCII 80 75 3 4 workbook)
file(WRITE ${WORK}/curve.xlsx "${workbook}rest")
file(WRITE ${WORK}/workbook.yaml "data: [{file: curve.xlsx}]\n${pressed}")
run(3 "curve.xlsx:1:1: found a workbook (.xlsx, .ods) or another zip archive" ${BIN}/langer-fit workbook.yaml -o workbook/material.h5)
