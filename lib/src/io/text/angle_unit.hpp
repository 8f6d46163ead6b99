// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace egocal::detail {

/// How the unit of angles is found that no header states. Study: the turns about two axes of 179 trajectories
/// (cars, a drone, hand-held rigs, arms) as radians and as degrees, wrapped and as sums, 1,790 columns. Of
/// 1,093 with values beyond a turn 36 are radians: 6 are told by the direction of travel, for 30 of rigs that
/// move in any direction the unit is asked for; the 1,057 of degrees are told. 13 columns of degrees below
/// 6.4, of rigs that hardly turn, are taken for radians by their size.
struct AngleUnitOptions {
  double largest_turn = 2 * std::numbers::pi + 0.1;  ///< [rad] of radians that are not summed; 0.1: rounding
  double fastest = 15;    ///< [rad/s] of any vehicle: the limit of StreamSummary's jumps
  double window = 0.5;    ///< [s] over which turning is measured: noise of one row does not count
  int least_chords = 20;  ///< of a path, from which on its direction is compared: 1 - R below a quarter by
                          ///< chance has a probability of 2e-5 (Rayleigh: exp(-n R^2))
  /// [m] of the lengths of chords that are tried, each twice the one before: from below the noise of any
  /// odometry to beyond any drive. Lengths of which there are less than least_chords do not count, so both
  /// ends are limits of the work (31 lengths) and change no decision.
  double shortest_chord = 1.0 / 1024, longest_chord = 1 << 20;
  double ratio = 4;  ///< of the spreads of the directions against both readings: F of 20 and 20 degrees of
                     ///< freedom, 0.2 % by chance
};

/// Takes the rows of a table and tells the unit of its angle about the vertical axis, in constant memory.
class AngleUnit {
 public:
  explicit AngleUnit(const AngleUnitOptions& options = {});

  /// time [s], position [m] where there is one; angle: as it was read.
  void add(double time, const std::optional<Eigen::Vector2d>& position, double angle);
  /// Any other angle of the row, such as roll.
  void add_other(double angle);

  struct Decision {
    std::optional<bool> degrees;  ///< nothing: it cannot be told
    std::string reason;
  };
  Decision decide() const;

 private:
  /// Directions of the chords of one length along the path, against both readings of the angle. Doubled, so
  /// that driving backwards is no other direction; with both signs, for headings of a compass.
  struct Chords {
    double length = 0;
    std::optional<Eigen::Vector2d> begin;
    double angle_at_begin = 0;
    int count = 0;
    std::complex<double> path, radians[2], degrees[2];
  };
  std::optional<bool> of_travel() const;

  AngleUnitOptions options_;
  std::vector<Chords> chords_;
  double first_ = 0, largest_ = 0, fastest_ = 0;
  double window_begin_ = 0, angle_at_window_ = 0;
  bool any_ = false;
};

}  // namespace egocal::detail
