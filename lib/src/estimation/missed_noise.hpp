// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace egocal::detail {

/// By what factor the spread over blocks of instants is too small; at least one. Omitting a block omits the
/// motions with an end in it. The noise of a step is in all motions that span the step, also in those that
/// begin before the block and end after it: with motions of s steps and blocks of L, a part s / (2 L) of the
/// variance is missed. Noise on poses is only in motions that end there, all of which are omitted. weights:
/// of one motion of each stride; all motions are taken to turn alike.
double missed_noise(const std::vector<double>& strides, const std::vector<double>& weights, double growth,
                    std::uint64_t block_length);

}  // namespace egocal::detail
