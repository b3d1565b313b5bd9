"""Writes plan.zip from a document whose phases have t, q, v, a, forces and perhaps tau: a second writer of
possibility-plan/2, after docs/file_formats.md. Every phase has a start."""

import json
import zipfile

import numpy as np
import packed_plan


def pack(plan, file):
    """`plan` as packed_plan.load gives it, changed or not; it stays as it is."""
    document = {key: value for key, value in plan.items() if key != "segments"}
    document["segments"], packed = [], []
    for segment in plan["segments"]:
        outlines = []
        for phase in segment["phases"]:
            outline = {key: value for key, value in phase.items()
                       if key not in ("t", "q", "v", "a", "tau", "forces")}
            first = {key: phase[key][0] for key in ("t", "q", "v")}
            outline.update(knots=len(phase["t"]), points=len(phase["forces"][0]) // 3, start=first)
            outlines.append(outline)
            packed.append(_integers_of(phase, outline, 2.0 ** -plan["force_bits"]))
        document["segments"].append({**segment, "phases": outlines})
    document["blocks"] = [1] * len(packed)
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("plan.json", json.dumps(document))
        for index, quantities in enumerate(packed):
            archive.writestr(f"motion/{index}", b"".join(_planes(q) for q in quantities))


def _planes(integers):
    zigzag = np.array([2 * k if k >= 0 else -2 * k - 1 for k in map(int, integers.ravel())],
                      np.uint64)
    count = (int(zigzag.max(initial=0)).bit_length() + 7) // 8
    planes = [(zigzag >> np.uint64(8 * plane)).astype(np.uint8).tobytes()
              for plane in range(count)]
    return bytes([count]) + b"".join(planes)


def _integers_of(phase, outline, force_step):
    """The integers of t, a, v, q, tau and forces."""
    a_step, v_step, q_step = (2.0 ** -bits for bits in outline["bits"])
    t, q, v, a, forces = (np.array(phase[key], float) for key in ("t", "q", "v", "a", "forces"))
    tau = np.array(phase.get("tau", np.zeros((len(t), 0))), float)
    steps = np.rint(np.diff(t) * 2.0 ** 40).astype(np.int64)
    h = steps * 2.0 ** -40
    a_integers = np.rint(a.T / a_step).astype(np.int64)
    a = a_integers * a_step
    change = packed_plan.rate_changes(a, h)
    rates, positions, rate, place = [], [], v[0], q[0]
    for k, duration in enumerate(h):
        rates.append(np.rint((v[k + 1] - rate - change[:, k]) / v_step))
        next_rate = rate + change[:, k] + rates[-1] * v_step
        moved = duration / 2 * (rate + next_rate) + duration**2 / 12 * (a[:, k] - a[:, k + 1])
        positions.append(np.rint((_difference(place, q[k + 1]) - moved) / q_step))
        moved += positions[-1] * q_step
        turned = packed_plan.turned(place[:4], moved[:3])
        rate, place = next_rate, np.concatenate([turned, place[4:] + moved[3:]])
    return [np.diff(steps, prepend=0), _differences(a_integers),
            np.array(rates).astype(np.int64).T, np.array(positions).astype(np.int64).T,
            _differences(np.rint(tau.T / (4 * force_step)).astype(np.int64)),
            _differences(np.rint(forces.T / force_step).astype(np.int64))]


def _differences(integers):
    for _ in range(3):
        integers = np.diff(integers, axis=1, prepend=0)
    return integers


def _difference(q0, q1):
    """Rotation vector from q0 to q1 in world axes, then the differences of all else."""
    w0, x0, y0, z0 = q0[:4] * [1, -1, -1, -1]
    right = np.array([[w0, -x0, -y0, -z0], [x0, w0, z0, -y0], [y0, -z0, w0, x0],
                      [z0, y0, -x0, w0]])
    turn = right @ (q1[:4] / np.linalg.norm(q1[:4]))
    turn *= np.sign(turn[0]) or 1
    sine = np.linalg.norm(turn[1:])
    angle = 2 * np.arctan2(sine, turn[0])
    return np.concatenate([turn[1:] * (angle / sine if sine > 0 else 2), q1[4:] - q0[4:]])
