// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A part of the drive that is in another unit than the rest.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct PartOfOtherScaleOptions {
  /// Factor between the lengths of both parts, at least. Less is found as a course of the scale
  /// (scale/scale_course.hpp), which begins at the answer of the whole drive: that of two units is of
  /// neither.
  double least = 1.5;
};

/// Finding scale_change: one extrinsic explains the drive if the lengths of b between these times [s] are
/// multiplied by a factor. Both ends may be off by some motions.
std::optional<Finding> part_of_other_scale(const Explained& given, double begin, double end,
                                           const DiagnosisOptions& options,
                                           const PartOfOtherScaleOptions& part = {});

}  // namespace egocal::detail
