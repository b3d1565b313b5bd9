"""Optimal-control problems stated in Python, against published optima and closed forms."""

import numpy as np
import possibility
import pytest
from conftest import one_line


def block_move(bounds=(-20, 20), effort=True):
    problem = possibility.Problem("block move")
    move = problem.phase("move", order=2, duration=1)
    x, force = move.coordinate("x"), move.control("force", bounds)
    move.dynamics({x: force})
    for end in ("start", "end"):
        move.fix(x.rate, 0, end)
    move.fix(x, 0, "start")
    move.fix(x, 1, "end")
    if effort:
        move.integral_cost(force * force)
    return problem, x, force


def test_the_block_move_has_its_closed_form():
    problem, x, force = block_move()
    solution = problem.solve(second_order_check=True, check_derivatives=True)
    assert solution.status == "solved"
    assert solution.objective == pytest.approx(12, rel=1e-7)
    t = np.linspace(0, 1, 7)
    assert np.allclose(solution(x, t), 3 * t**2 - 2 * t**3, atol=1e-6)
    assert np.allclose(solution(force, t), 6 - 12 * t, atol=1e-5)
    assert np.allclose(solution(x.rate.rate - force, t), 0, atol=1e-6)


def test_values_at_the_mesh_and_at_one_time():
    problem, x, _ = block_move()
    solution = problem.solve(intervals=10)
    assert solution.t.shape == (21,) and solution.t[-1] == 1
    assert solution(x).shape == (21,)
    assert solution(x, 0.5) == pytest.approx(0.5)
    assert solution(x**2 + x.at("end")).shape == (21,)


@pytest.mark.parametrize("name, tolerance", [
    ("block_move", 1e-6), ("van_der_pol", 1e-6), ("brachistochrone", 1e-6), ("kirk", 1e-6),
    ("goddard", 1e-3), ("sliding_mass", 1e-3)])
def test_named_problems_reach_their_published_optima(name, tolerance):
    problem = possibility.named_problem(name)
    assert problem.source
    solution = problem.solve()
    assert any(solution.objective == pytest.approx(optimum, rel=tolerance)
               for optimum in problem.optima.values())


def test_named_problems_have_named_quantities():
    problem = possibility.named_problem("brachistochrone")
    solution = problem.solve()
    y = problem.phases[0].variables["y"]
    assert solution(y)[0] == pytest.approx(10) and solution(y)[-1] == pytest.approx(5)


def test_an_unknown_named_problem_is_refused():
    with pytest.raises(possibility.InputError, match="van_der_pol"):
        possibility.named_problem("van_der_pole")
    assert len(possibility.named_problems()) > 30


def test_the_same_problem_from_python_and_from_c_takes_the_same_iterations():
    """Tapes have the derivatives and the masks of the compiled functions."""
    problem = possibility.Problem("van der Pol")
    phase = problem.phase("settle", order=2, duration=5)
    x, u = phase.coordinate("x"), phase.control("u", (-0.3, 1))
    phase.dynamics([(1 - x * x) * x.rate - x + u])
    phase.fix(x, 1, "start")
    phase.fix(x.rate, 0, "start")
    phase.integral_cost(x * x + x.rate * x.rate + u * u, name="squares")
    ours = problem.solve(intervals=320)
    theirs = possibility.named_problem("van_der_pol").solve()
    assert ours.iterations == theirs.iterations
    assert ours.objective == pytest.approx(theirs.objective, rel=1e-10)


def test_least_time_with_a_free_duration():
    problem = possibility.Problem("rest to rest")
    phase = problem.phase("push", order=2, duration=(0.1, 10))
    x, u = phase.coordinate("x"), phase.control("u", (-1, 1))
    phase.dynamics([u])
    phase.fix(x, 0, "start")
    phase.fix(x, 1, "end")
    phase.fix(x.rate, 0, "start")
    phase.fix(x.rate, 0, "end")
    problem.cost(phase.duration)
    solution = problem.solve(scheme="trapezoidal", intervals=20, jump_tolerance=1e-3)
    assert solution.objective == pytest.approx(2, rel=1e-5)
    assert solution(phase.duration) == pytest.approx(solution.objective)


def test_two_phases_are_joined():
    """A ball thrown up: push with 30 N over 0.3 m, then rise: height 0.3 (F/(m g) - 1)."""
    gravity = 10
    problem = possibility.Problem("throw")
    push = problem.phase("push", order=2, duration=(0.05, 1))
    y, force = push.coordinate("y", (0, None)), push.control("force", (0, 30))
    push.dynamics([force - gravity])
    push.fix(y, 0, "start")
    push.fix(y.rate, 0, "start")
    push.fix(y, 0.3, "end")
    rise = problem.phase("rise", order=2, duration=(0.05, 1))
    h = rise.coordinate("h")
    rise.dynamics([-gravity + 0 * h])
    rise.fix(h.rate, 0, "end")
    problem.join(y, h)
    problem.join(y.rate, h.rate)
    problem.cost(-h.at("end"))
    solution = problem.solve(scheme="trapezoidal")
    assert -solution.objective == pytest.approx(0.9, rel=1e-5)
    assert solution.times(rise)[0] == pytest.approx(solution.times(push)[-1])


def test_parameters_constraints_and_links():
    """A chord: the least p with p >= 1 - t and p >= t at all times is 1."""
    problem = possibility.Problem("parameter")
    phase = problem.phase("watch", duration=1)
    x = phase.coordinate("x")
    p = problem.parameter("p", (0, 5), guess=2)
    phase.dynamics([1 + 0 * x])
    problem.link(x.at("start"), 0)
    phase.constrain([p - x, p + x - 1], [(0, None), (0, None)])
    problem.cost(p)
    solution = problem.solve()
    assert solution(p) == pytest.approx(1, abs=1e-6)


def test_gates_at_a_share_of_the_duration():
    problem, x, _ = block_move()
    problem.link(x.at(0.25), 0.4)
    solution = problem.solve()
    assert solution(x, 0.25) == pytest.approx(0.4, abs=1e-8)
    assert solution.objective > 12.5


def test_an_integral_is_bounded():
    """x leads its mean by 0.05; the effort grows by what the closed form of a detour costs."""
    problem, x, _ = block_move()
    problem.phases[0].integral_bound(x, (0.55, None))
    solution = problem.solve()
    t = np.linspace(0, 1, 2001)
    assert np.trapz(solution(x, t), t) == pytest.approx(0.55, abs=1e-6)
    # Least effort of a detour d with d = d' = 0 at both ends and an area A: 720 A^2.
    assert solution.objective == pytest.approx(12 + 720 * 0.05**2, rel=1e-6)


def test_rates_of_controls_are_bounded_and_cost():
    """Closed forms of docs/collocation.md."""
    problem, _, force = block_move(effort=False)
    problem.phases[0].rate_cost(force)
    assert problem.solve().objective == pytest.approx(120, rel=1e-5)
    problem, _, force = block_move()
    problem.phases[0].rate_bound(force, (-12, 12))
    solution = problem.solve()
    assert solution.objective == pytest.approx(12, rel=1e-6)
    with pytest.raises(possibility.SolveError, match="infeasible"):
        problem.phases[0].rate_bound(force, (-8, 8))
        problem.solve()


def test_guesses_are_numbers_lists_or_functions():
    for guess in (0.5, [0, 0.2, 1], np.linspace(0, 1, 50), lambda share: share):
        problem, x, _ = block_move()
        problem.phases[0].guess(x, guess)
        assert problem.solve().objective == pytest.approx(12, rel=1e-7)


@pytest.mark.parametrize("scheme", ["trapezoidal", "hermite_simpson", "hermite_simpson_compressed",
                                    "gauss_lobatto", "legendre_gauss", "flipped_radau"])
def test_every_scheme_solves(scheme):
    problem, _, _ = block_move()
    assert problem.solve(scheme=scheme, intervals=40).objective == pytest.approx(12, rel=1e-2)


def test_an_infeasible_problem_names_the_conflict():
    problem, _, _ = block_move(bounds=(-3, 3))
    with pytest.raises(possibility.SolveError) as error:
        problem.solve()
    assert "infeasible" in one_line(error) and "force is at most 3" in one_line(error)
    assert error.value.solution.conflict


def test_an_iteration_limit_is_reported():
    problem, _, _ = block_move(bounds=(-6.5, 6.5))
    with pytest.raises(possibility.SolveError, match="iteration_limit"):
        problem.solve(max_iterations=1)


def test_a_function_that_is_not_finite_is_named():
    problem, x, _ = block_move()
    problem.phases[0].integral_cost(np.log(x - 5), name="logarithm")
    with pytest.raises(possibility.SolveError, match="logarithm"):
        problem.solve()


def phase_with_x():
    problem = possibility.Problem("p")
    phase = problem.phase("motion", duration=1)
    return problem, phase, phase.coordinate("x"), phase.control("u")


@pytest.mark.parametrize("mistake", [
    lambda problem, phase, x, u: problem.cost(x),
    lambda problem, phase, x, u: phase.integral_cost(x.at("end")),
    lambda problem, phase, x, u: phase.integral_cost(3),
    lambda problem, phase, x, u: phase.dynamics({u: x}),
    lambda problem, phase, x, u: phase.dynamics([u, u]),
    lambda problem, phase, x, u: phase.bound(x, (2, 1)),
    lambda problem, phase, x, u: phase.bound(x, (1, 2, 3)),
    lambda problem, phase, x, u: phase.bound(x, (0, 1), at="middle"),
    lambda problem, phase, x, u: phase.coordinate("x"),
    lambda problem, phase, x, u: phase.guess(x, [float("nan")]),
    lambda problem, phase, x, u: phase.guess(x, []),
    lambda problem, phase, x, u: phase.set_duration((0, 1)),
    lambda problem, phase, x, u: problem.phase("other", order=3),
    lambda problem, phase, x, u: problem.solve(),
    lambda problem, phase, x, u: problem.solve(scheme="euler"),
    lambda problem, phase, x, u: phase_with_x()[1].integral_cost(x * u),
])
def test_mistakes_are_value_errors_in_one_line(mistake):
    with pytest.raises(ValueError) as error:
        mistake(*phase_with_x())
    one_line(error)
