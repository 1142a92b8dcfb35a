"""Newton's method for points at equal distance from several supports, compiled.

The step is the shortest that solves the linearised equations d_k - d_0 = 0: with J the rows
g_k - g_0 of the gradients' differences, J = U S V^T by one-sided Jacobi rotations, which find even
small singular values to full relative precision.
"""

from __future__ import annotations

from math import sqrt

from decomp.carriers.compiled_carriers import Triple
from decomp.kernels.compiled import inner, scalar
from decomp.skeletons.balls.contact_rows import ContactRows
from decomp.skeletons.balls.supports import SupportTable, support
from decomp.vectors import Array, Ints

STEPS = 40
SWEEPS = 20
RANK = 1e-7
"""Directions in which the equations change less than this part of the most are left alone."""
AT_REST = 4e-16
"""Steps below this part of the size are the last ones; so large is the rounding of distances."""

FREE = 1e-3
"""Steps may be so much longer, as a part of the size, than half the distance."""
ORTHOGONAL = 1e-16
"""Cosine of the angle between columns of J below which they are not rotated: rounding."""
FAR = 1e300
"""Farther than anything."""
NOTHING = 1e-290
"""Products of columns that are no longer normal numbers."""

Balanced = tuple[float, float, float, float, float]


@inner
def orthogonalise(work: Array, rows: int) -> None:
    """Rotate the three columns of J, rows 0 to `rows` of `work`, until they are orthogonal.

    The rotations' product V is left in the three rows below. Column j of J is then s_j u_j.
    """
    for i in range(3):
        for j in range(3):
            work[rows + i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        turned = False
        for pair in range(3):
            i, j = (0 if pair < 2 else 1), (1 if pair == 0 else 2)
            a, b, c = 0.0, 0.0, 0.0
            for k in range(rows):
                a += work[k, i] * work[k, i]
                b += work[k, j] * work[k, j]
                c += work[k, i] * work[k, j]
            if abs(c) <= ORTHOGONAL * sqrt(a * b) or abs(c) < NOTHING:
                continue
            turned = True
            zeta = (b - a) / (2.0 * c)
            t = 1.0 / (abs(zeta) + sqrt(1.0 + zeta * zeta))
            if zeta < 0.0:
                t = -t
            cosine = 1.0 / sqrt(1.0 + t * t)
            sine = cosine * t
            for k in range(rows + 3):
                u, v = work[k, i], work[k, j]
                work[k, i] = cosine * u - sine * v
                work[k, j] = sine * u + cosine * v
        if not turned:
            break


@inner
def measure(
    table: SupportTable, contacts: ContactRows, first: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """Put distance and gradient of each support into columns 3 and 4 to 6 of the scratch.

    Contacts are read, and their feet brought up to date, from row `first` on.

    Returns:
        Mean, least and greatest distance.
    """
    which, feet, work = contacts.which, contacts.feet, contacts.work
    least, most, total = FAR, -FAR, 0.0
    for c in range(contacts.count):
        row = first + c
        away, gx, gy, gz, qx, qy, qz = support(
            table, which[row], x, y, z, feet[row, 0], feet[row, 1], feet[row, 2]
        )
        feet[row, 0], feet[row, 1], feet[row, 2] = qx, qy, qz
        work[c, 3], work[c, 4], work[c, 5], work[c, 6] = away, gx, gy, gz
        least, most, total = min(least, away), max(most, away), total + away
    return total / contacts.count, least, most


@inner
def differences(work: Array, rows: int) -> None:
    """Put J into the scratch, and rotate its columns until they are orthogonal."""
    for k in range(rows):
        for j in range(3):
            work[k, j] = work[k + 1, 4 + j] - work[0, 4 + j]
    orthogonalise(work, rows)


@inner
def newton_step(work: Array, rows: int) -> Triple:
    """The shortest step that solves the linearised equations, from J with orthogonal columns."""
    most = 0.0
    for j in range(3):
        square = 0.0
        for k in range(rows):
            square += work[k, j] * work[k, j]
        most = max(most, square)
    sx, sy, sz = 0.0, 0.0, 0.0
    for j in range(3):
        square, part = 0.0, 0.0
        for k in range(rows):
            square += work[k, j] * work[k, j]
            part += work[k, j] * (work[k + 1, 3] - work[0, 3])
        if square > RANK * RANK * most:
            part = -part / square
            sx += part * work[rows, j]
            sy += part * work[rows + 1, j]
            sz += part * work[rows + 2, j]
    return sx, sy, sz


@inner
def balance(
    table: SupportTable, contacts: ContactRows, first: int, x: float, y: float, z: float
) -> Balanced:
    """Move a point to where its supports are equally far, from where feet close by are known.

    Args:
        table: of supports.
        contacts: the point's, from row `first` on. The scratch is left with J's columns and V of
            the last step, and with the distances and gradients at the result.
        first: the row.
        x, y, z: the point.

    Returns:
        The point, its mean distance, and the largest difference of distances.
    """
    work, rows, size = contacts.work, contacts.count - 1, contacts.size
    for _ in range(STEPS):
        _, least, greatest = measure(table, contacts, first, x, y, z)
        differences(work, rows)
        if greatest - least <= AT_REST * max(size, abs(x), abs(y), abs(z)):
            # where the feet coincide gradients differ by rounding, and steps would be at random
            break
        sx, sy, sz = newton_step(work, rows)
        length = sqrt(sx * sx + sy * sy + sz * sz)
        # a step beyond the distance itself has left the neighbourhood where the sites are known
        limit = 0.5 * abs(least) + FREE * size
        scale = limit / length if length > limit else 1.0
        x, y, z = x + scale * sx, y + scale * sy, z + scale * sz
        if length <= AT_REST * size:
            break
    mean, least, greatest = measure(table, contacts, first, x, y, z)
    return x, y, z, mean, greatest - least


@scalar
def balance_all(
    table: SupportTable, contacts: ContactRows, points: Array, radius: Array, residual: Array
) -> None:
    """The same for points (k, 3), which are replaced; radius and residual (k,) are filled in."""
    for i in range(len(points)):
        x, y, z, mean, gap = balance(
            table, contacts, i * contacts.count, points[i, 0], points[i, 1], points[i, 2]
        )
        points[i, 0], points[i, 1], points[i, 2] = x, y, z
        radius[i], residual[i] = mean, gap


@scalar
def fields_at(
    table: SupportTable,
    which: Ints,
    points: Array,
    feet: Array,
    distance: Array,
    gradient: Array,
) -> None:
    """Distance (k,) and gradient (k, 3) of one support for each point; feet are replaced."""
    for i in range(len(points)):
        away, gx, gy, gz, qx, qy, qz = support(
            table,
            which[i],
            points[i, 0],
            points[i, 1],
            points[i, 2],
            feet[i, 0],
            feet[i, 1],
            feet[i, 2],
        )
        distance[i] = away
        gradient[i, 0], gradient[i, 1], gradient[i, 2] = gx, gy, gz
        feet[i, 0], feet[i, 1], feet[i, 2] = qx, qy, qz
