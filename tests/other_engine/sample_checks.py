"""The checks at every instant: forces and torques, contacts, limits of the joints."""

import numpy as np
from motion import Interval, State, cross, knot_state

KNOT_ROUNDING = 1e-6  # of the weight: plan.json has 12 digits
BETWEEN_KNOTS = {1: 1e-3, 2: 1e-6}  # of the weight, by format: what interpolation leaves
POINT_DISTANCE = 1e-3  # m, compression of a sole
EDGE = 1e-6  # m
POINT_SPEED = 2e-3  # m/s
BEARS = 1.0  # N; the ratio of smaller forces says nothing


class SampleChecks:
    def __init__(self, robot, plan, findings):
        self._robot, self._plan, self._findings = robot, plan, findings
        self._anchors = {}  # (patch, index) -> where the point began to bear
        self.samples = 0
        weight = robot.weight
        for check, unit, limit in (
                ("root force left over at knots", "weight", KNOT_ROUNDING),
                ("root torque left over at knots", "weight m", KNOT_ROUNDING),
                ("joint torque against the plan's", "N m", KNOT_ROUNDING * weight),
                ("root force left over between", "weight", BETWEEN_KNOTS[plan.version]),
                ("root torque left over between", "weight m", BETWEEN_KNOTS[plan.version]),
                ("root force if forces were linear", "weight", None),
                ("correction of a force between", "N", None),
                ("joint torque / limit", "1", 1 + 1e-6),
                ("joint speed / limit", "1", 1 + 1e-6),
                ("joint beyond its range", "rad", 1e-6),
                ("force outside its cone", "N", KNOT_ROUNDING * weight),
                ("friction used / friction", "1", None),
                ("point above or below ground", "m", POINT_DISTANCE),
                ("point beyond the ground's edge", "m", EDGE),
                ("point away from where it began", "m", POINT_DISTANCE),
                ("speed of a bearing point", "m/s", POINT_SPEED)):
            findings.declare(check, unit, limit)

    def run(self, rate):
        """All knots, and `rate` samples a second between them (0: none)."""
        for phase in self._plan.phases:
            self._anchors = {point: place for point, place in self._anchors.items()
                             if point in phase.points}
            for knot, time in enumerate(phase.t):
                self._knot(phase, time, knot)
                if knot + 1 < len(phase.t):
                    self._between(phase, knot, rate)

    def _knot(self, phase, time, knot):
        state = knot_state(phase, knot)
        self._robot.set_state(state)
        root, torques = self._robot.required(phase.points, phase.forces[knot])
        self._note_root("at knots", root, phase, time)
        if phase.tau is None:  # those that the format's rule gives
            forces = self._corrected(phase, state, root, phase.forces[knot])
            _, torques = self._robot.required(phase.points, forces)
        else:
            self._note_torques(phase, time, torques, phase.tau[knot])
        self._common(phase, time, state, torques, phase.forces[knot])

    def _note_torques(self, phase, time, needed, planned):
        joints = self._plan.joints
        self._findings.note_largest("joint torque against the plan's", abs(needed - planned), phase,
                                    time, joints)
        self._findings.note_largest("joint torque / limit",
                                    abs(planned) / self._robot.torque_limits(planned), phase, time,
                                    joints)

    def _between(self, phase, knot, rate):
        start, end = phase.t[knot], phase.t[knot + 1]
        pieces = int(np.ceil((end - start) * rate - 1e-9))
        if pieces < 2:
            return
        interval = Interval(phase, knot)
        for i in range(1, pieces):
            share = i / pieces
            time = start + share * (end - start)
            state = interval.at(time)
            forces = (1 - share) * phase.forces[knot] + share * phase.forces[knot + 1]
            self._robot.set_state(state)
            root, torques = self._robot.required(phase.points, forces)
            if phase.points:
                self._findings.note("root force if forces were linear",
                                    np.linalg.norm(root[3:]) / self._robot.weight, phase, time)
                corrected = self._corrected(phase, state, root, forces)
                self._findings.note_largest("correction of a force between",
                                            np.linalg.norm(corrected - forces, axis=1), phase, time,
                                            phase.points)
                forces = corrected
                root, torques = self._robot.required(phase.points, forces)
            self._note_root("between", root, phase, time)
            self._common(phase, time, state, torques, forces)

    def _corrected(self, phase, state: State, root, forces):
        """Forces between knots are not quite linear. The change that supplies what is missing and
        is least when measured against what each point bears ("Forces between knots" in
        docs/verification.md); where the points cannot supply it, the rest stays."""
        if not phase.points:
            return forces
        arms = self._robot.places(phase.points) - state.position
        wrench = np.hstack([np.vstack([cross(arm), np.eye(3)]) for arm in arms])
        missing = np.concatenate([state.rotation @ root[:3], state.rotation @ root[3:]])
        load = np.maximum(forces[:, 2], 0) + 1e-3 * self._robot.weight / len(forces)
        scale = np.repeat(load / load.max(), 3)
        change = np.linalg.lstsq(wrench * scale, missing, rcond=1e-6)[0] * scale
        return forces + change.reshape(-1, 3)

    def _note_root(self, kind, root, phase, time):
        weight = self._robot.weight
        for quantity, rows in (("torque", root[:3]), ("force", root[3:])):
            self._findings.note(f"root {quantity} left over {kind}", np.linalg.norm(rows) / weight,
                                phase, time)

    def _common(self, phase, time, state, torques, forces):
        self.samples += 1
        robot, note_largest, joints = self._robot, self._findings.note_largest, self._plan.joints
        note_largest("joint torque / limit", abs(torques) / robot.torque_limits(torques), phase, time,
                     joints)
        note_largest("joint speed / limit", abs(state.v[6:]) / robot.speed, phase, time, joints)
        beyond = np.maximum(robot.lowest - state.joints, state.joints - robot.highest)
        note_largest("joint beyond its range", np.maximum(beyond, 0), phase, time, joints)
        if phase.points:
            normals, friction = ground_at(self._plan.ground, robot.places(phase.points))
            note_largest("force outside its cone", outside_cone(forces, normals, friction), phase,
                         time, phase.points)
            load, sideways = split(forces, normals)
            pressed = load > BEARS
            used = sideways[pressed] / load[pressed] / friction[pressed]
            note_largest("friction used / friction", used, phase, time,
                         [point for point, bears in zip(phase.points, pressed) if bears])
            self._contact_points(phase, time)

    def _contact_points(self, phase, time):
        places = self._robot.places(phase.points)
        note_largest = self._findings.note_largest
        height, beyond = self._above_ground(places)
        note_largest("point above or below ground", height, phase, time, phase.points)
        note_largest("point beyond the ground's edge", beyond, phase, time, phase.points)
        began = np.array([self._anchors.setdefault(point, place)
                          for point, place in zip(phase.points, places)])
        away = np.linalg.norm(places - began, axis=1)
        note_largest("point away from where it began", away, phase, time, phase.points)
        speeds = np.linalg.norm(self._robot.velocities(phase.points), axis=1)
        note_largest("speed of a bearing point", speeds, phase, time, phase.points)

    def _above_ground(self, places):
        """For each place: vertical distance from the nearest side of ground above or below it (from
        any, if none is), and how far beyond the nearest edge it is."""
        vertical, outside = distances(self._plan.ground, places)
        reaches = (outside <= EDGE) | (outside.min(axis=1) > EDGE)[:, None]
        return (np.where(reaches, vertical, np.inf).min(axis=1),
                np.where(reaches, outside, np.inf).min(axis=1))


def distances(ground, places):
    """From each place (rows) to each side of ground (columns): along the vertical, and beyond the
    nearest edge, along the side."""
    offset = places[:, None, :] - ground.middles
    vertical = np.einsum("ijk,jk->ij", offset, ground.normals) / ground.normals[:, 2]
    foot = offset - vertical[..., None] * np.array([0, 0, 1])  # on the side's plane
    local = np.einsum("ijk,jkl->ijl", foot, ground.axes[:, :, :2])
    outside = np.linalg.norm(np.maximum(abs(local) - ground.half_sizes, 0), axis=-1)
    return abs(vertical), outside


def ground_at(ground, places):
    """Normals and coefficients of friction of the ground nearest to each place."""
    vertical, outside = distances(ground, places)
    nearest = np.hypot(vertical, outside).argmin(axis=1)
    return ground.normals[nearest], ground.friction[nearest]


def split(forces, normals):
    """Each force (n x 3, N) along the ground's normal, and across it."""
    load = np.sum(forces * normals, axis=1)
    return load, np.linalg.norm(forces - load[:, None] * normals, axis=1)


def outside_cone(forces, normals, friction):
    """By how much each force (n x 3, N) pulls at its ground or exceeds friction."""
    load, sideways = split(forces, normals)
    return np.maximum(np.maximum(-load, sideways - friction * load), 0)
