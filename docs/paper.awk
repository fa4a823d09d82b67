# docs/paper.csv and a run of pipelines/paper.yaml as the Markdown page docs/paper.md; ends with 1 where a value or a picture is missing.
#   awk -v run=runs/paper -f docs/paper.awk docs/paper.csv
function value(file, key, column,   line, head, cell, n, m, i, at, row, found) {
  found = ""
  file = run "/" file
  if ((getline line < file) <= 0) return ""
  n = split(line, head, ",")
  for (i = 1; i <= n; ++i) if (head[i] == column) at = i
  while ((getline line < file) > 0) {
    m = split(line, cell, ",")
    if (index(line "," , key ",") == 1) found = cell[at]  # of a path: the last state there
  }
  close(file)
  return at ? found : ""
}
function sentence(s) { return toupper(substr(s, 1, 1)) substr(s, 2) }
function shown(x,   a) {
  a = x < 0 ? -x : x
  if (a == 0) return "0"
  if (a < 1e-3) return sprintf("%.1e", x)
  return a < 10 ? sprintf("%.4g", x) : sprintf("%.5g", x)
}
BEGIN {
  FS = "|"
  print "# The paper and Langer, side by side\n"
  print "<!-- written by `make paper` from docs/paper.csv and a run of pipelines/paper.yaml: do not edit -->\n"
  print "Values and pictures of `make run PIPELINE=pipelines/paper.yaml`, beside those of [A23] ([references](references.md)). The errata it"
  print "speaks of stand in [theory.md](theory.md). Meshes of 1 to 6 000 hexahedra; the paper's own size, 12 320 hexahedra in 100 steps,"
  print "is `pipelines/indentation_paper_size.yaml`. Figures 1 to 3 and 6 of the paper are sketches.\n"
}
/^#/ || NF < 2 { next }
$1 == "T" { printf "\n## %s\n\n| quantity | paper | Langer | why they differ |\n| --- | --- | --- | --- |\n", $2; next }
$1 == "R" {
  x = value($3, $4, $5)
  if (x == "") { missing++; print $3 ": " $4 ": " $5 ": missing" > "/dev/stderr" }
  printf "| %s | %s | %s | %s |\n", $2, $6, x == "" ? "missing" : shown(x + 0), $7
  next
}
$1 == "F" {
  picture = run "/" $3
  if ((getline line < picture) < 0) { missing++; print picture ": missing" > "/dev/stderr" }
  close(picture)
  printf "\n## Figure %s: %s\n\n%s.\n\n![figure %s](paper/figure_%s.png)\n", $2, $4, sentence($5), $2, $2
}
END { exit missing > 0 }
