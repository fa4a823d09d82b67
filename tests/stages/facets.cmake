# An indenter of triangles in pictures and on the page of a run, though its file is gone: the solution keeps its surface.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(folder ${WORK}/project)
# a pyramid whose tip points down
set(text "solid tip\n")
foreach(triangle "0 4.1 0;2 6 -2;2 6 2" "0 4.1 0;2 6 2;-2 6 2" "0 4.1 0;-2 6 2;-2 6 -2" "0 4.1 0;-2 6 -2;2 6 -2"
        "2 6 -2;-2 6 -2;-2 6 2" "2 6 -2;-2 6 2;2 6 2")
  string(REPLACE ";" "\nvertex " vertices "${triangle}")
  string(APPEND text "facet normal 0 0 0\nouter loop\nvertex ${vertices}\nendloop\nendfacet\n")
endforeach()
file(WRITE ${folder}/tip.stl "${text}endsolid tip\n")
file(WRITE ${folder}/solve.yaml "mesh: {geometry: {block: {origin: [-4, 0, -4], size: [8, 4, 8], divisions: [4, 2, 4]}}}
supports: [{on: bottom, hold: [x, y, z]}]
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.1}}}
contacts: {tool: {on: top, rigid: {facets: {file: tip.stl, rounding: 0.1}}, motion: [{t: 1, to: [0, -0.4, 0]}]}}
path: {steps: 2}
stability: off\n")
run(0 ${BIN}/langer-solve solve.yaml -o solve/solution.h5 --quiet)
# Nodes slip over edges that are sharper than they are apart: the run ends, and says what helps.
run(4 ${BIN}/langer-solve solve.yaml -o sharp/solution.h5 --quiet
  --set "mesh.geometry.block.divisions=[8, 4, 8]" --set contacts.tool.rigid.facets.rounding=0.01
  --set "contacts.tool.motion=[{t: 1, to: [1, -2.3, 1]}]"
  --set "path={first: 0.1, largest: 0.1, smallest: 0.05}")
expect_said("a rounding of at least 1.4 mm helps")
file(REMOVE ${folder}/tip.stl)
file(WRITE ${folder}/post.yaml "columns: [{quantity: u_ind}, {quantity: force}]
render: {field: u_y}
renders: {alone: {}}\n")
run(0 ${BIN}/langer-post post.yaml --solution solve/solution.h5 -o post/curves.h5)
string(FIND "${said}" "the indenter" at)
if(NOT at EQUAL -1)
  message(FATAL_ERROR "not drawn: ${said}")
endif()
file(WRITE ${folder}/page.yaml "title: Tip\n")
run(0 ${BIN}/langer-report page.yaml --solution solve/solution.h5 -o page.html)
file(READ ${folder}/page.html page)
foreach(word "\"name\":\"tool\",\"points\":" "\"missing\":[]")
  string(FIND "${page}" "${word}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "the page does not hold ${word}")
  endif()
endforeach()
# without such an indenter there is no such group
run(0 ${BIN}/langer-solve solve.yaml -o ball/solution.h5 --quiet
  --set "contacts.tool.rigid={sphere: {radius: 2, centre: [0, 6, 0]}}")
run(0 ${BIN}/langer-post post.yaml --solution ball/solution.h5 -o ball_post/curves.h5 --quiet)
foreach(run post ball_post)
  file(STRINGS ${folder}/${run}/render.svg polygons REGEX "<polygon")
  list(LENGTH polygons ${run}_n)
endforeach()
file(SIZE ${folder}/solve/solution.h5 with)
file(SIZE ${folder}/ball/solution.h5 without)
message("polygons: ${post_n} with the tip, ${ball_post_n} with a ball; ${with} and ${without} bytes")
if(NOT with GREATER without OR NOT post_n GREATER 60)
  message(FATAL_ERROR "the file with triangles is no larger, or nothing of them is drawn")
endif()
