// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <deque>

namespace egocal::monitor {

/// The quantities whose course is kept, the four curves of the paper's Fig. 6.
enum Curve { rotation_error, translation_error, scaled_gap, execution_time, curve_count };

/// What happened within one slice of time. NaN where there was no finite value.
struct Slice {
  double begin = 0;  ///< [s]
  std::array<float, curve_count> low, high;
};

/// The course of an answer in bounded memory, however long the drive: the last minute in tenths of a second,
/// what is older in ever coarser slices, each with its extremes so that no spike is lost.
class History {
 public:
  /// Times that run backwards or are not finite are ignored. [s], [rad], [m], -, [s]
  void add(double time, const std::array<double, curve_count>& values);
  /// The finest course that reaches back to this time.
  const std::deque<Slice>& since(double time) const;
  double slice_width(const std::deque<Slice>& course) const;
  bool empty() const { return levels_[0].empty(); }
  double first_time() const { return first_; }
  double last_time() const { return last_; }

  static constexpr std::size_t slices = 600;  ///< a level
  static constexpr std::size_t levels = 5;    ///< 0.1 s to 410 s: a minute to 68 hours

 private:
  std::array<std::deque<Slice>, levels> levels_;
  double first_ = 0, last_ = 0;
};

}  // namespace egocal::monitor
