// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The 36 numbers of a motion's square, for one motion or for several in the lanes of a vector: the same
// operations, hence the same bits. Included once for each kind of Number, within a namespace that defines it,
// as code that is compiled for other processors cannot be shared as a template.

/// As QuaternionDifference (problem/motion_square.hpp).
struct Difference {
  Number s, u[3], w[3];
};

/// E'E = s^2 I - K^2. Number by number, as temporary matrices and loops over three axes cost more than the
/// arithmetic.
[[gnu::always_inline]] inline void set_square(const Difference& e, Number* to) {
  const Number ss = e.s * e.s, u0 = e.u[0], u1 = e.u[1], u2 = e.u[2], w0 = e.w[0], w1 = e.w[1], w2 = e.w[2];
  const Number sw = ss + (w0 * w0 + w1 * w1 + w2 * w2);
  to[0] = ss + (u0 * u0 + u1 * u1 + u2 * u2);
  to[1] = w1 * u2 - w2 * u1;
  to[2] = w2 * u0 - w0 * u2;
  to[3] = w0 * u1 - w1 * u0;
  to[4] = sw + u0 * u0 - w0 * w0;
  to[5] = sw + u1 * u1 - w1 * w1;
  to[6] = sw + u2 * u2 - w2 * w2;
  to[7] = u0 * u1 - w0 * w1;
  to[8] = u0 * u2 - w0 * w2;
  to[9] = u1 * u2 - w1 * w2;
}

/// E_d' E_r = (s_d I - K_d)(s_r I + K_r).
[[gnu::always_inline]] inline void set_product(const Difference& d, const Difference& r, Number* to) {
  const Number d0 = d.u[0], d1 = d.u[1], d2 = d.u[2], r0 = r.u[0], r1 = r.u[1], r2 = r.u[2];
  const Number dw0 = d.w[0], dw1 = d.w[1], dw2 = d.w[2], rw0 = r.w[0], rw1 = r.w[1], rw2 = r.w[2];
  const Number u0 = d.s * r0 - r.s * d0, u1 = d.s * r1 - r.s * d1, u2 = d.s * r2 - r.s * d2;
  const Number w0 = d.s * rw0 - r.s * dw0, w1 = d.s * rw1 - r.s * dw1, w2 = d.s * rw2 - r.s * dw2;
  const Number ss = d.s * r.s, sw = ss + (dw0 * rw0 + dw1 * rw1 + dw2 * rw2);
  to[0] = ss + (d0 * r0 + d1 * r1 + d2 * r2);
  to[1] = (rw1 * d2 - rw2 * d1) - u0;
  to[2] = (rw2 * d0 - rw0 * d2) - u1;
  to[3] = (rw0 * d1 - rw1 * d0) - u2;
  to[4] = u0 + (dw1 * r2 - dw2 * r1);
  to[5] = u1 + (dw2 * r0 - dw0 * r2);
  to[6] = u2 + (dw0 * r1 - dw1 * r0);
  to[7] = sw + d0 * r0 - rw0 * dw0;
  to[8] = sw + d1 * r1 - rw1 * dw1;
  to[9] = sw + d2 * r2 - rw2 * dw2;
  // -[w]x holds +w_i at (j, k) and -w_i at (k, j)
  to[10] = d1 * r2 - rw1 * dw2 + w0;
  to[11] = d2 * r1 - rw2 * dw1 - w0;
  to[12] = d2 * r0 - rw2 * dw0 + w1;
  to[13] = d0 * r2 - rw0 * dw2 - w1;
  to[14] = d0 * r1 - rw0 * dw1 + w2;
  to[15] = d1 * r0 - rw1 * dw0 - w2;
}

/// E_d'E_d, E_d'E_r and E_r'E_r: the upper triangles and all of the product, in the places that
/// square_places (problem/motion_square.hpp) gives.
[[gnu::always_inline]] inline void set_all(const Difference& dual, const Difference& real, Number* to) {
  set_square(dual, to);
  set_product(dual, real, to + 10);
  set_square(real, to + 26);
}
