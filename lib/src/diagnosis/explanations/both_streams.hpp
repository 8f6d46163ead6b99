// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The same mistake in both files: what is left of the motions agrees nearly, or as well.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Mean log ratio of the squares that decides between a reading and the same with both streams inverted: arms
/// (Tampere) that were inverted fit better by up to 2.3, and in metres, as the camera of an arm that watches
/// its target, by 1.5.
constexpr double decisive_loss = 3;

/// Finding inverted_both. Two inverted files do not contradict each other: their answer is the transform
/// between the two odometry frames. The finding is certain if the vehicle moves forward under that reading
/// alone, or if as given both sensors are impossibly fast. Noise that grows with the distance from the start
/// supports the streams as given. It does not support inverted ones, because a mount that moved looks the
/// same. In all other cases the finding is uncertain, and both answers are named.
std::optional<Finding> both_inverted(const Evidence& evidence, const DiagnosisOptions& options);

/// Finding quaternion_order_both: the same wrong order in both streams. It is nearly consistent if both
/// sensors move in nearly the same way. Short motions, of which there are many, show it.
std::optional<Finding> both_orders(const Evidence& evidence, const DiagnosisOptions& options);

}  // namespace egocal::detail
