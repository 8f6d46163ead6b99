// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace egocal::detail {

/// Fit of a drifting clock: offsets = level + slope * time, by least squares over the parts of a drive.
class LineFit {
 public:
  void add(double time, double offset) {
    n_ += 1;
    t_ += time;
    y_ += offset;
    tt_ += time * time;
    ty_ += time * offset;
  }
  double points() const { return n_; }
  /// Whether the points determine a line; false where all of them have one time.
  bool determined() const { return determinant() > 0; }
  double slope() const { return (n_ * ty_ - t_ * y_) / determinant(); }
  /// Value of the line at time zero, for a slope that may be limited.
  double level(double slope) const { return (y_ - slope * t_) / n_; }

 private:
  double determinant() const { return n_ * tt_ - t_ * t_; }

  double n_ = 0, t_ = 0, y_ = 0, tt_ = 0, ty_ = 0;
};

}  // namespace egocal::detail
