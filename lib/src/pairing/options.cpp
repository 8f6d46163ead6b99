// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/options.hpp"

#include <cstdio>
#include <string>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "pairing/congruence_floors.hpp"

namespace egocal {

namespace {

void require(const char* option, double value, const Range& range, const char* unit) {
  if (range.contains(value)) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s: expected %g to %g%s, got %g", option, range.least, range.most, unit,
                value);
  throw Error(text);
}

void require(const char* option, bool holds, const char* expected) {
  if (!holds) throw Error(std::string(option) + ": expected " + expected);
}

void check(const SynchroniserOptions& options) {
  require("poses_to_decide", options.poses_to_decide >= 2, "at least 2");
  require("most_waiting", options.most_waiting >= options.poses_to_decide, "at least poses_to_decide");
  require("slower_by", options.slower_by, {0, 1e9}, "");
  require("most_cut", options.most_cut, {0, 10}, "");
  require("most_bent", options.most_bent, {0, 10}, "");
  require("typical_steps", options.typical_steps >= 1 && options.typical_steps <= 1000, "1 to 1000");
  require("smooth_poses",
          options.smooth_poses == 0 || (options.smooth_poses % 2 == 0 && options.smooth_poses >= 4 &&
                                        options.smooth_poses <= SynchroniserOptions::most_smooth_poses),
          "0 or an even number from 4 to 16");
  require("correlation_length", options.correlation_length, {0.1, 10}, " periods");
  require("most_rough", options.most_rough, {0, 100}, "");
  require("most_uneven_here", options.most_uneven_here, {1, 100}, "");
  require("most_uneven", options.most_uneven, {1, 100}, "");
}

void check(const ClockOptions& options) {
  require("clock.first", options.first, {1, 3600}, " s");
  require("clock.every", options.every, {1, 1e6}, " s");
  require("clock.delay", options.delay, {0, 3600}, " s");
  require("clock.window", options.window, {1, 3600}, " s");
  require("clock.longest", options.longest, {options.first + options.delay, 36'000}, " s");
  require("clock.most_held", options.most_held >= 10 && options.most_held <= 10'000'000, "10 to 1e7 poses");
  require("clock.least_correlation", options.least_correlation, {0, 1}, "");
  require("clock.least_inliers", options.least_inliers, {0, 1}, "");
  require("clock.largest_stddev", options.largest_stddev, {0, 10}, " s");
  require("clock.least_change", options.least_change, {0, 10}, " s");
  require("clock.change_sigmas", options.change_sigmas, {0, 1000}, " standard deviations");
  require("clock.phase", options.phase >= 0 && options.phase < 1, "from 0 to below 1");
}

void check(const CongruenceOptions& options) {
  require("congruence.least_turn", options.least_turn, {1e-9, std::numbers::pi}, " rad");
  require("congruence.angle_floor", options.angle_floor, detail::angle_floors, " rad");
  require("congruence.length_floor", options.length_floor, detail::length_floors, " m");
  require("congruence.memory", options.memory >= 16 && options.memory <= 1'000'000, "16 to 1e6 motions");
  require("congruence.first_estimate",
          options.first_estimate >= 4 && options.first_estimate <= options.memory,
          "4 to congruence.memory motions");
  require("congruence.estimate_every", options.estimate_every >= 1 && options.estimate_every_when_full >= 1,
          "at least 1");
  require("congruence.doubtful_remembered", options.doubtful_remembered >= 1, "at least 1");
  require("congruence.most_growing", options.most_growing, {0, 1}, "");
  require("congruence.still", options.still, {0, 1}, "");
  require("congruence.beyond", options.beyond, {1, 1e6}, "");
  require("congruence.unknown_noise", options.unknown_noise, {0, 1}, "");
  require("congruence.gross_angle", options.gross_angle, {1e-3, std::numbers::pi}, " rad");
  require("congruence.gross_lengths", options.gross_lengths, {1, 1e6}, "");
  require("longest_lever_arm", options.longest_lever_arm, {0, 1e4}, " m");
}

void check(const ScreeningOptions& options) {
  require("doubtful", options.doubtful, {1, 1e6}, " standard deviations");
  require("break_chain", options.break_chain, {options.doubtful, 1e6}, " standard deviations");
  require("most_doubtful", options.most_doubtful >= 2 && options.most_doubtful <= 1000, "2 to 1000");
  require("repeated", options.repeated, {0, 1e-3}, "");
  check(options.congruence);
}

void check(const AccumulatorOptions& options) {
  require("longest_motion", options.longest_motion, {1e-3, 3600}, " s");
  require("stretch", options.stretch, {1, 1000}, " strides");
  require("most_rotation", options.most_rotation, {1e-3, std::numbers::pi}, " rad");
  require("balances", !options.balances.empty() && options.balances.size() <= 100, "1 to 100 of them");
  for (const double weight : options.balances) {
    require("balances", weight, limits::translation_weight, " 1/m^2");
    require("balances", weight > 0, "weights above 0");
  }
  require("choice_phase", options.choice_phase >= 0 && options.choice_phase < 1, "from 0 to below 1");
}

}  // namespace

PairingOptions validated(PairingOptions options) {
  if (options.stride) require("stride", *options.stride, limits::stride, " steps");
  if (options.balance) {
    require("rotation weight", options.balance->rotation, limits::rotation_weight, "");
    // with less the costs are so small that nothing can be proven of them
    constexpr double most = limits::translation_weight.most;
    require("translation weight", options.balance->translation, {1 / most, most}, "");
  }
  require("time_offset", options.time_offset, limits::time_offset, " s");
  require("max_gap", options.max_gap, limits::max_gap, " s");
  check(options.clock);
  check(options.synchroniser);
  check(options.screening);
  check(options.accumulator);
  if (options.mode == Mode::planar) {
    options.plane_a = validated(options.plane_a);
    options.plane_b = validated(options.plane_b);
  }
  return options;
}

}  // namespace egocal
