"""Plans: their arrays, files, exports and page."""

from __future__ import annotations

import html
import os
import shutil
from functools import cached_property
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np

from . import _possibility as _ext
from ._files import is_temporary

PathLike = Union[str, "os.PathLike[str]"]


class Knot:
    """The robot at one instant. Arrays are read-only views of the plan's memory."""

    def __init__(self, data: _ext.PlanData, place: Tuple[int, int, int]):
        self._data = data
        self._place = place

    def _view(self, name: str) -> np.ndarray:
        return self._data.knot(*self._place, name)

    @property
    def t(self) -> float:
        """s since the start of the plan."""
        return float(self._view("t")[0])

    @property
    def q(self) -> np.ndarray:
        """Root quaternion (w, x, y, z), root position (m), joints (rad or m)."""
        return self._view("q")

    @property
    def v(self) -> np.ndarray:
        """Root angular velocity, root velocity (world), joint rates."""
        return self._view("v")

    @property
    def a(self) -> np.ndarray:
        """The time derivative of v."""
        return self._view("a")

    @property
    def tau(self) -> np.ndarray:
        """Joint torques, N m or N."""
        return self._view("tau")

    @property
    def forces(self) -> np.ndarray:
        """Forces on the robot at the phase's contact points: points x 3, world, N."""
        return self._view("forces").reshape(-1, 3)


class _Stretch:
    """Consecutive knots of a plan, as views of the plan's stacked arrays."""

    _plan: "Plan"
    _knots: slice

    @property
    def t(self) -> np.ndarray:
        """Times of the knots, s."""
        return self._plan._stacked("t")[self._knots]

    @property
    def q(self) -> np.ndarray:
        """Configurations, knots x nq (Knot.q)."""
        return self._plan._stacked("q")[self._knots]

    @property
    def v(self) -> np.ndarray:
        """Velocities, knots x nv (Knot.v)."""
        return self._plan._stacked("v")[self._knots]

    @property
    def a(self) -> np.ndarray:
        """Accelerations, knots x nv (Knot.a)."""
        return self._plan._stacked("a")[self._knots]

    @property
    def tau(self) -> np.ndarray:
        """Joint torques, knots x joints, N m or N."""
        return self._plan._stacked("tau")[self._knots]

    def __len__(self) -> int:
        return self._knots.stop - self._knots.start


class Phase(_Stretch):
    """A stretch of time with one set of contacts."""

    def __init__(self, plan: "Plan", place: Tuple[int, int], knots: slice, numbers: slice,
                 outline: Tuple[List[str], int, int, int]):
        self._plan = plan
        self._place = place
        self._knots = knots
        self._numbers = numbers
        self.contacts: List[str] = outline[0]
        """Patches that bear, with points if only some of them do: "left_sole[0,3]"."""
        self._num_points = outline[2]

    @property
    def forces(self) -> np.ndarray:
        """Forces on the robot: knots x points x 3, world, N. Points in the order of contacts."""
        return self._plan._stacked("forces")[self._numbers].reshape(len(self), -1, 3) \
            if self._num_points else np.zeros((len(self), 0, 3))

    @property
    def impulses(self) -> np.ndarray:
        """Impulses of the impact at the start of the phase: points x 3, N s; empty: no impact."""
        return self._plan._data.impulses(*self._place).reshape(-1, 3)

    @cached_property
    def knots(self) -> List[Knot]:
        return [Knot(self._plan._data, (*self._place, k)) for k in range(len(self))]

    def __repr__(self) -> str:
        contacts = ", ".join(self.contacts) or "flight"
        return f"<Phase {self.t[0]:.3f} to {self.t[-1]:.3f} s: {contacts}>"


class Segment(_Stretch):
    """One executed edge of the route."""

    def __init__(self, plan: "Plan", action: str, vertices: Tuple[int, int], phases: List[Phase]):
        self._plan = plan
        self.action = action
        self.vertices = vertices
        """Start and end in the explored graph; -1: not in the graph."""
        self.phases = phases
        self._knots = slice(phases[0]._knots.start, phases[-1]._knots.stop)

    @property
    def forces(self) -> List[np.ndarray]:
        """Phase.forces of every phase: phases differ in their points."""
        return [phase.forces for phase in self.phases]

    def __repr__(self) -> str:
        return f"<Segment {self.action}: {self.t[0]:.3f} to {self.t[-1]:.3f} s>"


class Plan(_Stretch):
    """A motion from start to goal, or the answer that there is none.

    Knots lie apart in the program's memory. `knots` are views of them without copies. `t`, `q`,
    `v`, `a`, `tau` are stacked once, when first asked for, and kept; those of segments and phases
    are views of these arrays. All are read-only.
    """

    def __init__(self, data: _ext.PlanData):
        self._plan = self
        self._data = data
        self._arrays: Dict[str, np.ndarray] = {}
        self.segments: List[Segment] = []
        knot, number = 0, 0
        for s, (action, start, end, outline) in enumerate(data.outline()):
            phases = []
            for p, phase in enumerate(outline):
                count, points = phase[1], phase[2]
                phases.append(Phase(self, (s, p), slice(knot, knot + count),
                                    slice(number, number + 3 * points * count), phase))
                knot, number = knot + count, number + 3 * points * count
            self.segments.append(Segment(self, action, (start, end), phases))
        self._knots = slice(0, knot)

    def _stacked(self, name: str) -> np.ndarray:
        if name not in self._arrays:
            array = self._data.stacked(name)
            if name not in ("t", "forces"):
                array = array.reshape(len(self), -1 if len(self) else 0)
            self._arrays[name] = array
        return self._arrays[name]

    @property
    def joints(self) -> List[str]:
        """Names, in the order of q[:, 7:], v[:, 6:] and tau."""
        return self._data.joints

    @property
    def duration(self) -> float:
        """s."""
        return self._data.duration

    @property
    def seed(self) -> int:
        return self._data.seed

    @property
    def goal(self) -> int:
        """Index of the goal reached."""
        return self._data.goal

    @property
    def timings(self) -> Dict[str, float]:
        """Where planning spent its time, s."""
        return self._data.timings

    @property
    def statistics(self) -> Dict[str, int]:
        return self._data.statistics

    @cached_property
    def robot(self) -> _ext.Robot:
        return self._data.robot

    @cached_property
    def scenario(self) -> _ext.Scenario:
        return self._data.scenario

    @property
    def is_current(self) -> bool:
        """Whether robot and scenario are byte for byte the ones planned for."""
        return self._data.is_current

    def save(self, path: PathLike) -> Path:
        """Writes plan.json into the folder, or to a file whose name ends in .json, or in .zip for
        format 2: a tenth as large, and exact between knots (docs/file_formats.md).

        A scenario that was built in code is written beside it, as scenario.yaml.
        """
        file = Path(path)
        if file.suffix not in (".json", ".zip"):
            file = file / "plan.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        scenario_file = ""
        if is_temporary(self.scenario.file):
            scenario_file = str(file.parent / "scenario.yaml")
            shutil.copyfile(self.scenario.file, scenario_file)
        self._data.save(str(file), scenario_file)
        return file

    def export(self, *, csv: Optional[PathLike] = None, npz: Optional[PathLike] = None,
               mcap: Optional[PathLike] = None, mujoco: Optional[PathLike] = None,
               sto: Optional[PathLike] = None, period: Optional[float] = None,
               margins: bool = False) -> None:
        """Writes files for other programs (docs/exports.md): csv is a folder, the others are files.

        period: s between samples; None: the knots.
        """
        wanted: Dict[str, Any] = {"csv": csv, "npz": npz, "mcap": mcap, "mujoco": mujoco,
                                  "sto": sto}
        wanted = {kind: path for kind, path in wanted.items() if path is not None}
        if not wanted:
            raise _ext.InputError("export: nothing to write, expected for instance npz='plan.npz'")
        if period is not None and not 0 < period < float("inf"):
            raise _ext.InputError(f"export: period: expected a time above 0 s, got {period}")
        for kind, path in wanted.items():
            _ext.export(self._data, kind, os.fspath(path), period, margins)

    def view(self, path: PathLike = "plan.html") -> Path:
        """Writes one page on which the plan is watched in a browser."""
        _ext.write_page(self._data, os.fspath(path))
        return Path(path)

    def page(self) -> str:
        """The page as text."""
        return _ext.page(self._data)

    def _repr_html_(self) -> str:
        """The page in a frame of its own, for notebooks."""
        return ('<iframe style="width:100%;height:600px;border:0" sandbox="allow-scripts" '
                f'srcdoc="{html.escape(self.page(), quote=True)}"></iframe>')

    def __repr__(self) -> str:
        actions = ", ".join(dict.fromkeys(segment.action for segment in self.segments))
        return (f"<Plan of {self.duration:.2f} s, {len(self.segments)} segments"
                f"{': ' + actions if actions else ''}>")


def load_plan(path: PathLike) -> Plan:
    """Reads a plan file of either format or that of a folder, with the robot and the scenario that it names."""
    return Plan(_ext.load_plan(os.fspath(path)))
