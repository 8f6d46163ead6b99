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

/// Both files inverted is no contradiction by itself: the answer is then that of the two odometry frames. It
/// is certain where a vehicle's way points forward under it alone, or where as given both sensors are faster
/// than anything. Noise that grows with the distance from the start supports the streams as given, but not
/// the inverted ones: a mount that moved looks the same. Otherwise both answers stand.
std::optional<Finding> both_inverted(const Evidence& evidence, const DiagnosisOptions& options);

/// The order of the quaternions wrong in both streams alike: where both sensors move in nearly the same way
/// that is nearly consistent. Short motions, of which there are many, show it.
std::optional<Finding> both_orders(const Evidence& evidence, const DiagnosisOptions& options);

}  // namespace egocal::detail
