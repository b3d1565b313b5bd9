"""Measures what planning from Python costs beside the program: processor time of each, in pairs,
or, where the machine is too busy for that, the instructions that Valgrind counts (minutes).

    PYTHONPATH=build/release/python python3 tests/python/overhead.py PROGRAM SCENARIO [PAIRS]
    PYTHONPATH=build/release/python python3 tests/python/overhead.py PROGRAM SCENARIO instructions
"""

import os
import re
import statistics
import subprocess
import sys
import tempfile

CHILD = """
import sys
import possibility
plan = possibility.plan(sys.argv[1], seed=1, threads=1).plan
plan.save(sys.argv[2])
plan.view(sys.argv[2] + "/plan.html")
"""
EMPTY = "import numpy"


def seconds(command):
    """Processor time of a process."""
    before = os.times()
    subprocess.run(command, check=True, capture_output=True)
    after = os.times()
    return (after.children_user + after.children_system
            - before.children_user - before.children_system)


def instructions(command):
    """Number of instructions of a process, the same whatever else the machine does."""
    valgrind = ["valgrind", "--tool=cachegrind", "--cache-sim=no",
                "--cachegrind-out-file=/dev/null"]
    run = subprocess.run(valgrind + command, check=True, capture_output=True, text=True)
    return int(re.search(r"I +refs: +([\d,]+)", run.stderr).group(1).replace(",", ""))


def both(program, scenario, out):
    """The commands of a pair: by the program, and from Python."""
    return [[program, "plan", scenario, "--seed", "1", "--threads", "1", "--out", out],
            [sys.executable, "-c", CHILD, scenario, out]]


def compare_instructions(program, scenario):
    with tempfile.TemporaryDirectory() as out:
        theirs, ours = [instructions(command) for command in both(program, scenario, out)]
    alone = instructions([sys.executable, "-c", EMPTY])
    print(f"program {theirs:,} instructions, Python {ours:,}, Python and NumPy alone {alone:,}: "
          f"{100 * ((ours - alone) / theirs - 1):+.2f} % without these")


def compare_times(program, scenario, pairs):
    ours, theirs, imports = [], [], []
    with tempfile.TemporaryDirectory() as out:
        commands = both(program, scenario, out)
        for i in range(pairs):
            times = {}
            for j in (i % 2, 1 - i % 2):
                times[j] = seconds(commands[j])
            imports.append(seconds([sys.executable, "-c", EMPTY]))
            theirs.append(times[0])
            ours.append(times[1])
            print(f"program {times[0]:.2f} s, Python {times[1]:.2f} s, of which Python and NumPy "
                  f"alone {imports[-1]:.2f} s", flush=True)
    # Whatever else runs on the machine only adds.
    alone = min(imports)
    for name, of in (("least", min), ("median", statistics.median)):
        share = (of(ours) - alone) / of(theirs) - 1
        print(f"{name} of {len(ours)}: {100 * share:+.1f} % without {alone:.2f} s of Python and "
              "NumPy")


def main(program, scenario, how="7"):
    if how == "instructions":
        compare_instructions(program, scenario)
    else:
        compare_times(program, scenario, int(how))


main(*sys.argv[1:])
