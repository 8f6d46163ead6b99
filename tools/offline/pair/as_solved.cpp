// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/as_solved.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::tools {

namespace {

/// Median distance of two poses [s].
double period_of(const Trajectory& trajectory) {
  std::vector<double> steps;
  steps.reserve(trajectory.size());
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    steps.push_back(to_seconds(trajectory[i].time_us - trajectory[i - 1].time_us));
  return detail::median(std::move(steps));
}

}  // namespace

Motions as_solved(Motions motions, const CalibrationOptions& options, const SolveResult& result) {
  const Side side = options.scale_side;
  const double scale = result.calibration.scale_applied;
  if (!motions.pairs.empty()) {
    for (MotionPair& pair : motions.pairs) {
      DualQuaternion& motion = side == Side::a ? pair.a : pair.b;
      motion = scaled(motion, scale);
    }
    return motions;
  }
  motions.a = reread(motions.a, options.read_a);
  motions.b = reread(motions.b, options.read_b);
  Trajectory& stream = side == Side::a ? motions.a : motions.b;
  stream = result.course ? scaled(stream, *result.course) : scaled(stream, scale);
  return motions;
}

Paired as_paired(const Motions& motions, const CalibrationOptions& options, const Calibration& calibration) {
  Paired paired{options.pairing, motions.b};
  const std::optional<TimeOffset>& offset = calibration.time_offset;
  if (offset)
    paired.b = on_clock_of_a(*offset, motions.b);
  else
    paired.options.time_offset = calibration.time_offset_applied;
  paired.options.stride = calibration.choice.stride;
  paired.options.balance = calibration.choice.balance;
  return paired;
}

std::vector<MotionPair> pairs_of(const Motions& motions, const CalibrationOptions& options,
                                 const Calibration& calibration) {
  if (!motions.pairs.empty()) return motions.pairs;
  const Paired paired = as_paired(motions, options, calibration);
  return pair_motions(paired.options, motions.a, paired.b).pairs;
}

std::vector<MotionPair> pairs_of_fit(const Motions& motions, const CalibrationOptions& options,
                                     const Calibration& calibration) {
  if (!motions.pairs.empty()) return motions.pairs;
  Paired paired = as_paired(motions, options, calibration);
  const double period = std::max(period_of(motions.a), period_of(motions.b));
  const double steps = period > 0 ? std::round(calibration.fit.motion_seconds / period) : 1;
  paired.options.stride = static_cast<int>(std::clamp(steps, limits::stride.least, limits::stride.most));
  paired.options.robust = false;
  paired.options.mode = Mode::spatial;  // motions of the sensors, not of the frames in their planes
  return pair_motions(paired.options, motions.a, paired.b).pairs;
}

}  // namespace egocal::tools
