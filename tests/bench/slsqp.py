#!/usr/bin/env python3
"""Solves by SciPy's SLSQP what a god-object solves: slsqp.py FILE

A line holds the point that is to be reached, the answer, and up to three unit normals: nine numbers or more. Prints
the largest distance between that answer and SLSQP's; exits with 77 where there is no SciPy.
"""

import sys

try:
    import numpy
    from scipy.optimize import minimize
except ImportError:
    sys.exit(77)


def nearest(goal, normals):
    found = minimize(
        lambda x: ((x - goal) ** 2).sum(), numpy.zeros(3), jac=lambda x: 2 * (x - goal), method="SLSQP",
        constraints={"type": "ineq", "fun": lambda x: normals @ x, "jac": lambda _: normals},
        options={"ftol": 1e-20, "maxiter": 200})
    return found.x


def main():
    worst = 0
    with open(sys.argv[1], encoding="utf-8") as file:
        for line in file:
            numbers = numpy.array([float(word) for word in line.split()]).reshape(-1, 3)
            worst = max(worst, numpy.linalg.norm(nearest(numbers[0], numbers[2:]) - numbers[1]))
    print(worst)


if __name__ == "__main__":
    main()
