// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/measured_part.hpp"

#include <algorithm>
#include <cmath>

namespace egocal::detail {

Motions motions_of_part(const Trajectory& measured, Side side, const Evidence& evidence,
                        const ClockModel& clock, double max_gap, const DiagnosisOptions& options) {
  const Trajectory &a = evidence.streams.a, &b = evidence.streams.b;
  const Instants instants = synchronised(side == Side::a ? measured : a, side == Side::b ? measured : b,
                                         clock, max_gap, 1, options.motions);
  if (!(instants.period > 0)) return {};
  const double length = evidence.stride * evidence.instants.period;
  const int stride = std::max(1, static_cast<int>(std::lround(length / instants.period)));
  return motions_of(instants, {}, {}, stride, options.motions.most, options.motions);
}

}  // namespace egocal::detail
