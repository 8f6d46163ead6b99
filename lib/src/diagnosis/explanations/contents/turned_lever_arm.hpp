// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that were moved to another point of the body by the inverse rotations: p + R'l instead of p + R
// l.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes".
struct TurnedLeverArmOptions {
  double least = 0.05;  ///< lever arms below this are not named [m]: what they change is within a tolerance
};

/// The stream whose positions hold such a lever arm, the extrinsic without it, and by how much the motions
/// then fit better, where they clearly do. instants, given: the drive, and its motions with the extrinsic
/// that suits them as they are.
std::optional<Finding> turned_lever_arm(const Instants& instants, const Explained& given,
                                        const DiagnosisOptions& options,
                                        const TurnedLeverArmOptions& lever = {});

}  // namespace egocal::detail
