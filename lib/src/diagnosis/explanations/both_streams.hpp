// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The same mistake in both files: what is left of the motions agrees nearly, or as well.
#pragma once

#include <optional>
#include <vector>

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

/// Chosen on 12 walking persons whose positions are late, checked on other machines and another simulator.
struct InvertedInVainOptions {
  /// loss_in_metres() from the motions as given to those as in the files, at most. Positions that are late by
  /// three rows left 20 cm inverted and 26 cm (0.53) as they were.
  double most_loss = 1;
  /// How many times as far both sensors travel as in the files, at least. In files that are rightly inverted
  /// both travel less, unless both turn about the origins of their worlds. In vain it was 3 to 9 times.
  double least_times = 1.5;
  /// Cameras that watch targets travel further than their inverse, up to 4.6 times in orbits around a board.
  /// Rightly inverted the answer is then the mounting; in the files it is how the targets sit to each other:
  /// the identity, to this [m, rad], where it is one board. In vain the answer is the distance of two worlds,
  /// and longer than that of the files by more than the tolerance of a translation.
  double one_world = 0.1, one_world_turned = 0.05;
};

/// Finding inverted_both, uncertain, of streams that options inverted, where both sensors travel further than
/// in the files. `value` is how many times as far. Far from the origin of its world an inverted pose moves by
/// its turns times the distance: a mistake of 40 cm is a small part of each motion, and the answer seems
/// known. Empty where the inverted ones travel forward alone, or agree clearly better in metres.
std::optional<Finding> inverted_in_vain(const Evidence& evidence, const DiagnosisOptions& options,
                                        const InvertedInVainOptions& tuning = {});

/// Removes an uncertain inverted_both beside a certain mistake of positions or axes, where both sensors would
/// travel further under that reading: its option would be the only one that is offered, and what contradicts
/// is a smaller part of longer motions.
void drop_unlikely_inversion(const Evidence& evidence, const DiagnosisOptions& options,
                             std::vector<Finding>& findings);

/// Finding quaternion_order_both: the same wrong order in both streams. It is nearly consistent if both
/// sensors move in nearly the same way. Short motions, of which there are many, show it.
std::optional<Finding> both_orders(const Evidence& evidence, const DiagnosisOptions& options);

}  // namespace egocal::detail
