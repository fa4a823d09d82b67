# A page of docs/ as a shell script that does what the page tells its reader to do.
#   awk -f walk.awk docs/tutorial.md > script
# ```sh            commands, run in order
# ```<kind> FILE   the text of a file that the reader writes
# ```text          lines that the commands before have said, word for word (spaces apart)
# Blocks of other kinds (console, yaml without a name, matlab) are not run.
BEGIN {
  print "set -e"
  print "said=$(mktemp); now=$(mktemp); trap 'code=$?; [ $code = 0 ] || tail -n 20 \"$now\"; rm -f \"$said\" \"$now\"' EXIT"
  print "seen() { tr -s ' ' < \"$said\" | grep -qF -- \"$1\" || { echo \"$2: the commands before it did not say: $1\"; exit 1; }; }"
}
function quoted(s) { gsub(/'/, "'\\''", s); return "'" s "'" }
/^```/ && !kind {
  kind = substr($1, 4); file = $2; first = FNR
  if (kind == "") kind = "none"
  if (kind == "sh") print "echo " quoted(FILENAME ":" FNR) "; {"
  if (file != "") print "cat > " quoted(file) " <<'END OF FILE'"
  next
}
/^```/ {
  if (kind == "sh") print "} > \"$now\" 2>&1; cat \"$now\" >> \"$said\""
  if (file != "") print "END OF FILE"
  kind = ""; file = ""
  next
}
kind == "sh" || file != "" { print }
kind == "text" && file == "" {
  line = $0; gsub(/ +/, " ", line)
  if (line != "") print "seen " quoted(line) " " quoted(FILENAME ":" FNR)
}
