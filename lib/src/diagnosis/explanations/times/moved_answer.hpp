// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// By how much two times of one stream move the answer, and what that leaves unknown.
#pragma once

#include "egocal/diagnosis/diagnose.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

/// A change of the answer (frame_a_difference()) with 0 in the directions that are not known.
Vector6d in_known_directions(Vector6d change, const Observability& observability);

/// Whether a change reaches this part of the tolerances (far_off()), and in some direction exceeds this many
/// of the standard deviations that are stated.
bool matters(const Vector6d& change, const Answered& answered, const DiagnosisOptions& options,
             double least_move, double stddevs);

/// Adds a change to what the times leave unknown, of the answer and of its diagnosis.
void widen_by(const Vector6d& change, Answered& answered, Diagnosis& result);

}  // namespace egocal::detail
