#!/usr/bin/env python3
"""Another engine's opinion of a plan: DART looks at plan.json or plan.zip.

    check_plan.py PLAN [--rate HZ] [--json]

PLAN is a plan.json, a plan.zip or the folder of one. Shares no code with the project: it reads plan.json and
the two YAML files itself, DART parses the URDF, and kinematics, inverse dynamics, mass matrix,
Jacobians and forward dynamics are DART's. Needs Debian's python3-dartpy, python3-numpy and
python3-yaml.

Checked at every knot of every phase, and with --rate at that many instants a second between them:
nothing is left over on the six rows of the root under the plan's contact forces; joint torques are
the plan's and within the limits; joint ranges and speeds; contact forces push and stay within
friction; bearing points are on the ground, stay there and rest. Of the whole: phases join, DART's
own flight from a flight's first state lands where the plan lands, impacts obey DART's mass matrix.

Not looked at: start and goal, hashes, collisions, and joints that mimic others (refused).

Exit code 0 if DART agrees, 1 if not or if there is nothing it could look at; then one line on
standard error says what and where.

    check_plan.py      the program
    input_files.py     what it reads
    packed_plan.py     plan.zip
    motion.py          what a plan means between knots
    dart_robot.py      DART
    sample_checks.py   what is checked at every instant
    event_checks.py    joints between phases, impacts, flights
    findings.py        the worst of every check
    check_plan_test.py and the rest: its tests (tests/CMakeLists.txt)
"""

import argparse
import json
import sys
from dataclasses import asdict

sys.dont_write_bytecode = True  # the source tree stays as it is
try:
    from dart_robot import DartRobot
    from event_checks import check_continuity, check_flights, check_impacts
    from findings import Findings
    from input_files import InputError, read_plan
    from sample_checks import SampleChecks
except ImportError as error:
    sys.exit(f"check_plan.py: {error} (python3-dartpy, python3-numpy and python3-yaml are needed)")


def _rate(text):
    rate = float(text)
    if not 0 <= rate <= 1e5:
        raise ValueError
    return rate


class _OneLineParser(argparse.ArgumentParser):
    def error(self, message):
        print(f"{self.prog}: {message}", file=sys.stderr)
        sys.exit(1)


def _arguments(words):
    parser = _OneLineParser(prog="check_plan.py", description="Checks a plan with DART.")
    parser.add_argument("plan", help="a plan.json or plan.zip, or the folder of one")
    parser.add_argument("--rate", type=_rate, default=0.0, metavar="HZ",
                        help="samples a second between knots (0 to 1e5; default 0: knots alone)")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of a table")
    return parser.parse_args(words)


def _check(plan, rate):
    """(robot, findings, flights, number of samples)"""
    robot = DartRobot(plan.robot, plan.joints)
    findings = Findings()
    samples = SampleChecks(robot, plan, findings)
    samples.run(rate)
    check_continuity(plan, findings)
    check_impacts(robot, plan, findings)
    flights = check_flights(robot, plan, findings)
    return robot, findings, flights, samples.samples


def _print_table(findings, flights, samples):
    print(f"{samples} samples")
    for finding in findings.all.values():
        worst = "-" if finding.worst is None else f"{finding.worst:.3g}"
        limit = "-" if finding.limit is None else f"{finding.limit:.4g}"
        mark = "  FAILED" if finding.failed else ""
        print(f"{finding.check:<34} {worst:>9} of {limit:<9} {finding.unit:<11} "
              f"{finding.where}{mark}")
    for flight in flights:
        print(f"flight in segment {flight.segment}, {flight.start:.4f} to {flight.end:.4f} s: "
              f"lands {flight.position:.3g} m and {flight.angle:.3g} degrees from the plan")


def _print_json(file, robot, findings, flights, samples):
    checks = [{"check": f.check, "worst": f.worst, "limit": f.limit, "unit": f.unit,
               "segment": f.segment, "phase": f.phase, "time_s": f.time, "what": f.what,
               "failed": f.failed} for f in findings.all.values()]
    print(json.dumps({"plan": file, "accepted": findings.accepted, "samples": samples,
                      "weight_n": robot.weight, "checks": checks,
                      "flights": [asdict(flight) for flight in flights]}, indent=1))


def main(words):
    """Exit code."""
    arguments = _arguments(words)
    try:
        plan = read_plan(arguments.plan)
        robot, findings, flights, samples = _check(plan, arguments.rate)
    except InputError as error:
        print(f"check_plan.py: {error}", file=sys.stderr)
        return 1
    if arguments.json:
        _print_json(arguments.plan, robot, findings, flights, samples)
    else:
        _print_table(findings, flights, samples)
    if findings.accepted:
        return 0
    worst = findings.most_failed()
    print(f"check_plan.py: {arguments.plan}: {worst.check}: {worst.worst:.4g} {worst.unit}, limit "
          f"{worst.limit:.4g}: {worst.where}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
