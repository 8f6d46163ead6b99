// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/far_off.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

double far_off(const DualQuaternion& T_a_b, const Answered& answered, const DiagnosisOptions& options) {
  const Vector6d difference = frame_a_difference(answered.T_a_b, T_a_b);
  double rotation = 0, translation = 0;
  for (int i = 0; i < 6; ++i) {
    if (!answered.observability.observable[static_cast<std::size_t>(i)]) continue;
    (i < 3 ? translation : rotation) += difference[i] * difference[i];
  }
  return std::max(std::sqrt(rotation) / options.tolerance_rotation,
                  std::sqrt(translation) / options.tolerance_translation);
}

double far_off(const Finding& finding, const Answered& answered, const DiagnosisOptions& options) {
  if (!finding.T_a_b) return finding.certain ? INFINITY : 0;
  return far_off(to_dual_quaternion(*finding.T_a_b), answered, options);
}

}  // namespace egocal::detail
