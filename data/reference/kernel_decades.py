"""Writes kernel-decades.csv and periodic-decades.csv: the kernels over 20 decades, from arithmetic with 100 digits.

Run with mpmath: `python data/reference/kernel_decades.py data/reference`; a few minutes. Every argument is exactly the
double that its printed form stands for. Values have 25 digits.
"""

import sys
from functools import lru_cache
from pathlib import Path

from mpmath import asinh, cos, erf, erfc, mp, mpf, nstr, pi, sqrt

mp.dps = 100
# Images and waves beyond this add less than 1e-40 to Ewald's sums.
REACH = 5


def corner(x, y):
    """An antiderivative of 1/r in x and in y."""
    along_y = x * asinh(y / abs(x)) if x else mpf(0)
    along_x = y * asinh(x / abs(y)) if y else mpf(0)
    return along_y + along_x


def square(x, y, d):
    """Integral of 1/r over the square of half side d, seen from the offset (x, y): Johnson (1985), Eq. 3.25."""
    a, b, c, e = x + d, x - d, y + d, y - d
    return corner(a, c) - corner(b, c) - corner(a, e) + corner(b, e)


def others(x, y):
    """All images but the nearest, and the background: Ewald's sum of a lattice of side 1, less 1/r."""
    root, r = sqrt(pi), sqrt(x * x + y * y)
    total = -2 - (erf(root * r) / r if r else mpf(2))
    along_x = [cos(2 * pi * i * x) for i in range(REACH + 1)]
    along_y = [cos(2 * pi * j * y) for j in range(REACH + 1)]
    for i in range(-REACH, REACH + 1):
        for j in range(-REACH, REACH + 1):
            if (i, j) != (0, 0):
                r = sqrt((x - i) ** 2 + (y - j) ** 2)
                total += erfc(root * r) / r
                # Sines cancel between waves of opposite sign.
                total += wave(i * i + j * j, mp.prec) * along_x[abs(i)] * along_y[abs(j)]
    return total


@lru_cache(maxsize=None)
def wave(squared, _precision):
    """The weight of a wave in Ewald's sum, by the square of its number."""
    k = sqrt(mpf(squared))
    return erfc(sqrt(pi) * k) / k


@lru_cache(maxsize=None)
def legendre(n):
    """Nodes and weights of n points on [-1, 1], by Newton's method."""
    nodes = []
    for i in range(n):
        x = cos(pi * (i + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(8):
            p, q = mpf(1), mpf(0)
            for k in range(n):
                p, q = ((2 * k + 1) * x * p - k * q) / (k + 1), p
            slope = n * (x * p - q) / (x * x - 1)
            x -= p / slope
        nodes.append((x, 2 / ((1 - x * x) * slope**2)))
    return nodes


def mean_of_others(x, y, d, n):
    """Integral of `others` over the square, by Gauss and Legendre with n² points: the integrand is smooth."""
    nodes = legendre(n)
    return d * d * sum(u * v * others(x - d * s, y - d * t) for s, u in nodes for t, v in nodes)


def periodic(x, y, d):
    """L_ij of Eq. 4-6 times pi, checked by a second number of points."""
    with mp.workdps(40):
        n = 4 if d < 5e-3 else 6 if d < 5e-2 else 10 if d < 0.2 else 16
        rest, check = mean_of_others(x, y, d, n), mean_of_others(x, y, d, n - 1)
    value = square(x, y, d) + rest
    assert abs(rest - check) < mpf(10) ** -16 * max(abs(value), 4 * d * d), (x, y, d, rest, check)
    return value


def write(path, header, rows):
    path.write_text("\n".join([header, *(",".join(row) for row in rows)]) + "\n")


def free_rows():
    for exponent in range(-10, 11):
        for mantissa in (1.0, 3.7):
            x = mantissa * 10.0**exponent
            for ratio in (0.0, 0.61, 1.0):
                y = ratio * x
                value = square(mpf(x), mpf(y), mpf(1)) / pi
                yield [repr(x), repr(y), "1.0", nstr(value, 25)]
    for exponent in range(-10, 11):
        # The same shape at every size, and one that touches the edge but for rounding.
        d = 10.0**exponent
        for x, y in ((1.3 * d, 0.2 * d), (0.999999999 * d, 0.4 * d)):
            yield [repr(x), repr(y), repr(d), nstr(square(mpf(x), mpf(y), mpf(d)) / pi, 25)]


def periodic_rows():
    for d in (0.25, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10):
        offsets = [(0.0, 0.0), (0.5, 0.5), (0.31, 0.17)]
        distance = 2.0 * d
        while distance < 0.5:
            offsets.append((distance, 0.25 * distance))
            distance *= 100.0
        for x, y in offsets:
            yield [repr(x), repr(y), repr(d), nstr(periodic(mpf(x), mpf(y), mpf(d)) / pi, 25)]
            print(d, x, y, flush=True)


def main():
    folder = Path(sys.argv[1])
    write(folder / "kernel-decades.csv", "x,y,half_side,displacement", list(free_rows()))
    write(folder / "periodic-decades.csv", "dx,dy,half_side,coefficient", list(periodic_rows()))


if __name__ == "__main__":
    main()
