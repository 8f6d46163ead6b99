// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is looked for where nothing else is certain, whatever else was found.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Whether there is nothing further to look for. Twin readings that both fit far better are uncertain each,
/// but one of them is right.
bool explains(const Finding& finding, const DiagnosisOptions& options);

/// A wrong scale that few motions show, where nothing else is certain. One that is no larger than right
/// odometries differ by is named where the answer at it is farther away than the tolerance: a drone tilts as
/// it accelerates, and moves slowly, so that its lengths are hundreds of times those that a lever arm adds.
void name_wrong_scale(const Evidence& evidence, const PairingOptions& pairing, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings);

/// Names a scale that changes along the drive and fits clearly better, in place of one scale for the whole
/// drive, where nothing else is certain: as of wheels that wear, or of a camera whose scale drifts. At the
/// one scale the answer would be as far off as before.
void replace_by_changing_scale(const Evidence& evidence, const PairingOptions& pairing,
                               const Answered& answered, const DiagnosisOptions& options,
                               std::vector<Finding>& findings);

/// Names rotations that are askew, which no part of the drive shows by itself, where nothing else explains
/// the streams.
void name_askew_rotations(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                          std::vector<Finding>& findings);

}  // namespace egocal::detail
