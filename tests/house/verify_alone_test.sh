#!/bin/sh
# verify_alone_test.sh PROGRAM VERIFY_ALONE SOURCE_DIR FOLDER
# The verifier's room, linked alone, accepts a plan of the program and refuses it for another scene.
set -eu
program=$1 verify_alone=$2 source=$3 folder=$4
scenarios=$source/experiments/scenarios
robot=$source/models/drchubo1/drchubo1.yaml
"$program" plan "$scenarios/three_routes_a.yaml" --out "$folder" --seed 1 >/dev/null
"$verify_alone" "$folder/plan.json" "$robot" "$scenarios/three_routes_a.yaml"
if "$verify_alone" "$folder/plan.json" "$robot" "$scenarios/hallway.yaml"; then
  echo "a plan for another scene was accepted" >&2
  exit 1
fi
