"""possibility: a motion planner for humanoid robots (docs/python.md)."""

import atexit

from . import _possibility, expressions
from ._possibility import InputError, Robot, Scenario
from .expressions import Expression
from .planning import (PlanResult, Rollout, Verification, load_robot, load_scenario, margins, plan,
                       rollout, scenario, verify)
from .plans import Knot, Phase, Plan, Segment, load_plan
from .problems import (Problem, ProblemPhase, Solution, SolveError, named_problem, named_problems)

__all__ = [
    "Expression", "InputError", "Knot", "Phase", "Plan", "PlanResult", "Problem", "ProblemPhase",
    "Robot", "Rollout", "Scenario", "Segment", "Solution", "SolveError", "Verification",
    "expressions", "load_plan", "load_robot", "load_scenario", "margins", "named_problem",
    "named_problems", "plan", "rollout", "scenario", "verify",
]

# Cancelled work still uses the libraries for a moment.
atexit.register(_possibility.await_abandoned_work)
