// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "robust/disagreements.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "problem/wide_lanes.hpp"
#include "robust/residual_limit.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t count = MotionsToOne::count;
using Numbers = std::array<double, count>;
/// Made of pairs where the processor has no wide vectors.
using Lanes [[gnu::vector_size(sizeof(Numbers))]] = double;

/// As QuaternionDifference (problem/motion_square.hpp).
struct Difference {
  Lanes s, u[3], w[3];
};

[[gnu::always_inline]] inline void load(const Numbers& from, Lanes& to) {
  std::memcpy(&to, from.data(), sizeof to);
}

[[gnu::always_inline]] inline void load(const Numbers* from, Difference& to) {
  load(from[0], to.s);
  for (int i = 0; i < 3; ++i) {
    load(from[1 + i], to.u[i]);
    load(from[4 + i], to.w[i]);
  }
}

/// E x.
[[gnu::always_inline]] inline void multiply(const Difference& e, const Lanes* x, Lanes* to) {
  to[0] = e.s * x[0] - (e.u[0] * x[1] + e.u[1] * x[2] + e.u[2] * x[3]);
  to[1] = e.s * x[1] + e.u[0] * x[0] - (e.w[1] * x[3] - e.w[2] * x[2]);
  to[2] = e.s * x[2] + e.u[1] * x[0] - (e.w[2] * x[1] - e.w[0] * x[3]);
  to[3] = e.s * x[3] + e.u[2] * x[0] - (e.w[0] * x[2] - e.w[1] * x[1]);
}

[[gnu::always_inline]] inline void set_squared_size(const Difference& e, Lanes& to) {
  const Lanes uu = e.u[0] * e.u[0] + e.u[1] * e.u[1] + e.u[2] * e.u[2],
              ww = e.w[0] * e.w[0] + e.w[1] * e.w[1] + e.w[2] * e.w[2];
  to = 4 * e.s * e.s + 2 * (uu + ww);
}

[[gnu::always_inline]] inline void set_squared_norm(const Lanes* x, Lanes& to) {
  to = (x[0] * x[0] + x[2] * x[2]) + (x[1] * x[1] + x[3] * x[3]);
}

/// The agreements, one in each lane.
struct Agreements {
  Lanes real[4], dual[4], absolute, relative;
};

[[gnu::always_inline]] inline void load(const std::array<const Agreement*, count>& from,
                                        const ConsensusOptions& options, Agreements& to) {
  for (std::size_t lane = 0; lane < count; ++lane) {
    const Agreement& agreement = *from[lane];
    for (int i = 0; i < 4; ++i) {
      to.real[i][lane] = agreement.q.real[i];
      to.dual[i][lane] = agreement.q.dual[i];
    }
    to.absolute[lane] = agreement.scale.absolute;
    to.relative[lane] = std::max(agreement.scale.relative, options.least_relative);
  }
}

[[gnu::always_inline]] inline void set_disagreements(const MotionsToOne& motions,
                                                     const std::array<const Agreement*, count>& agreements,
                                                     const Balance& balance, const ConsensusOptions& options,
                                                     double limit, Numbers& result) {
  Difference real, dual;
  load(motions.differences.data(), real);
  load(motions.differences.data() + 7, dual);
  Agreements agreed;
  load(agreements, options, agreed);
  Lanes rotation, size, across[4], more[4], of_translation, of_rotation;
  set_squared_size(real, rotation);
  set_squared_size(dual, size);
  size = balance.translation * size + balance.rotation * rotation;
  multiply(dual, agreed.real, across);
  multiply(real, agreed.dual, more);
  for (int i = 0; i < 4; ++i) across[i] += more[i];
  set_squared_norm(across, of_translation);
  multiply(real, agreed.real, across);
  set_squared_norm(across, of_rotation);
  const Lanes residual = balance.translation * of_translation + balance.rotation * of_rotation;
  const Lanes absolute = residual / agreed.absolute, relative = residual / (size * agreed.relative);
  for (std::size_t lane = 0; lane < count; ++lane)
    result[lane] = size[lane] > 0 ? std::min(absolute[lane], relative[lane]) / limit : 0;
}

#ifdef EGOCAL_WIDE_LANES
[[gnu::target("avx2")]] void set_disagreements_widely(const MotionsToOne& motions,
                                                      const std::array<const Agreement*, count>& agreements,
                                                      const Balance& balance, const ConsensusOptions& options,
                                                      double limit, Numbers& result) {
  set_disagreements(motions, agreements, balance, options, limit, result);
}
#endif

}  // namespace

std::array<double, MotionsToOne::count> disagreements(
    const MotionsToOne& motions, const std::array<const Agreement*, MotionsToOne::count>& agreements,
    const Balance& balance, const ConsensusOptions& options, [[maybe_unused]] bool in_pairs) {
  Numbers result;
  const double limit = excess_limit(1, options);
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes()) {
    set_disagreements_widely(motions, agreements, balance, options, limit, result);
    return result;
  }
#endif
  set_disagreements(motions, agreements, balance, options, limit, result);
  return result;
}

}  // namespace egocal::detail
