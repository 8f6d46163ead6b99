// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams of which one half repeats its values while the other half goes on.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Study: tests/lib/test_held_streams.cpp.
struct HeldOptions {
  std::size_t most = 4000;  ///< poses that are looked at, from the middle: bounds the cost of a long drive
  std::size_t least = 20;   ///< new values behind repeated ones; fewer are chance
  double rounding =
      1e-13;       ///< of the length and of 1: what computing with a pose adds to a value that repeats
  double gap = 5;  ///< in median steps: a longer one is a gap between drives or between samples
  /// Least part of the way of the values that is in steps behind a repeated value. Where each value is held
  /// twice it is all of the way; joined from 7 Hz into 10 Hz it is 0.43; a machine that rests, or turns on
  /// the spot, now and then goes on by many steps.
  double share = 0.3;
  /// Least part of the rows that repeat a value in which the other half of the pose goes on: a machine at
  /// rest repeats both halves.
  double going_on = 0.8;
  /// Least length of a step behind a repeated value, in digits of the file. Coordinates that are rounded to a
  /// metre also repeat while the sensor moves; their steps have one digit.
  double digits = 10;
  /// Least part of the values that last for as many rows as the median one, by a row more or less: what is
  /// held comes at a rate of its own, and what is rounded lasts for as long as the sensor is slow.
  double even = 0.9;
};

/// A new value, the last row that repeats it, and the next new one: indices of the stream.
struct HeldRows {
  std::size_t fresh = 0, last = 0, next = 0;
};

/// Which rows repeat. They also do where values are written with few digits in other numbers than ours, and
/// where an arm turns in one place: whether the sensor moved on only the other stream says (held_streams()).
struct Held {
  bool positions = true;            ///< or rotations
  double rate = 0;                  ///< of new values [1/s]
  std::vector<std::size_t> fresh;   ///< rows with new values
  std::vector<HeldRows> repeating;  ///< those that are repeated, in order
};

/// The half of a stream that repeats its values so; empty: neither half does.
std::optional<Held> repeating_half(const Trajectory& stream, const HeldOptions& options = {});

}  // namespace egocal::detail
