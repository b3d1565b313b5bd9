"""Measures what planning from Python costs beside the program, in pairs, processor time of each.

    PYTHONPATH=build/release/python python3 tests/python/overhead.py PROGRAM SCENARIO [PAIRS]
"""

import os
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


def main(program, scenario, pairs=7):
    ours, theirs, imports = [], [], []
    with tempfile.TemporaryDirectory() as out:
        for i in range(int(pairs)):
            commands = [[program, "plan", scenario, "--seed", "1", "--threads", "1", "--out", out],
                        [sys.executable, "-c", CHILD, scenario, out]]
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


main(*sys.argv[1:])
