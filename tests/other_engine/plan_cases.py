"""Shared by the tests of check_plan.py: plans of the built program, and runs of the check."""

import contextlib
import io
import json
import os
import subprocess
import sys
import unittest
from dataclasses import dataclass

import check_plan
import packed_plan
import packing
import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
SCENARIOS = os.path.join(HERE, "..", "..", "experiments", "scenarios")
PROGRAM, FOLDER = "", ""


def make_plan(scenario):
    """The folder of the plan for experiments/scenarios/`scenario`.yaml."""
    folder = os.path.join(FOLDER, scenario)
    if not os.path.exists(folder):
        run = subprocess.run([PROGRAM, "plan", os.path.join(SCENARIOS, scenario + ".yaml"), "--out",
                              folder, "--seed", "1", "--time-limit", "600"],
                             capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"no plan for {scenario}: exit code {run.returncode}: {run.stderr}")
    return folder


def make_packed_plan(scenario, *options):
    """The same plan in format 2."""
    file = os.path.join(make_plan(scenario), "packed" + "".join(options) + ".zip")
    if not os.path.exists(file):
        run = subprocess.run([PROGRAM, "export", make_plan(scenario), "--plan", file, *options],
                             capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"no plan.zip of {scenario}: exit code {run.returncode}: {run.stderr}")
    return file


@dataclass
class Outcome:
    code: int
    out: str
    err: str


def check(*arguments):
    """Runs check_plan.py in this process, since loading DART takes longer than most checks."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = check_plan.main(arguments)
        except SystemExit as end:
            code = end.code
    return Outcome(code, out.getvalue(), err.getvalue())


def run_script(*arguments):
    """Runs check_plan.py as its users do."""
    run = subprocess.run([sys.executable, "-B", os.path.join(HERE, "check_plan.py"), *arguments],
                         capture_output=True, text=True, check=False)
    return Outcome(run.returncode, run.stdout, run.stderr)


class CheckCase(unittest.TestCase):
    def accepts(self, *arguments):
        outcome = check(*arguments, "--json")
        self.assertEqual((outcome.code, outcome.err), (0, ""))
        report = json.loads(outcome.out)
        self.assertTrue(report["accepted"])
        self.assertEqual(self.failing(report), set())
        return report

    @staticmethod
    def failing(report):
        return {entry["check"] for entry in report["checks"] if entry["failed"]}

    def refused(self, file, *options):
        """The checks that fail. One line names the place of the worst."""
        outcome = check(file, "--json", *options)
        self.assertEqual(outcome.code, 1, outcome.out)
        self.assert_one_line(outcome.err)
        self.assertRegex(outcome.err, r"limit .*: segment \d+ \(.*\), phase \d+, ")
        report = json.loads(outcome.out)
        self.assertFalse(report["accepted"])
        return self.failing(report)

    def assert_one_line(self, text):
        self.assertTrue(text.startswith("check_plan.py: "), text)
        self.assertEqual((text.count("\n"), text[-1]), (1, "\n"), text)

    def refuses(self, file, *failing, options=()):
        """Exactly these checks fail."""
        self.assertEqual(self.refused(file, *options), set(failing))

    def refuses_at_least(self, file, *failing, options=()):
        """These checks fail. Others may fail too, since one change spoils several things."""
        self.assertLessEqual(set(failing), self.refused(file, *options))

    def refuses_input(self, file, *words):
        outcome = check(file)
        self.assertEqual((outcome.code, outcome.out), (1, ""))
        self.assert_one_line(outcome.err)
        for word in words:
            self.assertIn(word, outcome.err)


class Spoilt(CheckCase):
    """Short pieces of plans, first as they are, then with one thing changed."""

    def write(self, plan, robot=None, scenario=None):
        """`plan` under this test's name, with another robot or scenario if given."""
        for key, node in (("robot", robot), ("scenario", scenario)):
            file = os.path.join(FOLDER, f"{self.id()}_{key}.yaml")
            if node is not None:
                with open(file, "w", encoding="utf-8") as stream:
                    yaml.safe_dump(node, stream)
                plan[key]["file"] = file
        return self.write_document(plan)

    def write_document(self, plan):
        file = os.path.join(FOLDER, f"{self.id()}.json")
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(json.dumps(plan))
        return file

    @staticmethod
    def document(scenario):
        with open(os.path.join(make_plan(scenario), "plan.json"), encoding="utf-8") as stream:
            return json.load(stream)

    @classmethod
    def piece(cls, scenario, action, phases=None):
        """A plan of one segment: the first of that action, or some of its phases."""
        plan = cls.document(scenario)
        for key in ("robot", "scenario"):
            plan[key]["file"] = os.path.normpath(
                os.path.join(make_plan(scenario), plan[key]["file"]))
        segment = next(s for s in plan["segments"] if s["action"] == action)
        segment["phases"] = segment["phases"][:phases]
        plan["segments"] = [segment]
        plan["explored"] = {"vertices": [], "edges": []}
        return plan

    @staticmethod
    def yaml_of(plan, key):
        with open(plan[key]["file"], encoding="utf-8") as stream:
            node = yaml.safe_load(stream)
        if key == "robot":
            node["urdf"] = os.path.join(os.path.dirname(plan[key]["file"]), node["urdf"])
        return node


class Packed:
    """Mixed into Spoilt, in front of it: the same in format 2."""

    options = ("--torques",)

    @classmethod
    def document(cls, scenario):
        return packed_plan.load(make_packed_plan(scenario, *cls.options))

    def write_document(self, plan):
        file = os.path.join(FOLDER, f"{self.id()}.zip")
        packing.pack(plan, file)
        return file
