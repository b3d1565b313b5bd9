"""Planning, verification and simulation."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Union

from . import _possibility as _ext
from ._files import temporary_scenario, without_file
from .plans import PathLike, Plan

Progress = Callable[[Dict[str, Any]], None]
_MOST_THREADS = 256


def load_robot(path: PathLike) -> _ext.Robot:
    """Reads a robot YAML and the URDF that it names."""
    return _ext.load_robot(os.fspath(path))


def load_scenario(path: PathLike) -> _ext.Scenario:
    """Reads a scenario YAML."""
    return _ext.load_scenario(os.fspath(path))


def scenario(description: Mapping[str, Any], folder: PathLike = ".") -> _ext.Scenario:
    """A scenario from a dict with the keys of the YAML (docs/file_formats.md).

    Relative paths in it start from `folder`.
    """
    file = temporary_scenario(description, Path(folder))
    try:
        return _ext.load_scenario(str(file))
    except _ext.InputError as error:
        raise _ext.InputError(without_file(str(error), file)) from None


class Verification:
    """The verifier's report. True in a condition if the plan is accepted."""

    def __init__(self, report: Dict[str, Any]):
        self.report = report
        """All of it (docs/verification.md)."""

    @property
    def accepted(self) -> bool:
        return bool(self.report["accepted"])

    @property
    def violations(self) -> List[Dict[str, Any]]:
        """The worst of each kind."""
        return self.report["violations"]

    @property
    def margins(self) -> Optional[Dict[str, Dict[str, Any]]]:
        return self.report.get("margins")

    def __bool__(self) -> bool:
        return self.accepted

    def __repr__(self) -> str:
        if self.accepted:
            return "<Verification: accepted>"
        return f"<Verification: rejected, {self.violations[0]['kind']}>"


class Rollout:
    """A simulation under one perturbation. True in a condition if the robot survives."""

    def __init__(self, perturbation: Dict[str, float], stretches: List[Dict[str, Any]]):
        self.perturbation = perturbation
        self.stretches = stretches
        """One entry for each part of the plan that is simulated (docs/rollouts.md)."""

    @property
    def survives(self) -> bool:
        return all(stretch["survives"] for stretch in self.stretches)

    def __bool__(self) -> bool:
        return self.survives

    def __repr__(self) -> str:
        named = ", ".join(f"{k}={v:g}" for k, v in self.perturbation.items()) or "as planned"
        return f"<Rollout {named}: {'survives' if self.survives else 'fails'}>"


class PlanResult:
    """What `plan` found."""

    def __init__(self, status: str, explanation: str, plan: Plan, verification: Verification):
        self.status = status
        """found, proven_infeasible, exhausted or time_limit."""
        self.explanation = explanation
        self.plan = plan
        """The plan; without segments unless it was found."""
        self.verification = verification
        """The verifier's report on it; meaningless unless it was found."""

    @property
    def found(self) -> bool:
        """Whether there is a plan, which has been verified."""
        return self.status == "found"

    @property
    def timings(self) -> Dict[str, float]:
        return self.plan.timings

    @property
    def statistics(self) -> Dict[str, int]:
        return self.plan.statistics

    def __bool__(self) -> bool:
        return self.found

    def __repr__(self) -> str:
        return f"<PlanResult {self.status}: {self.plan!r}>"

    def _repr_html_(self) -> str:
        return self.plan._repr_html_()


def _threads(threads: Optional[int]) -> int:
    if threads is None:
        return min(os.cpu_count() or 1, _MOST_THREADS)
    if not isinstance(threads, int) or not 1 <= threads <= _MOST_THREADS:
        raise _ext.InputError(f"threads: expected a number from 1 to {_MOST_THREADS}, "
                              f"got {threads!r}")
    return threads


def _require_allowed(actions: Sequence[str], allowed: Sequence[str]) -> List[str]:
    if isinstance(actions, str):
        actions = actions.split(",")
    for action in actions:
        if action not in allowed:
            raise _ext.InputError(f"actions: '{action}' is not among the scenario's, expected some "
                                  f"of {', '.join(allowed)}")
    return list(actions)


def plan(scenario: Union[_ext.Scenario, Mapping[str, Any], PathLike], *,
         seed: Optional[int] = None, threads: Optional[int] = None,
         time_limit: Optional[float] = None, actions: Sequence[str] = (),
         preset: str = "default", library: PathLike = "",
         progress: Optional[Progress] = None) -> PlanResult:
    """Plans, generates the motion and verifies it, as `possibility plan` does.

    scenario: one that was loaded or built, a dict, or a path. seed, time_limit: None: the
    scenario's. threads: None: all of the machine. actions: of the scenario's only these. library:
    folder of solved jumps; empty: jumps, beside the robot. progress: called about ten times a
    second with a dict; what it raises ends the planning.

    Other Python threads run meanwhile. Ctrl-C ends it.
    """
    chosen = _scenario_of(scenario)
    seed = chosen.seed if seed is None else seed
    if not isinstance(seed, int) or not 0 <= seed < 2**63:
        raise _ext.InputError(f"seed: expected a whole number of at least 0, got {seed!r}")
    limit = chosen.time_limit if time_limit is None else float(time_limit)
    if not 0 < limit < float("inf"):
        raise _ext.InputError(f"time_limit: expected a time above 0 s, got {limit}")
    folder = os.fspath(library)
    if folder and not os.path.isdir(folder):
        raise _ext.InputError(f"library: '{folder}' is not a folder")
    status, explanation, data, report = _ext.plan(
        chosen, seed, _threads(threads), limit, _require_allowed(actions, chosen.actions), preset,
        folder, progress)
    return PlanResult(status, explanation, Plan(data), Verification(json.loads(report)))


def _scenario_of(given: Union[_ext.Scenario, Mapping[str, Any], PathLike]) -> _ext.Scenario:
    if isinstance(given, _ext.Scenario):
        return given
    return scenario(given) if isinstance(given, Mapping) else load_scenario(given)


def verify(plan: Plan, *, threads: Optional[int] = None, simulate: bool = True) -> Verification:
    """Checks a plan from first principles, as `possibility verify` does. Ctrl-C ends it.

    simulate: also simulates dynamic motions, which takes seconds for each.
    """
    return Verification(json.loads(_ext.verify(plan._data, _threads(threads), simulate)))


def margins(plan: Plan, *, threads: Optional[int] = None) -> Dict[str, Dict[str, Any]]:
    """How near the plan comes to its limits: for each kind value, segment and t.

    Raises InputError if the plan is too broken to be measured.
    """
    verification = verify(plan, threads=threads, simulate=False)
    if verification.margins is None:
        raise _ext.InputError(f"margins: the plan has none: "
                              f"{verification.violations[0]['quantity']}")
    return verification.margins


def rollout(plan: Plan, *, threads: Optional[int] = None, **perturbation: float) -> Rollout:
    """Simulates a plan on a perturbed robot and ground, as `possibility rollout` does.

    Perturbations: mass, slope_deg, side_slope_deg, torque, armature, friction, push_ns,
    push_direction_deg, push_share (docs/rollouts.md). None: as planned. Ctrl-C ends it.
    """
    text = ",".join(f"{name}={value!r}" for name, value in perturbation.items())
    try:
        stretches = _ext.rollout(plan._data, text, _threads(threads))
    except _ext.InputError as error:
        raise _ext.InputError(str(error).replace("--perturb: ", "rollout: ", 1)) from None
    return Rollout(dict(perturbation), stretches)
