// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/pace.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

/// Power of 1000 that makes the distance of poses the most usual one.
double likely_factor(double period, double usual) {
  return std::pow(1000.0, std::round(std::log(usual / period) / std::log(1000.0)));
}

std::string taken_as(double factor) {
  return factor == 1e3   ? "such as milliseconds taken as microseconds"
         : factor == 1e6 ? "such as seconds taken as microseconds"
                         : "in another unit";
}

}  // namespace

std::optional<Finding> impossible_pace(const Motions& motions, double duration, double period, bool metres,
                                       const PaceCheckOptions& options) {
  if (motions.all.empty() || !(duration > 0) || !(period > 0)) return std::nullopt;
  std::vector<double> speeds, turns, accelerations;
  for (const Motion& motion : motions.all) {
    speeds.push_back(std::min(motion.t_a.norm(), motion.t_b.norm()) / duration);
    turns.push_back(std::min(motion.angle_a, motion.angle_b) / duration);
    accelerations.push_back(speeds.back() * turns.back());
  }
  const double speed = quantile(speeds, 0.5), turning = quantile(turns, 0.5);
  const bool fast = metres && (speed > options.most_speed ||
                               (speed > options.usual_speed &&
                                quantile(accelerations, options.accelerated) > options.most_acceleration));
  const bool moves = fast || turning > options.most_turning;
  if (!moves && !(1 / period > options.most_rate)) return std::nullopt;
  Finding finding;
  finding.code = "time_unit";
  finding.certain = moves;  // a fast sensor alone is possible
  finding.message = format(
      "By the stamps %.0f poses come in a second, the sensors go %.0f m/s and turn %.0f deg/s: ", 1 / period,
      speed, turning * degrees_per_radian);
  const double factor = likely_factor(period, options.usual_period);
  if (factor > 1) {
    finding.value = factor;
    finding.message += format("the times are likely %.0f times too small, ", factor) + taken_as(factor) + ".";
    finding.remedy =
        format("Multiply the times by %.0f, or name their unit in the head of the column.", factor);
  } else {
    finding.message += "the times, or the lengths of both streams, are in another unit.";
    finding.remedy = "Give times in the unit of the format, and lengths in metres.";
  }
  return finding;
}

}  // namespace egocal::detail
