// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct MovedMount {
  std::vector<Finding> findings;  ///< mount_moved, one for each change of the mounting, in the order of time
  /// Chance of the strongest evidence where no move was found (MovesResult::chance); otherwise 1.
  double unexplained = 1;
};

/// Changes of the mounting (moves/find_moves.hpp). reading: of both streams.
MovedMount moved_mount(const Instants& instants, const Answered& answered, const DiagnosisOptions& options,
                       const PoseReading& reading = {});

/// Finding mount_moved, uncertain: motions of different times contradict each other, and no move of the
/// mounting shows in motions of every length. chance: MovedMount::unexplained.
std::optional<Finding> contradicting_times(double chance, const DiagnosisOptions& options);

/// Whether these findings of moved_mount() are one move, or one and the way back.
bool one_move(const std::vector<Finding>& moves);

}  // namespace egocal::detail
