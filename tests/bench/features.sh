#!/bin/sh
# What each feature costs, in instructions (callgrind): the same small scenes with and without it, and in each the share of the
# folders that nothing in the scene names. Usage: features.sh BUILD OUT.md
# BUILD is one without LANGER_NATIVE: valgrind knows no AVX-512.
set -eu
build=$1 out=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$(cd "$(dirname "$0")/../.." && pwd)
command -v valgrind > /dev/null || { echo "features.sh needs valgrind" >&2; exit 1; }

# function -> folder of lib/ that defines it
for folder in contact scene solve assembly element material mesh store config; do
  find "$build" -path "*lib/$folder/*.o" -exec nm -C --defined-only {} + | awk -v f="$folder" '
    $2 == "T" || $2 == "t" { $1 = $2 = ""; sub(/^ +/, ""); print f "\t" $0 }'
done > "$work/folders"

"$build/bin/langer-mesh" "$root/configs/mesh/smoke.yaml" -o "$work/mesh.h5" --quiet

rubber='material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [], volume: {quadratic: {d: 1e-6}}}'
skin='material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [{hgo: {c1: 0.317, c2: 0.319}, alpha: 0}], volume: {quadratic: {d: 1e-6}}}'
tension='supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]
loads: [{on: x_max, displacement: {x: 1}}]
path: {first: 0.5, largest: 0.5}'
press() {
  echo "supports: [{on: bottom, hold: [x, y, z]}]
contacts: {sphere: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, friction: $1, motion: [{t: 1, to: [0, -0.2, 0]}]}}
path: {first: 0.5, largest: 0.5}"
}

: > "$work/table"
run() { # name, config
  echo "$2" > "$work/solve.yaml"
  rm -f "$work"/s.h5* "$work/callgrind"
  OPENBLAS_CORETYPE=Haswell OPENBLAS_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file="$work/callgrind" \
    "$build/bin/langer-solve" "$work/solve.yaml" --mesh "$work/mesh.h5" -o "$work/s.h5" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  callgrind_annotate --threshold=100 --inclusive=no "$work/callgrind" | awk -v name="$1" -v iterations="$(awk '/^step/ { for (i = 2; i <= NF; ++i) if ($i == "iterations") n += $(i - 1) } END { print n }' "$work/log")" '
    FNR == NR { split($0, part, "\t"); folder[part[2]] = part[1]; next }
    /PROGRAM TOTALS/ { total = $1; gsub(",", "", total) }
    /^ *[0-9,]+ .*:/ && !/PROGRAM TOTALS/ {
      count = $1; gsub(",", "", count)
      function_name = $0; sub(/^ *[0-9,]+ *(\([ 0-9.]+%\))? *[^:]*:/, "", function_name); sub(/ \[[^]]*\]$/, "", function_name); sub(/\x27[0-9]+$/, "", function_name)
      if (function_name in folder) part_of[folder[function_name]] += count
    }
    END { printf "%s\t%.0f\t%.0f\t%.0f\t%s\n", name, total, part_of["contact"], part_of["solve"] + part_of["assembly"] + part_of["element"] + part_of["material"], iterations }' \
    "$work/folders" - >> "$work/table"
}
run "tension, no fibres" "$rubber
$tension"
run "tension, one fibre family" "$skin
$tension"
run "tension, stability at each step" "$skin
$tension
stability: each_step"
run "indentation, no fibres, no friction" "$rubber
$(press 0)"
run "indentation, no fibres, friction 0.34" "$rubber
$(press 0.34)"
run "indentation, one fibre family, no friction" "$skin
$(press 0)"
run "indentation, one fibre family, friction 0.34" "$skin
$(press 0.34)"
run "the same, symmetry: auto" "$skin
$(press 0.34)
symmetry: auto"
run "the same, stability at each step" "$skin
$(press 0.34)
stability: each_step"
awk -F'\t' 'BEGIN { print "| scene | million instructions | iterations | in lib/contact |\n| --- | --- | --- | --- |" }
  { printf "| %s | %.1f | %d | %s |\n", $1, $2 / 1e6, $5, $3 > 0 ? sprintf("%.2f", $3 / 1e6) : "0" }' "$work/table" > "$out"
cat "$out"
awk -F'\t' '/^tension/ && $3 > 0 { print "a scene without contact ran contact code: " $1; bad = 1 } END { exit bad }' "$work/table"
