#!/usr/bin/env bash
# The layer check holds here, and sees each kind of breach: check_layers_test.sh PROJECT_ROOT
set -euo pipefail
root=$1
"$root/tools/check_layers" "$root"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# breach FILE CONTENT WORDS: a project with that file alone must fail with those words.
breach() {
  rm -rf "${folder:?}"/*
  mkdir -p "$folder/$(dirname "$1")"
  printf '%b' "$2" >"$folder/$1"
  if said=$("$root/tools/check_layers" "$folder"); then echo "not seen: $1"; exit 1; fi
  [[ $said == *"$3"* ]] || { echo "wrong words for $1: $said"; exit 1; }
}
breach src/core/a.cpp '#include "stages/median/median.h"\n' 'lies above'
breach src/sinks/a.cpp '#include "sources/video.h"\n' 'lies beside'
breach src/sinks/b.cpp '#include "paint/draw_hue.h"\n' 'lies beside'
breach src/body/a.cpp '#include "stages/median/median.h"\n' 'lies above'
breach src/matchers/a.cpp '#include "trackers/pinhole.h"\n' 'lies above'
breach src/engines/a.cpp '#include "trackers/thesis/observation.h"\n' 'an engine includes a tracker'
breach src/stages/a/a.cpp '#include "stages/median/median.h"\n' 'a stage includes another'
breach src/core/string_utils.h '\n' 'says nothing'
breach apps/duoptic/a.cpp '#include "core/pool.h"\n' 'sees only include/duoptic'
breach include/duoptic/a.h '#include "core/pool.h"\n' 'public header'
breach include/duoptic/b.h 'namespace duo {\nclass Hidden;\nclass Shown;\nclass Shown {};\n}\n' 'shows the private type Hidden'
breach src/core/long.cpp "$(printf '\\n%.0s' {1..400})" '400 lines'
breach src/sinks/c.cpp 'out = json.dump();\n' 'json_text'
breach src/bench/c.cpp 'out = json.dump(2);\n' 'json_text'
# What is allowed is let pass.
rm -rf "${folder:?}"/*
mkdir -p "$folder"/src/{stages/a,trackers,engines} "$folder"/include/duoptic
printf '#include "stages/types/noise.h"\n' >"$folder/src/stages/a/a.h"
printf '#include "matchers/match.h"\n#include "body/skeleton.h"\n' >"$folder/src/trackers/a.h"
printf 'class Shown;\nenum class Kind : int { kA };\n' >"$folder/include/duoptic/a.h"
printf 'class Shown final : public Base {\n' >"$folder/include/duoptic/b.h"
"$root/tools/check_layers" "$folder"
echo "every breach seen"
