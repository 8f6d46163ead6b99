// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// The shortest motions that a long drive is looked at with, and longer ones that must confirm what they
/// show.
std::vector<std::vector<MotionPair>> strides_of(const Instants& instants, const Answered& answered,
                                                const DiagnosisOptions& options, const PoseReading& reading);

}  // namespace egocal::detail
