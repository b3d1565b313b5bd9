"""Plans a walk through a room and draws the torques of the joints that work hardest,
for the first 6 s."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import possibility

result = possibility.plan("experiments/scenarios/three_routes_a.yaml", actions=["walk"], seed=1)
plan = result.plan
start = plan.t < 6
for joint in abs(plan.tau).max(axis=0).argsort()[-4:]:
    plt.plot(plan.t[start], plan.tau[start, joint], label=plan.joints[joint])
plt.xlabel("time (s)")
plt.ylabel("torque (N m)")
plt.legend()
plt.savefig("joint_torques.png", dpi=120)
print(result, "-> joint_torques.png")
