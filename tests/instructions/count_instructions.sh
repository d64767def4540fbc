#!/usr/bin/env bash
# count_instructions.sh PROGRAM COUNTS: instructions that one frame takes with each matcher, against those kept in COUNTS
# (lines of "matcher instructions"). More than a tenth above fails; so does a tenth below, so that the file stays true.
# Valgrind's processor has AVX2 and no AVX-512, whatever the machine has. To write new counts: UPDATE=1.
set -euo pipefail
program=$1 counts=$2
[[ -x $program ]] || { echo "no program $program"; exit 1; }
command -v valgrind >/dev/null || { echo "skipped: no valgrind"; exit 77; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# instructions MATCHER FRAMES
instructions() {
  valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=/dev/null "$program" "$1" "$2" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
  sed -n 's/^==[0-9]*== Collected : *\([0-9]*\).*/\1/p' "$log"
}

failed=0 new=
while read -r matcher kept; do
  counted=$(instructions "$matcher" 3)
  ((counted > 0)) || { cat "$log"; echo "$matcher: nothing was counted"; exit 1; }
  now=$((counted / 3))
  echo "$matcher: $now instructions a frame, kept $kept"
  new+="$matcher $now"$'\n'
  if ((now * 10 > kept * 11 || now * 10 < kept * 9)); then
    echo "$matcher: that is more than a tenth off; look why, or write the new count with UPDATE=1 and say why"
    failed=1
  fi
done <"$counts"
if [[ -n ${UPDATE:-} ]]; then
  printf '%s' "$new" >"$counts"
  exit 0
fi
exit $failed
