#!/usr/bin/env bash
# What a second worker of `duoptic batch run --local` gains, over 12 equal recordings with one thread each: scaling.sh TOOL [ROUNDS]
# By the fine matcher, beside which the threads that read and write take next to nothing: a task that keeps one core busy, and no more.
# Beside it, what the machine itself gains: the same commands in one row, and in two rows at once, without a pool. Least times of all rounds.
set -euo pipefail
tool=$(realpath "$1") rounds=${2:-3}
work=(--engine simd --threads 1 --preset fine --every 20 --outputs depth)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$tool" synth --script wave --frames 40 --quiet -o clip >/dev/null
recordings=(01 02 03 04 05 06 07 08 09 10 11 12)
for i in "${recordings[@]}"; do
  mkdir -p "archive/p$i"
  cp clip/left.avi clip/right.avi "archive/p$i/"
done
cp clip/calibration_truth.yml archive/
"$tool" batch plan archive -o planned --depth -- "${work[@]:4}" >/dev/null
"$tool" batch status planned >/dev/null  # reads the inputs

with_pool() {
  rm -rf out && cp -r planned out
  "$tool" batch run out --local --jobs "$1" --quiet
}
row() { for i in "$@"; do "$tool" depth "archive/p$i/left.avi" "archive/p$i/right.avi" --rig archive/calibration_truth.yml "${work[@]}" -o "p$i" --quiet; done; }
two_rows() {
  row "${recordings[@]:0:6}" &
  row "${recordings[@]:6:6}"
  wait
}
declare -A least_ms
measure() {
  local name=$1 start=${EPOCHREALTIME/./} ms
  shift
  "$@"
  ms=$(((${EPOCHREALTIME/./} - start) / 1000))
  [[ -n ${least_ms[$name]:-} && ${least_ms[$name]} -le $ms ]] || least_ms[$name]=$ms
}
for ((round = 0; round < rounds; ++round)); do
  measure one_worker with_pool 1
  measure two_workers with_pool 2
  measure one_row row "${recordings[@]}"
  measure two_rows two_rows
done
gain() { echo "$1: ${least_ms[$2]} ms, ${least_ms[$3]} ms, $((least_ms[$2] * 100 / least_ms[$3])) % of the throughput of one"; }
gain "one and two workers" one_worker two_workers
gain "one and two rows of commands without a pool" one_row two_rows
