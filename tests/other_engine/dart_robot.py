"""The robot as DART reads it from its URDF."""

import contextlib
import os
import xml.etree.ElementTree as ElementTree

import dartpy as dart
import numpy as np
from input_files import InputError

GRAVITY = 9.80665  # m/s^2, standard gravity, in which plans are made


@contextlib.contextmanager
def _silence():
    """DART complains about a URDF on both streams and in several lines."""
    kept = [os.dup(1), os.dup(2)]
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        os.dup2(nowhere.fileno(), 2)
        try:
            yield
        finally:
            for stream, copy in zip((1, 2), kept):
                os.dup2(copy, stream)
                os.close(copy)


def _refuse_mimics(robot, joints):
    try:
        tree = ElementTree.parse(robot.urdf)
    except (OSError, ElementTree.ParseError) as error:
        raise InputError(f"{robot.urdf}: not a URDF: {error}") from None
    for joint in tree.getroot().iter("joint"):
        if joint.find("mimic") is not None and joint.get("name") in joints:
            raise InputError(f"{robot.urdf}: joint {joint.get('name')}: DART's parser does not "
                             "couple mimic joints: this robot cannot be checked")


def _load(robot, joints):
    if not os.path.isfile(robot.urdf):
        raise InputError(f"{robot.urdf}: no such file (urdf of {robot.file})")
    _refuse_mimics(robot, joints)
    with _silence():
        skeleton = dart.utils.DartLoader().parseSkeleton(robot.urdf)
    if skeleton is None:
        raise InputError(f"{robot.urdf}: DART cannot read it")
    if skeleton.getRootBodyNode().getName() != robot.root_link:
        raise InputError(f"{robot.urdf}: the root is not {robot.root_link}")
    skeleton.setGravity([0, 0, -GRAVITY])
    return skeleton


class Actuators:
    """The YAML's `actuators` (docs/file_formats.md), one number per joint of the plan. DART knows
    no armature."""

    def __init__(self, entries):
        def column(key, default):
            return np.array([entry.get(key, default) for entry in entries], float)
        self.armature = column("armature", 0)
        self._viscous, self._dry = column("viscous_friction", 0), column("dry_friction", 0)
        self._dry_speed = column("dry_speed", 0.1)
        self._stall, self._no_load = column("stall_torque", np.inf), column("no_load_speed", np.inf)

    def torques(self, rates, accelerations):
        return (self.armature * accelerations + self._viscous * rates +
                self._dry * np.tanh(rates / self._dry_speed))

    def limits(self, effort, torques, rates):
        """A driving torque falls with the speed, a braking one does not."""
        line = self._stall * (1 - np.where(torques < 0, -rates, rates) / self._no_load)
        return np.minimum(effort, np.maximum(line, 0))


class DartRobot:
    """A DART skeleton with a floating root. Joints that the plan does not have stay in the skeleton
    and are held at 0. Their rows are those of a lock and are not checked."""

    def __init__(self, robot, joints):
        self._skeleton = skeleton = _load(robot, joints)
        self._root = skeleton.getRootJoint()
        dofs = {skeleton.getDof(i).getName(): skeleton.getDof(i)
                for i in range(6, skeleton.getNumDofs())}
        for name in joints:
            if name not in dofs:
                raise InputError(f"{robot.urdf}: there is no joint {name}, which the plan moves")
        for name in dofs:
            if name not in joints and name not in robot.lumped:
                raise InputError(f"{robot.file}: joint {name} is neither lumped nor in the plan")
        for name, patch in robot.patches.items():
            if skeleton.getBodyNode(patch.link) is None:
                raise InputError(f"{robot.file}: contact {name}: there is no link {patch.link}")
        self._kept = np.array([dofs[name].getIndexInSkeleton() for name in joints])
        self._rows = np.concatenate([np.arange(6), self._kept])
        self._patches = robot.patches
        self._bodies = {name: skeleton.getBodyNode(patch.link)
                        for name, patch in robot.patches.items()}
        self.weight = skeleton.getMass() * GRAVITY
        limits = [dofs[name].getPositionLimits() for name in joints]
        self.lowest, self.highest = np.array(limits).T
        self.speed = np.array([dofs[name].getVelocityLimits()[1] for name in joints])
        self.effort = np.array([robot.effort.get(name, dofs[name].getForceLimits()[1])
                                for name in joints])
        self._actuators = Actuators([robot.actuators.get(name, {}) for name in joints])
        for name, limits in (("speed", self.speed), ("torque", self.effort)):
            if not (limits > 0).all():
                raise InputError(f"{robot.urdf}: joint {joints[int((limits > 0).argmin())]}: "
                                 f"expected a positive limit of {name}")

    def set_state(self, state, with_acceleration=True):
        """Puts the skeleton there; DART turns world axes into its own coordinates."""
        n = self._skeleton.getNumDofs()
        self._rates, self._accelerations = state.v[6:], state.a[6:]
        pose = dart.math.Isometry3(state.rotation, state.position)
        root = self._root.convertToPositions(pose)
        self._skeleton.setPositions(self._spread(n, state.joints, root))
        self._skeleton.setVelocities(self._spread(n, state.v[6:]))
        self._root.setAngularVelocity(state.v[:3])
        self._root.setLinearVelocity(state.v[3:6])
        if with_acceleration:
            self._skeleton.setAccelerations(self._spread(n, state.a[6:]))
            self._root.setAngularAcceleration(state.a[:3])
            self._root.setLinearAcceleration(state.a[3:6])

    def _spread(self, size, joints, root=0.0):
        values = np.zeros(size)
        values[:6] = root
        values[self._kept] = joints
        return values

    def required(self, points, forces):
        """Inverse dynamics under forces (n x 3, world) at the points listed: what is missing on the
        root, torque about its origin and force in its axes, and the joint torques."""
        self._skeleton.clearExternalForces()
        for (patch, index), force in zip(points, forces):
            self._bodies[patch].addExtForce(force, self._patches[patch].points[index], False, True)
        self._skeleton.computeInverseDynamics(True)
        answer = self._skeleton.getForces()
        self._skeleton.clearExternalForces()
        taken = self._actuators.torques(self._rates, self._accelerations)
        return answer[:6], answer[self._kept] + taken

    def torque_limits(self, torques):
        """At the rates of the state set, for torques of these signs."""
        return self._actuators.limits(self.effort, torques, self._rates)

    def places(self, points):
        """World positions (n x 3)."""
        frames = {patch: self._bodies[patch].getWorldTransform().matrix()
                  for patch in {patch for patch, _ in points}}
        return np.array([frames[patch][:3, :3] @ self._patches[patch].points[index] +
                         frames[patch][:3, 3] for patch, index in points]).reshape(-1, 3)

    def velocities(self, points):
        return np.array([self._bodies[patch].getLinearVelocity(self._patches[patch].points[index])
                         for patch, index in points]).reshape(-1, 3)

    def momentum_change(self, before, after, points, impulses):
        """M (v+ - v-) - J' impulses (root rows first, then joints) and the gain of kinetic energy,
        for two states that differ in v alone."""
        self.set_state(before, False)
        speed, energy = self._skeleton.getVelocities(), self._skeleton.computeKineticEnergy()
        self.set_state(after, False)
        change = self._skeleton.getMassMatrix() @ (self._skeleton.getVelocities() - speed)
        for (patch, index), impulse in zip(points, impulses):
            jacobian = self._skeleton.getLinearJacobian(self._bodies[patch],
                                                        self._patches[patch].points[index])
            change -= jacobian.T @ impulse
        change, gain = change[self._rows], self._skeleton.computeKineticEnergy() - energy
        armature = self._actuators.armature
        change[6:] += armature * (after.v[6:] - before.v[6:])
        return change, gain + armature @ (after.v[6:]**2 - before.v[6:]**2) / 2

    def prescribe_joints(self):
        """From here on DART's forward dynamics takes the joints' accelerations as given."""
        for i in range(1, self._skeleton.getNumJoints()):
            if self._skeleton.getJoint(i).getNumDofs() > 0:
                self._skeleton.getJoint(i).setActuatorType(dart.dynamics.Joint.ACCELERATION)

    def free_root_acceleration(self, state):
        """Of the root (angular, linear; world) with nothing but gravity acting on the robot, its
        joints accelerating as `state.a` says. Needs prescribe_joints."""
        self.set_state(state, False)
        self._skeleton.setCommands(self._spread(self._skeleton.getNumDofs(), state.a[6:]))
        self._skeleton.computeForwardDynamics()
        root = self._skeleton.getRootBodyNode()
        return np.concatenate([root.getAngularAcceleration(), root.getLinearAcceleration()])
