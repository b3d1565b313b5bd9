"""Plans a walk through a room and draws the torques of the joints that work hardest."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import possibility

result = possibility.plan("experiments/scenarios/three_routes_a.yaml", actions=["walk"], seed=1)
plan = result.plan
hardest = abs(plan.tau).max(axis=0).argsort()[::-1][:4]
for joint in hardest:
    plt.plot(plan.t, plan.tau[:, joint], label=plan.joints[joint], linewidth=0.7)
plt.xlabel("time (s)")
plt.ylabel("torque (N m)")
plt.legend()
plt.savefig("joint_torques.png", dpi=120)
print(result, "-> joint_torques.png")
