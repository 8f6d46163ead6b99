// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Where the data of a plot are in its picture.
#pragma once

#include <algorithm>
#include <limits>

#include "figures/plot.hpp"

namespace egocal::tools {

inline constexpr double font_size = 8;  // [pt], the size of the paper's captions
inline constexpr double margin_left = 44, margin_right = 8, margin_top = 20,
                        margin_bottom = 32;  // margins [pt]

/// The range of an axis, of scaled numbers (on_axis()).
struct AxisRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  bool empty() const { return !(least <= most); }
};

/// Whether this axis has a place for the number.
bool drawable(const Axis& axis, double value);
/// The number, or its logarithm.
double on_axis(const Axis& axis, double value);

/// The map from data to points of the picture.
class Frame {
 public:
  /// plot: must exist as long as this object.
  explicit Frame(const Plot& plot);

  double width() const { return plot_.width - margin_left - margin_right; }
  double height() const { return plot_.height - margin_top - margin_bottom; }
  const AxisRange& x_range() const { return x_; }
  const AxisRange& y_range() const { return y_; }
  double x(double value) const {
    return margin_left + width() * (on_axis(plot_.x, value) - x_.least) / (x_.most - x_.least);
  }
  double y(double value) const {
    return margin_top + height() * (1 - (on_axis(plot_.y, value) - y_.least) / (y_.most - y_.least));
  }

 private:
  void make_equal();

  const Plot& plot_;
  AxisRange x_, y_;
};

}  // namespace egocal::tools
