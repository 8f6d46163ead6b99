// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Findings mount_moved, one for each change of the mounting (moves/find_moves.hpp), in the order of time.
/// reading: of both streams.
std::vector<Finding> moved_mount(const Instants& instants, const Answered& answered,
                                 const DiagnosisOptions& options, const PoseReading& reading = {});

/// Whether these findings of moved_mount() are one move, or one and the way back.
bool one_move(const std::vector<Finding>& moves);

}  // namespace egocal::detail
