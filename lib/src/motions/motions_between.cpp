// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "motions/motions_between.hpp"

namespace egocal {

namespace {

/// One number of sensor a and one of sensor b: a pose has some forty motions, and two cost as much as one.
using Both = Eigen::Array2d;

struct BothQuaternions {
  Both w, x, y, z;

  static BothQuaternions load(const QuaternionVector& a, const QuaternionVector& b) {
    return {{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}, {a[3], b[3]}};
  }
  QuaternionVector sensor(int i) const { return {w[i], x[i], y[i], z[i]}; }
};

/// conjugate(p) q.
[[gnu::always_inline]] inline BothQuaternions conjugate_product(const BothQuaternions& p,
                                                                const BothQuaternions& q) {
  return {p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z, p.w * q.x - p.x * q.w - p.y * q.z + p.z * q.y,
          p.w * q.y + p.x * q.z - p.y * q.w - p.z * q.x, p.w * q.z - p.x * q.y + p.y * q.x - p.z * q.w};
}

[[gnu::always_inline]] inline BothQuaternions operator+(const BothQuaternions& p, const BothQuaternions& q) {
  return {p.w + q.w, p.x + q.x, p.y + q.y, p.z + q.z};
}

[[gnu::always_inline]] inline BothQuaternions operator/(const BothQuaternions& p, const Both& s) {
  return {p.w / s, p.x / s, p.y / s, p.z / s};
}

[[gnu::always_inline]] inline Both dot(const BothQuaternions& p, const BothQuaternions& q) {
  return (p.w * q.w + p.y * q.y) + (p.x * q.x + p.z * q.z);
}

}  // namespace

detail::MotionsOfBoth detail::motions_between(const Instant& from, const Instant& to) {
  const auto from_real = BothQuaternions::load(from.a.real, from.b.real);
  const auto from_dual = BothQuaternions::load(from.a.dual, from.b.dual);
  const auto to_real = BothQuaternions::load(to.a.real, to.b.real);
  const auto to_dual = BothQuaternions::load(to.a.dual, to.b.dual);
  BothQuaternions real = conjugate_product(from_real, to_real);
  BothQuaternions dual = conjugate_product(from_real, to_dual) + conjugate_product(from_dual, to_real);
  const Both norm = dot(real, real).sqrt();
  // a half turn, or poses that are no rotations: rare enough to be taken step by step
  if (!(norm[0] > 0.5 && norm[0] < 2 && norm[1] > 0.5 && norm[1] < 2) || real.w[0] == 0 || real.w[1] == 0)
    return {motion_between(from.a, to.a), motion_between(from.b, to.b)};
  const double sign_a = real.w[0] > 0 ? 1 : -1, sign_b = real.w[1] > 0 ? 1 : -1;
  real = real / norm;
  dual = dual / norm;
  const Both along = dot(real, dual);
  const BothQuaternions level{dual.w - along * real.w, dual.x - along * real.x, dual.y - along * real.y,
                              dual.z - along * real.z};
  return {{real.sensor(0) * sign_a, level.sensor(0) * sign_a},
          {real.sensor(1) * sign_b, level.sensor(1) * sign_b}};
}

}  // namespace egocal
