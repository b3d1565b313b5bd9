"""The way from (0, 10) to (10, 5) that a bead slides in the least time: 1.80160 s."""

import numpy as np
import possibility

problem = possibility.Problem("brachistochrone")
slide = problem.phase("slide", duration=(0.5, 10))
x, y, v = (slide.coordinate(name, (0, 50), scale=10) for name in "xyv")
angle = slide.control("angle", (0.01, 3.1))
slide.dynamics({x: v * np.sin(angle), y: -v * np.cos(angle), v: 9.80665 * np.cos(angle)})
for quantity, value in ((x, 0), (y, 10), (v, 0)):
    slide.fix(quantity, value, "start")
for quantity, value in ((x, 10), (y, 5)):
    slide.fix(quantity, value, "end")
slide.guess(angle, lambda share: 0.1 + 1.6 * share)
problem.cost(slide.duration)
solution = problem.solve(intervals=40, mesh_tolerance=1e-6)
print(solution)
