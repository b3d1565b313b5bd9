"""Expressions, their values and their derivatives."""

import numpy as np
import possibility
import pytest
from possibility import expressions
from possibility.expressions import Tape


@pytest.fixture
def quantities():
    phase = possibility.Problem("p").phase("motion", duration=1)
    return [phase.coordinate(name) for name in "abcdefgh"]


POINT = [0.3, 0.7, 0.45, 1.2, 0.9, 0.2, 1.7, 0.6]

FUNCTIONS = [
    lambda x, y: x + y * 2 - 1, lambda x, y: 1 - x * y, lambda x, y: x / y + 2 / x,
    lambda x, y: -x + abs(y), lambda x, y: x**3 - y**0.5, lambda x, y: x**y + 2**x,
    lambda x, y: np.sin(x) * np.cos(y), lambda x, y: np.tan(x + y),
    lambda x, y: np.arcsin(x) + np.arccos(y), lambda x, y: np.arctan(x * y),
    lambda x, y: np.arctan2(x, y), lambda x, y: np.sinh(x) - np.cosh(y) * np.tanh(x),
    lambda x, y: np.exp(x * y) + np.log(x), lambda x, y: np.sqrt(x + y) + np.square(x),
    lambda x, y: np.reciprocal(x) * np.power(y, 2),
    lambda x, y: expressions.smooth_max(x, y, 0.1) - expressions.smooth_min(x, y, 0.2),
]


def differences(f, point, step=1e-5):
    """Central differences of a list of outputs: outputs x inputs."""
    columns = []
    for i in range(len(point)):
        high, low = np.array(point, dtype=float), np.array(point, dtype=float)
        high[i] += step
        low[i] -= step
        columns.append((f(high) - f(low)) / (2 * step))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("f", FUNCTIONS)
def test_values_and_derivatives_of_every_function(quantities, f):
    tape = Tape([f(*quantities[:2])])
    point = [dict(zip("ab", POINT))[leaf.name] for leaf in tape.leaves]
    values, jacobian, hessians = tape.tape.evaluate(point)
    assert values[0] == pytest.approx(f(*POINT[:2]), rel=1e-14)
    assert np.allclose(jacobian, differences(lambda z: tape.tape.evaluate(list(z))[0], point),
                       atol=1e-7)
    assert np.allclose(hessians[0], differences(lambda z: tape.tape.evaluate(list(z))[1][0], point),
                       atol=1e-6)


def test_many_inputs_are_differentiated_in_several_runs(quantities):
    product = np.prod(quantities)
    tape = Tape([product * np.sin(quantities[0]), np.exp(quantities[7] * quantities[2])])
    _, jacobian, hessians = tape.tape.evaluate(POINT)
    assert np.allclose(jacobian, differences(lambda z: tape.tape.evaluate(list(z))[0], POINT),
                       atol=1e-8)
    for i, hessian in enumerate(hessians):
        rows = differences(lambda z: tape.tape.evaluate(list(z))[1][i], POINT)
        assert np.allclose(hessian, rows, atol=1e-7)
        assert np.array_equal(hessian, hessian.T)


def test_masks_leave_out_what_is_always_zero(quantities):
    a, b, c = quantities[:3]
    jacobian, hessian = Tape([a * b + c, 3 * c - b, a / 2]).tape.masks()
    assert np.array_equal(jacobian, [[1, 1, 1], [0, 1, 1], [1, 0, 0]])
    curved = np.zeros((3, 3))
    curved[0, 1] = curved[1, 0] = 1
    assert np.array_equal(hessian, curved)


def test_masks_hold_every_derivative(quantities):
    tape = Tape([f(*quantities[i % 7:i % 7 + 2]) for i, f in enumerate(FUNCTIONS)])
    jacobian_mask, hessian_mask = tape.tape.masks()
    point = [dict(zip("abcdefgh", np.array(POINT) / 2))[leaf.name] for leaf in tape.leaves]
    _, jacobian, hessians = tape.tape.evaluate(point)
    assert not np.any(jacobian[jacobian_mask == 0])
    for hessian in hessians:
        assert not np.any(hessian[hessian_mask == 0])


def test_arrays_of_expressions_work_like_arrays(quantities):
    vector = np.array(quantities[:3])
    matrix = np.array([[1.0, 2.0, 0.5], [0.0, 1.0, 3.0]])
    product = matrix @ vector
    assert product.shape == (2,)
    tape = Tape(list(np.sin(product)) + [np.dot(vector, vector)])
    values, _, _ = tape.tape.evaluate(POINT[:3])
    x = np.array(POINT[:3])
    assert np.allclose(values, [*np.sin(matrix @ x), x @ x])
    assert (np.array([1.0, 2.0]) * quantities[0]).shape == (2,)
    assert (quantities[0] + np.array([1.0, 2.0])).shape == (2,)


def test_equal_operations_occur_once(quantities):
    a, b = quantities[:2]
    assert len(Tape([np.sin(a * b) + np.sin(a * b)])) == 5


def test_long_sums_need_no_recursion(quantities):
    total = quantities[0]
    for _ in range(20000):
        total = total + 0.5
    values, _, _ = Tape([total]).tape.evaluate([1.0])
    assert values[0] == 10001


def test_numbers_of_numpy_are_numbers(quantities):
    values, _, _ = Tape([np.float64(2) * quantities[0] + np.int32(1)]).tape.evaluate([3.0])
    assert values[0] == 7


@pytest.mark.parametrize("wrong, error", [
    (lambda x: x + "1", TypeError), (lambda x: x * float("nan"), ValueError),
    (lambda x: np.floor(x), TypeError), (lambda x: bool(x), TypeError),
    (lambda x: float(x), TypeError), (lambda x: x * True, TypeError),
    (lambda x: x.at(1.5), ValueError), (lambda x: x.at("middle"), ValueError),
])
def test_what_has_no_meaning_is_refused(quantities, wrong, error):
    with pytest.raises(error) as caught:
        wrong(quantities[0])
    assert "\n" not in str(caught.value)


def test_a_tape_refuses_wrong_input(quantities):
    tape = Tape([quantities[0] * quantities[1]]).tape
    with pytest.raises(ValueError, match="expected 2 inputs, got 1"):
        tape.evaluate([1.0])
    with pytest.raises(ValueError, match="out of range"):
        possibility._possibility.Tape(1, [("sin", 0, 0, 0.0)], [0])
    with pytest.raises(ValueError, match="no operation"):
        possibility._possibility.Tape(1, [("sine", 0, 0, 0.0)], [0])
