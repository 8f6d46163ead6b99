// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/drives/clocks_of_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/pairing/clock_offset.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "egocal/scale/scale_statistics.hpp"

namespace egocal::tools {

namespace {

using Estimates = std::vector<std::optional<TimeOffset>>;

/// Whether the estimate of a drive alone may tell it from others: no other offset fits it as well.
bool is_certain(const TimeOffset& offset, const ClockOptions& options) {
  return !offset.rival && is_trusted(offset, options);
}

/// The largest difference [s] between the offsets of two drives, of those that are told apart for certain; 0
/// where none are.
double largest_difference(const Estimates& estimates, const ClockOptions& options) {
  const auto certain = [&](const std::optional<TimeOffset>& one) { return one && is_certain(*one, options); };
  double largest = 0;
  for (const std::optional<TimeOffset>& x : estimates)
    for (const std::optional<TimeOffset>& y : estimates) {
      if (!certain(x) || !certain(y)) continue;
      const double change = std::abs(x->seconds - y->seconds);
      if (is_another_clock(change, std::hypot(x->stddev, y->stddev), options))
        largest = std::max(largest, change);
    }
  return largest;
}

bool in_order(const Trajectory& trajectory) {
  const auto not_later = [](const StampedPose& x, const StampedPose& y) { return x.time_us >= y.time_us; };
  return std::adjacent_find(trajectory.begin(), trajectory.end(), not_later) == trajectory.end();
}

}  // namespace

std::vector<ClockOfDrive> put_drives_on_clock_of_a(const Drives& drives, std::size_t sensor_a,
                                                   std::size_t sensor_b, const Trajectory& a, Trajectory& b,
                                                   const CalibrationOptions& options) {
  if (drives.size() < 2) return {};
  const auto lengths = [&](Trajectory part, Side side) {
    return !options.estimate_scale && options.scale_side == side ? scaled(std::move(part), options.scale)
                                                                 : part;
  };
  Estimates estimates;
  for (std::size_t k = 0; k < drives.size(); ++k)
    estimates.push_back(
        estimate_time_offset(lengths(reread(drives.part(a, k, sensor_a), options.read_a), Side::a),
                             lengths(reread(drives.part(b, k, sensor_b), options.read_b), Side::b),
                             {.max_gap = options.pairing.max_gap}));
  // each is compared with how far the drives differ instead
  ClockOptions clock = options.pairing.clock;
  clock.largest_stddev = std::numeric_limits<double>::infinity();
  const double difference = largest_difference(estimates, clock);
  if (!(difference > 0)) return {};
  std::vector<ClockOfDrive> result;
  Trajectory corrected;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    if (!estimates[k])
      throw Error(
          fmt::format("{}: the time offset of this drive cannot be estimated, it is too short or never "
                      "turns, and the clocks of the other drives differ: leave it out",
                      drives.name(k)));
    if (!is_certain(*estimates[k], clock) || !(clock.change_sigmas * estimates[k]->stddev < difference))
      throw Error(fmt::format(
          "{}: the time offset of this drive is not certain ({:.3f} s with a standard deviation of {:.3f} s "
          "and a correlation of {:.2f}), and the clocks of the other drives differ: leave it out",
          drives.name(k), estimates[k]->seconds, estimates[k]->stddev, estimates[k]->correlation));
    const Trajectory part = on_clock_of_a(*estimates[k], drives.part(b, k, sensor_b));
    corrected.insert(corrected.end(), part.begin(), part.end());
    result.push_back({drives.name(k), *estimates[k]});
  }
  if (!in_order(corrected)) return {};  // a stream of one drive reaches into the next one
  b = std::move(corrected);
  return result;
}

std::string clocks_in_words(const std::vector<ClockOfDrive>& clocks) {
  std::string text;
  for (const ClockOfDrive& clock : clocks)
    text += fmt::format("{}{:.4f} s ({})", text.empty() ? "" : ", ", clock.estimate.seconds, clock.name);
  return text + " added to its stamps";
}

}  // namespace egocal::tools
