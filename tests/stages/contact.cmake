# An indenter is held against the whole boundary: whatever the body does not feel of it is refused or warned of by name and place.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(project ${WORK}/project)
run(0 ${BIN}/langer-mesh configs/mesh/smoke.yaml -o m.h5 --quiet)

function(solve_says code text contacts)
  file(WRITE ${project}/s.yaml "supports: [{on: bottom, hold: [x, y, z]}]
contacts:
${contacts}
material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1e-3}}}
")
  file(REMOVE ${project}/s.h5 ${project}/s.h5.part)
  run(${code} ${BIN}/langer-solve s.yaml --mesh m.h5 -o s.h5 ${ARGN})
  expect_said("${text}")
  set(said "${said}" PARENT_SCOPE)
endfunction()
set(steps "path: {steps: 10}")

# smaller than the cells: in between their nodes, on one of them, with a set and without, as any shape
foreach(on "on: top, " "")
  foreach(shape "sphere: {radius: 0.4, centre: [0.45, 4.4, 0.45]}" "sphere: {radius: 0.1, centre: [0, 4.1, 0]}"
          "ellipsoid: {half_axes: [0.3, 1, 0.2], centre: [0.4, 5, 0.5]}" "cylinder: {radius: 0.35, edge: 0.1, face: [0.45, 4, 0.45]}")
    solve_says(2 "contacts.s.rigid: at t = 0.1 the indenter is smaller than the cells: half its width is 0."
      "  s: {${on}rigid: {${shape}}, friction: 0.34, motion: [{t: 1, to: [0, -0.3, 0]}]}\n${steps}")
  endforeach()
endforeach()
# deep in a facet between nodes; the set has them, and has not
set(beside "rigid: {sphere: {radius: 1, centre: [-7.1, 2, 0]}}, friction: 0.34, motion: [{t: 1, to: [3, 0, 0]}]}\npath: {steps: 30}")
solve_says(2 "mm inside the body near (-6, 2, " "  s: {on: x_min, ${beside}")
foreach(set top contact)
  solve_says(2 "mm inside the body at (-6, 1.333, 0), a node that is not in its set" "  s: {on: ${set}, ${beside}")
endforeach()
# starts inside: nodes outside of the set, between nodes, wholly
solve_says(2 "contacts.s.rigid: starts 1.5 mm inside the body at (0, 0, 0)"
  "  s: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 1, 0]}}, motion: [{t: 1, to: [0, -0.2, 0]}]}")
foreach(place "0, 2, 0" "0.4, 1.1, -0.3" "4, 2.6, 3")
  solve_says(2 "contacts.s.rigid: starts wholly inside the body"
    "  s: {on: contact, rigid: {sphere: {radius: 0.3, centre: [${place}]}}, motion: [{t: 1, to: [0, -0.2, 0]}]}")
endforeach()
# in one long increment from outside to inside, past every node
solve_says(2 "contacts.s.rigid: at t = 1 the indenter is wholly inside the body and touches no node"
  "  s: {on: contact, rigid: {sphere: {radius: 0.2, centre: [0.45, 4.3, 0.45]}}, motion: [{t: 1, to: [0, -2, 0]}]}\npath: {steps: 1}")
# the set ends inside the contact; an indenter slides off its set; beside it
solve_says(2 "contacts.s.on: at t = "
  "  s: {on: M, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, friction: 0.34, motion: [{t: 1, to: [0, -0.5, 0]}]}\n${steps}")
expect_said("a node that is not in its set; expected a set with every node that the indenter reaches")
expect_said("leave out the key `on`")
solve_says(2 "a node that is not in its set"
  "  s: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, motion: [{t: 0.3, to: [0, -0.4, 0]}, {t: 1, to: [4, -0.4, 0]}]}\n${steps}")
solve_says(2 "a node that is not in its set"
  "  s: {on: contact, rigid: {sphere: {radius: 2.5, centre: [5, 6.5, 0]}}, motion: [{t: 1, to: [0, -0.4, 0]}]}\n${steps}")
# the same without a set run to their end
foreach(motion "{t: 1, to: [0, -0.5, 0]}" "{t: 0.3, to: [0, -0.4, 0]}, {t: 1, to: [2, -0.4, 0]}")
  solve_says(0 "force_N" "  s: {rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, motion: [${motion}]}\n${steps}" --json)
endforeach()
# never touches; without a set that is known before
solve_says(0 "warning: contacts.s: the indenter never touches the body: nearest at t = 1, 0.4 mm from (0, 4, 0)"
  "  s: {on: top, rigid: {sphere: {radius: 1, centre: [0, 5.6, 0]}}, motion: [{t: 1, to: [0, -0.2, 0]}]}\n${steps}" --quiet)
solve_says(2 "contacts.s.motion: the indenter reaches no node of the body"
  "  s: {rigid: {sphere: {radius: 1, centre: [0, 9, 0]}}, motion: [{t: 1, to: [0, -0.2, 0]}]}\n${steps}")
# no node touches, though the sphere is larger than the cells
solve_says(2 "no node touches the indenter, which is up to 0.04 mm inside the body near (0.45, 4, 0.45)"
  "  s: {on: top, rigid: {sphere: {radius: 2.5, centre: [0.45, 6.5, 0.45]}}, motion: [{t: 1, to: [0, -0.04, 0]}]}\n${steps}")

# through the body in one increment: out of it before and after; past it: no word of that
solve_says(2 "mm inside nodes that supports hold, at (0, 0, "
  "  s: {rigid: {sphere: {radius: 1.5, centre: [0, 6, 0]}}, motion: [{t: 1, to: [0, -8, 0]}]}\npath: {steps: 1}\n")
solve_says(2 "mm inside nodes that supports hold"
  "  s: {rigid: {ellipsoid: {half_axes: [1.2, 1, 1.6], centre: [0, 5.5, 0]}}, motion: [{t: 1, to: [0.5, -9, 0]}]}\npath: {steps: 1}\n")
solve_says(0 "never touches the body"
  "  s: {on: top, rigid: {sphere: {radius: 1.5, centre: [8, 6, 0]}}, motion: [{t: 1, to: [0, -8, 0]}]}\npath: {steps: 1}\n")
# several indenters: the force of each by name, their sum, and the support's reaction
solve_says(0 "contacts: 2" "  a: {on: contact, rigid: {sphere: {radius: 2, centre: [0, 6, 0]}}, motion: [{t: 1, to: [0, -0.3, 0]}]}
  b: {rigid: {sphere: {radius: 2, centre: [4, 6, 3]}}, motion: [{t: 1, to: [0, -0.5, 0]}]}
path: {steps: 2}" -v --json)
foreach(name force force_a force_b)
  string(REGEX MATCH "\"${name}_N\"[^0-9]*([0-9.e-]+)" _ "${said}")
  set(${name} ${CMAKE_MATCH_1})
  if(NOT ${name} GREATER 0)
    message(FATAL_ERROR "no ${name} in\n${said}")
  endif()
endforeach()
file(WRITE ${project}/p.yaml "columns:
- {quantity: force_y}
- {history: force_a_y}
- {history: force_b_y}
- {quantity: reaction_y, at: bottom}
- {quantity: force}
- {history: force_a}
- {history: force_b}
- {history: penetration_between_nodes}
")
run(0 ${BIN}/langer-post p.yaml --solution s.h5 -o c.h5 --quiet)
file(STRINGS ${project}/c.csv lines)
list(GET lines 0 head)
expect_equal("${head}" "force_y_N,force_a_y_N,force_b_y_N,reaction_y_bottom_N,force_N,force_a_N,force_b_N,penetration_between_nodes_mm" "columns")
execute_process(COMMAND awk -F, "NR == 4 { e = 1e-6 * $1; exit !($1 > 0.01 && ($1 - $2 - $3)^2 < e^2 && ($1 - $4)^2 < e^2 && ($5 - $6 - $7)^2 < 1e-6) }"
  ${project}/c.csv RESULT_VARIABLE wrong)
if(wrong)
  list(JOIN lines "\n" lines)
  message(FATAL_ERROR "the forces are not the support's reaction:\n${lines}")
endif()

# rest with friction, between movements and at the end; the forces stay
foreach(friction 0 0.05 0.34 3)
  foreach(part 0.25 0.1)
    file(REMOVE ${project}/r.h5.part)
    run(0 ${BIN}/langer-solve configs/solve/smoke.yaml --mesh m.h5 --material configs/material/abdomen_hgo_yeoh.yaml -o r.h5
      -v --set contacts.sphere.motion[0].t=0.5 --set path.first=${part} --set path.largest=${part} --set contacts.sphere.friction=${friction})
    string(REGEX MATCH "t 0.5000[^\n]*force ([0-9.]+) N.*t 1.0000[^\n]*force ([0-9.]+) N" _ "${said}")
    if(NOT CMAKE_MATCH_1 OR NOT CMAKE_MATCH_1 STREQUAL CMAKE_MATCH_2)
      message(FATAL_ERROR "the force changes while nothing moves, friction ${friction}:\n${said}")
    endif()
  endforeach()
endforeach()

# a pressure that reaches under the plate of a cup is noticed
set(coarse --set "mesh.geometry.section.divisions=[24,8]" --set "loads=[{on: hole, pressure: -0.01}]" --set "path={steps: 2}" --set estimate=none)
run(0 ${BIN}/langer-solve configs/solve/suction_plate.yaml ${coarse} -o cup.h5)
if(said MATCHES "under the plate")
  message(FATAL_ERROR "the set of the shipped cup ends at its hole:\n${said}")
endif()
run(0 ${BIN}/langer-solve configs/solve/suction_plate.yaml ${coarse} --set mesh.sets.hole.within.cylinder.radius=4 -o wide.h5)
expect_said("contacts.plate: a pressure also acts under the plate: its set reaches 4 mm from the axis of the hole, and the plate is flat from 2.25 mm on")
