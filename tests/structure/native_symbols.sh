#!/bin/sh
# native_symbols.sh NM OBJDUMP "NATIVE ARCHIVES" "OTHER ARCHIVES"
# Fails if an inline function or template instance that computes with floating-point numbers is
# emitted both in archives compiled for this very machine and in others: the linker keeps one of the
# copies, and results of the others (the mesh) would depend on the machine and on the link order.
set -eu
nm=$1 objdump=$2 native=$3 other=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
weak() { "$nm" "$@" 2>/dev/null | awk 'NF == 3 && $2 == "W" { print $3 }' | sort -u; }
weak $native > "$folder/native"
weak $other > "$folder/other"
comm -12 "$folder/native" "$folder/other" > "$folder/shared"
for list in native other shared; do
  [ -s "$folder/$list" ] || { echo "no weak functions: $list"; exit 2; }
done
for archive in $native $other; do "$objdump" -d --no-show-raw-insn "$archive"; done |
  awk 'NR == FNR { shared[$1] = 1; next }
       /^[0-9a-f]+ <.*>:$/ { name = substr($2, 2, length($2) - 3); next }
       (name in shared) && /\tv?(add|sub|mul|div|sqrt|min|max|hadd|dp|fn?m(add|sub))[0-9a-z]*[sp][sd][ \t]/ {
         print name }' "$folder/shared" - | sort -u > "$folder/found"
echo "$(wc -l < "$folder/shared") functions are in both, $(wc -l < "$folder/found") of them compute"
cat "$folder/found"
[ ! -s "$folder/found" ]
