// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams of which one was made from the other, in whole or in half, by whatever trace shows it first.
#pragma once

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Adds the finding same_stream. What only follows from it is removed: positions that seem to be filled in
/// where the poses of a map correct an odometry now and then, and axes that seem turned beside positions of
/// another sensor.
void name_same_stream(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                      Diagnosis& result);

}  // namespace egocal::detail
