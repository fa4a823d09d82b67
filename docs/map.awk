# The folders of lib and the includes between them as a graph for dot, lowest folders at the bottom.
#   make map
function room(path) { sub("^lib/", "", path); sub("/.*", "", path); return path }
FNR == 1 { part++ }
part == 1 { split($0, cell, ":"); lines[room(cell[1])] += cell[2]; files[room(cell[1])]++; next }
{
  split($0, cell, ":"); split(cell[2], word, "\"")
  from = room(cell[1]); to = room(word[2])
  if (from != to) includes[from " -> " to]++
}
END {
  print "digraph langer {\n  graph [rankdir=TB, nodesep=0.25, ranksep=0.4]\n  node [shape=box, style=rounded, fontname=\"Helvetica\", fontsize=11]\n  edge [color=gray40, arrowsize=0.6]"
  for (r in lines) printf "  %s [label=\"%s\\n%d files, %d lines\"]\n", r, r, files[r], lines[r]
  for (arrow in includes) printf "  %s\n", arrow
  print "}"
}
