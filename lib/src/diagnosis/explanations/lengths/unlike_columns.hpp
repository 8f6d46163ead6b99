// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Columns of the position of one stream that are in unlike units, or stretched unlike: latitude and longitude
// in degrees, a height in feet, x and y of a map that is not true to scale.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct UnlikeColumnsOptions {
  /// Largest factor over the smallest, as a logarithm, at least: twice what the scales of ordinary odometries
  /// differ by (ScaleCheckOptions).
  double least = 0.03;
  /// The columns are called stretched from this logarithm on, and the odometry below it: an odometry that
  /// drifts by 5 % along each axis has factors that differ by up to 0.12.
  double of_columns = 0.15;
  /// The finding is certain from this logarithm on, a factor of 1.5: feet have 1.19, degrees of latitude and
  /// longitude 0.4 where people live. Below, an honest odometry may drift that way: a lidar measures heights
  /// of hills 25 % wrong and the answer is off by less than the tolerance. Then the change of the answer
  /// decides.
  double certain = 0.4;
  int rounds = 3;  ///< of factors and extrinsic in turn
  /// A column counts where its part of the way is at least this, under the factors: of what hardly moves the
  /// factor is noise.
  double least_part = 0.01;
  /// The squared residuals in the columns of the file are smaller by this, as a logarithm, at least. Factors
  /// that only shrink the noise of their columns make them larger (mathematics).
  double least_gain_in_columns = 0;
};

/// Finding axes_a|_b, certain or not, or odometry where it is little: three factors for the columns of the
/// positions of one stream fit clearly better than one. Both streams where either may be the one, the better
/// one first. Exchanged columns besides where the motions do not agree at all otherwise.
std::vector<Finding> unlike_columns(const Evidence& evidence, const DiagnosisOptions& options,
                                    const UnlikeColumnsOptions& columns = {});

}  // namespace egocal::detail
