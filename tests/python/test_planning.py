"""Planning, verification, margins and simulation."""

import json
import re
import subprocess

import numpy as np
import possibility
import pytest
from conftest import PROGRAM, one_line


def test_a_plan_is_found_and_verified(result):
    assert result.found and result.status == "found"
    assert result.verification.accepted
    assert result.plan.duration > 1
    assert {segment.action for segment in result.plan.segments} == {"walk"}
    assert result.timings["motion_s"] > 0
    assert result.statistics["vertices"] >= 2


def without_timings(file):
    text = file.read_text()
    return re.sub(r'"timings":\{[^}]*\}', "", text)


def test_the_program_writes_the_same_bytes(plan, tmp_path):
    """But for the measured times."""
    ours = plan.save(tmp_path / "ours")
    subprocess.run([PROGRAM, "plan", str(tmp_path / "ours/scenario.yaml"), "--threads", "1",
                    "--out", str(tmp_path / "theirs")], check=True, capture_output=True)
    theirs = (tmp_path / "theirs/plan.json")
    same_place = without_timings(theirs).replace("../ours/scenario.yaml", "scenario.yaml")
    assert same_place == without_timings(ours)


def test_the_same_seed_gives_the_same_plan(plan, description):
    again = possibility.plan(description, threads=1).plan
    assert np.array_equal(again.q, plan.q) and np.array_equal(again.tau, plan.tau)


def test_other_seeds_and_threads_are_accepted(description):
    result = possibility.plan(description, seed=11, threads=2, time_limit=50)
    assert result.found and result.plan.seed == 11


def test_progress_is_reported_from_the_calling_thread(description):
    reports = []
    possibility.plan(description, threads=1, progress=reports.append)
    stages = [report["stage"] for report in reports]
    assert "verifying" in stages
    assert all(0 <= report["fraction"] <= 1 for report in reports)


def test_what_progress_raises_ends_planning(description):
    class Enough(Exception):
        pass

    def refuse(report):
        raise Enough

    with pytest.raises(Enough):
        possibility.plan(description, threads=1, progress=refuse)


def test_a_closed_room_is_explained(description):
    walls = description["environment"]["obstacles"]
    walls.append({"name": "wall", "shape": "box", "size": [0.1, 3, 2], "position": [1.7, 1, 1]})
    description["goal"]["x"] = 2.4
    result = possibility.plan(description, threads=1)
    assert not result and result.status == "proven_infeasible"
    assert "wall" in result.explanation
    assert result.plan.segments == [] and result.plan.q.shape[0] == 0


def test_an_answer_no_has_nothing_to_verify_or_export(description, tmp_path):
    description["environment"]["obstacles"].append(
        {"name": "wall", "shape": "box", "size": [0.1, 3, 2], "position": [1.7, 1, 1]})
    description["goal"]["x"] = 2.4
    plan = possibility.plan(description, threads=1).plan
    for use in (possibility.verify, lambda p: p.export(npz=tmp_path / "a.npz")):
        with pytest.raises(possibility.InputError, match="no plan"):
            use(plan)


@pytest.mark.parametrize("options, expected", [
    ({"threads": 0}, "threads"),
    ({"threads": 1.5}, "threads"),
    ({"seed": -1}, "seed"),
    ({"seed": "one"}, "seed"),
    ({"time_limit": 0}, "time_limit"),
    ({"time_limit": float("inf")}, "time_limit"),
    ({"actions": ["crawl"]}, "'crawl' is not among"),
    ({"preset": "papers"}, "papers"),
    ({"library": "nowhere"}, "nowhere"),
])
def test_bad_options_are_refused_in_one_line(description, options, expected):
    with pytest.raises(possibility.InputError) as error:
        possibility.plan(description, **options)
    assert expected in one_line(error)


def test_a_start_in_collision_is_refused(description):
    description["environment"]["obstacles"][0]["position"] = [1, 1, 0.5]
    with pytest.raises(possibility.InputError) as error:
        possibility.plan(description, threads=1)
    assert "'pole'" in one_line(error)


def test_verify_accepts_the_plan(plan):
    verification = possibility.verify(plan, threads=1, simulate=False)
    assert verification and verification.violations == []
    assert verification.report["samples"] > 100


def test_verify_rejects_a_plan_whose_torques_were_changed(plan, tmp_path):
    file = plan.save(tmp_path)
    content = json.loads(file.read_text())
    content["segments"][0]["phases"][0]["tau"][3][0] += 5
    file.write_text(json.dumps(content))
    verification = possibility.verify(possibility.load_plan(tmp_path), simulate=False)
    assert not verification
    assert "dynamics" in {violation["kind"] for violation in verification.violations}


def test_margins_name_value_segment_and_time(plan):
    margins = possibility.margins(plan)
    assert 0 < margins["torque"]["value"] < 1
    assert 0 < margins["zmp"]["value"]
    assert 0 <= margins["torque"]["t"] <= plan.duration
    assert set(margins) == {"zmp", "ground_edge", "torque", "friction", "joint_speed",
                            "self_distance", "obstacle_distance"}


def test_a_rollout_survives_a_small_slope(plan):
    rollout = possibility.rollout(plan, mass=1.05, slope_deg=1)
    assert rollout.survives and rollout
    assert rollout.perturbation == {"mass": 1.05, "slope_deg": 1}
    assert rollout.stretches[0]["worst_position_m"] > 0


def test_a_rollout_falls_without_torque(plan):
    assert not possibility.rollout(plan, torque=0.02)


@pytest.mark.parametrize("perturbation, expected", [
    ({"weight": 1}, "weight"),
    ({"mass": 0}, "mass"),
    ({"mass": float("nan")}, "mass"),
])
def test_bad_perturbations_are_refused_in_one_line(plan, perturbation, expected):
    with pytest.raises(possibility.InputError) as error:
        possibility.rollout(plan, **perturbation)
    assert expected in one_line(error)
    assert "--perturb" not in str(error.value)
