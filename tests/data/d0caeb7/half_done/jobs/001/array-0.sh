#!/bin/bash
# $1, $2: the process to wait for, if any, and when it was started
set -u
while [[ -n ${1:-} ]] && read -r stat 2>/dev/null </proc/"$1"/stat; do
  fields=(${stat##*) })
  [[ ${fields[0]} != [ZX] && ${fields[19]} == "$2" ]] || break
  sleep 0.2
done
exec >>'/home/user/half_done/logs/strut-89101cb6-7f234dde-001.array-0.log' 2>&1
threads=1
for ((task = 0; task < 1; ++task)); do
  program='/usr/bin/strut'
  "$program" run '/home/user/half_done' --threads "$threads" --task 001/0/"$task"
done
