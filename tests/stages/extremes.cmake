# Extreme cases that are refusals: what a mesh or a scene cannot be is said by name, with its place.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(project ${WORK}/project)
function(refused text yaml)
  file(WRITE ${project}/m.yaml "${yaml}")
  set(code 2)
  if(ARGC GREATER 2)
    set(code ${ARGV2})
  endif()
  run(${code} ${BIN}/langer-mesh m.yaml -o m.h5 --quiet)
  expect_said("${text}")
  if(EXISTS ${project}/m.h5)
    message(FATAL_ERROR "a refused mesh was written")
  endif()
endfunction()
set(block "geometry: {block: {size: [1, 1, 1], divisions: [2, 2, 2]}}\n")
set(corner "{of: top, within: {box: {from: [0, 1, 0], to: [0.2, 1, 0.2]}}}")
# zero thickness, negative, huge
foreach(size 0 -1 1e9)
  refused("m.yaml:1:30: geometry.block.size[1]: found ${size}; expected a number >= 0.001 and <= 1000000 in mm"
    "geometry: {block: {size: [1, ${size}, 1], divisions: [1, 1, 1]}}\n")
endforeach()
# an empty set, a set named twice, a set with the name of a side or of a point
refused("m.yaml:3:3: sets.a: no node of the mesh is in this set; expected at least one"
  "${block}sets:\n  a: {of: top, within: {box: {from: [0.1, 1, 0.1], to: [0.2, 1, 0.2]}}}\n")
refused("m.yaml:4:3: the key \"a\" was already given at line 3" "${block}sets:\n  a: ${corner}\n  a: ${corner}\n")
refused("sets.top: found the name of a side" "${block}sets:\n  top: ${corner}\n")
refused("sets.a: found the name of a point" "${block}points: {a: [0, 1, 0]}\nsets:\n  a: ${corner}\n")
# a mesh of another program whose second cell has a corner pushed through the opposite one
file(WRITE ${project}/folded.inp "*NODE
1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1
9, 0, 0, 2\n10, 1, 0, 2\n11, -0.1, -0.1, 0.9\n12, 0, 1, 2
*ELEMENT, TYPE=C3D8
1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n")
refused("folded.inp:16:1: element 2 is folded: its Jacobian is -" "geometry: {file: {path: folded.inp}}\n" 3)

# scenes: nothing of the set is there, two values for one place, nothing held
file(WRITE ${project}/m.yaml "${block}sets:\n  corner: ${corner}\n")
run(0 ${BIN}/langer-mesh m.yaml -o m.h5 --quiet)
set(material "material: {include: configs/material/abdomen_hgo_yeoh.yaml}\n")
function(solve_says code text yaml)
  file(WRITE ${project}/s.yaml "${material}${yaml}")
  run(${code} ${BIN}/langer-solve s.yaml --mesh m.h5 -o s.h5 ${ARGN})
  expect_said("${text}")
  set(said "${said}" PARENT_SCOPE)
endfunction()
solve_says(2 "supports[0].on: found \"botom\"; expected a node set of the mesh" "supports:
  - {on: botom, hold: [x]}
loads:
  - {on: top, displacement: {y: 0.1}}
")
solve_says(2 "asks for y = 0.1 mm at a node that supports[0] sets to 0 mm" "supports:
  - {on: x_min, hold: [y]}
loads:
  - {on: top, displacement: {y: 0.1}}
")
# nothing holds it along z: no unique equilibrium
solve_says(2 "the supports leave the body free to move along (0, 0, 1)" "supports:
  - {on: x_min, hold: [x, y]}
loads:
  - {on: x_max, displacement: {x: 0.1, y: 0}}
")
# a body that may glide and turn on its base: under a smooth sphere it is solved; off its middle it slips away, and what is to be
# held is said
function(pressed_at code text z)
  solve_says(${code} "${text}" "supports:
  - {on: bottom, hold: [y]}
contacts:
  sphere: {on: top, rigid: {sphere: {radius: 2, centre: [0.5, 3, ${z}]}}, motion: [{t: 1, to: [0, -0.1, 0]}]}
" -v)
  expect_said("the supports leave the body 3 rigid motions (2 along, 1 about an axis): only contact holds it")
  set(said "${said}" PARENT_SCOPE)
endfunction()
pressed_at(0 " step cut-backs; " 0.5)
pressed_at(4 "the body slips away from under the indenter, and nothing else holds it" 0.9)
expect_said("hold also a node on the indenter's axis and, against turning, one next to it, where contact does not")
