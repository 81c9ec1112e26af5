"""Ridge regression on evidence that fades, in plain floats: the same on every machine."""

from math import sqrt

from twin.physics.maths import dot, total

NOISE_S = 0.75  # time over which noise hangs together, in L/U_0
MEMORY, SPREAD, GATE = 20.0, 1.5, 3.0  # time constants, in L/U_0
HINDSIGHT = 1.0  # the gate asks numbers at least as old as this, in L/U_0
LARGEST = 5.0  # force scales that a regressor may be


def factor(information: list[list[float]], prior: list[float]) -> list[list[float]]:
    """L of I + diag(prior) = L L' (Cholesky)."""
    L: list[list[float]] = []
    for i, (line, least) in enumerate(zip(information, prior, strict=True)):
        row: list[float] = []
        for j in range(i):
            row.append((line[j] - dot(row, L[j])) / L[j][j])
        row.append(sqrt(line[i] + least - dot(row, row)))
        L.append(row)
    return L


def solve(L: list[list[float]], b: list[float]) -> list[float]:
    """x of L L' x = b."""
    x: list[float] = []
    for row, y in zip(L, b, strict=True):
        x.append((y - dot(row, x)) / row[-1])
    for i in range(len(b) - 1, -1, -1):
        x[i] = (x[i] - total([L[k][i] * x[k] for k in range(i + 1, len(b))])) / L[i][i]
    return x


def deviations(L: list[list[float]]) -> list[float]:
    """Square roots of the diagonal of (L L')^-1: the columns of L^-1 by their lengths."""
    n, inverse = len(L), [[0.0] * len(L) for _ in L]
    for i, row in enumerate(L):
        for j in range(i):
            inverse[i][j] = -total([row[k] * inverse[k][j] for k in range(j, i)]) / row[i]
        inverse[i][i] = 1.0 / row[i]
    return [sqrt(total([inverse[k][i] ** 2 for k in range(i, n)])) for i in range(n)]
