#!/bin/sh
# Plans, exports a recording, and reads it with @mcap/core of npm. Skipped (77) without Node.js, npm
# or the packages.  usage: read_recording_test.sh PROGRAM SOURCE FOLDER
set -eu
program=$1
source=$2
folder=$3

for tool in node npm; do
  if ! command -v "$tool" >/dev/null; then
    echo "skipped: $tool is not installed"
    exit 77
  fi
done
rm -rf "$folder"
mkdir -p "$folder"
cp "$source/tests/mcap/read_recording.mjs" "$folder"
cd "$folder"
echo '{"private": true}' >package.json
if ! npm install --no-audit --no-fund @mcap/core@2 @foxglove/schemas@2 fzstd@0.1 >npm.log 2>&1; then
  echo "skipped: npm cannot install @mcap/core, @foxglove/schemas and fzstd:"
  tail -n 3 npm.log
  exit 77
fi
for scenario in three_routes_c stairs; do
  "$program" plan "$source/experiments/scenarios/$scenario.yaml" --out "$scenario" --seed 3 >plan.log
  "$program" export "$scenario" --mcap "$scenario.mcap"
  node read_recording.mjs "$scenario.mcap" "$scenario/plan.json"
done
# A reader that checks CRCs must notice a changed byte.
printf 'x' | dd of=stairs.mcap bs=1 seek=20000 conv=notrunc 2>dd.log
if node read_recording.mjs stairs.mcap stairs/plan.json >spoilt.log 2>&1; then
  echo "a spoilt recording was accepted"
  exit 1
fi
