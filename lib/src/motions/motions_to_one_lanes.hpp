// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions from several instants to one, a motion in each lane of a vector: the operations of
// detail::motions_between() and MotionSquare in the same order, hence the same bits. Included once for each
// processor, see problem/square_numbers.hpp. The namespace defines Lanes, lane_count, root(), gather() and
// store().

using Number = Lanes;
#include "problem/square_numbers.hpp"

struct Quaternions {
  Lanes w{}, x{}, y{}, z{};
};

/// poses: of each lane, 4 numbers each.
[[gnu::always_inline]] inline void load(const double* const* poses, Quaternions& to) {
  gather(poses, to.w, to.x, to.y, to.z);
}

[[gnu::always_inline]] inline void load_all(const double* pose, Quaternions& to) {
  for (int lane = 0; lane < lane_count; ++lane) {
    to.w[lane] = pose[0];
    to.x[lane] = pose[1];
    to.y[lane] = pose[2];
    to.z[lane] = pose[3];
  }
}

/// conjugate(p) q.
[[gnu::always_inline]] inline void conjugate_product(const Quaternions& p, const Quaternions& q,
                                                     Quaternions& to) {
  to.w = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
  to.x = p.w * q.x - p.x * q.w - p.y * q.z + p.z * q.y;
  to.y = p.w * q.y + p.x * q.z - p.y * q.w - p.z * q.x;
  to.z = p.w * q.z - p.x * q.y + p.y * q.x - p.z * q.w;
}

[[gnu::always_inline]] inline void divide(Quaternions& q, const Lanes& by) {
  q.w /= by;
  q.x /= by;
  q.y /= by;
  q.z /= by;
}

[[gnu::always_inline]] inline void multiply(Quaternions& q, const Lanes& by) {
  q.w *= by;
  q.x *= by;
  q.y *= by;
  q.z *= by;
}

[[gnu::always_inline]] inline void set_dot(const Quaternions& p, const Quaternions& q, Lanes& to) {
  to = (p.w * q.w + p.y * q.y) + (p.x * q.x + p.z * q.z);
}

/// Motions of one sensor. plain: cleared for lanes with a half turn, or with poses that are no rotations.
[[gnu::always_inline]] inline void motions(const double* const* from_real, const double* const* from_dual,
                                           const double* to_real, const double* to_dual, Quaternions& real,
                                           Quaternions& dual, bool* plain) {
  Quaternions p, p_dual, q, q_dual, more;
  load(from_real, p);
  load(from_dual, p_dual);
  load_all(to_real, q);
  load_all(to_dual, q_dual);
  conjugate_product(p, q, real);
  conjugate_product(p, q_dual, dual);
  conjugate_product(p_dual, q, more);
  dual.w += more.w;
  dual.x += more.x;
  dual.y += more.y;
  dual.z += more.z;
  Lanes norm{}, along{}, sign{};
  set_dot(real, real, norm);
  norm = root(norm);
  for (int lane = 0; lane < lane_count; ++lane) {
    plain[lane] = plain[lane] && norm[lane] > 0.5 && norm[lane] < 2 && real.w[lane] != 0;
    sign[lane] = real.w[lane] > 0 ? 1 : -1;
  }
  divide(real, norm);
  divide(dual, norm);
  set_dot(real, dual, along);
  dual.w -= along * real.w;
  dual.x -= along * real.x;
  dual.y -= along * real.y;
  dual.z -= along * real.z;
  multiply(real, sign);
  multiply(dual, sign);
}

/// Sets the difference of motions with scalars >= 0.
[[gnu::always_inline]] inline void set_difference(const Quaternions& a, const Quaternions& b,
                                                  Difference& to) {
  to.s = b.w - a.w;
  to.u[0] = b.x - a.x;
  to.u[1] = b.y - a.y;
  to.u[2] = b.z - a.z;
  to.w[0] = b.x + a.x;
  to.w[1] = b.y + a.y;
  to.w[2] = b.z + a.z;
}

[[gnu::always_inline]] inline void keep(const Lanes& value, double* to) {
  __builtin_memcpy(to, &value, sizeof value);
}

[[gnu::always_inline]] inline void keep_difference(const Difference& difference, int first,
                                                   std::array<double, MotionsToOne::count>* to) {
  keep(difference.s, to[0].data() + first);
  for (int i = 0; i < 3; ++i) {
    keep(difference.u[i], to[1 + i].data() + first);
    keep(difference.w[i], to[4 + i].data() + first);
  }
}

/// The motions of the lanes from `first` on.
inline void motions_to_one(const PosesOfMotions& poses, int first, MotionsToOne& result) {
  bool* const plain = result.plain.data() + first;
  for (int lane = 0; lane < lane_count; ++lane) plain[lane] = true;
  Quaternions a, a_dual, b, b_dual;
  motions(poses.from[0] + first, poses.from[1] + first, poses.to[0], poses.to[1], a, a_dual, plain);
  motions(poses.from[2] + first, poses.from[3] + first, poses.to[2], poses.to[3], b, b_dual, plain);
  double* to[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) {
    result.least_scalar.data()[first + lane] = b.w[lane] < a.w[lane] ? b.w[lane] : a.w[lane];
    to[lane] = poses.squares[first + lane];
  }
  Difference real, dual;
  set_difference(a, b, real);
  set_difference(a_dual, b_dual, dual);
  keep_difference(real, first, result.differences.data());
  keep_difference(dual, first, result.differences.data() + 7);
  Lanes numbers[36];
  set_all(dual, real, numbers);
  for (int column = 0; column < 8; ++column)
    for (int row = 0; row < 8; row += lane_count) {
      const Lanes* rows[lane_count];
      for (int k = 0; k < lane_count; ++k) rows[k] = numbers + number_at[8 * column + row + k];
      store(rows, to, 8 * column + row);
    }
}
