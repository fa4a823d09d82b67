# The cases of docs/extremes.csv against the tables of a run of pipelines/extremes.yaml, as lines of a Markdown table.
#   awk -v run=runs/extremes -f docs/extremes.awk docs/extremes.csv
# Ends with 1 where a case is not passed.
function load(table,   file, line, head, cell, n, i, axes, key, m) {
  if (table in loaded) return
  loaded[table] = 1
  file = run "/" table "_table/table.csv"
  if ((getline line < file) <= 0) return
  n = split(line, head, ",")
  axes = table ~ /^solver_/ ? 2 : 1
  while ((getline line < file) > 0) {
    m = split(line, cell, ",")
    key = axes == 2 ? cell[1] "," cell[2] : cell[1]
    for (i = axes + 1; i <= m; ++i) {
      value[table, key, head[i]] = cell[i]
      if (axes == 2) value[table, cell[2] "," cell[1], head[i]] = cell[i]  # in either order
    }
  }
  close(file)
}
function find(table, key, column,   k, parts) {
  if ((table, key, column) in value) return value[table, key, column]
  for (k in value) {  # 1e-10 and 1.0e-10 are one row
    split(k, parts, SUBSEP)
    if (parts[1] == table && parts[3] == column && parts[2] + 0 == key + 0 && parts[2] ~ /^[0-9]/ && key ~ /^[0-9]/) return value[k]
  }
  return ""
}
BEGIN { FS = "|"; print "| case | found | expected | |"; print "| --- | --- | --- | --- |" }
/^#/ || NF < 6 { next }
{
  load($2)
  found = find($2, $3, $4)
  other = $5 == "as" ? find($2, $6, $4) : $6
  if (found == "" || other == "") { verdict = "not run"; missing++ }
  else {
    difference = found - other; if (difference < 0) difference = -difference
    size = other < 0 ? -other : other + 0
    ok = $5 == "most" ? found + 0 <= other + 0 : $5 == "least" ? found + 0 >= other + 0 : difference <= $7 * size
    verdict = ok ? "passed" : "**FAILED**"; ok ? passed++ : failed++
  }
  sign = $5 == "most" ? "≤ " : $5 == "least" ? "≥ " : ""
  printf "| %s | %s %.7g | %s%.7g%s | %s |\n", $1, $4, found, sign, other, ($7 == "" ? "" : " ± " $7 * 100 " %"), verdict
}
END {
  printf "\n%d cases passed, %d failed, %d not run.\n", passed, failed, missing
  exit failed + missing > 0
}
