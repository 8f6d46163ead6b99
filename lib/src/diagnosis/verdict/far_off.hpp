// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// How far the answer of a finding is from the one that is judged, as a part of the tolerance, in the
/// directions that are known. Without an answer: infinite where the finding is certain, else 0.
double far_off(const Finding& finding, const Answered& answered, const DiagnosisOptions& options);
double far_off(const DualQuaternion& T_a_b, const Answered& answered, const DiagnosisOptions& options);

}  // namespace egocal::detail
