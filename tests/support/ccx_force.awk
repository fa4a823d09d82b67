# Is the last total force that CalculiX printed of a set (job.dat) the one at the head of the deck (Langer's answer, which is of the
# whole body)?  awk -v set=x_max -v axis=1 -v tolerance=1e-3 -v share=1 -f ccx_force.awk deck.inp job.dat
FNR == NR { if (/answer at t = 1: force/) { split($0, part, /[(),]/); own = part[axis + 1] }; next }
/total force/ && index(toupper($0), " SET " toupper(set) " ") { getline; getline; found = share * $axis }
END {
  off = found / own - 1
  printf "CalculiX %s %.6g N, Langer %.6g N, off by %.2g\n", set, found, own, off
  exit !(own != 0 && off < tolerance && off > -tolerance)
}
