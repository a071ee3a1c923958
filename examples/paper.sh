#!/bin/bash
# The paper from end to end: its grid of worn cars, each sent over the bump; a network trained on them;
# a worn car identified by it; and the paper's tables beside our numbers. Prints each command before it
# runs it, and ends with the path of the report.
#   examples/paper.sh [DIR]     DIR (default paper) holds everything that comes out
# Running it again goes on from what is there. STRUT: the program (default build/release/strut).
set -euo pipefail
folder=$(realpath -m "${1:-paper}")
cd "$(dirname "$(realpath "$0")")/.."
strut=${STRUT:-build/release/strut}
folder=$(realpath --relative-base="$PWD" -m "$folder")

# run ARGUMENTS...: the program with them, told before.
run() {
  printf '\n$ strut %s\n' "$*"
  "$strut" "$@"
}

mkdir -p "$folder"
echo "== 10,000 cars, new to worn, over the bump"
run plan examples/sweeps/paper.toml -o "$folder/sweep"
run run "$folder/sweep"

printf '\n== A network that tells springs and dampers from what the body does on the bump\n'
run train "$folder/sweep" -o "$folder/model.h5" --goal 1e-9 --force
run evaluate "$folder/model.h5" "$folder/sweep"

printf '\n== A worn car that is not on the grid, and what the network says of it\n'
run simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml \
  --set front_stiffness=38240 --set front_damping=1913 --set rear_stiffness=33310 \
  --set rear_damping=1867 -o "$folder/worn.h5" --force
run identify "$folder/model.h5" "$folder/worn.h5"

printf '\n== The tables of the paper, and ours\n'
run study examples/studies/paper_quick.toml -o "$folder/study"

printf '\nThe report, one file for a browser:\n%s\n' "$folder/study/report.html"
