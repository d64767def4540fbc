#!/usr/bin/env bash
# A recording of a rendered person, as `duoptic record` makes it: make_clip.sh TOOL FOLDER
set -euo pipefail
rm -rf "$2"
mkdir -p "$2"
"$1" synth --script wave --frames 20 --size 320x240 --quiet -o "$2/clip"
"$1" record "$2/clip/left.avi" "$2/clip/right.avi" --rig "$2/clip/calibration_truth.yml" -o "$2/clip.mkv" --quiet
