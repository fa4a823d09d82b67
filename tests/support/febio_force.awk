# Is the sum over the rows of FEBio's last record (number, x, y, z) the force at the head of the deck (Langer's answer, which is of the
# whole body)?  awk -F, -v axis=1 -v tolerance=1e-3 -v share=1 -f febio_force.awk deck.feb x_max_reaction.csv
FNR == NR { if (/answer at t = 1: force/) { split($0, part, /[(),]/); own = part[axis + 1] }; next }
/^\*/ { if (/^\*Step/) found = 0; if (/^\*Time/) { split($0, part, "="); t = part[2] }; next }
{ found += share * $(axis + 1) }
END {
  off = found / own - 1
  printf "FEBio %.6g N at t = %g, Langer %.6g N, off by %.2g\n", found, t, own, off
  exit !(t > 1 - 1e-9 && own != 0 && off < tolerance && off > -tolerance)
}
