# Functions of more than `most` lines: from the line at the margin that begins one to the brace at the margin that ends it.
FNR == 1 { start = body = 0 }
/^[^ \t}#\/].*\(/ && !/^(namespace|struct|class|enum|union)/ { start = FNR; says = $0; body = 0 }
start && !body && /\{$/ { body = 1 }
start && !body && /;$/ { start = 0 }
start == FNR && /\}$/ { start = 0 }
/^\}/ {
  if (body && FNR - start + 1 > most) {
    printf "%s:%d: %d lines: %s\n  rule: at most %d in a function\n", FILENAME, start, FNR - start + 1, says, most
    found = 1
  }
  start = body = 0
}
END { exit found }
