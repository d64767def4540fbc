#!/usr/bin/env bash
# What Duoptic writes, read by other people's programs: readers_test.sh mcap|gltf TOOL RECORDING FOLDER      exit 77: skipped
set -euo pipefail
what=$1 tool=$2 recording=$3 folder=$4
here=$(dirname "$(realpath "$0")")
declare -A file=([mcap]=people.mcap [gltf]=people.glb)

command -v node >/dev/null || { echo "skipped: there is no node; make readers installs it, and the readers"; exit 77; }
[[ -d $here/node_modules ]] || { echo "skipped: the readers are not installed; make readers does it"; exit 77; }
mkdir -p "$folder"
"$tool" track "$recording" -o "$folder/$what.jsonl" "--$what" "$folder/${file[$what]}" --quiet
node "$here/read_$what.mjs" "$folder/$what.jsonl" "$folder/${file[$what]}"
