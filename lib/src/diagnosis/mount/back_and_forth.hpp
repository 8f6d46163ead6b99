// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Finding mount_moved where the mount goes back and forth between two places (moves/switching.hpp): its one
/// answer lies between them, with small standard deviations.
std::optional<Finding> back_and_forth(const Instants& instants, const Answered& answered,
                                      const DiagnosisOptions& options);

}  // namespace egocal::detail
