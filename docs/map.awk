# The wings of lib/ with their rooms as a graph for dot, lowest wings at the bottom:
#   awk -f docs/map.awk tests/layout.cmake LINES INCLUDES | tred | dot -Tsvg
# LINES: `file:number`, INCLUDES: `file:#include "folder/`, both of lib/ and stages/. An arrow is an include; arrows that follow from
# others are left out by tred. In a wing each room may include those below it. `make map` writes docs/map.svg.
BEGIN {
  says["core/base"] = "text, errors, units, random numbers"
  says["core/tensor"] = "invariants, kinematics, packets"
  says["core/config"] = "YAML to structs and back"
  says["core/hdf5"] = "arrays in files, checksums"
  says["mechanics/mesh"] = "cells, sets, shape functions"
  says["mechanics/contact"] = "rigid shapes, Coulomb's cone, adhesion"
  says["mechanics/mortar"] = "contact of two deformable surfaces"
  says["mechanics/material"] = "energies, stress and tangent"
  says["mechanics/element"] = "internal force and tangent of a cell"
  says["mechanics/assembly"] = "body, loads, mass matrix"
  says["mechanics/dynamics"] = "time integration schemes"
  says["mechanics/linear"] = "direct and iterative solvers"
  says["mechanics/nonlinear"] = "Newton, KINSOL, load path"
  says["mechanics/solve"] = "an increment with contact"
  says["mechanics/vibration"] = "modes, harmonic response"
  says["meshing/meshing"] = "blocks, sections, files, gmsh"
  says["results/store"] = "solutions in HDF5"
  says["results/plot"] = "charts and pictures"
  says["results/post"] = "columns, fields, figures"
  says["layers/layers"] = "waves and wrinkles of layers"
  says["scene/model"] = "from a config to a scene"
  says["scene/run"] = "one run along its path"
  says["accuracy/checks"] = "stability, contact, locking"
  says["accuracy/estimate"] = "error bars"
  says["accuracy/refinement"] = "choice of the next level"
  says["identification/fit"] = "tests, noise, least squares"
  says["identification/sensitivity"] = "Morris, Sobol"
  says["identification/statistics"] = "intervals, next test"
  says["identification/posterior"] = "no-U-turn sampler"
  says["identification/setup"] = "config of a fit"
  says["identification/population"] = "many specimens"
  says["identification/laws"] = "which material model"
  says["identification/inverse"] = "scenes as tests"
  says["export/export"] = "decks for CalculiX, FEBio"
  says["report/report"] = "one HTML page"
  says["pipeline/sweep"] = "tables over sweeps"
  says["pipeline/plan"] = "pipelines to Makefiles"
  says["cli/cli"] = "commands of langer"
  says["serve/serve"] = "set-up page in the browser"
  says["stages/stages"] = "one small main per program"
}
# A room is a folder in its wing. Wings with files of their own are one room, with the folders in it.
function room_of(path,   part_of) {
  sub("^lib/", "", path)
  split(path, part_of, "/")
  if (("" part_of[1] "/" part_of[2]) in listed) return part_of[1] "/" part_of[2]
  return part_of[1] "/" part_of[1]
}
function cell_of(text, side, colour) {
  if (text == "") return "<td></td>"
  return sprintf("<td align=\"%s\"><font color=\"%s\">%s</font></td>", side, colour, text)
}
function wing_of(room) { sub("/.*", "", room); return room }
FNR == 1 { part++ }
# the rooms in their order, from set(rooms ...)
part == 1 {
  if (/^set\(rooms/) { inside = 1; next }
  if (!inside) next
  line = $0
  if (sub(/\).*/, "", line)) last = 1
  count = split(line, words, " ")
  for (i = 1; i <= count; i++) {
    room = words[i] ~ /\// && words[i] != "serve/http" ? words[i] : wing_of(words[i]) "/" wing_of(words[i])
    if (room in listed) continue
    listed[room] = 1
    order[++rooms] = room
  }
  if (last) inside = 0
  next
}
part == 2 { split($0, cell, ":"); lines[room_of(cell[1])] += cell[2]; next }
{
  split($0, cell, ":"); split(cell[2], word, "\"")
  from = wing_of(room_of(cell[1])); to = wing_of(room_of(word[2] "x"))
  if (from != to) arrows[from " -> " to] = 1
}
END {
  print "digraph langer {"
  print "  graph [rankdir=TB, nodesep=0.3, ranksep=0.45]"
  print "  node [shape=plain, fontname=\"Helvetica\", fontsize=11]"
  print "  edge [color=gray40, arrowsize=0.7]"
  for (i = rooms; i >= 1; i--) {
    wing = wing_of(order[i])
    name = order[i]
    sub(/.*\//, "", name)
    if (name == wing) name = ""
    if (!says[order[i]]) print "docs/map.awk says nothing about " order[i] > "/dev/stderr"
    rows[wing] = rows[wing] "<tr>" cell_of(name, "left", "#000000") cell_of(says[order[i]], "left", "#505050") \
      cell_of(lines[order[i]], "right", "#505050") "</tr>"
    if (!(wing in drawn)) {
      drawn[wing] = 1
      wings[++n] = wing
    }
  }
  for (i = 1; i <= n; i++)
    printf "  %s [label=<<table border=\"1\" style=\"rounded\" cellborder=\"0\" cellspacing=\"0\" cellpadding=\"3\" %s>%s%s</table>>]\n",
      wings[i], "color=\"#37474f\" bgcolor=\"#f4f6f7\"", "<tr><td colspan=\"3\"><b>" wings[i] "</b></td></tr>", rows[wings[i]]
  for (arrow in arrows) print "  " arrow
  print "}"
}
