// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace egocal::detail {

/// Noise of motions of s steps: variance 2 + growth * s, up to a common factor.
struct StrideVariances {
  std::vector<double> strides;      ///< [steps]
  std::vector<double> variances;    ///< mean squared residuals of one motion
  std::vector<double> independent;  ///< motions that share no step; 0: not used
};

/// The smallest of these growths (ascending) that fits within `errors` standard errors of the best one.
double least_growth(const StrideVariances& seen, const std::vector<double>& growths, double errors);

/// How many times too small the spread over blocks of instants is, at least one. Omitting a block omits the
/// motions with an end in it. Noise of a motion's steps is in all motions that span the step, also in those
/// that go on beyond the block on both sides: with motions of s steps and blocks of L, a part s / (2 L) of
/// the variance is missed. Noise on poses is in motions that end there, all of which are omitted. weights: of
/// one motion of each stride, which are taken to turn alike.
double missed_noise(const std::vector<double>& strides, const std::vector<double>& weights, double growth,
                    std::uint64_t block_length);

}  // namespace egocal::detail
