// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// When a step between two poses is worth mentioning. The defaults suit vehicles; they decide no answer.
struct SummaryOptions {
  double gap_factor = 3;  ///< a gap is longer than this many median steps; jitter of real sensors stays below
  double least_gap = 0.2;         ///< and longer than this [s]
  double largest_speed = 70;      ///< a faster step is a jump [m/s]; no road vehicle is faster
  double largest_turn_rate = 15;  ///< a faster turn is a jump [rad/s]; faster than hand-held devices turn
};

/// What a stream of poses holds, in numbers.
struct StreamSummary {
  std::uint64_t poses = 0;
  std::int64_t first_us = 0, last_us = 0;  ///< earliest and latest time [us]
  double rate = 0;                         ///< 1 / median step [Hz]; 0 for less than two poses
  double path_length = 0;                  ///< [m], without jumps
  std::array<double, 3>
      turning{};  ///< sum of absolute rotations about x, y, z of the sensor [rad], without jumps
  std::uint64_t gaps = 0;
  double longest_gap = 0;  ///< [s]
  std::uint64_t jumps = 0;
  std::uint64_t out_of_order = 0;  ///< times that do not increase: earlier than, or equal to, the one before
};

/// Summarises a stream pose by pose, in the order of the file, in constant memory: the median step is that of
/// the first 4096.
class StreamSummariser {
 public:
  explicit StreamSummariser(SummaryOptions options = {}) : options_(options) {}
  void add(const StampedPose& pose);
  StreamSummary summary() const;

 private:
  SummaryOptions options_;
  StreamSummary summary_;
  std::optional<StampedPose> last_;
  std::vector<float> steps_;          ///< the first ones, for the median [s]
  std::vector<float> suspect_steps_;  ///< those above least_gap; at most as many [s]
};

}  // namespace egocal
