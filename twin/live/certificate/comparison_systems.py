"""Three-by-three algebra of comparison systems, on plain floats: what bounds an error component by component.

If |e+| <= G |e| + g with G >= 0, the error stays under b = (I - G)^-1 g as soon as the greatest eigenvalue of
G is below one. Source: Berman & Plemmons (1994) Nonnegative Matrices in the Mathematical Sciences, ch. 6
(M-matrices).
"""

from collections.abc import Callable, Iterable

from twin.physics.maths import total

Row = tuple[float, float, float]
Matrix = tuple[Row, Row, Row]

AXES = (0, 1, 2)
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def row(entries: Iterable[float]) -> Row:
    """Three numbers as a row."""
    first, second, third = entries
    return first, second, third


def matrix(entry: Callable[[int, int], float]) -> Matrix:
    """The matrix of entry(i, j)."""
    first, second, third = (row(float(entry(i, j)) for j in AXES) for i in AXES)
    return first, second, third


def diagonal(d: Row) -> Matrix:
    """The matrix with this diagonal, zero elsewhere."""
    return matrix(lambda i, j: d[i] if i == j else 0.0)


def plus(*parts: Matrix) -> Matrix:
    """Sum of matrices."""
    return matrix(lambda i, j: total(p[i][j] for p in parts))


def scaled(factor: float, a: Matrix) -> Matrix:
    """A matrix times a number."""
    return matrix(lambda i, j: factor * a[i][j])


def scaled_row(factor: float, a: Row) -> Row:
    """A row times a number."""
    return factor * a[0], factor * a[1], factor * a[2]


def product(a: Matrix, b: Matrix) -> Matrix:
    """The matrix product A B."""
    return matrix(lambda i, j: total(a[i][k] * b[k][j] for k in AXES))


def apply(a: Matrix, x: Row) -> Row:
    """The matrix times a column, A x."""
    return row(a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2] for i in AXES)


def add(*rows: Row) -> Row:
    """Sum of rows."""
    return row(total(r[i] for r in rows) for i in AXES)


def inverse(a: Matrix) -> Matrix | None:
    """By cofactors; None when the matrix is singular."""
    c = matrix(lambda i, j: a[j - 2][i - 2] * a[j - 1][i - 1] - a[j - 2][i - 1] * a[j - 1][i - 2])
    det = total(a[0][k] * c[k][0] for k in AXES)
    return scaled(1.0 / det, c) if abs(det) > 1e-300 else None


def contracts(a: Matrix, under: float = 1.0) -> bool:
    """True when every eigenvalue of a matrix with no negative entry lies under a number: the minors of (under
    I - A) are positive.
    """
    (a00, a01, a02), (a10, a11, a12), (a20, a21, a22) = a
    p, q, r = under - a00, under - a11, under - a22
    second = p * q - a01 * a10
    third = r * second - a12 * (p * a21 + a01 * a20) - a02 * (a10 * a21 + q * a20)
    return p > 0.0 and second > 0.0 and third > 0.0


def radius(a: Matrix) -> float:
    """Greatest eigenvalue of a matrix with no negative entry (Perron), from above, to a part in 10^12;
    infinite where the minors are beyond what a double holds."""
    if not all(x < float("inf") for row in a for x in row):
        return float("inf")
    low, high = 0.0, max(max(map(max, a)), 1e-300)
    while not contracts(a, high):
        if high == float("inf"):
            return high
        low, high = high, 2.0 * high
    while high - low > 1e-12 * high:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (low, middle) if contracts(a, middle) else (middle, high)
    return high


def settled(g: Matrix) -> Matrix | None:
    """(I - G)^-1 when G is a contraction (its inverse then has no negative entry), else None."""
    return inverse(plus(IDENTITY, scaled(-1.0, g))) if contracts(g) else None


def beyond_first(a: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    """exp(a) - I - a for a square matrix of any size with no negative entry: the bend of a step beyond its
    first order.
    """
    axes = range(len(a))
    term, found = a, tuple(tuple(0.0 for _ in axes) for _ in axes)
    greatest = max(map(total, a))
    for k in range(2, 40):
        term = tuple(tuple(total(row[n] * a[n][j] for n in axes) / k for j in axes) for row in term)
        before, found = (
            found,
            tuple(tuple(x + y for x, y in zip(*rows, strict=True)) for rows in zip(found, term, strict=True)),
        )
        if found == before and k > greatest:  # nor do the smaller ones that come
            break
    return found
