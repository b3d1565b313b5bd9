"""What the tests share. ctest names the project's folder and the program in the environment."""

import copy
import os
from pathlib import Path

import possibility
import pytest

ROOT = Path(os.environ["POSSIBILITY_SOURCE_DIR"])
PROGRAM = os.environ["POSSIBILITY_PROGRAM"]

SHORT_WALK = {
    "name": "short_walk", "robot": str(ROOT / "models/drchubo1/drchubo1.yaml"),
    "actions": ["walk"],
    "start": {"action": "walk", "x": 1, "y": 1, "yaw_deg": 0},
    "goal": {"action": "walk", "x": 1.4, "y": 1, "yaw_deg": 0},
    "time_limit": 60, "seed": 3,
    "environment": {"bounds": {"x": [0, 3], "y": [0, 2]},
                    "ground": [{"name": "floor", "size": [4, 3, 0.5], "position": [1.5, 1, -0.25]}],
                    "obstacles": [{"name": "pole", "shape": "cylinder", "radius": 0.05,
                                   "length": 1, "position": [2.5, 0.3, 0.5]}]},
}


@pytest.fixture
def description():
    """A scenario that plans in a moment, to be changed at will."""
    return copy.deepcopy(SHORT_WALK)


@pytest.fixture(scope="session")
def result():
    return possibility.plan(copy.deepcopy(SHORT_WALK), threads=1)


@pytest.fixture(scope="session")
def plan(result):
    assert result.found, result.explanation
    return result.plan


def one_line(error):
    """The message of an exception, which must be one line."""
    message = str(error.value)
    assert message and "\n" not in message
    return message
