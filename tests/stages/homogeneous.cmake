# A strip whose fibres, 60 degrees off the pull, are shorter than at rest up to a stretch of (sqrt(13) - 1) / 2 = 1.303: until then it is
# isotropic and one hexahedron stands for it; then they pull, it deforms otherwise from place to place, and the mesh goes on from there.
include(${ROOT}/tests/support/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})
file(WRITE ${WORK}/strip.yaml "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [4, 1, 2]}}}
material: {matrix: {neo_hooke: {a1: 0.1}}, fibres: [{hgo: {c1: 0.3, c2: 0.3}, alpha: 60}], volume: {quadratic: {d: 1.0e-3}}}
supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: 2}}]
path: {steps: 10}
stability: off
")
run(0 ${BIN}/langer-solve strip.yaml -o changes/solution.h5 -v)
expect_said("homogeneous: one hexahedron stands for 8 cells")
expect_said("homogeneous: the mesh no longer balances, and is solved from there on")
expect_said("continues after 6 steps, at t = 0.6")  # stretch 1.3
run(0 ${BIN}/langer-solve strip.yaml -o mesh/solution.h5 --set homogeneous=off)
file(WRITE ${WORK}/post.yaml "columns: [{quantity: t}, {quantity: reaction_x, at: x_max}, {quantity: energy}]\n")
foreach(run changes mesh)
  run(0 ${BIN}/langer-post post.yaml --solution ${run}/solution.h5 -o ${run}/curves.h5 --quiet)
endforeach()
# the same rows, to 1e-8
file(WRITE ${WORK}/same.awk [=[
FNR == 1 { next }
FNR == NR { for (i = 1; i <= NF; ++i) a[FNR, i] = $i; n = FNR; next }
{ for (i = 1; i <= NF; ++i) if (($i - a[FNR, i])^2 > 1e-16 * $i^2) { print FNR, i, a[FNR, i], $i; exit 1 } m = FNR }
END { if (n != m || n < 12) exit 1 }
]=])
run(0 awk -F, -f same.awk changes/curves.csv mesh/curves.csv)
