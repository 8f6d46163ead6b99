// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/known_directions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "diagnosis/goal/goal.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Whether a finding names another reading of one of the streams. The fit of the streams as given in some
/// directions is no evidence against such a reading.
bool is_another_reading(const Finding& finding) {
  const std::string_view code = finding.code;
  return code == "inverted_a" || code == "inverted_b" || code.starts_with("quaternion_order_") ||
         code.starts_with("axes_");
}

}  // namespace

Misfit where_known(const Misfit& misfit, const Motions& motions, const Answered& answered,
                   const DualQuaternion& best, const std::vector<Finding>& findings) {
  constexpr double standard_deviations = 3;  // mathematics: 99.7 % of what is known keeps within
  if (!(misfit.best < misfit.at_answer) || std::any_of(findings.begin(), findings.end(), is_another_reading))
    return misfit;
  const Vector6d difference = frame_a_difference(answered.T_a_b, best);
  bool all_known = true;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!answered.observability.observable[k])
      all_known = false;
    else if (std::abs(difference[i]) >
             standard_deviations * with_further_parts(answered.observability.stddev[k], answered, k))
      return misfit;
  }
  if (all_known) return misfit;
  return {misfit.best, misfit.best, median_misfit(motions, evaluated(motions, best))};
}

}  // namespace egocal::detail
