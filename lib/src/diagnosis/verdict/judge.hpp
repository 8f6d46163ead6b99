// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct Misfit {
  double at_answer =
      0;  ///< residual at the answer that a third of the motion keeps below, as a part of the typical motion
  double best = 0;    ///< at the extrinsic that suits the motions best
  double median = 0;  ///< residual at the answer that half of the motion keeps below
};

/// The options with a tolerance of the translation that suits the unit of the lengths.
DiagnosisOptions in_unit_of(const Motions& motions, DiagnosisOptions options);

/// Sets verdict and reason from fit, findings and what is known of each direction.
void judge(Diagnosis& diagnosis, const Answered& answered, const Misfit& misfit,
           const DiagnosisOptions& options);

}  // namespace egocal::detail
