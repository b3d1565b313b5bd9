"""A scenario that is built in code, planned, verified and simulated on another slope."""

import possibility

scenario = possibility.scenario({
    "name": "short_walk", "robot": "models/drchubo1/drchubo1.yaml", "actions": ["walk"],
    "start": {"action": "walk", "x": 1, "y": 1, "yaw_deg": 0},
    "goal": {"action": "walk", "x": 1.6, "y": 1, "yaw_deg": 0},
    "environment": {"bounds": {"x": [0, 3], "y": [0, 2]},
                    "ground": [{"name": "floor", "size": [4, 3, 0.5],
                                "position": [1.5, 1, -0.25]}]},
})
plan = possibility.plan(scenario, seed=1, time_limit=30).plan
print(plan, possibility.verify(plan))
print("torque used:", round(possibility.margins(plan)["torque"]["value"], 2))
print(possibility.rollout(plan, mass=1.05, slope_deg=1))
