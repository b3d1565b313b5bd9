"""What the check reads: plan.json or plan.zip, the robot's YAML and the scenario's (docs/file_formats.md)."""

import json
import os
import re
import zipfile
import zlib
from dataclasses import dataclass

import numpy as np
import packed_plan
import yaml


class InputError(Exception):
    """One line that says what is wrong with which file."""


@dataclass
class Patch:
    """A contact patch of the robot: a link and points in its frame (n x 3)."""

    link: str
    points: np.ndarray


@dataclass
class Robot:
    file: str
    urdf: str
    root_link: str
    lumped: set
    friction: float
    effort: dict  # joint -> limit that replaces the URDF's
    patches: dict  # name -> Patch
    actuators: dict  # joint -> {key of the YAML: number}


@dataclass
class Ground:
    """Sides of boxes that face up most: middles (n x 3), axes (n x 3 x 3: two along the side, then
    out of it, as columns), half extents (n x 2), coefficients of friction (n)."""

    middles: np.ndarray
    axes: np.ndarray
    half_sizes: np.ndarray
    friction: np.ndarray

    @property
    def normals(self):
        return self.axes[:, :, 2]


@dataclass
class Phase:
    """Arrays have one row per knot; `points` lists (patch, index) in the order of `forces`."""

    segment: int
    index: int
    action: str
    points: list
    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: object  # None: not in the file
    forces: np.ndarray  # knots x points x 3
    impulses: object  # points x 3, or None


@dataclass
class Plan:
    joints: list
    robot: Robot
    ground: Ground
    phases: list
    version: int  # of the format


def _text_of(file):
    try:
        with open(file, encoding="utf-8") as stream:
            return stream.read()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8"
        raise InputError(f"{file}: cannot be read: {reason}") from None


def _yaml_of(file):
    try:
        return yaml.load(_text_of(file), getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.YAMLError as error:
        raise InputError(f"{file}: not YAML: {' '.join(str(error).split())}") from None


def _get(node, key, kind, where):
    if not isinstance(node, dict) or key not in node:
        raise InputError(f"{where}: {key} is missing")
    value = node[key]
    wanted = (int, float) if kind is float else kind
    if not isinstance(value, wanted) or isinstance(value, bool):
        raise InputError(f"{where}: {key}: expected {kind.__name__}, found {str(value)[:40]!r}")
    return value


def _names(node, key, where):
    """A list of different names; empty if there is no such key."""
    names = node.get(key, [])
    if (not isinstance(names, list) or not all(isinstance(name, str) for name in names) or
            len(set(names)) < len(names)):
        raise InputError(f"{where}: {key}: expected a list of different names")
    return names


def _numbers(value, shape, where):
    """`value` as an array of finite numbers; None in `shape` stands for any length."""
    try:
        array = np.array(value)
    except ValueError:
        raise InputError(f"{where}: rows of different lengths") from None
    if array.size == 0 and 0 in shape:
        array = array.reshape(shape).astype(float)
    fits = array.ndim == len(shape) and all(
        want in (None, have) for want, have in zip(shape, array.shape))
    if array.dtype.kind not in "iuf" or not fits or not (abs(array) <= 1e6).all():
        wanted = " x ".join("n" if n is None else str(n) for n in shape)
        raise InputError(f"{where}: expected {wanted} numbers, none beyond 1e6")
    return array.astype(float)


def _read_actuators(node, file):
    actuators = {}
    for entry in _get(node, "actuators", list, file) if "actuators" in node else []:
        where = f"{file}: actuators"
        numbers = {key: float(_get(entry, key, float, where))
                   for key in entry if key not in ("joints", "reason")}
        actuators.update((joint, numbers) for joint in _names(entry, "joints", where))
    return actuators


def _read_robot(file):
    node = _yaml_of(file)
    patches = {}
    for contact in _get(node, "contacts", list, file):
        name = _get(contact, "name", str, f"{file}: contacts")
        where = f"{file}: contact {name}"
        patches[name] = Patch(_get(contact, "link", str, where),
                              _numbers(_get(contact, "points", list, where), (None, 3), where))
    effort = {}
    for entry in _get(node, "effort", list, file) if "effort" in node else []:
        limit = float(_get(entry, "limit", float, f"{file}: effort"))
        effort.update((joint, limit) for joint in _names(entry, "joints", f"{file}: effort"))
    urdf = os.path.join(os.path.dirname(file), _get(node, "urdf", str, file))
    return Robot(file, urdf, _get(node, "root_link", str, file), set(_names(node, "lump", file)),
                 float(_get(node, "friction", float, file)), effort, patches,
                 _read_actuators(node, file))


def _read_ground(file, robots_friction):
    environment = _get(_yaml_of(file), "environment", dict, file)
    boxes = list(_get(environment, "ground", list, file))
    boxes += [box for box in environment.get("obstacles", []) if box.get("bears", False)]
    if not boxes:
        raise InputError(f"{file}: environment.ground: expected at least one box")
    where = f"{file}: environment.ground"
    sizes = _numbers([_get(box, "size", list, where) for box in boxes], (None, 3), where)
    positions = _numbers([_get(box, "position", list, where) for box in boxes], (None, 3), where)
    turns = _numbers([box.get("rpy_deg", [0, 0, box.get("yaw_deg", 0)]) for box in boxes],
                     (None, 3), where)
    sides = [_upper_side(*box) for box in zip(positions, sizes, np.radians(turns))]
    friction = _numbers([box.get("friction", robots_friction) for box in boxes], (None,), where)
    return Ground(*(np.array(part) for part in zip(*sides)), np.minimum(friction, robots_friction))


def _rotation(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
            @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
            @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def _upper_side(position, size, turn):
    """Middle, axes and half extents of the side of a box that faces up most."""
    axes = _rotation(*turn)
    out = int(np.argmax(np.round(abs(axes[2]), 9) + [0, 0, 1e-9]))
    normal = axes[:, out] * np.sign(axes[2, out])
    along = [(out + 1) % 3, (out + 2) % 3]
    return (position + normal * size[out] / 2,
            np.column_stack([axes[:, along[0]], axes[:, along[1]], normal]), size[along] / 2)


def _bearing_points(contacts, robot, where):
    """(patch, index) of all points of "patch" or "patch[i,j]"."""
    points = []
    for contact in contacts:
        parts = re.fullmatch(r"([^\[\]]+)(?:\[(\d+(?:,\d+)*)\])?", str(contact))
        if not parts or parts[1] not in robot.patches:
            raise InputError(f"{where}: the robot has no contact patch {contact}")
        count = len(robot.patches[parts[1]].points)
        indices = [int(i) for i in parts[2].split(",")] if parts[2] else list(range(count))
        if max(indices) >= count:
            raise InputError(f"{where}: {contact}: the patch has {count} points")
        points += [(parts[1], index) for index in indices]
    if len(set(points)) < len(points):
        raise InputError(f"{where}: a contact point is listed twice")
    return points


def _read_series(node, file):
    """What a long plan's components do, each course once: an array, or a number that stays."""
    series = []
    for i, course in enumerate(_get(node, "series", list, file)):
        where = f"{file}: series[{i}]"
        values = _numbers(course if isinstance(course, list) else [course], (None,), where)
        series.append(values)
    return series


def _courses(indices, width, knots, series, where):
    """knots x width numbers."""
    if len(indices) != width:
        raise InputError(f"{where}: expected {width} indices")
    values = np.empty((knots, width))
    for column, index in enumerate(indices):
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(series):
            raise InputError(f"{where}[{column}]: expected the index of a series")
        if len(series[index]) not in (1, knots):
            raise InputError(f"{where}[{column}]: expected a series of {knots} numbers")
        values[:, column] = series[index]
    return values


def _read_phase(node, segment, index, action, robot, num_joints, series, has_torques, file):
    where = f"{file}: segment {segment}, phase {index}"
    points = _bearing_points(_get(node, "contacts", list, where), robot, where)
    t = _numbers(_get(node, "t", list, where), (None,), f"{where}: t")
    knots = len(t)
    if knots < 2 or (np.diff(t) <= 0).any() or (np.diff(t) > 1).any():
        raise InputError(f"{where}: t: expected two times or more, increasing by at most 1 s")

    def rows(key, width):
        if series is not None:
            return _courses(_get(node, key, list, where), width, knots, series, f"{where}: {key}")
        return _numbers(_get(node, key, list, where), (knots, width), f"{where}: {key}")

    q = rows("q", 7 + num_joints)
    if abs(np.linalg.norm(q[:, :4], axis=1) - 1).max() > 1e-6:
        raise InputError(f"{where}: q: expected unit quaternions")
    forces = rows("forces", 3 * len(points)).reshape(knots, len(points), 3)
    impulses = None
    if "impulses" in node:
        if not points or (segment, index) == (0, 0):
            raise InputError(f"{where}: impulses: nothing can hit the ground here")
        impulses = _numbers(node["impulses"], (3 * len(points),), f"{where}: impulses")
        impulses = impulses.reshape(len(points), 3)
    tau = rows("tau", num_joints) if "tau" in node or has_torques else None
    return Phase(segment, index, action, points, t, q, rows("v", 6 + num_joints),
                 rows("a", 6 + num_joints), tau, forces, impulses)


def _refuse_constant(name):
    raise ValueError(f"{name} is no number of JSON")


def _object(pairs):
    node = dict(pairs)
    if len(node) < len(pairs):
        raise ValueError("an object has the same key twice")
    return node


def _packed_document(file):
    try:
        return packed_plan.load(file)
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, OverflowError,
            RecursionError, RuntimeError, zipfile.BadZipFile, zlib.error, OSError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{file}: spoilt, expected a possibility-plan/2: {reason}") from None


def _plain_document(file):
    try:
        return json.loads(_text_of(file), parse_constant=_refuse_constant,
                          object_pairs_hook=_object)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: not proper JSON: {error}") from None


def _document_of(file):
    """(file, document, version) of a plan file or the folder of one."""
    if os.path.isdir(file):
        plain, packed = os.path.join(file, "plan.json"), os.path.join(file, "plan.zip")
        file = packed if os.path.exists(packed) and not os.path.exists(plain) else plain
    version = 2 if os.path.isfile(file) and packed_plan.is_packed(file) else 1
    node = _packed_document(file) if version == 2 else _plain_document(file)
    if not isinstance(node, dict) or node.get("format") != f"possibility-plan/{version}":
        raise InputError(f"{file}: format: expected \"possibility-plan/{version}\"")
    return file, node, version


def read_plan(file):
    """The plan with its robot and its ground.

    Raises InputError for whatever cannot be read or does not fit together."""
    file, node, version = _document_of(file)

    def beside(key):
        named = _get(_get(node, key, dict, file), "file", str, f"{file}: {key}")
        return os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(file)), named))

    robot = _read_robot(beside("robot"))
    joints = _names(node, "joints", file)
    series = _read_series(node, file) if "series" in node else None
    phases = []
    for i, segment in enumerate(_get(node, "segments", list, file)):
        action = _get(segment, "action", str, f"{file}: segment {i}")
        for j, phase in enumerate(_get(segment, "phases", list, f"{file}: segment {i}")):
            phases.append(_read_phase(phase, i, j, action, robot, len(joints), series,
                                      node.get("torques", True), file))
    if not phases:
        raise InputError(f"{file}: there is no motion in this plan")
    return Plan(joints, robot, _read_ground(beside("scenario"), robot.friction), phases, version)
