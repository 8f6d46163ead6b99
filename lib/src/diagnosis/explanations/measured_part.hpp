// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Motions with some poses of one stream, those that were measured, as long as the motions that are compared
/// elsewhere: of these the noise is a small part. side: of that stream. max_gap: of interpolation [s]. No
/// motions where no two of the poses have a partner.
Motions motions_of_part(const Trajectory& measured, Side side, const Evidence& evidence,
                        const ClockModel& clock, double max_gap, const DiagnosisOptions& options);

}  // namespace egocal::detail
