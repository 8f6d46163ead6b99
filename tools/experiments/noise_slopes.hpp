// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiments/noise.hpp"

namespace egocal::tools {

/// Each run gives an exponent of n, the slope of the line through (log n, log error); this is their mean, so
/// that near and far sensors count alike, and its standard error. The errors of one run are those of a
/// growing set of motions: a single slope scatters by 0.3 to 0.5.
struct Exponent {
  double mean = 0, standard_error = 0;
};

/// How the errors of one noise level fall with the number of pairs n, where n > 100 (all sizes where fewer
/// than three are). Independent noise makes the spread fall with n^(-1/2). The error also contains the bias
/// of a least-squares estimate from noisy motions on both sides, which does not fall.
struct NoiseSlope {
  double level = 0;
  Exponent translation, rotation;                ///< of the errors (32)
  Exponent corrected_translation;                ///< with the noise taken off the cost
  Exponent translation_spread, rotation_spread;  ///< of the errors without their bias
  double shortened = 0;                          ///< NoisePoint::shortened at the largest number of pairs
};
std::vector<NoiseSlope> slopes(const std::vector<NoisePoint>& points);

/// The slopes as a table in Markdown, one noise level a line.
std::string markdown(const std::vector<NoiseSlope>& slopes);
/// The slopes as a table in HTML.
std::string html(const std::vector<NoiseSlope>& slopes);

}  // namespace egocal::tools
