"""The checks of stretches and events: transitions between phases, flights, impacts."""

from dataclasses import dataclass

import numpy as np
from motion import (Interval, State, cross, knot_state, product, rotation_of, rotation_vector,
                    turned)
from sample_checks import KNOT_ROUNDING, ground_at, outside_cone

CONTINUITY = 1e-6  # m, rad, m/s, rad/s: rounding
IMPACT_SPEED = 1e-4  # m/s, of a point that has just hit the ground
FLIGHT_STEP = 2e-3  # s, longest step of the integration
LANDING_DISTANCE = 1e-3  # m; DART and a plan differ by a millionth of it
LANDING_ANGLE = 0.1  # degrees


@dataclass
class Flight:
    """`position`: m, `angle`: degrees, between DART and the plan at the landing."""

    segment: int
    start: float
    end: float
    position: float
    angle: float


def check_continuity(plan, findings):
    """The last state of a phase is the first of the next."""
    for check, unit, limit in (("gap in time", "s", 1e-9), ("jump of q", "m, rad", CONTINUITY),
                               ("jump of v without impact", "m/s, rad/s", CONTINUITY)):
        findings.declare(check, unit, limit)
    for before, after in zip(plan.phases, plan.phases[1:]):
        time = after.t[0]
        findings.note("gap in time", abs(before.t[-1] - time), after, time)
        findings.note("jump of q", pose_difference(before.q[-1], after.q[0]).max(), after, time)
        if after.impulses is None:
            findings.note("jump of v without impact", abs(before.v[-1] - after.v[0]).max(), after,
                          time)


def pose_difference(q, other):
    """Rotation and distance of the root, then differences of the joints; all absolute."""
    turn = rotation_vector(product(other[:4], q[:4] * [1, -1, -1, -1]))
    return np.concatenate([[np.linalg.norm(turn), np.linalg.norm(other[4:7] - q[4:7])],
                           abs(other[7:] - q[7:])])


def check_impacts(robot, plan, findings):
    """M (v+ - v-) = J' impulses in all rows; impulses push within friction; the points rest."""
    weight = robot.weight
    for check, unit, limit in (("impact: momentum left over", "N s, N m s", KNOT_ROUNDING * weight),
                               ("impact: impulse outside its cone", "N s", KNOT_ROUNDING * weight),
                               ("impact: speed of the points after", "m/s", IMPACT_SPEED),
                               ("impact: gain of energy", "J", KNOT_ROUNDING * weight)):
        findings.declare(check, unit, limit)
    for previous, phase in zip(plan.phases, plan.phases[1:]):
        if phase.impulses is None:
            continue
        time, after = phase.t[0], knot_state(phase, 0)
        before = State(after.rotation, after.position, after.joints, previous.v[-1], after.a)
        rows, energy = robot.momentum_change(before, after, phase.points, phase.impulses)
        names = ["root"] * 6 + plan.joints
        findings.note_largest("impact: momentum left over", abs(rows), phase, time, names)
        findings.note("impact: gain of energy", max(energy, 0), phase, time)
        normals, friction = ground_at(plan.ground, robot.places(phase.points))
        findings.note_largest("impact: impulse outside its cone",
                              outside_cone(phase.impulses, normals, friction), phase, time,
                              phase.points)
        speeds = np.linalg.norm(robot.velocities(phase.points), axis=1)
        findings.note_largest("impact: speed of the points after", speeds, phase, time,
                              phase.points)


def check_flights(robot, plan, findings):
    """Lets DART fly from the first state of every flight with the joints moving as planned, and
    compares where it is at each later knot. Makes `robot` one with prescribed joints."""
    for check, unit, limit in (("flight: root away on the way", "m", LANDING_DISTANCE),
                               ("flight: root turned on the way", "degrees", LANDING_ANGLE),
                               ("flight: root away at landing", "m", LANDING_DISTANCE),
                               ("flight: root turned at landing", "degrees", LANDING_ANGLE)):
        findings.declare(check, unit, limit)
    robot.prescribe_joints()
    flights, root = [], None
    for i, phase in enumerate(plan.phases):
        if phase.points:
            root = None
            continue
        if root is None:
            root = _Root(phase)
            flights.append(Flight(phase.segment, float(phase.t[0]), 0, 0, 0))
        for knot in range(len(phase.t) - 1):
            root.fly(robot, phase, knot)
            distance, angle = root.off(phase.q[knot + 1])
            findings.note("flight: root away on the way", distance, phase, phase.t[knot + 1])
            findings.note("flight: root turned on the way", angle, phase, phase.t[knot + 1])
        flights[-1].end = float(phase.t[-1])
        flights[-1].position, flights[-1].angle = distance, angle
        if i + 1 == len(plan.phases) or plan.phases[i + 1].points:
            findings.note("flight: root away at landing", distance, phase, phase.t[-1])
            findings.note("flight: root turned at landing", angle, phase, phase.t[-1])
    return flights


class _Root:
    """Pose and velocity of the flying root."""

    def __init__(self, phase):
        self._orientation = phase.q[0, :4]
        self._x = np.concatenate([phase.q[0, 4:7], phase.v[0, :6]])  # position, angular, linear

    def fly(self, robot, phase, knot):
        """To the next knot: Runge-Kutta 4 on DART's forward dynamics. The orientation of a step is
        exp(r) times that at its beginning; r' = w - r x w / 2 + r x (r x w) / 12 but for terms of
        the fourth order in r."""
        interval = Interval(phase, knot)
        start, end = phase.t[knot], phase.t[knot + 1]
        steps = int(np.ceil((end - start) / FLIGHT_STEP))
        h = (end - start) / steps
        for i in range(steps):
            t = start + i * h
            y = np.concatenate([np.zeros(3), self._x])
            k1 = self._rate(robot, interval, t, y)
            k2 = self._rate(robot, interval, t + h / 2, y + h / 2 * k1)
            k3 = self._rate(robot, interval, t + h / 2, y + h / 2 * k2)
            k4 = self._rate(robot, interval, min(t + h, end), y + h * k3)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            self._orientation = turned(y[:3], self._orientation)
            self._x = y[3:]

    def _rate(self, robot, interval, time, y):
        turn, position, velocity = y[:3], y[3:6], y[6:]
        planned = interval.at(time)
        v = np.concatenate([velocity, planned.v[6:]])
        state = State(rotation_of(turned(turn, self._orientation)), position, planned.joints, v,
                      planned.a)
        w = velocity[:3]
        bend = cross(turn) @ w
        turn_rate = w - bend / 2 + cross(turn) @ bend / 12
        return np.concatenate([turn_rate, velocity[3:], robot.free_root_acceleration(state)])

    def off(self, q):
        """Distance (m) and angle (degrees) from the plan's."""
        here = np.concatenate([self._orientation, self._x[:3]])
        angle, distance = pose_difference(here, q[:7])
        return float(distance), float(np.degrees(angle))
