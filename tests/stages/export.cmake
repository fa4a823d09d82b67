# Solved scenes as decks of other programs: what CalculiX makes of them is what Langer found, the .feb names only what it has, and
# what a program lacks is refused.
include(${ROOT}/tests/support/run.cmake)
copy_project()
set(volume "volume: {quadratic: {d: 1.0e-4}}")
set(law "{matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, ${volume}}")
# uniaxial
file(WRITE ${WORK}/project/tension.yaml "stability: off
mesh: {geometry: {block: {size: [3, 2, 1], divisions: [3, 2, 2]}}}
supports:
  - {on: x_min, hold: [x]}
  - {on: y_min, hold: [y]}
  - {on: z_min, hold: [z]}
loads:
  - {on: x_max, displacement: {x: 0.9}}
path: {steps: 6}
material: ${law}
")
# stretched along x and z, free along y: homogeneous on any cells, where the fibres are the same on both sides of x
file(WRITE ${WORK}/project/biaxial.yaml "stability: off
mesh: {geometry: {block: {size: [3, 2, 1], divisions: [2, 2, 1]}}}
supports:
  - {on: x_min, hold: [x]}
  - {on: y_min, hold: [y]}
  - {on: z_min, hold: [z]}
loads:
  - {on: z_max, displacement: {z: 0.1}}
  - {on: x_max, displacement: {x: 0.9}}
path: {steps: 6}
")
set(neo "{neo_hooke: {a1: 0.312}}")
set(family "{hgo: {c1: 0.297, c2: 0.87}, alpha: 30}")
file(WRITE ${WORK}/project/fibres.yaml "include: biaxial.yaml
material: {matrix: ${neo}, fibres: [${family}, {hgo: {c1: 0.297, c2: 0.87}, alpha: -30}, {hgo: {c1: 0.1, c2: 0.5}, alpha: 90}], ${volume}}
")
file(WRITE ${WORK}/project/field.yaml "include: tension.yaml
material: {matrix: {yeoh: {a1: 0.312, a2: 0, a3: 0}}, fibres: [${family}], ${volume}}
fibre_field: {formula: {alpha: \"20 * x\"}}
")
# hex27 and C3D20R, in half of the sphere's body
file(WRITE ${WORK}/project/sphere.yaml "include: configs/solve/indentation.yaml
stability: off
symmetry: auto
mesh: {include: configs/mesh/smoke.yaml, cells: hex27}
fibre_angles: []
material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-2}}}
contacts: {sphere: {friction: 0.2, motion: [{t: 0.5, to: [0, -0.2, 0]}, {t: 1, to: [0, -0.5, 0]}]}}
path: {first: 0.25, largest: 0.25}
")
# two families that no plane maps onto each other, free to shear: not homogeneous, and C3D20R come to what hex27 come to; with one of them
# mirrored the force is 0.8 % larger
file(WRITE ${WORK}/project/slanted.yaml "include: tension.yaml
mesh: {geometry: {block: {size: [3, 2, 1], divisions: [6, 2, 4]}}, cells: hex27}
path: {steps: 24}
material: {matrix: ${neo}, fibres: [{hgo: {c1: 0.297, c2: 0.5}, alpha: 20}, {hgo: {c1: 0.15, c2: 0.3}, alpha: 65}], volume: {quadratic: {d: 1.0e-3}}}
")
# clamped plates press a nearly incompressible layer flat: cells that lock are far off
file(WRITE ${WORK}/project/bonded.yaml "stability: off
mesh: {geometry: {block: {size: [3, 1, 3], divisions: [8, 4, 8]}}}
supports:
  - {on: y_min, hold: [x, y, z]}
  - {on: y_max, hold: [x, z]}
loads:
  - {on: y_max, displacement: {y: -0.2}}
path: {first: 0.3, largest: 0.4}
material: {matrix: {neo_hooke: {a1: 0.3}}, volume: {quadratic: {d: 1.0e-3}}}
")
# hex8 and C3D20R
file(WRITE ${WORK}/project/ball.yaml "include: sphere.yaml
mesh: {include: configs/mesh/smoke.yaml, cells: hex8}
")
# a body on another one, whose meshes do not match; both may widen, so that the pressure is uniform
file(WRITE ${WORK}/project/pair.yaml "bodies:
  skin:
    mesh: {geometry: {block: {size: [2, 1, 2], divisions: [4, 2, 3]}}}
    material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}
  pad:
    mesh: {geometry: {block: {origin: [0, 1, 0], size: [2, 1, 2], divisions: [3, 2, 2]}}}
    material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}
    supports: [{on: x_min, hold: [x]}, {on: z_min, hold: [z]}]
    loads: [{on: top, displacement: {y: -0.3}}]
supports: [{on: skin_bottom, hold: [y]}, {on: skin_x_min, hold: [x]}, {on: skin_z_min, hold: [z]}]
contacts: {pad: {on: pad_bottom, against: skin_top}}
path: {first: 0.5, largest: 0.5}
")
foreach(scene tension fibres field slanted sphere bonded ball pair)
  run(0 ${BIN}/langer-solve ${scene}.yaml -o ${scene}.h5 --quiet)
  run(0 ${BIN}/langer-post --solution ${scene}.h5 --export ${scene}.inp --export ${scene}.feb)
  expect_said("${scene}.feb for FEBio 4")
  if(scene MATCHES "sphere|slanted")
    expect_said("warning: hex27 are plain displacement elements in FEBio")
  elseif(said MATCHES "warning")
    message(FATAL_ERROR "${scene}: a warning without cause: ${said}")
  endif()
endforeach()
file(STRINGS ${WORK}/project/sphere.inp head LIMIT_COUNT 8)
if(NOT "${head}" MATCHES "mirror x and mirror z through \\(0, 0\\): 48 of 192 cells: forces here are 1/4")
  message(FATAL_ERROR "the head of the deck does not tell of its symmetry:\n${head}")
endif()
# a whole turn of the path is a step of its own
file(STRINGS ${WORK}/project/sphere.inp steps REGEX "^\\*STEP")
list(LENGTH steps n)
expect_equal(${n} 2 "steps of the deck")

# ELASTIC_FIBER ends a run where an iteration goes too far: short increments with contact
run(0 ${BIN}/langer-solve ball.yaml -o skin.h5 --quiet --set "material={matrix: ${neo}, fibres: [${family}, {hgo: {c1: 0, c2: 1}, alpha: 5}], volume: {quadratic: {d: 0.01}}}")
run(0 ${BIN}/langer-post --solution skin.h5 --export skin.inp --export skin.feb)
file(READ ${WORK}/project/skin.inp deck)
if(NOT "${deck}" MATCHES "STATIC\n0.05, 0.5, 0.0001, 0.05\n" OR NOT "${deck}" MATCHES "CONSTANTS=6\n")
  message(FATAL_ERROR "increments or families of skin.inp")
endif()

# what is no scene of theirs
run(2 ${BIN}/langer-post --solution tension.h5 --export tension.txt)
expect_said("a file ending with .inp (CalculiX) or .feb (FEBio 4)")
run(3 ${BIN}/langer-post --solution missing.h5 --export x.inp)
run(2 ${BIN}/langer-post configs/post/tensile.yaml --solution tension.h5 --export x.inp)
run(0 ${BIN}/langer-solve biaxial.yaml -o table1.h5 --quiet --set "material={include: configs/material/abdomen_hgo_yeoh.yaml}")
run(2 ${BIN}/langer-post --solution table1.h5 --export x.inp)
expect_said("fibres in a matrix other than neo-Hookean")
run(2 ${BIN}/langer-post --solution table1.h5 --export x.feb)
expect_said("it lacks fibres with c1 = -0.317 (it refuses ksi, k1 < 0); expected c1 of 0 or more")
run(0 ${BIN}/langer-solve tension.yaml -o chains.h5 --quiet --set "material.matrix={arruda_boyce: {mu: 0.4, locking_stretch: 3}}")
run(2 ${BIN}/langer-post --solution chains.h5 --export x.feb)
expect_said("it lacks arruda_boyce")
expect_said("expected gent, or near rest yeoh: {a1: 0.2")
run(0 ${BIN}/langer-post --solution chains.h5 --export chains.inp)
run(0 ${BIN}/langer-solve ball.yaml -o stiff.h5 --quiet --set material.volume.quadratic.d=1e-6)
run(0 ${BIN}/langer-post --solution stiff.h5 --export stiff.inp --export stiff.feb)
expect_said("FEBio's contact was found to converge up to 1000 times; solve with d: 0.0037")
expect_said("CalculiX's contact was found to stall beyond 1000 times; solve with d: 0.0037")
run(0 ${BIN}/langer-solve sphere.yaml -o punch.h5 --quiet --set "path.first=1" --set "path.largest=1"
  --set "contacts.sphere.rigid={cylinder: {radius: 1, edge: 0.5, face: [0, 4, 0]}}" --set "contacts.sphere.motion=[{t: 1, to: [0, -0.01, 0]}]")
run(2 ${BIN}/langer-post --solution punch.h5 --export x.inp)
expect_said("contacts.sphere.rigid: an indenter of another shape")
if(EXISTS ${WORK}/project/x.inp OR EXISTS ${WORK}/project/x.feb)
  message(FATAL_ERROR "a refused deck was written")
endif()

find_program(PYTHON python3)
if(PYTHON)
  foreach(scene tension fibres field sphere bonded ball stiff skin pair)
    run(0 ${PYTHON} ${ROOT}/tests/support/check_feb.py ${scene}.feb)
  endforeach()
else()
  message("the .feb files were not looked at: no python3")
endif()
find_program(FEBIO febio4)
function(by_febio scene file axis share tolerance)
  run(0 ${CMAKE_COMMAND} -E env OMP_NUM_THREADS=1 ${FEBIO} -noconfig -i ${scene}.feb)
  run(0 awk -F, -v axis=${axis} -v share=${share} -v tolerance=${tolerance} -f ${ROOT}/tests/support/febio_force.awk ${scene}.feb ${file}.csv)
  message("${scene}: ${said}")
endfunction()
if(FEBIO)
  by_febio(tension x_max_reaction 1 1 1e-4)
  by_febio(fibres x_max_reaction 1 1 1e-4)
  by_febio(bonded y_max_reaction 2 4 1e-3)
  by_febio(ball sphere_force 2 -4 5e-2)  # facets and a penalty that lets the sphere in
else()
  message("not given to FEBio: no febio4")
endif()
find_program(CCX ccx)
if(NOT CCX)
  message("not given to CalculiX: no ccx (calculix-ccx)")
  return()
endif()
function(by_calculix scene set axis share tolerance)
  run(0 ${CMAKE_COMMAND} -E env OMP_NUM_THREADS=1 ${CCX} -i ${scene})
  run(0 awk -v set=${set} -v axis=${axis} -v share=${share} -v tolerance=${tolerance} -f ${ROOT}/tests/support/ccx_force.awk ${scene}.inp ${scene}.dat)
  message("${scene}: ${said}")
endfunction()
by_calculix(tension x_max 1 1 1e-4)
by_calculix(fibres x_max 1 1 1e-4)
by_calculix(slanted x_max 1 1 5e-3)  # 0.33 %, with cells of half the length 0.19 %
by_calculix(bonded y_max 2 4 1e-2)  # a quarter of the layer
by_calculix(pair pad_top 2 1 2e-2)  # a penalty that lets the surfaces in
by_calculix(sphere RIGID_SPHERE 2 -4 3e-2)  # other cells, and a penalty that lets the sphere in
# hex8 of 0.9 mm are 15 % off themselves where their corners touch the sphere; as C3D20R they give what hex27 give here
run(0 ${CMAKE_COMMAND} -E env OMP_NUM_THREADS=1 ${CCX} -i ball)
run(0 awk -v set=RIGID_SPHERE -v axis=2 -v share=-4 -v tolerance=3e-2 -f ${ROOT}/tests/support/ccx_force.awk sphere.inp ball.dat)
message("ball: ${said}")
