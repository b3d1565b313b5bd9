"""The van der Pol oscillator (Vassiliadis 1993): 2.86726."""

import possibility

problem = possibility.Problem("van der Pol")
settle = problem.phase("settle", order=2, duration=5)
x = settle.coordinate("x")
u = settle.control("u", (-0.3, 1))
settle.dynamics({x: (1 - x**2) * x.rate - x + u})
settle.fix(x, 1, "start")
settle.fix(x.rate, 0, "start")
settle.integral_cost(x**2 + x.rate**2 + u**2)
solution = problem.solve(intervals=80)
print(solution)
