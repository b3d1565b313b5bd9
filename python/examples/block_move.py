"""The least effort that moves a block of 1 kg by 1 m in 1 s, from rest to rest: 12."""

import possibility

problem = possibility.Problem("block move")
move = problem.phase("move", order=2, duration=1)
x = move.coordinate("x")
force = move.control("force", (-20, 20))
move.dynamics({x: force})
for end in ("start", "end"):
    move.fix(x.rate, 0, end)
move.fix(x, 0, "start")
move.fix(x, 1, "end")
move.integral_cost(force**2)
solution = problem.solve()
print(solution, "at 0.25 s:", solution(x, 0.25))
