# What locks, what is too soft, and what rounding spoils is said, or ends with exit code 4; what is right says nothing.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/project)
set(folder ${WORK}/project)
macro(expect_silence)
  if(said MATCHES "warning")
    message(FATAL_ERROR "expected no warning, but it said:\n${said}")
  endif()
endmacro()

file(WRITE ${folder}/press.yaml "mesh:
  geometry: {block: {origin: [-6, 0, -6], size: [12, 4, 12], divisions: [14, 4, 14], centre: {edge: 0.5}}}
  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.6}}}}
material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [], volume: {quadratic: {d: 1e-3}}}
supports: [{on: bottom, hold: [x, y, z]}]
contacts:
  sphere: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, friction: 0.34, motion: [{t: 1, to: [0, -0.5, 0]}]}
path: {first: 0.25, largest: 0.25}
symmetry: auto
")
set(press ${BIN}/langer-solve press.yaml -o press.h5)
run(0 ${press})
expect_silence()
foreach(d 1e-3 0.1)
  run(0 ${press} --set formulation=displacement --set material.volume.quadratic.d=${d})
  expect_said("warning: formulation displacement on hex8: the cells lock")
  expect_said("formulation: mean_dilatation cures it")
endforeach()
set(quadratic --set mesh.cells=hex27 --set "mesh.geometry.block.divisions=[8, 2, 8]" --set mesh.geometry.block.centre.edge=1)
run(0 ${press} ${quadratic} --set formulation=mean_dilatation)
expect_said("warning: formulation mean_dilatation on hex27: the volume changes within cells")
expect_said("formulation: linear_dilatation cures it")
run(0 ${press} ${quadratic})
expect_silence()

# the reaction of a pulled block is right within 0.1 %, or it is said, or refused
file(WRITE ${folder}/pull.yaml "mesh: {geometry: {block: {size: [10, 2, 10], divisions: [6, 2, 6]}}}
material: {matrix: {neo_hooke: {a1: 0.05}}, fibres: [], volume: {quadratic: {d: 1e-3}}}
supports: [{on: x_min, hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: 1}}]
path: {first: 0.5, largest: 0.5}
")
set(pull ${BIN}/langer-solve pull.yaml -o pull.h5)
foreach(d 1e-3 1e-6 1e-8)
  run(0 ${pull} --set material.volume.quadratic.d=${d})
  expect_silence()
endforeach()
foreach(d 1e-10 1e-11)
  run(0 ${pull} --set material.volume.quadratic.d=${d})
  expect_said("warning: the residual's tolerance was raised from")
  expect_said("leaves what was asked")
endforeach()
foreach(d 1e-12 3e-14 1e-14)
  run(4 ${pull} --set material.volume.quadratic.d=${d})
  expect_said("expected a residual of at most 0.1 % of the reactions")
  expect_said("hint: material.volume.quadratic.d: ")
endforeach()
run(0 ${pull} --set material.volume.quadratic.d=1e-8)

# chains beyond their end
file(WRITE ${folder}/chains.yaml "mesh: {geometry: {block: {size: [10, 2, 10], divisions: [2, 1, 2]}}}
supports: [{on: x_min, hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: 3}}]
material: {matrix: {arruda_boyce: {mu: 0.1, locking_stretch: 1.2}}, fibres: [], volume: {quadratic: {d: 1e-4}}}
path: {first: 0.25, largest: 0.25}
")
run(0 ${BIN}/langer-solve chains.yaml -o chains.h5 --set "loads[0].displacement.x=8")
expect_said("warning: the chains of arruda_boyce are stretched to 1.2")
run(0 ${BIN}/langer-solve chains.yaml -o chains.h5 --set "loads[0].displacement.x=3")
expect_silence()
