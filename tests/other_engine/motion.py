"""The motion of a plan between its knots (docs/file_formats.md, "Between knots")."""

from dataclasses import dataclass
from math import factorial

import numpy as np


@dataclass
class State:
    """`rotation`: 3 x 3, root to world; `v`, `a`: angular, linear (world axes), joints."""

    rotation: np.ndarray
    position: np.ndarray
    joints: np.ndarray
    v: np.ndarray
    a: np.ndarray


def cross(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def rotation_of(quaternion):
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def product(p, q):
    """Of quaternions w, x, y, z."""
    a, b, c, d = p
    w, x, y, z = q
    return np.array([a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y,
                     a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w])


def rotation_vector(quaternion):
    """Of the turn by at most pi."""
    w, imaginary = quaternion[0], quaternion[1:]
    if w < 0:
        w, imaginary = -w, -imaginary
    sine = np.linalg.norm(imaginary)
    return imaginary * (2 * np.arctan2(sine, w) / sine if sine > 1e-12 else 2.0)


def turned(rotation_vector_, quaternion):
    """exp(rotation vector) * quaternion."""
    angle = np.linalg.norm(rotation_vector_)
    half = np.sinc(angle / (2 * np.pi)) / 2
    return product(np.concatenate([[np.cos(angle / 2)], half * rotation_vector_]), quaternion)


# Coefficients in powers of the squared angle s, highest first, of (1 - cos) / s, (angle - sin) /
# angle^3. They hold from 0 to beyond pi without a special case.
_A = [(-1) ** k / factorial(2 * k + 2) for k in reversed(range(16))]
_B = [(-1) ** k / factorial(2 * k + 3) for k in reversed(range(16))]
_DA, _DB = np.polyder(_A).tolist(), np.polyder(_B).tolist()


def _value(coefficients, s):
    total = 0.0
    for coefficient in coefficients:
        total = total * s + coefficient
    return total


def left_jacobian(phi, rate):
    """J of SO(3) with angular velocity = J(phi) phi', and its derivative in time."""
    P, D = cross(phi), cross(rate)
    s, ds = float(phi @ phi), float(2 * phi @ rate)
    a, b = _value(_A, s), _value(_B, s)
    PP = P @ P
    return np.eye(3) + a * P + b * PP, (_value(_DA, s) * ds * P + a * D +
                                        _value(_DB, s) * ds * PP + b * (P @ D + D @ P))


class Interval:
    """The motion between two neighbouring knots of a phase."""

    def __init__(self, phase, knot):
        q0, q1 = phase.q[knot], phase.q[knot + 1]
        v0, v1 = phase.v[knot], phase.v[knot + 1]
        a0, a1 = phase.a[knot], phase.a[knot + 1]
        self._start = phase.t[knot]
        self._orientation = q0[:4]
        phi = rotation_vector(product(q1[:4], q0[:4] * [1, -1, -1, -1]))
        zero = np.zeros(3)
        J = left_jacobian(phi, zero)[0]
        rate = np.linalg.solve(J, v1[:3])
        J_rate = left_jacobian(phi, rate)[1]
        bend = np.linalg.solve(J, a1[:3] - J_rate @ rate)
        ends = [(zero, q0[4:]), (v0[:3], v0[3:]), (a0[:3], a0[3:]),
                (phi, q1[4:]), (rate, v1[3:]), (bend, a1[3:])]
        self._polynomials = self._quintic(phase.t[knot + 1] - self._start,
                                          *(np.concatenate(end) for end in ends))

    @staticmethod
    def _quintic(h, x0, v0, a0, x1, v1, a1):
        """Coefficients of x, x', x'', lowest power first."""
        x = x1 - x0 - v0 * h - a0 * h * h / 2
        v = (v1 - v0 - a0 * h) * h
        a = (a1 - a0) * h * h
        c = np.array([x0, v0, a0 / 2, (10 * x - 4 * v + a / 2) / h**3,
                      (-15 * x + 7 * v - a) / h**4, (6 * x - 3 * v + a / 2) / h**5])
        first = c[1:] * np.arange(1, 6)[:, None]
        return c, first, first[1:] * np.arange(1, 5)[:, None]

    def at(self, time):
        powers = (time - self._start) ** np.arange(6)
        x, v, a = (powers[:len(c)] @ c for c in self._polynomials)
        J, J_rate = left_jacobian(x[:3], v[:3])
        orientation = turned(x[:3], self._orientation)
        return State(rotation_of(orientation), x[3:6], x[6:],
                     np.concatenate([J @ v[:3], v[3:]]),
                     np.concatenate([J @ a[:3] + J_rate @ v[:3], a[3:]]))


def knot_state(phase, knot):
    q = phase.q[knot]
    return State(rotation_of(q[:4]), q[4:7], q[7:], phase.v[knot], phase.a[knot])
