"""Optimal-control problems stated in Python, solved by the collocation of C++."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _possibility as _ext
from .expressions import Expression, Leaf, Tape, as_expression, evaluate

Bounds = Union[None, float, Tuple[Optional[float], Optional[float]], Sequence[Optional[float]]]
Guess = Union[float, Sequence[float], np.ndarray, Callable[[float], float]]
_GUESS_POINTS = 201


class SolveError(RuntimeError):
    """A problem was not solved. `solution` is what the solver ended with."""

    def __init__(self, message: str, solution: "Solution"):
        super().__init__(message)
        self.solution = solution


def _interval(bounds: Bounds, name: str) -> Tuple[float, float]:
    """None: no bounds; a number: equal to it; a pair, in which None is no bound."""
    if bounds is None:
        return (-np.inf, np.inf)
    if np.isscalar(bounds):
        return (float(bounds), float(bounds))  # type: ignore[arg-type]
    pair = list(bounds)  # type: ignore[arg-type]
    if len(pair) != 2:
        raise ValueError(f"{name}: expected bounds (lower, upper), got {bounds!r}")
    lower, upper = pair
    return (-np.inf if lower is None else float(lower), np.inf if upper is None else float(upper))


def _expressions(value: Any) -> List[Expression]:
    if isinstance(value, (list, tuple)):
        return [each for part in value for each in _expressions(part)]
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return [as_expression(each) for each in value.ravel()]
    return [as_expression(value)]


def _intervals(bounds: Any, count: int, name: str) -> List[Tuple[float, float]]:
    """One pair for all, or a list with one entry for each."""
    if isinstance(bounds, list) and len(bounds) == count and count > 1:
        return [_interval(each, name) for each in bounds]
    return [_interval(bounds, name)] * count


def _instantaneous(value: Any, name: str) -> Tape:
    tape = Tape(_expressions(value))
    for leaf in tape.leaves:
        if leaf.share is not None:
            raise ValueError(f"{name}: {leaf!r} is fixed in time, expected quantities of every "
                             "instant")
    return _with_argument(tape, name)


def _with_argument(tape: Tape, name: str) -> Tape:
    if not tape.leaves:
        raise ValueError(f"{name}: depends on no quantity of the problem")
    return tape


def _leaf(value: Any, name: str) -> Leaf:
    if isinstance(value, Leaf) and value.share is None:
        return value
    raise TypeError(f"{name}: expected a quantity of the problem, got {value!r}")


class ProblemPhase:
    """A time interval with one system."""

    def __init__(self, problem: "Problem", index: int, name: str, order: int):
        self._problem = problem
        self._raw = problem._raw
        self._index = index
        self._order = order
        self._functions = 0
        self.name = name
        self.coordinates: List[Coordinate] = []
        self.duration = Leaf(self._raw.duration(index), f"{name} duration")
        self.time = Leaf(self._raw.time(index), f"{name} time")
        self.share = Leaf(self._raw.share(index), f"{name} share")
        self.variables: Dict[str, Leaf] = {}
        """Coordinates and controls by name."""

    def coordinate(self, name: str, bounds: Bounds = None, *, scale: Optional[float] = None,
                   order: Optional[int] = None) -> "Coordinate":
        """A coordinate with its derivatives up to its order (None: the phase's)."""
        self._require_new(name)
        order = self._order if order is None else order
        variable = self._raw.add_coordinate(self._index, order, name, _interval(bounds, name),
                                            scale)
        return self._own(Coordinate(self, variable, name))

    def _own(self, coordinate: "Coordinate") -> "Coordinate":
        self.coordinates.append(coordinate)
        self.variables[coordinate.name] = coordinate
        return coordinate

    def control(self, name: str, bounds: Bounds = None, *, scale: Optional[float] = None) -> Leaf:
        self._require_new(name)
        leaf = Leaf(self._raw.add_control(self._index, name, _interval(bounds, name), scale), name)
        self.variables[name] = leaf
        return leaf

    def _require_new(self, name: str) -> None:
        if name in self.variables:
            raise ValueError(f"{self.name}: '{name}' exists")

    def set_duration(self, bounds: Bounds) -> None:
        """s: a number, or (lower, upper) for a free duration."""
        self._raw.set_duration(self._index, _interval(bounds, "duration"))

    def dynamics(self, derivatives: Union[Mapping[Any, Any], Any]) -> None:
        """The highest derivative of every coordinate: a dict by coordinate, or a list in the order
        in which they were added."""
        if isinstance(derivatives, Mapping):
            by_key = {_leaf(each, "dynamics").key: f for each, f in derivatives.items()}
            known = {coordinate.key for coordinate in self.coordinates}
            if set(by_key) != known:
                raise ValueError("dynamics: expected one entry for each of "
                                 + ", ".join(each.name for each in self.coordinates))
            derivatives = [by_key[coordinate.key] for coordinate in self.coordinates]
        tape = _instantaneous(derivatives, "dynamics")
        self._raw.set_dynamics(self._index, tape.tape, [leaf.variable for leaf in tape.leaves])

    def fix(self, quantity: Leaf, value: float, at: str) -> None:
        """Fixes a quantity at the 'start' or the 'end'."""
        self.bound(quantity, (value, value), at)

    def bound(self, quantity: Leaf, bounds: Bounds, at: str = "everywhere") -> None:
        """Bounds a quantity everywhere, at start, end, after_start, before_end or inside."""
        leaf = _leaf(quantity, "bound")
        self._raw.bound(self._index, leaf.variable, _interval(bounds, leaf.name), at)

    def scale(self, quantity: Leaf, scale: float) -> None:
        """The quantity's typical size."""
        self._raw.set_scale(self._index, _leaf(quantity, "scale").variable, scale)

    def constrain(self, expression: Any, bounds: Bounds, *, at: str = "everywhere",
                  name: Optional[str] = None, scale: float = 1) -> None:
        """Bounds an expression, or a list of them."""
        name = name or self._next_name("constraint")
        tape = _instantaneous(expression, name)
        intervals = _intervals(bounds, len(_expressions(expression)), name)
        self._raw.constrain(self._index, name, tape.tape, [leaf.variable for leaf in tape.leaves],
                            intervals, at, [scale])

    def integral_cost(self, expression: Any, *, weight: float = 1,
                      name: Optional[str] = None) -> None:
        """Adds weight times the time integral of the expression to the cost."""
        name = name or self._next_name("integral cost")
        tape = _instantaneous(expression, name)
        self._raw.add_integral_cost(self._index, name, tape.tape,
                                    [leaf.variable for leaf in tape.leaves], weight)

    def integral_bound(self, expression: Any, bounds: Bounds, *,
                       name: Optional[str] = None) -> None:
        """Bounds the time integral of the expression."""
        name = name or self._next_name("integral bound")
        tape = _instantaneous(expression, name)
        self._raw.constrain_integral(self._index, name, tape.tape,
                                     [leaf.variable for leaf in tape.leaves],
                                     _interval(bounds, name))

    def rate_cost(self, control: Leaf, *, weight: float = 1) -> None:
        """Adds weight times the time integral of the control's squared rate to the cost."""
        self._raw.add_rate_cost(self._index, _leaf(control, "rate_cost").variable, weight)

    def rate_bound(self, control: Leaf, bounds: Bounds) -> None:
        """Bounds the control's rate, per second."""
        self._raw.bound_rate(self._index, _leaf(control, "rate_bound").variable,
                             _interval(bounds, "rate_bound"))

    def guess(self, quantity: Leaf, value: Guess) -> None:
        """Where the solver starts: a number, values spread evenly over the duration, or a function
        of the share of the duration, 0 to 1."""
        if callable(value):
            values = [float(value(share)) for share in np.linspace(0, 1, _GUESS_POINTS)]
        else:
            values = [float(each) for each in np.atleast_1d(np.asarray(value, dtype=float))]
        if not np.all(np.isfinite(values)):
            raise ValueError(f"guess: expected finite numbers for {quantity!r}")
        self._raw.guess(self._index, _leaf(quantity, "guess").variable, values)

    def _next_name(self, kind: str) -> str:
        self._functions += 1
        return f"{kind} {self._functions}"


class Coordinate(Leaf):
    """A coordinate of a phase, or one of its derivatives."""

    __slots__ = ("_phase",)

    def __init__(self, phase: ProblemPhase, variable: _ext.Variable, name: str):
        super().__init__(variable, name)
        self._phase = phase

    @property
    def rate(self) -> "Coordinate":
        """Its time derivative."""
        variable = self._phase._raw.rate(self._phase._index, self.variable)
        return Coordinate(self._phase, variable, self.name + "'")


class Problem:
    """An optimal-control problem of one or more phases."""

    def __init__(self, name: str = "problem"):
        self.name = name
        self.phases: List[ProblemPhase] = []
        self._raw = _ext.Problem(name)
        self._functions = 0
        self._defaults: Dict[str, Any] = {}
        self.source = ""
        """Of a named problem: where it and its optimum are published."""
        self.optima: Dict[str, float] = {}
        """Of a named problem: the published optima by name."""

    def phase(self, name: str = "motion", *, order: int = 1,
              duration: Bounds = None) -> ProblemPhase:
        """Adds a phase. order 1: x' = f; order 2: x'' = f. duration: s, a number or bounds."""
        phase = ProblemPhase(self, self._raw.add_phase(name, order), name, order)
        self.phases.append(phase)
        if duration is not None:
            phase.set_duration(duration)
        return phase

    def parameter(self, name: str, bounds: Bounds = None, *, scale: Optional[float] = None,
                  guess: float = 0) -> Leaf:
        """A number that is the same in the whole problem."""
        return Leaf(self._raw.add_parameter(name, _interval(bounds, name), scale, guess), name)

    def cost(self, expression: Any, *, weight: float = 1, name: Optional[str] = None) -> None:
        """Adds weight times an expression of quantities at instants, x.at('end'), of durations and
        of parameters."""
        name = name or self._next_name("cost")
        tape = self._at_instants(expression, name)
        self._raw.add_cost(name, tape.tape, [(leaf.variable, leaf.share) for leaf in tape.leaves],
                           weight)

    def link(self, expression: Any, bounds: Bounds = 0.0, *, name: Optional[str] = None) -> None:
        """Bounds an expression of quantities at instants of any phases."""
        name = name or self._next_name("link")
        tape = self._at_instants(expression, name)
        self._raw.link(name, tape.tape, [(leaf.variable, leaf.share) for leaf in tape.leaves],
                       _intervals(bounds, len(_expressions(expression)), name))

    def join(self, before: Leaf, after: Leaf) -> None:
        """Makes a quantity at the end of its phase and one at the start of a later phase equal."""
        self._raw.join(_leaf(before, "join").variable, _leaf(after, "join").variable)

    def solve(self, *, intervals: Union[None, int, Sequence[int]] = None,
              scheme: Optional[str] = None, nodes: int = 4, mesh_tolerance: Optional[float] = None,
              jump_tolerance: float = 0, tolerance: float = 1e-8, max_iterations: int = 1000,
              time_limit: float = 0, check_derivatives: bool = False,
              second_order_check: bool = False, coarse_first: bool = True) -> "Solution":
        """Solves the problem. Raises SolveError if it is not solved. Ctrl-C ends it.

        intervals: of the first mesh, for all phases or for each. scheme: trapezoidal,
        hermite_simpson, hermite_simpson_compressed, gauss_lobatto, legendre_gauss or flipped_radau,
        of `nodes` nodes where it needs them. mesh_tolerance: the mesh is refined until the error
        between its points is below; 0: never. time_limit: s; 0: none. coarse_first: large problems
        are first solved on every fifth knot. docs/collocation.md tells more.
        """
        chosen = {"intervals": intervals, "scheme": scheme, "mesh_tolerance": mesh_tolerance}
        options = {"intervals": 20, "scheme": "hermite_simpson", "mesh_tolerance": 0.0,
                   **self._defaults,
                   **{key: value for key, value in chosen.items() if value is not None}}
        counts = options["intervals"]
        options.update(intervals=[counts] if isinstance(counts, int) else list(counts),
                       nodes=nodes, jump_tolerance=jump_tolerance, tolerance=tolerance,
                       max_iterations=max_iterations, time_limit=time_limit,
                       check_derivatives=check_derivatives,
                       second_order_check=second_order_check, coarse_first=coarse_first)
        solution = Solution(self, _ext.solve(self._raw, options))
        if not solution.succeeded:
            conflict = "; ".join(solution.conflict)
            raise SolveError(f"{self.name}: {solution.status}: {solution.message}"
                             + (f" (in conflict: {conflict})" if conflict else ""), solution)
        return solution

    def _at_instants(self, expression: Any, name: str) -> Tape:
        tape = Tape(_expressions(expression))
        for leaf in tape.leaves:
            kind = leaf.variable.key[0]
            if leaf.share is None and kind not in (_PARAMETER, _DURATION):
                raise ValueError(f"{name}: {leaf!r} needs an instant, expected for instance "
                                 f"{leaf!r}.at('end')")
        return _with_argument(tape, name)

    def _next_name(self, kind: str) -> str:
        self._functions += 1
        return f"{kind} {self._functions}"


# Of VariableKind in C++.
_PARAMETER, _DURATION = 2, 3


class Solution:
    """A motion. `solution(x, t)` is the value of an expression at times, s."""

    def __init__(self, problem: Problem, data: _ext.SolutionData):
        self._problem = problem
        self._data = data
        self._times = [data.times(phase) for phase in range(data.num_phases)]

    @property
    def objective(self) -> float:
        return self._data.objective

    @property
    def succeeded(self) -> bool:
        return self._data.succeeded

    @property
    def status(self) -> str:
        """solved, acceptable, infeasible, unbounded, iteration_limit, time_limit, ..."""
        return self._data.status

    @property
    def message(self) -> str:
        return self._data.message

    @property
    def iterations(self) -> int:
        return self._data.iterations

    @property
    def seconds(self) -> float:
        """Time in the solver, s."""
        return self._data.seconds

    @property
    def mesh_error(self) -> float:
        """The greatest error between the points of the mesh."""
        return self._data.mesh_error

    @property
    def refinements(self) -> int:
        return self._data.refinements

    @property
    def conflict(self) -> List[str]:
        """Of an infeasible problem: what cannot hold together, the heaviest first."""
        return self._data.conflict

    @property
    def t(self) -> np.ndarray:
        """The times of the points of the mesh, s; those of all phases, one after the other."""
        return np.concatenate(self._times) if self._times else np.zeros(0)

    def times(self, phase: ProblemPhase) -> np.ndarray:
        """The times of the points of the mesh in a phase, s."""
        return self._times[phase._index]

    def __call__(self, expression: Any, t: Any = None) -> Any:
        """An expression's value at times, s. None: at the points of the mesh of its phase."""
        if t is None:
            t = self._own_times(as_expression(expression))
        times = np.asarray(t, dtype=float)
        flat = np.atleast_1d(times).ravel()

        def value_of(leaf: Leaf) -> np.ndarray:
            if leaf.share is None:
                return self._data.values(leaf.variable, flat)
            phase = self._times[leaf.variable.key[1]]
            instant = phase[0] + leaf.share * (phase[-1] - phase[0])
            return self._data.values(leaf.variable, np.array([instant]))

        values = np.broadcast_to(evaluate(expression, value_of), flat.shape)
        return float(values[0]) if times.ndim == 0 else values.reshape(times.shape)

    def _own_times(self, expression: Expression) -> Any:
        phases = {leaf.variable.key[1] for leaf in Tape([expression]).leaves} - {-1}
        if len(phases) > 1:
            raise ValueError("the expression has quantities of several phases, expected times")
        return self._times[phases.pop()] if phases else 0.0

    def __repr__(self) -> str:
        return f"<Solution {self.status}: {self.objective:.9g} in {self.iterations} iterations>"


def named_problems() -> Dict[str, str]:
    """The problems that C++ states, by name, each with the source of its published optimum."""
    return {problem.name: problem.source for problem in _ext.named_problems()}


def named_problem(name: str) -> Problem:
    """A problem that C++ states; its phases' quantities are in `phases[i].variables`."""
    for given in _ext.named_problems():
        if given.name == name:
            return _from_named(given)
    raise _ext.InputError(f"named_problem: no problem '{name}', expected one of "
                          + ", ".join(named_problems()))


def _from_named(given: _ext.NamedProblem) -> Problem:
    problem = Problem(given.name)
    problem._raw = given.build()
    for index, (name, order, quantities) in enumerate(problem._raw.outline()):
        phase = ProblemPhase(problem, index, name, order)
        for quantity, variable in quantities:
            if variable.key[0] == 0:
                phase._own(Coordinate(phase, variable, quantity))
            else:
                phase.variables[quantity] = Leaf(variable, quantity)
        problem.phases.append(phase)
    problem.source, problem.optima = given.source, dict(given.optima)
    problem._defaults = {"intervals": given.intervals, "mesh_tolerance": given.mesh_tolerance,
                         "scheme": given.scheme}
    return problem
