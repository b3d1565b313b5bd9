"""Writes a plan for other programs, and reads the arrays back."""

import numpy as np
import possibility

plan = possibility.load_plan("plan")
plan.export(npz="walk.npz", csv="walk_tables", mujoco="walk.xml", period=0.01, margins=True)
arrays = np.load("walk.npz")
print(arrays["q"].shape, arrays["tau_names"][:3])
plan.view("walk.html")
