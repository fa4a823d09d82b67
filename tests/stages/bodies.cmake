# Two bodies that touch, as users meet them: what friction takes is a column, the error has a bar, the scene is a deck for other programs,
# and what bodies do not have is refused by name.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
file(WRITE ${folder}/scene.yaml "bodies:
  skin:
    mesh: {geometry: {block: {size: [4, 1, 4], divisions: [8, 4, 8]}}}
    material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}
  pad:
    mesh: {geometry: {block: {origin: [1, 1, 1], size: [2, 1, 2], divisions: [4, 4, 4]}}}
    material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.5}}}
    loads: [{on: top, displacement: {x: [{t: 0.5, to: 0}, {t: 1, to: 0.3}], y: [{t: 0.5, to: -0.15}, {t: 1, to: -0.15}], z: 0}}]
supports: [{on: skin_bottom, hold: [x, y, z]}]
contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.2}}
path: {steps: 20}
sensitivity: [materials.skin.matrix.neo_hooke.a1, contacts.pad.friction]
estimate: refinement
")
file(WRITE ${folder}/post.yaml "columns:
  - {quantity: t}
  - {history: force_pad}
  - {history: d_force_pad_N_d_contacts_pad_friction}
  - {quantity: energy}
  - {quantity: work}
  - {quantity: dissipated}
  - {quantity: balance}
maps:
  slip: {on: pad_bottom, field: slip}
figures:
  work: {title: Work, x: t, y: [work, dissipated], y_label: energy}
")
run(0 ${BIN}/langer-solve scene.yaml -o solution.h5)
expect_said("force_pad")
expect_said("+-")
run(0 ${BIN}/langer-post post.yaml --solution solution.h5 -o curves.h5)
file(STRINGS ${folder}/curves.csv rows)
list(GET rows 0 names)
list(GET rows -1 last)
string(REPLACE "," ";" names "${names}")
string(REPLACE "," ";" last "${last}")
# the value of a column at the end of the path
function(at_end column out)
  list(FIND names ${column} place)
  list(GET last ${place} value)
  set(${out} ${value} PARENT_SCOPE)
endfunction()
at_end(d_force_pad_N_d_contacts_pad_friction by_friction)
at_end(work_N_mm work)
at_end(dissipated_N_mm dissipated)
at_end(balance balance)
message("work ${work} N mm, dissipated ${dissipated} N mm, balance ${balance}")
if(NOT dissipated GREATER 0 OR NOT work GREATER dissipated OR NOT by_friction GREATER 0)
  message(FATAL_ERROR "the work of friction, or what friction changes of the force: ${last}")
endif()
# of increments as long as these
if(NOT balance LESS 0.02 OR NOT balance GREATER -0.02)
  message(FATAL_ERROR "work is neither stored nor dissipated: ${balance}")
endif()

# quantities of an indenter
foreach(quantity hysteresis relaxation path)
  run(2 ${BIN}/langer-post post.yaml --solution solution.h5 -o none.h5 --set "columns=[{quantity: ${quantity}}]" --set figures={} --set maps={})
  expect_said("${quantity} of a solution whose surfaces are all deformable")
endforeach()

# decks: both surfaces, their friction, and the answer to compare with
run(0 ${BIN}/langer-post --solution solution.h5 --export deck.inp --export deck.feb)
file(READ ${folder}/deck.inp deck)
foreach(line "*CONTACT PAIR, INTERACTION=CONTACT1, TYPE=SURFACE TO SURFACE\nSLAVE1, MASTER1" "*FRICTION\n0.2, "
        "** surfaces \"pad\": \"pad_bottom\" against \"skin_top\", friction 0.2"
        "force on \"skin_top\" by \"pad_bottom\" of the whole body")
  string(FIND "${deck}" "${line}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "deck.inp lacks\n${line}")
  endif()
endforeach()
file(READ ${folder}/deck.feb deck)
foreach(line "<contact name=\"contact_of_pad\" type=\"sliding-elastic\" surface_pair=\"pair_of_pad\">" "<fric_coeff>0.2</fric_coeff>"
        "<Surface name=\"body_of_pad\">" "<Surface name=\"face_of_pad\">")
  string(FIND "${deck}" "${line}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "deck.feb lacks\n${line}")
  endif()
endforeach()

# what is refused, with the way out
run(2 ${BIN}/langer-solve scene.yaml -o none.h5 --set accuracy=1% --set bodies.pad.mesh.geometry.block.divisions=[5,4,4])
expect_said("numbers that are 1 or multiples of 4")
run(2 ${BIN}/langer-solve scene.yaml -o none.h5 --set estimate=recovery)
expect_said("expected refinement or none")
run(2 ${BIN}/langer-solve scene.yaml -o none.h5 --set bodies.pad.mesh.geometry.block.divisions=[5,4,4])
expect_said("numbers that are 1 or multiples of 4")

# cells of both bodies until the bar of the force is within what was asked for
run(0 ${BIN}/langer-solve scene.yaml -o within.h5 --set accuracy=8% --quiet --set "sensitivity=[]" --set "path={steps: 4}" --json)
string(REGEX MATCH "\"accuracy_percent\": ([0-9.e+-]+)" found "${said}")
if(NOT CMAKE_MATCH_1 OR CMAKE_MATCH_1 GREATER 8)
  message(FATAL_ERROR "asked for 8 %, ended with ${CMAKE_MATCH_1} % and exit code 0")
endif()
