"""Runs check_plan.py on plans that the built program makes, and on the same plans spoilt.

    check_plan_test.py PROGRAM FOLDER quick|long

FOLDER is emptied and used for the plans."""

import json
import os
import shutil
import sys
import unittest

import plan_cases
from bad_input import BadInput
from plan_cases import CheckCase, make_packed_plan, make_plan
from spoilt_plans import (SpoiltJump, SpoiltPackedJump, SpoiltPackedStride, SpoiltStride,
                          SpoiltStrideWithoutTorques)


class Agrees(CheckCase):
    def test_walking_and_crawling(self):
        report = self.accepts(make_plan("three_routes_b"))
        self.assertGreater(report["samples"], 1000)
        self.assertEqual(report["flights"], [])

    def test_tilted_ground(self):
        report = self.accepts(make_plan("debris"))
        self.assertGreater(report["samples"], 500)

    def test_jumping(self):
        report = self.accepts(make_plan("hallway"))
        self.assertGreaterEqual(len(report["flights"]), 1)
        for flight in report["flights"]:
            self.assertGreater(flight["end"] - flight["start"], 0.1)
            self.assertLess(flight["position"], 0.02)
            self.assertLess(flight["angle"], 3)


    def test_format_2_between_knots(self):
        for scenario in ("three_routes_b", "hallway"):
            report = self.accepts(make_packed_plan(scenario), "--rate", "500")
            limits = {entry["check"]: entry["limit"] for entry in report["checks"]}
            self.assertEqual(limits["root force left over between"], 1e-6)


class AgreesLong(CheckCase):
    """Every scenario that has a route over boxes, at the verifier's 5 ms."""

    def test_all_scenarios(self):
        for scenario in ("three_routes_a", "three_routes_b", "three_routes_c", "hallway",
                         "double_jump", "crack", "sill", "stones", "stairs", "ramp", "debris", "rubble",
                         "beam", "everything"):
            with self.subTest(scenario):
                report = self.accepts(make_plan(scenario), "--rate", "200")
                self.accepts(make_packed_plan(scenario), "--rate", "200")
                with open(os.path.join(make_plan(scenario), "plan.json"), encoding="utf-8") as file:
                    jumps = [s for s in json.load(file)["segments"]
                             if s["action"] in ("jump", "leap")]
                self.assertEqual(len(report["flights"]), len(jumps))


def main():
    if len(sys.argv) != 4 or sys.argv[3] not in ("quick", "long"):
        sys.exit(__doc__)
    plan_cases.PROGRAM = os.path.abspath(sys.argv[1])
    plan_cases.FOLDER = folder = os.path.abspath(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    cases = [AgreesLong] if sys.argv[3] == "long" else [
        Agrees, SpoiltStride, SpoiltJump, SpoiltPackedStride, SpoiltPackedJump,
        SpoiltStrideWithoutTorques, BadInput]
    suite = unittest.TestSuite(unittest.defaultTestLoader.loadTestsFromTestCase(case)
                               for case in cases)
    passed = unittest.TextTestRunner().run(suite).wasSuccessful()
    shutil.rmtree(folder)
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
