#!/bin/sh
# example_project_test.sh CMAKE BUILD_DIR SOURCE_DIR FOLDER PROGRAM COMPILER
# Somebody else's project finds an installed tree, is built against it alone, and plans with it.
set -eu
cmake=$1 build=$2 source=$3 folder=$4 program=$5 compiler=$6
rm -rf "$folder"
mkdir -p "$folder"
"$cmake" --install "$build" --prefix "$folder/installed" >"$folder/install.log"
# A copy: nothing beside the project may help it.
cp -r "$source/docs/example_project" "$folder/project"
"$cmake" -S "$folder/project" -B "$folder/built" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" \
    -DCMAKE_PREFIX_PATH="$folder/installed" >"$folder/configure.log" || {
  cat "$folder/configure.log"
  exit 1
}
"$cmake" --build "$folder/built" >"$folder/build.log" || {
  cat "$folder/build.log"
  exit 1
}
scenarios=$folder/installed/share/possibility/experiments/scenarios
"$folder/built/plan_and_verify" "$scenarios/three_routes_a.yaml" "$folder/plan" >"$folder/said.txt"
grep -q '^drchubo1, [1-9][0-9]* segments, [1-9][0-9.]* s, verified$' "$folder/said.txt" || {
  cat "$folder/said.txt"
  exit 1
}
# The program of the build accepts what the installed libraries planned.
"$program" verify "$folder/plan" >/dev/null

# What is wrong is said in one line, with the program's exit code.
code=0
"$folder/built/plan_and_verify" "$folder/none.yaml" "$folder/plan" 2>"$folder/errors.txt" || code=$?
[ "$code" -eq 1 ] && [ "$(wc -l <"$folder/errors.txt")" -eq 1 ] &&
    grep -q "none.yaml" "$folder/errors.txt" || {
  echo "exit code $code and these words for a file that is missing:"
  cat "$folder/errors.txt"
  exit 1
}
