// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/moved_answer.hpp"

#include <cmath>
#include <cstddef>

#include "diagnosis/goal/goal.hpp"
#include "diagnosis/verdict/far_off.hpp"

namespace egocal::detail {

Vector6d in_known_directions(Vector6d change, const Observability& observability) {
  for (std::size_t i = 0; i < 6; ++i)
    if (!observability.observable[i]) change[static_cast<Eigen::Index>(i)] = 0;
  return change;
}

bool matters(const Vector6d& change, const Answered& answered, const DiagnosisOptions& options,
             double least_move, double stddevs) {
  if (far_off(frame_a_moved(answered.T_a_b, change), answered, options) < least_move) return false;
  for (std::size_t i = 0; i < 6; ++i)
    if (std::abs(change[static_cast<Eigen::Index>(i)]) >
        stddevs * with_further_parts(answered.observability.stddev[i], answered, i))
      return true;
  return false;
}

void widen_by(const Vector6d& change, Answered& answered, Diagnosis& result) {
  for (std::size_t i = 0; i < 6; ++i)
    answered.timing_stddev[i] = std::hypot(answered.timing_stddev[i], change[static_cast<Eigen::Index>(i)]);
  result.timing_stddev = answered.timing_stddev;
}

}  // namespace egocal::detail
