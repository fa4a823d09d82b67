# Input files of Abaqus/CAE and Gmsh as people have them: included files, instances, reversed elements, physical groups. What is
# included is an input of the run.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
set(nodes "*NODE, NSET=all\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n")
set(element "*ELEMENT, TYPE=C3D8H, ELSET=skin\n1,1,2,3,4,5,6,7,8\n")
file(WRITE ${folder}/nodes.inc "${nodes}")
file(WRITE ${folder}/materials.inc "*MATERIAL, NAME=m\n*HYPERELASTIC, NEO HOOKE\n0.05, 0.01\n")
file(WRITE ${folder}/main.inp
  "*HEADING\n nodes and materials elsewhere\n*INCLUDE, INPUT=\"nodes.inc\"\n*INCLUDE, INPUT=materials.inc\n${element}*SOLID SECTION, ELSET=skin, MATERIAL=m\n")
file(WRITE ${folder}/mesh.yaml "geometry: {file: {path: main.inp}}\n")

run(0 ${BIN}/langer-mesh mesh.yaml -o mesh.h5)
set(keys "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.01}}}")
expect_said("the material m of skin for a solve config, with the numbers of the file: ${keys}")

# this text is right in a solve config, and langer-solve prints it too where it reads the file itself
file(WRITE ${folder}/copied.yaml
  "mesh: {geometry: {file: {path: main.inp}}}\n${keys}\n"
  "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 0.2}}]\npath: {steps: 1}\n")
run(0 ${BIN}/langer-solve copied.yaml -o copied.h5)
expect_said("the material m of skin for a solve config")
file(REMOVE ${folder}/copied.h5)
run(0 ${BIN}/langer check mesh.yaml)
run(0 ${BIN}/langer show mesh.h5)
expect_said("skin")

# the identity of the mesh follows what is included
run(0 ${BIN}/langer-mesh mesh.yaml -o same.h5 --json --quiet)
file(READ ${folder}/nodes.inc before)
string(REPLACE "7,1,1,1" "7,1,1,1.5" after "${before}")
macro(included_id file variable)
  run(0 ${BIN}/langer show ${file})
  string(REGEX MATCH "geometry.file.path.include\\[0\\] ([0-9a-f]+)" found "${said}")
  if(NOT found)
    message(FATAL_ERROR "the included file is no input of the mesh: ${said}")
  endif()
  set(${variable} ${CMAKE_MATCH_1})
endmacro()
included_id(mesh.h5 first)
included_id(same.h5 same)
expect_equal("${same}" "${first}" "the identity of the same included file")
file(WRITE ${folder}/nodes.inc "${after}")
run(0 ${BIN}/langer-mesh mesh.yaml -o mesh.h5 --quiet)
included_id(mesh.h5 second)
if(first STREQUAL second)
  message(FATAL_ERROR "another included file has the same identity")
endif()

# nothing that the run makes replaces an included file
file(RENAME ${folder}/nodes.inc ${folder}/out.inp)
file(READ ${folder}/main.inp main)
string(REPLACE "nodes.inc" "out.inp" main "${main}")
file(WRITE ${folder}/main.inp "${main}")
run(3 ${BIN}/langer-mesh mesh.yaml --set "export=[inp]" -o out.h5)
expect_said("out.inp: is read by this run and would be replaced")
run(3 ${BIN}/langer-mesh mesh.yaml -o mesh.h5 --log out.inp)
expect_said("out.inp: ")

# paths as programs on Windows write them
file(MAKE_DIRECTORY ${folder}/sub)
file(WRITE ${folder}/sub/w.inc "${nodes}")
file(WRITE ${folder}/main.inp "*HEADING\n*INCLUDE, INPUT=sub\\w.inc\n${element}")
run(0 ${BIN}/langer-mesh mesh.yaml -o windows.h5)
file(WRITE ${folder}/main.inp "*HEADING\n*INCLUDE, INPUT=..\\outside.inc\n${element}")
run(3 ${BIN}/langer-mesh mesh.yaml -o windows.h5)
expect_said("is not in the folder of the main file")

# files that cannot be included, by name and line
foreach(bad "../outside.inc;is not in the folder of the main file" "/etc/hostname;is not in the folder of the main file"
    "nothing.inc;there is no such file" "fifo;is no plain file" "main.inp;which includes this file")
  list(POP_FRONT bad named)
  execute_process(COMMAND mkfifo ${folder}/fifo ERROR_QUIET)
  file(WRITE ${WORK}/outside.inc "${nodes}")
  file(WRITE ${folder}/main.inp "*HEADING\n*INCLUDE, INPUT=${named}\n${element}")
  run(3 ${BIN}/langer-mesh mesh.yaml -o bad.h5)
  expect_said("main.inp:2:1: *INCLUDE of \"${named}\"")
  expect_said("${bad}")
endforeach()

# elements of which all are numbered the other way round
file(WRITE ${folder}/main.inp "${nodes}*ELEMENT, TYPE=C3D8\n1,5,6,7,8,1,2,3,4\n")
run(0 ${BIN}/langer-mesh mesh.yaml -o turned.h5)
expect_said("the nodes of 1 of 1 elements are numbered the other way round (first: element 1, ")
file(WRITE ${folder}/main.inp "${nodes}*ELEMENT, TYPE=C3D8\n1,1,2,4,3,5,6,7,8\n")
run(3 ${BIN}/langer-mesh mesh.yaml -o folded.h5)
expect_said("main.inp:11:1: element 1 is folded")

# Cook's membrane as Gmsh writes it: quadratic, bent between two clamps, with physical groups alone
# and with node sets. The force on the right is the traction times its area.
foreach(groups elements nodes)
  file(WRITE ${folder}/scene.yaml "mesh: {geometry: {file: {path: cook_${groups}.inp}}, cells: hex27}
supports:
  - {on: left, hold: [x, y, z]}
  - {on: front, hold: [z]}
  - {on: back, hold: [z]}
loads:
  - {on: right, traction: {y: 1e-3}}
path: {steps: 1}
material:
  matrix: {neo_hooke: {a1: 0.5}}
  volume: {quadratic: {d: 0.01}}
")
  file(COPY ${ROOT}/tests/support/inp/cook_${groups}.inp DESTINATION ${folder})
  run(0 ${BIN}/langer-solve scene.yaml -o cook_${groups}.h5 --quiet)
endforeach()
run(0 ${BIN}/langer show cook_elements.h5)
expect_said("cook")

# fibres along axis 1 of an orientation that is turned by 30 degrees are fibres at 30 degrees
set(orientation "*ORIENTATION, NAME=o\n0.8660254037844387, 0, 0.5, -0.5, 0, 0.8660254037844387\n")
file(WRITE ${folder}/main.inp "${nodes}${element}${orientation}*SOLID SECTION, ELSET=skin, MATERIAL=m, ORIENTATION=o\n")
file(WRITE ${folder}/solve.yaml
  "mesh: {geometry: {file: {path: main.inp}}}\n"
  "material:\n  matrix: [{yeoh: {a1: 0.05, a2: 0.02, a3: 0}}]\n  fibres: [{hgo: {c1: 0.1, c2: 0.3}}]\n"
  "  volume: {quadratic: {d: 0.5}}\n"
  "fibre_angles: [30]\nsupports: [{on: x_min, hold: [x, y, z]}]\n"
  "loads: [{on: x_max, displacement: {x: 0.2}}]\npath: {steps: 2}\n")
file(WRITE ${folder}/post.yaml "columns: [{quantity: t}, {quantity: energy}, {quantity: sigma_xx, at: x_max}, {quantity: sigma_xz, at: x_max}]\n")
run(0 ${BIN}/langer-solve solve.yaml -o global.h5 --quiet)
run(0 ${BIN}/langer-mesh mesh.yaml -o oriented.h5)
expect_said("1 of 1 elements have an *ORIENTATION, in which `frames: file` measures angles")
run(0 ${BIN}/langer-solve solve.yaml --set mesh.frames=file --set "fibre_angles=[0]" -o file.h5 --quiet)
run(0 ${BIN}/langer-solve solve.yaml --set "fibre_angles=[0]" -o along.h5 --quiet)
foreach(name global file along)
  run(0 ${BIN}/langer-post post.yaml --solution ${name}.h5 -o ${name}_curves.h5 --quiet)
endforeach()
foreach(name global file along)
  file(READ ${folder}/${name}_curves.csv text)
  string(REGEX REPLACE "\n0,[^\n]*" "" text "${text}")  # at rest there is rounding alone
  string(REGEX REPLACE "([.][0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9])[0-9]*" "\\1" ${name}_curves "${text}")
endforeach()
expect_equal("${file_curves}" "${global_curves}" "eight decimals of the curves of turned fibres")
if(along_curves STREQUAL global_curves)
  message(FATAL_ERROR "the direction of the fibres does not matter: ${along_curves}")
endif()
file(WRITE ${folder}/main.inp "${nodes}${element}*SOLID SECTION, ELSET=skin, MATERIAL=m\n")
run(2 ${BIN}/langer-solve solve.yaml --set mesh.frames=file -o none.h5)
expect_said("frames: found file, and its sections have no *ORIENTATION that can be used; expected frames: global")
