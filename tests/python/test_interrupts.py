"""Ctrl-C, in processes of their own."""

import os
import signal
import subprocess
import sys
import time

import pytest
from conftest import ROOT

CHILD = """
import sys, time
import possibility
problem = possibility.Problem("long")
phase = problem.phase("p", duration=1)
x, u = phase.coordinate("x"), phase.control("u")
phase.dynamics([u - 3 * x**3])
phase.integral_cost(u**2 + x**4)
phase.fix(x, 1, "start")
work = {
    "plan": lambda: possibility.plan(sys.argv[2], threads=1),
    "plan_threads": lambda: possibility.plan(sys.argv[2], threads=3),
    "solve": lambda: problem.solve(intervals=20000, max_iterations=100000, tolerance=1e-15),
}[sys.argv[1]]
print("ready", flush=True)
try:
    while True:  # However quick the machine is, the work is not over when Ctrl-C comes.
        work()
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
"""


@pytest.mark.parametrize("work, delay", [("plan", 0.2), ("plan", 1.5), ("plan_threads", 2.5),
                                         ("solve", 0.5)])
def test_ctrl_c_ends_work_at_once(work, delay):
    scenario = ROOT / "experiments/scenarios/hallway.yaml"
    child = subprocess.Popen([sys.executable, "-c", CHILD, work, str(scenario)],
                             stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    time.sleep(delay)
    sent = time.monotonic()
    os.kill(child.pid, signal.SIGINT)
    word, at = child.stdout.readline().split()
    assert word == "interrupted"
    # docs/python.md has the times; here only that the work itself is not waited for.
    assert float(at) - sent < 2
    assert child.wait(timeout=60) == 0
