// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal {

/// What a diagnosis makes of the directions that the statistics state: standard deviations with what the
/// times and digits of the poses add, and no direction observable that both streams assume. Also of a later
/// answer to the same drive, until that is judged. Thread-safe.
Observability as_judged(Observability stated, const Diagnosis& diagnosis);

}  // namespace egocal
