"""Robots and scenarios, from files and from dicts, and what is said about bad ones."""

import numpy as np
import possibility
import pytest
from conftest import ROOT, one_line

ROBOT = ROOT / "models/drchubo1/drchubo1.yaml"


def test_a_robot_has_names_and_limits():
    robot = possibility.load_robot(ROBOT)
    assert len(robot.joints) == 27
    assert set(robot.gaits) >= {"walk", "crawl"}
    assert "left_sole" in robot.contacts
    assert robot.limits["LKP"]["lower"] < robot.limits["LKP"]["upper"]
    assert robot.mass == pytest.approx(43.98, abs=0.01)


def test_a_robot_has_the_actuators_of_its_file(tmp_path):
    assert possibility.load_robot(ROBOT).actuators == {}
    text = ROBOT.read_text().replace("urdf: ", f"urdf: {ROBOT.parent}/")
    file = tmp_path / "robot.yaml"
    file.write_text(text + "actuators: [{joints: [LKP], armature: 0.3, dry_friction: 2, "
                           "stall_torque: 150, no_load_speed: 20, reason: assumed}]\n")
    assert possibility.load_robot(file).actuators == {"LKP": {
        "armature": 0.3, "viscous_friction": 0, "dry_friction": 2, "dry_speed": 0.1,
        "stall_torque": 150, "no_load_speed": 20}}


def test_a_missing_robot_is_an_input_error():
    with pytest.raises(possibility.InputError) as error:
        possibility.load_robot("nowhere.yaml")
    assert "nowhere.yaml" in one_line(error)


def test_input_errors_are_value_errors():
    with pytest.raises(ValueError):
        possibility.load_scenario("nowhere.yaml")


def test_a_scenario_comes_from_a_file():
    scenario = possibility.load_scenario(ROOT / "experiments/scenarios/three_routes_b.yaml")
    assert scenario.name == "three_routes_b"
    assert scenario.actions == ["walk", "crawl"]
    assert scenario.start["x"] == 1.1
    assert scenario.goals[0]["action"] == "walk"


def test_a_scenario_comes_from_a_dict(description):
    scenario = possibility.scenario(description)
    assert (scenario.name, scenario.seed, scenario.time_limit) == ("short_walk", 3, 60)
    assert scenario.goals == [{"action": "walk", "x": 1.4, "y": 1, "z": 0, "yaw": 0}]


def test_a_dict_may_hold_arrays_and_paths(description):
    description["robot"] = ROBOT
    description["environment"]["ground"][0]["size"] = np.array([4, 3, 0.5])
    description["seed"] = np.int64(5)
    assert possibility.scenario(description).seed == 5


def test_paths_in_a_dict_start_from_the_folder(description):
    description["robot"] = "drchubo1.yaml"
    scenario = possibility.scenario(description, folder=ROBOT.parent)
    assert scenario.robot_file == str(ROBOT)


@pytest.mark.parametrize("change, expected", [
    (lambda d: d.pop("start"), "'start' is missing"),
    (lambda d: d.update(sead=1), "sead"),
    (lambda d: d["start"].update(x="far"), "start.x: expected a number"),
    (lambda d: d["start"].update(x=9), "outside environment.bounds"),
    (lambda d: d.update(actions=["wlak"]), "walk"),
    (lambda d: d["environment"]["ground"][0].update(size=[1, 2]), "size"),
    (lambda d: d.update(seed=-1), "seed"),
    (lambda d: d.update(time_limit=float("nan")), "time_limit"),
])
def test_a_bad_dict_is_refused_in_one_line(description, change, expected):
    change(description)
    with pytest.raises(possibility.InputError) as error:
        possibility.scenario(description)
    message = one_line(error)
    assert expected in message
    assert message.startswith("scenario") and "/tmp" not in message


def test_what_is_no_number_text_or_list_is_refused(description):
    description["seed"] = object()
    with pytest.raises(TypeError, match="scenario: a object"):
        possibility.scenario(description)


def test_an_unknown_robot_is_refused_when_planning(description):
    description["robot"] = "nowhere.yaml"
    with pytest.raises(possibility.InputError) as error:
        possibility.plan(description)
    assert "nowhere.yaml" in one_line(error)
