// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What was found is replaced by what explains more.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/options.hpp"

namespace egocal::detail {

/// One stream that has late positions, a lever arm that was turned wrongly, or turns too far: what explains
/// most.
std::vector<Finding> wrong_stream(const Evidence& evidence, const DiagnosisOptions& options);

/// A mount that moved by much looks like other axes, another clock or another recording: it is named instead
/// of them where it explains more.
bool replace_by_large_move(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, std::vector<Finding>& findings);

/// Axes that are turned alike in both files by any angle explain a part of what a mount that moved does, or
/// of one that fell back: the moves are named instead where they explain more.
bool replace_by_moves(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings);

/// The same of what one stream alone explains more of, and unlike columns that look like another scale.
bool replace_by_wrong_stream(const Evidence& evidence, const Answered& answered,
                             const DiagnosisOptions& options, std::vector<Finding>& findings);

}  // namespace egocal::detail
