// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Finding inverted_both, uncertain: as given one mounting explains the motions; with both streams inverted
/// one that changed once, at once, explains them about as well. Poses of two worlds that do not drift have
/// the same transform between the worlds whatever the mounting does. So sensors that were knocked look as if
/// they were not, once both streams are inverted. The answer is that after the change,
/// `time` is its time, and `improvement` the smaller one of those in parts of the motions and in metres.
std::optional<Finding> inverted_and_moved(const Evidence& evidence, const Answered& answered,
                                          const DiagnosisOptions& options);

}  // namespace egocal::detail
