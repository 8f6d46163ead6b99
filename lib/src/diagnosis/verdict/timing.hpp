// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the times of the poses leave unknown of an answer.
#pragma once

#include "diagnosis/verdict/foreseen.hpp"

namespace egocal::detail {

/// States what clocks that differ and interpolation change of the answer. Only where the streams are
/// understood otherwise: a wrong answer has no standard deviation that could be right.
void look_at_times(const Foreseen& foreseen, Answered& answered, Diagnosis& result);

}  // namespace egocal::detail
