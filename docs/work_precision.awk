# Tables of docs/work_precision.md.   awk -v what=front -f docs/work_precision.awk runs/refinement_study/<scene>/levels.csv
#   front     levels on the front of the force, by cost
#   levels    one line per level: errors of the force in all scenes given, seconds and memory of the last one
#   estimates  estimated errors against true ones, of runs/estimates/<scene>_table/table.csv
#   accuracy  asked against a finer mesh's limit, of runs/accuracy/<law>_table/table.csv
BEGIN { FS = "," }
BEGIN {  # fitted limits of make work-precision, and how far they may be off in %
  right["isotropic"] = 10.763; right["table1"] = 9.362; right["positive"] = 12.670
  open["isotropic"] = 0.03; open["table1"] = 0.06; open["positive"] = 0.06
}
FNR == 1 { ++file; delete head; for (i = 1; i <= NF; ++i) head[$i] = i; next }
what == "front" && $head["force_front"] == 1 {
  row[++n] = sprintf("| %s | %.2g | %.2g | %.2g | %.0f |", $1, $head["force_error_percent"], $head["cpu_s"], $head["wall_s"], $head["memory_MB"])
  cost[n] = $head["cpu_s"]
}
what == "levels" {
  if (!($1 in at)) { order[++n] = $1; at[$1] = n }
  error[$1, file] = $head["force_error_percent"]; cpu[$1, file] = $head["cpu_s"]; files = file
}
what == "accuracy" {
  how = $1; s = $2
  if ($2 == "asked" || $2 == "fine") { how = $2; s = $1 }
  if (how == "asked") { asked[s] = $head["force_N"]; said[s] = $head["force_error_N"]; limit[s] = $head["force_limit_N"] }
  else { fine[s] = $head["force_limit_N"]; unsure[s] = $head["force_error_N"] }
  if (!(s in seen)) { order[++n] = s; seen[s] = FILENAME }
}
what == "estimates" {
  scene = FILENAME; sub(/_table\/table.csv$/, "", scene); sub(/.*\//, "", scene)
  column = "increments" in head ? scene " " $head["increments"] : scene
  if (!($1 in at)) { order[++n] = $1; at[$1] = n }
  if (!(column in seen)) { columns[++m] = column; seen[column] = 1 }
  off = 100 * ($head["force_N"] / right[scene] - 1); est = 100 * $head["force_error_N"] / $head["force_N"]
  cell[$1, column] = sprintf("%+.2f, %.2g", off, est)
  size = off < 0 ? -off : off
  if (size > open[scene]) {
    kind = substr($1, 1, 1) == "h" ? "hex8" : "hex27"
    ++cases; ++cases_of[kind]
    if (est < 3 * size && est > size / 3) { ++good; ++good_of[kind] }
    else if (est < size) ++low
  }
}
END {
  if (what == "front") {
    print "| level | error of the force, % | CPU s | wall s | MB |\n| --- | --- | --- | --- | --- |"
    for (k = 1; k <= n; ++k) {
      least = 0
      for (i = 1; i <= n; ++i) if (!(i in done) && (!least || cost[i] < cost[least])) least = i
      done[least] = 1; print row[least]
    }
  }
  if (what == "levels") {
    print "| level | isotropic: error %, CPU s | Table 1, 60°: error %, CPU s | c1 > 0, 30°: error %, CPU s |\n| --- | --- | --- | --- |"
    for (k = 1; k <= n; ++k) {
      line = "| " order[k] " |"
      for (f = 1; f <= files; ++f) line = line sprintf(" %.2g, %.2g |", error[order[k], f], cpu[order[k], f])
      print line
    }
  }
  if (what == "estimates") {
    line = "| level |"; rule = "| --- |"
    for (k = 1; k <= m; ++k) { line = line " " columns[k] " |"; rule = rule " --- |" }
    print line "\n" rule
    for (k = 1; k <= n; ++k) {
      line = "| " order[k] " |"
      for (j = 1; j <= m; ++j) line = line " " cell[order[k], columns[j]] " |"
      print line
    }
    printf "\nOf %d errors that are larger than what the limits leave open, the estimate is within a factor of three in %d (%.0f %%; ", cases, good, 100 * good / cases
    printf "hex8 %d of %d, hex27 %d of %d), below a third in %d.\n", good_of["hex8"], cases_of["hex8"], good_of["hex27"], cases_of["hex27"], low
  }
  if (what == "accuracy") {
    print "| scene | law | force N, finer mesh | its own +- % | asked for 1 %: off by % | estimated +- % | limit: off by % |\n| --- | --- | --- | --- | --- | --- | --- |"
    for (k = 1; k <= n; ++k) {
      s = order[k]; law = seen[s]; sub(/_table\/table.csv$/, "", law); sub(/.*\//, "", law)
      off = 100 * (asked[s] / fine[s] - 1); size = off < 0 ? -off : off; est = 100 * said[s] / fine[s]
      if (size < 1) ++hits; if (est < 3 * size && est > size / 3) ++good; if (est > size / 3) ++safe
      if (asked[s] > fine[s] + unsure[s] || asked[s] < fine[s] - unsure[s]) { ++seen_errors; if (est < 3 * size && est > size / 3) ++told }
      lim = 100 * (limit[s] / fine[s] - 1)
      printf "| %s | %s | %.4g | %.2g | %+.2f | %.2g | %+.2f |\n", s, law, fine[s], 100 * unsure[s] / fine[s], off, est, lim
    }
    printf "\n%d of %d within 1 %%; the estimate within a factor of three of the error in %d, below a third of it in %d.\n", hits, n, good, n - safe
    printf "Of the %d errors that are larger than what the finer meshes leave open, the estimate is within a factor of three in %d.\n", seen_errors, told
  }
}
