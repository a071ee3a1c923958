#!/bin/bash
# Reproduces the paper: simulates its grid of worn cars over the bump, trains a network on them,
# identifies a worn car, and prints the paper's tables beside our numbers. Prints each command before
# running it, and ends with the path of the report.
#   examples/paper.sh [DIR]     writes all results to DIR (default: paper)
# A repeated run resumes from existing results. STRUT: the program (default build/release/strut).
set -euo pipefail
folder=$(realpath -m "${1:-paper}")
cd "$(dirname "$(realpath "$0")")/.."
strut=${STRUT:-build/release/strut}
folder=$(realpath --relative-base="$PWD" -m "$folder")

# run ARGUMENTS...: prints the command, then runs the program.
run() {
  printf '\n$ strut %s\n' "$*"
  "$strut" "$@"
}

mkdir -p "$folder"
echo "== Simulate 10,000 cars, new to worn, over the bump"
run plan examples/sweeps/paper.toml -o "$folder/sweep"
run run "$folder/sweep"

printf '\n== Train a network to identify springs and dampers from the motion of the body on the bump\n'
run train "$folder/sweep" -o "$folder/model.h5" --goal 1e-9 --force
run evaluate "$folder/model.h5" "$folder/sweep"

printf '\n== Identify a worn car that is not a point of the grid\n'
run simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml \
  --set front_stiffness=38240 --set front_damping=1913 --set rear_stiffness=33310 \
  --set rear_damping=1867 -o "$folder/worn.h5" --force
run identify "$folder/model.h5" "$folder/worn.h5"

printf '\n== Compare with the tables of the paper\n'
run study examples/studies/paper_quick.toml -o "$folder/study"

printf '\nThe report, one file for a browser:\n%s\n' "$folder/study/report.html"
