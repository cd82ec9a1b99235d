#!/usr/bin/env python3
"""Fits polynomials to the colour map viridis: the coefficients of render/heat_scale.cpp.

Needs matplotlib, whose table it reads. Least squares, weighted anew until the greatest error is as
small as it gets; prints the coefficients of red, green and blue by rising power, and that error.
"""

from matplotlib import colormaps

DEGREE = 6
ROUNDS = 60


def solve(matrix):
    """Gauss-Jordan; the last column is the right side."""
    size = len(matrix)
    for a in range(size):
        pivot = max(range(a, size), key=lambda row: abs(matrix[row][a]))
        matrix[a], matrix[pivot] = matrix[pivot], matrix[a]
        for row in range(size):
            if row == a:
                continue
            factor = matrix[row][a] / matrix[a][a]
            for column in range(a, size + 1):
                matrix[row][column] -= factor * matrix[a][column]
    return [matrix[a][size] / matrix[a][a] for a in range(size)]


def fit(values):
    last, terms = len(values) - 1, range(DEGREE + 1)
    weights = [1.0] * len(values)
    for _ in range(ROUNDS):
        matrix = [[0.0] * (DEGREE + 2) for _ in terms]
        for k, value in enumerate(values):
            for a in terms:
                for b in terms:
                    matrix[a][b] += weights[k] * (k / last) ** (a + b)
                matrix[a][-1] += weights[k] * (k / last) ** a * value
        coefficients = solve(matrix)
        errors = [abs(sum(c * (k / last) ** a for a, c in enumerate(coefficients)) - value)
                  for k, value in enumerate(values)]
        weights = [weight * (0.2 + error / max(errors)) for weight, error in zip(weights, errors)]
        mean = sum(weights) / len(weights)
        weights = [weight / mean for weight in weights]
    return coefficients, max(errors)


def main():
    channels = [fit([color[channel] for color in colormaps["viridis"].colors]) for channel in range(3)]
    for powers in zip(*(coefficients for coefficients, _ in channels)):
        print("    {" + ", ".join(f"{c:.6f}" for c in powers) + "},")
    print(f"greatest error: {255 * max(error for _, error in channels):.2f} of 255")


if __name__ == "__main__":
    main()
