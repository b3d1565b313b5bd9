"""Pieces of plans with one thing changed. check_plan.py must name the check that fails."""

import copy
import os

import plan_cases
from plan_cases import Packed, Spoilt, run_script


class SpoiltStride(Spoilt):
    @classmethod
    def setUpClass(cls):
        cls._original = cls.piece("three_routes_b", "walk", 6)

    def setUp(self):
        self.plan = copy.deepcopy(self._original)
        self.phases = self.plan["segments"][0]["phases"]
        # In the middle of the first phase on one foot.
        self.phase = next(p for p in self.phases if len(p["contacts"]) == 1)
        self.knot = len(self.phase["t"]) // 2

    def test_nothing_changed(self):
        knots = self.accepts(self.write(self.plan))["samples"]
        samples = self.accepts(self.write(self.plan), "--rate", "200")["samples"]
        self.assertGreater(samples, 2 * knots)

    def test_script(self):
        file = self.write(self.plan)
        outcome = run_script(file)
        self.assertEqual((outcome.code, outcome.err), (0, ""))
        for entry in self.accepts(file)["checks"]:
            self.assertIn(entry["check"], outcome.out)

    def test_force(self):
        forces = self.phase["forces"][self.knot]
        highest = max(range(2, len(forces), 3), key=lambda i: forces[i])
        forces[highest] *= 1.2
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots", "joint torque against the plan's")

    def test_sideways_force(self):
        forces = self.phase["forces"][self.knot]
        highest = max(range(2, len(forces), 3), key=lambda i: forces[i])
        forces[highest - 2] += 2 * forces[highest]
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots", "joint torque against the plan's",
                     "force outside its cone", "joint torque / limit")

    def test_torque(self):
        self.phase["tau"][self.knot][3] += 0.01
        self.refuses(self.write(self.plan), "joint torque against the plan's")

    def test_joint_acceleration(self):
        self.phase["a"][self.knot][6 + 3] += 0.01
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots", "joint torque against the plan's")

    def test_root_acceleration(self):
        self.phase["a"][self.knot][5] += 0.001
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots", "joint torque against the plan's")

    def test_stance_joint(self):
        stance = "L" if self.phase["contacts"][0].startswith("left") else "R"
        self.phase["q"][self.knot][7 + self.plan["joints"].index(stance + "AP")] += 0.02
        self.refuses_at_least(self.write(self.plan), "point away from where it began",
                              "point above or below ground")

    def test_joint_speed(self):
        self.phase["v"][self.knot][6 + self.plan["joints"].index("TSY")] = 50
        self.refuses_at_least(self.write(self.plan), "joint speed / limit")

    def test_joint_range(self):
        self.phase["q"][self.knot][7 + self.plan["joints"].index("LKP")] = -1
        self.refuses_at_least(self.write(self.plan), "joint beyond its range")

    def test_weaker_motors(self):
        robot = self.yaml_of(self.plan, "robot")
        for entry in robot["effort"]:
            entry["limit"] /= 2
        self.refuses(self.write(self.plan, robot), "joint torque / limit")

    def test_slippery_floor(self):
        robot = self.yaml_of(self.plan, "robot")
        robot["friction"] = 0.01
        self.refuses(self.write(self.plan, robot), "force outside its cone")

    def test_slippery_ground(self):
        scenario = self.yaml_of(self.plan, "scenario")
        for box in scenario["environment"]["ground"]:
            box["friction"] = 0.01
        self.refuses(self.write(self.plan, scenario=scenario), "force outside its cone")

    def test_longer_sole(self):
        robot = self.yaml_of(self.plan, "robot")
        for contact in robot["contacts"]:
            contact["points"][0][0] += 0.001
        self.refuses(self.write(self.plan, robot), "root torque left over at knots",
                     "joint torque against the plan's")

    def test_lower_floor(self):
        scenario = self.yaml_of(self.plan, "scenario")
        for box in scenario["environment"]["ground"]:
            box["position"][2] -= 0.002
        self.refuses(self.write(self.plan, scenario=scenario), "point above or below ground")

    def test_floor_elsewhere(self):
        scenario = self.yaml_of(self.plan, "scenario")
        for box in scenario["environment"]["ground"]:
            box["position"][1] += 50
        self.refuses(self.write(self.plan, scenario=scenario), "point beyond the ground's edge")

    def test_heavier_link(self):
        robot = self.yaml_of(self.plan, "robot")
        with open(robot["urdf"], encoding="utf-8") as stream:
            urdf = stream.read()
        robot["urdf"] = os.path.join(plan_cases.FOLDER, "heavier.urdf")
        with open(robot["urdf"], "w", encoding="utf-8") as stream:
            stream.write(urdf.replace('<mass value="3.858114"/>', '<mass value="3.859"/>', 1))
        self.refuses(self.write(self.plan, robot), "root force left over at knots")

    def test_phase_left_out(self):
        del self.phases[2]
        self.refuses_at_least(self.write(self.plan), "gap in time", "jump of q")


class SpoiltJump(Spoilt):
    @classmethod
    def setUpClass(cls):
        cls._original = cls.piece("double_jump", "jump")
        phases = cls._original["segments"][0]["phases"]
        flight = next(i for i, phase in enumerate(phases) if not phase["contacts"])
        cls._original["segments"][0]["phases"] = phases[flight - 1:flight + 2]

    def setUp(self):
        self.plan = copy.deepcopy(self._original)
        self.before, self.flight, self.landing = self.plan["segments"][0]["phases"]
        self.middle = len(self.flight["t"]) // 2

    def test_nothing_changed(self):
        self.accepts(self.write(self.plan), "--rate", "200")

    def test_flight_position(self):
        """The place of a flying robot does not affect forces. Only the integration detects it."""
        self.flight["q"][self.middle][4] += 0.005
        self.refuses(self.write(self.plan), "flight: root away on the way")

    def test_flight_orientation(self):
        """Turned about the vertical. Gravity looks the same, but the rotation is discontinuous."""
        c, s = 0.9999, 0.0141  # 1.6 degrees
        w, x, y, z = self.flight["q"][self.middle][:4]
        length = (c * c + s * s) ** 0.5
        turned = [c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w]
        self.flight["q"][self.middle][:4] = [value / length for value in turned]
        self.refuses_at_least(self.write(self.plan), "flight: root turned on the way")

    def test_flight_position_between_knots(self):
        """A tenth of a millimetre, which is too little for the comparison of poses."""
        self.flight["q"][self.middle][4] += 0.0001
        file = self.write(self.plan)
        self.accepts(file)
        self.refuses(file, "root force left over between", "root torque left over between",
                     options=("--rate", "500"))

    def test_take_off_velocity(self):
        self.before["v"][-1][5] += 0.01
        self.flight["v"][0][5] += 0.01
        self.refuses_at_least(self.write(self.plan), "flight: root away at landing",
                              "speed of a bearing point")

    def test_take_off_spin(self):
        self.before["v"][-1][0] += 0.1
        self.flight["v"][0][0] += 0.1
        self.refuses_at_least(self.write(self.plan), "flight: root turned at landing")

    def test_bouncing(self):
        self.landing["v"][0][5] += 5
        self.refuses_at_least(self.write(self.plan), "impact: speed of the points after",
                              "impact: gain of energy", "impact: momentum left over")

    def test_impulse(self):
        self.landing["impulses"][2] *= 1.2
        self.refuses(self.write(self.plan), "impact: momentum left over")

    def test_impulse_that_pulls(self):
        self.landing["impulses"][2] = -1
        self.refuses(self.write(self.plan), "impact: momentum left over",
                     "impact: impulse outside its cone")

    def test_impact_not_declared(self):
        del self.landing["impulses"]
        self.refuses(self.write(self.plan), "jump of v without impact")

    def test_script(self):
        self.landing["impulses"][2] *= 1.2
        outcome = run_script(self.write(self.plan))
        self.assertEqual(outcome.code, 1)
        self.assertIn("FAILED", outcome.out)
        self.assert_one_line(outcome.err)
        self.assertIn("impact: momentum left over", outcome.err)

    def test_force_in_flight(self):
        self.flight["forces"][0] = [0, 0, 1]
        self.refuses_input(self.write(self.plan), "segment 0, phase ", "forces")


class SpoiltPackedStride(Packed, SpoiltStride):
    pass


class SpoiltPackedJump(Packed, SpoiltJump):
    def test_flight_position_between_knots(self):
        """A thousandth of a millimetre."""
        self.flight["q"][self.middle][4] += 1e-6
        file = self.write(self.plan)
        self.accepts(file)
        self.refuses_at_least(file, "root force left over between", options=("--rate", "5000"))

    def test_force_in_flight(self):
        for forces in self.flight["forces"]:
            forces.extend([0, 0, 1])
        self.refuses_input(self.write(self.plan), "segment 0, phase ", "forces")


class SpoiltStrideWithoutTorques(Packed, Spoilt):
    options = ()

    def setUp(self):
        self.plan = self.piece("three_routes_b", "walk", 6)
        phases = self.plan["segments"][0]["phases"]
        self.phase = next(p for p in phases if len(p["contacts"]) == 1)
        self.knot = len(self.phase["t"]) // 2

    def test_nothing_changed(self):
        self.assertNotIn("tau", self.phase)
        self.accepts(self.write(self.plan), "--rate", "200")

    def test_force(self):
        self.phase["forces"][self.knot][2] += 10
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots")

    def test_joint_acceleration(self):
        self.phase["a"][self.knot][6 + 3] += 0.01
        self.refuses(self.write(self.plan), "root force left over at knots",
                     "root torque left over at knots")
