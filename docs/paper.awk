# docs/paper.csv and a run of pipelines/paper.yaml as the Markdown page docs/paper.md; ends with 1 where a value or a picture is missing.
#   awk -v run=runs/paper -f docs/paper.awk docs/paper.csv
function value(file, key, column,   line, head, cell, n, m, i, at, found, wanted, x0, y0, s) {
  found = ""
  file = run "/" file
  if ((getline line < file) <= 0) { close(file); return "" }
  n = split(line, head, ",")
  for (i = 1; i <= n; ++i) if (head[i] == column) at = i
  wanted = substr(key, 1, 1) == "@" ? substr(key, 2) + 0 : ""
  while ((getline line < file) > 0) {
    m = split(line, cell, ",")
    if (wanted != "") {  # between the rows around it
      if (cell[1] + 0 >= wanted && found == "") {
        s = cell[1] == x0 ? 0 : (wanted - x0) / (cell[1] - x0)
        found = y0 + s * (cell[at] - y0)
      }
      x0 = cell[1] + 0; y0 = cell[at] + 0
    } else if (index(line "," , key ",") == 1) found = cell[at]  # of a path: the last state there
  }
  close(file)
  return at ? found : ""
}
# {file;key;column}, {-;file;key;column;paper}, {/;file;key;column;paper} in a sentence
function filled(text,   from, to, part, n, x, how) {
  while ((from = index(text, "{")) > 0 && (to = index(substr(text, from), "}")) > 0) {
    n = split(substr(text, from + 1, to - 2), part, ";")
    how = n == 5 ? part[1] : ""
    x = how == "" ? value(part[1], part[2], part[3]) : value(part[2], part[3], part[4])
    if (x == "") { missing++; print substr(text, from, to) ": missing" > "/dev/stderr"; x = "missing" }
    else x = how == "-" ? difference(x, part[5]) : how == "/" ? sprintf("%.0f", part[5] / x) : shown(x + 0)
    text = substr(text, 1, from - 1) x substr(text, from + to)
  }
  return text
}
# in percent of the paper's number
function difference(x, paper) { return sprintf("%+.3g", 100 * (x - paper) / (paper < 0 ? -paper : paper)) }
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
  print "Values and pictures of `make run PIPELINE=pipelines/paper.yaml`, compared with [A23] ([references](references.md)). For the errata, see"
  print "[theory](theory.md). Meshes have 1 to 6 000 hexahedra. The paper's own size, 12 320 hexahedra in 100 steps, is"
  print "`pipelines/indentation_paper_size.yaml`. Figures 1 to 3 and 6 of the paper are sketches."
  print "\nThe paper's drawings are not available as data. Compared are the numbers that it prints in its tables and its text. Those of its figures are in"
  print "`data/paper_a23_figure_9.csv` and `data/paper_a23_figure_13.csv`, and are shown as points. For the other figures no number is printed: this page"
  print "quotes the statements of the text and gives Langer's results.\n"
}
/^#/ || NF < 2 { next }
$1 == "T" { printf "\n## %s\n\n| quantity | paper | Langer | difference, %% | why they differ |\n| --- | --- | --- | --- | --- |\n", $2; next }
$1 == "R" {
  x = value($3, $4, $5)
  if (x == "") { missing++; print $3 ": " $4 ": " $5 ": missing" > "/dev/stderr" }
  printf "| %s | %s | %s | %s | %s |\n", $2, $6, x == "" ? "missing" : shown(x + 0), x != "" && $6 ~ /^-?[0-9.]+$/ && $6 + 0 != 0 ? difference(x + 0, $6 + 0) : "–", $7
  next
}
$1 == "F" {
  picture = run "/" $3
  if ((getline line < picture) < 0) { missing++; print picture ": missing" > "/dev/stderr" }
  close(picture)
  printf "\n## Figure %s: %s\n\n%s.\n\n![figure %s](paper/figure_%s.png)\n", $2, $4, sentence(filled($5)), $2, $2
}
END { exit missing > 0 }
