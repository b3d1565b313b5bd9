"""Files that check_plan.py cannot read give one line on standard error and exit code 1."""

import copy
import os

import plan_cases
from plan_cases import Spoilt, check, make_packed_plan


class BadInput(Spoilt):
    @classmethod
    def setUpClass(cls):
        cls._original = cls.piece("three_routes_b", "walk", 1)

    def setUp(self):
        self.plan = copy.deepcopy(self._original)

    def test_files(self):
        self.refuses_input(os.path.join(plan_cases.FOLDER, "no_such.json"), "no_such.json")
        self.refuses_input(plan_cases.FOLDER, "plan.json")
        broken = os.path.join(plan_cases.FOLDER, "broken.json")
        for text in ("", "{", "[" * 100000, "[]", "{\"format\": \"possibility-plan/2\"}", "\0",
                     "{\"format\": 1, \"format\": 1}"):
            with open(broken, "w", encoding="utf-8") as stream:
                stream.write(text)
            self.refuses_input(broken, "broken.json")
        with open(broken, "wb") as stream:
            stream.write(b"\xff\xfe\xfd")
        self.refuses_input(broken, "not UTF-8")

    def test_packed_files(self):
        with open(make_packed_plan("three_routes_b"), "rb") as stream:
            whole = stream.read()
        spoilt = os.path.join(plan_cases.FOLDER, "spoilt.zip")
        for change in (whole[:100], whole[:-100], whole[:200] + bytes([whole[200] ^ 0xFF]) + whole[201:],
                       whole.replace(b"motion/0", b"motion/9"), whole.replace(b"plan.json", b"plan.text")):
            with open(spoilt, "wb") as stream:
                stream.write(change)
            self.refuses_input(spoilt, "spoilt.zip", "possibility-plan/2")

    def test_options(self):
        for options in ((), ("--rate", "-1"), ("--rate", "nan"), ("--rate",), ("--no-such",)):
            outcome = check(*options)
            self.assertEqual((outcome.code, outcome.out), (1, ""))
            self.assert_one_line(outcome.err)

    def test_robot_not_found(self):
        self.plan["robot"]["file"] = "no_such_robot.yaml"
        self.refuses_input(self.write(self.plan), "no_such_robot.yaml")

    def test_urdf(self):
        robot = self.yaml_of(self.plan, "robot")
        for text, word in ((None, "no such file"), ("<robot", "not a URDF"),
                           ("<robot name=\"r\"/>", "DART cannot read it")):
            robot["urdf"] = os.path.join(plan_cases.FOLDER, "broken.urdf")
            if text is not None:
                with open(robot["urdf"], "w", encoding="utf-8") as stream:
                    stream.write(text)
            self.refuses_input(self.write(self.plan, robot), "broken.urdf", word)

    def test_joint_that_is_not_held(self):
        robot = self.yaml_of(self.plan, "robot")
        robot["lump"].remove("NKY")
        self.refuses_input(self.write(self.plan, robot), "NKY")

    def test_no_motion(self):
        self.plan["segments"] = []
        self.refuses_input(self.write(self.plan), "no motion")

    def test_contents(self):
        def infinite(phase):
            phase["q"][0][0] = float("inf")

        def ragged(phase):
            phase["v"][0].pop()

        def text(phase):
            phase["tau"][0][0] = "1"

        def standing_still(phase):
            phase["t"][1] = phase["t"][0]

        def long(phase):
            phase["q"][0][0] = 2

        def missing(phase):
            del phase["a"]

        def unknown_patch(phase):
            phase["contacts"][0] = "left_hand"

        def unknown_point(phase):
            phase["contacts"][0] = "left_sole[4]"

        def twice(phase):
            phase["contacts"][1] = phase["contacts"][0]

        def early_impact(phase):
            phase["impulses"] = [0] * len(phase["forces"][0])

        for spoil in (infinite, ragged, text, standing_still, long, missing, unknown_patch,
                      unknown_point, twice, early_impact):
            with self.subTest(spoil.__name__):
                plan = copy.deepcopy(self.plan)
                spoil(plan["segments"][0]["phases"][0])
                self.refuses_input(self.write(plan))

    def test_joints(self):
        self.plan["joints"][0] = "elbow"
        self.refuses_input(self.write(self.plan), "elbow")
