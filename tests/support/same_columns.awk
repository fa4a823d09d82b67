# Two CSV files of the same head and number of rows agree in every column but the one called `but`, to 1e-6 relative.
#   awk -F, -v but=newton_iterations -f same_columns.awk one.csv other.csv
function size(x) { return x < 0 ? -x : x }
NR == FNR { for (i = 1; i <= NF; ++i) first[FNR, i] = $i; rows = FNR; next }
FNR == 1 { for (i = 1; i <= NF; ++i) { if ($i != first[1, i]) wrong = "head"; if ($i != but) compared[i] } }
FNR > 1 { for (i in compared) if (size($i - first[FNR, i]) > 1e-6 * size(first[FNR, i]) + 1e-12) wrong = "row " FNR ", column " i }
END {
  if (FNR != rows || rows < 2) wrong = FNR " rows and " rows
  if (wrong) { print "the files differ: " wrong; exit 1 }
}
