"""The motion of plan.zip (possibility-plan/2, docs/file_formats.md) as plan.json has it."""

import json
import zipfile

import numpy as np


def is_packed(file):
    with open(file, "rb") as stream:
        return stream.read(4) == b"PK\x03\x04"


def load(file):
    """The document, whose phases have t, q, v, a, forces, and tau unless the file leaves it out."""
    with zipfile.ZipFile(file) as archive:
        plan = json.loads(archive.read("plan.json"))
        phases = [phase for segment in plan["segments"] for phase in segment["phases"]]
        joints, last = len(plan["joints"]), None
        has_torques = plan.get("torques", True)
        if not isinstance(has_torques, bool):
            raise ValueError("torques: expected true or false")
        for index, count in enumerate(plan["blocks"]):
            block, phases = phases[:count], phases[count:]
            columns = _integers(archive.read(f"motion/{index}"), block, joints, has_torques)
            for phase, numbers in zip(block, columns):
                last = _unpack(phase, numbers, 2.0 ** -plan["force_bits"], phase.get("start", last))
                if not has_torques:
                    del phase["tau"]
        if phases:
            raise ValueError("blocks: fewer phases than the segments have")
    return plan


def _integers(data, block, joints, has_torques):
    """For each phase the integers of t, a, v, q, tau and forces: components x knots or intervals."""
    sizes = [[(1, n - 1), (6 + joints, n), (6 + joints, n - 1), (6 + joints, n - 1), (joints * has_torques, n),
              (3 * phase["points"], n)] for phase in block for n in [phase["knots"]]]
    columns, place = [[] for _ in block], 0
    for quantity in range(6):
        shapes = [size[quantity] for size in sizes]
        counts = [rows * length for rows, length in shapes]
        planes, place = data[place], place + 1
        zigzag = np.zeros(sum(counts), np.uint64)
        for plane in range(planes):
            zigzag |= np.frombuffer(data, np.uint8, len(zigzag), place).astype(
                np.uint64) << np.uint64(8 * plane)
            place += len(zigzag)
        signed = (zigzag >> np.uint64(1)).astype(np.int64) ^ -(zigzag & np.uint64(1)).astype(np.int64)
        for column, part, shape in zip(columns, np.split(signed, np.cumsum(counts)[:-1]), shapes):
            column.append(part.reshape(shape))
    if place != len(data):
        raise ValueError("a block has more bytes than numbers")
    return columns


def _unpack(phase, numbers, force_step, start):
    """Sets the phase's motion. The state at its end, from which the next phase may go on."""
    times, a, v, q, tau, forces = numbers
    a_step, v_step, q_step = (2.0 ** -bits for bits in phase["bits"])
    for differences in (a, tau, forces):
        for _ in range(3):
            np.cumsum(differences, axis=1, out=differences)
    h = np.cumsum(times[0]) * 2.0 ** -40
    a = a * a_step
    rates = [np.array(start["v"])]
    change = rate_changes(a, h) + v * v_step
    for k in range(len(h)):
        rates.append(rates[-1] + change[:, k])
    v = np.array(rates).T
    change = h / 2 * (v[:, :-1] + v[:, 1:]) + h**2 / 12 * (a[:, :-1] - a[:, 1:]) + q * q_step
    positions = [np.array(start["q"])]
    for k in range(len(h)):
        before = positions[-1]
        turn = turned(before[:4], change[:3, k])
        positions.append(np.concatenate([turn, before[4:] + change[3:, k]]))
    t = start["t"] + np.concatenate([[0], np.cumsum(h)])
    phase.update(t=t.tolist(), q=np.array(positions).tolist(), v=v.T.tolist(), a=a.T.tolist(),
                 tau=(tau * force_step * 4).T.tolist(), forces=(forces * force_step).T.tolist())
    return {"t": t[-1], "q": positions[-1], "v": v[:, -1]}


def rate_changes(a, h):
    """The integral of a over every interval: of the cubic through the four nearest knots."""
    if a.shape[1] < 4:
        return h / 2 * (a[:, :-1] + a[:, 1:])
    inner = 13 * (a[:, 1:-2] + a[:, 2:-1]) - a[:, :-3] - a[:, 3:]
    first = 9 * a[:, 0] + 19 * a[:, 1] - 5 * a[:, 2] + a[:, 3]
    last = 9 * a[:, -1] + 19 * a[:, -2] - 5 * a[:, -3] + a[:, -4]
    return h / 24 * np.column_stack([first, inner, last])


def turned(quaternion, vector):
    """exp([vector]) times the rotation, w first."""
    angle = np.linalg.norm(vector)
    s = np.sinc(angle / (2 * np.pi)) / 2
    w, (x, y, z) = np.cos(angle / 2), s * vector
    product = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]) @ quaternion
    return product / np.linalg.norm(product)
