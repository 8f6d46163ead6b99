#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the egocal developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes six_pairs.txt: a small problem and every number on the way to its answer, in 50 digits with mpmath, from
the paper's formulas with dense 8 x 8 matrices. Shares no code with the library."""
from mpmath import mp, mpf, matrix, cos, sin, sqrt, eigsy, lu_solve

mp.dps = 50


def product(p, q):
    return [p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]]


def dual_product(p, q):
    real = product(p[:4], q[:4])
    dual = [x + y for x, y in zip(product(p[:4], q[4:]), product(p[4:], q[:4]))]
    return real + dual


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3], q[4], -q[5], -q[6], -q[7]]


def displacement(rotation, translation):
    angle = sqrt(sum(x * x for x in rotation))
    real = [cos(angle / 2)] + [sin(angle / 2) * x / angle for x in rotation]
    return real + [x / 2 for x in product([mpf(0)] + list(translation), real)]


def as_doubles(q):
    return [mpf(float(x)) for x in q]


def columns(linear):
    """The matrix of a linear map of eight numbers."""
    M = matrix(8, 8)
    for j in range(8):
        image = linear([mpf(1) if i == j else mpf(0) for i in range(8)])
        for i in range(8):
            M[i, j] = image[i]
    return M


T = displacement([mpf(3) / 10, -mpf(2) / 10, mpf(5) / 10], [mpf(1), mpf(2), -mpf(1) / 2])
pairs = []
for k in range(1, 7):
    b = displacement([sin(mpf(k)) / 5, cos(mpf(2 * k)) / 5, sin(mpf(3 * k)) / 3],
                     [1 + sin(mpf(5 * k)) / 10, cos(mpf(7 * k)) / 5, sin(mpf(11 * k)) / 5])
    error = displacement([sin(mpf(13 * k)) / 500, cos(mpf(17 * k)) / 500, sin(mpf(19 * k)) / 500],
                         [sin(mpf(23 * k)) / 100, cos(mpf(29 * k)) / 100, sin(mpf(31 * k)) / 100])
    a = dual_product(dual_product(dual_product(T, b), conjugate(T)), error)
    pairs.append((as_doubles(a), as_doubles(b)))

rotation_weight, translation_weight = mpf(1), mpf(1) / 4
Q, S = matrix(8, 8), matrix(8, 8)
for a, b in pairs:
    M = columns(lambda q: [x - y for x, y in zip(dual_product(q, b), dual_product(a, q))])  # (14)
    for i in range(8):
        for j in range(8):
            real = sum(M[k, i] * M[k, j] for k in range(4))
            dual = sum(M[k, i] * M[k, j] for k in range(4, 8))
            S[i, j] += dual
            Q[i, j] += (rotation_weight * real + translation_weight * dual) / len(pairs)  # (15), (16)

# Newton on the KKT system of (18): Z q = 0, |r| = 1, r . d = 0
q = matrix(T)
l1, l2 = mpf(0), mpf(0)
for _ in range(40):
    Z = Q.copy()
    for i in range(4):
        Z[i, i] -= l1
        Z[i, i + 4] += l2
        Z[i + 4, i] += l2
    K, right = matrix(10, 10), matrix(10, 1)
    Zq = Z * q
    for i in range(8):
        for j in range(8):
            K[i, j] = Z[i, j]
        right[i] = -Zq[i]
    for i in range(4):
        K[i, 8] = K[8, i] = -q[i]
        K[i, 9] = K[9, i] = q[i + 4]
        K[i + 4, 9] = K[9, i + 4] = q[i]
    right[8] = (sum(q[i] * q[i] for i in range(4)) - 1) / 2
    right[9] = -sum(q[i] * q[i + 4] for i in range(4))
    step = lu_solve(K, right)
    for i in range(8):
        q[i] += step[i]
    l1 += step[8]
    l2 += step[9]
Z = Q.copy()
for i in range(4):
    Z[i, i] -= l1
    Z[i, i + 4] += l2
    Z[i + 4, i] += l2
least = min(eigsy(Z, eigvals_only=True))
assert least > -mpf(10) ** -40, least  # positive semidefinite: q is the global minimum and l1 its bound
cost = (q.T * Q * q)[0]
assert abs(cost - l1) < mpf(10) ** -40


def line(numbers):
    return " ".join(mp.nstr(x, 20, min_fixed=0, max_fixed=0) for x in numbers) + "\n"


with open("six_pairs.txt", "w") as out:
    out.write("# written by make.py\n# weights of rotation and translation\n" + line([rotation_weight, translation_weight]))
    out.write("# motions of a, then of b: w x y z real, w x y z dual\n")
    for a, b in pairs:
        out.write(" ".join(repr(float(x)) for x in a + b) + "\n")
    out.write("# sum of M_d'M_d over the pairs\n")
    for i in range(8):
        out.write(line(S[i, j] for j in range(8)))
    out.write("# Q (16)\n")
    for i in range(8):
        out.write(line(Q[i, j] for j in range(8)))
    out.write("# the minimiser of (18)\n" + line(q))
    out.write("# multipliers (28): lambda_1, which is the greatest lower bound and the least cost, and lambda_2\n" + line([l1, l2]))
    out.write("# Z (21)\n")
    for i in range(8):
        out.write(line(Z[i, j] for j in range(8)))
