// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace egocal::detail {

/// How many times too small the spread over blocks of instants is, at least one. Omitting a block omits the
/// motions with an end in it. Noise of a motion's steps is in all motions that span the step, also in those
/// that go on beyond the block on both sides: with motions of s steps and blocks of L, a part s / (2 L) of
/// the variance is missed. Noise on poses is in motions that end there, all of which are omitted. weights: of
/// one motion of each stride, which are taken to turn alike.
double missed_noise(const std::vector<double>& strides, const std::vector<double>& weights, double growth,
                    std::uint64_t block_length);

}  // namespace egocal::detail
