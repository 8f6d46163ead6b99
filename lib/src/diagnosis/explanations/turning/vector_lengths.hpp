// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotation vectors of one stream that were read as those of another length.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// The stream whose rotation vectors are twice or half as long as they should be, or of degrees taken as
/// radians the other way round, where the motions clearly fit better without that: turning_scale_a|_b.
/// least_gain: mean log ratio of the squared residuals. instants, given: the drive, and its motions with the
/// extrinsic that suits them as they are.
std::optional<Finding> vectors_of_another_length(const Instants& instants, const Explained& given,
                                                 const DiagnosisOptions& options, double least_gain);

}  // namespace egocal::detail
