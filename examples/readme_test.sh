#!/usr/bin/env bash
# README's C++ is a part of examples/print_the_depth.cpp, line by line: readme_test.sh SOURCE_FOLDER
set -euo pipefail
snippet=$(awk '$0 == "```" { on = 0 } on { print } $0 == "```cpp" { on = 1 }' "$1/README.md")
[[ -n $snippet && $(<"$1/examples/print_the_depth.cpp") == *"$snippet"* ]] && exit 0
echo "README.md's C++ is not in examples/print_the_depth.cpp; copy it from there" >&2
exit 1
