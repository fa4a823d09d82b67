# gmsh and the libraries behind it are loaded by what needs them and by nothing else; without them the rest works, and it is said
# what is missing.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})

# loads(<TRUE|FALSE> <command>...): whether the command's dynamic loader meets libgmsh
macro(loads expected)
  run(0 ${CMAKE_COMMAND} -E env LD_DEBUG=files ${ARGN})
  expect_said("libyaml-cpp")  # so the loader speaks
  string(FIND "${said}" "libgmsh" at)
  if(${expected} AND at EQUAL -1)
    message(FATAL_ERROR "${ARGN}: does not load gmsh")
  elseif(NOT ${expected} AND NOT at EQUAL -1)
    message(FATAL_ERROR "${ARGN}: loads gmsh")
  endif()
endmacro()

set(text "solid box\n")
foreach(triangle "-1 5 -1/-1 5 1/1 5 -1" "1 5 -1/-1 5 1/1 5 1" "-1 7 -1/1 7 -1/-1 7 1" "1 7 -1/1 7 1/-1 7 1" "-1 5 -1/1 5 -1/1 7 -1" "-1 5 -1/1 7 -1/-1 7 -1"
        "-1 5 1/1 7 1/1 5 1" "-1 5 1/-1 7 1/1 7 1" "-1 5 -1/-1 7 -1/-1 5 1" "-1 7 -1/-1 7 1/-1 5 1" "1 5 -1/1 5 1/1 7 -1" "1 7 -1/1 5 1/1 7 1")
  string(REGEX REPLACE "(.*)/(.*)/(.*)" "\\1\nvertex \\3\nvertex \\2" vertices "${triangle}")
  string(APPEND text "facet normal 0 0 0\nouter loop\nvertex ${vertices}\nendloop\nendfacet\n")
endforeach()
file(WRITE ${WORK}/tool.stl "${text}endsolid box\n")
set(block "geometry: {indented_block: {origin: [-6, 0, -6], size: [12, 4, 12], radius: 2.5, depth: 0.5, edge: 0.7}}\n")
file(WRITE ${WORK}/mesh.yaml "${block}export: [msh]\n")
file(WRITE ${WORK}/file.yaml "geometry: {file: {path: mesh.msh}}\n")
set(scene "supports: [{on: bottom, hold: [x, y, z]}]
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.1}}}
contacts: {tool: {on: top, rigid: {facets: {file: tool.stl, rounding: 0.5}}, motion: [{t: 1, to: [0, -0.8, 0]}]}}
path: {steps: 2}\n")
file(WRITE ${WORK}/solve.yaml "${scene}")
string(REPLACE "\n" "\n  " inside "  ${block}")
file(WRITE ${WORK}/whole.yaml "${scene}mesh:\n${inside}\n")
file(WRITE ${WORK}/graded.yaml "geometry:\n  graded_block: {origin: [-6, 0, -6], size: [12, 4, 12], core: {half_width: 1, cells: 2}, rings: [{radius: 3, cells: 2}], outer_cells: 2, layers: 2}\n")
foreach(program langer-mesh langer-solve langer-post langer-fit langer-gather langer-plan langer-sensitivity langer-report langer-tune langer)
  if(EXISTS ${BIN}/${program})
    loads(FALSE ${BIN}/${program} --version)
  endif()
endforeach()
loads(FALSE ${BIN}/langer-mesh mesh.yaml -o mesh.h5 --quiet)
loads(FALSE ${BIN}/langer-mesh graded.yaml -o graded.h5 --quiet)
loads(FALSE ${BIN}/langer-solve solve.yaml --mesh mesh.h5 -o solution.h5 --quiet)
loads(FALSE ${BIN}/langer-solve whole.yaml -o whole.h5 --quiet)
run(0 ${BIN}/langer-compare-h5 solution.h5 whole.h5 0 --data)
loads(FALSE ${BIN}/langer-mesh file.yaml -o again.h5 --quiet)
run(0 ${BIN}/langer-compare-h5 mesh.h5 again.h5 0 --data)

# gmsh meshes what triangles enclose, in a process of its own: this one never loads it. With sanitizers that process keeps its stderr, so that
# they can report; then its loader is heard, too.
file(COPY ${ROOT}/tests/support/box.stl DESTINATION ${WORK})
file(WRITE ${WORK}/solid.yaml "geometry: {file: {path: box.stl, edge: 1}}\n")
if(SANITIZED)
  run(0 ${BIN}/langer-mesh solid.yaml -o solid.h5 --quiet)
else()
  loads(FALSE ${BIN}/langer-mesh solid.yaml -o solid.h5 --quiet)
endif()

# a program alone in its folder
file(COPY ${BIN}/langer-mesh DESTINATION ${WORK}/alone/bin)
run(0 alone/bin/langer-mesh mesh.yaml -o alone.h5 --quiet)
run(0 alone/bin/langer-mesh file.yaml -o alone.h5 --quiet)
run(3 alone/bin/langer-mesh solid.yaml -o alone.h5)
expect_said("box.stl: gmsh, which such a file needs, cannot be loaded: ")
expect_said("alone/lib/langer/langer_gmsh.so: cannot open shared object file")
expect_said("hint: install libgmsh")
# something else in the module's place
file(MAKE_DIRECTORY ${WORK}/alone/lib/langer)
file(WRITE ${WORK}/alone/lib/langer/langer_gmsh.so "no library")
run(3 alone/bin/langer-mesh solid.yaml -o alone.h5)
expect_said("cannot be loaded")
