// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/robust_fit.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

/// Whether the mounting changed once during the drive: two extrinsics, before and after some time, must fit
/// clearly better than one, and differ by far more than the parts of the drive on either side scatter.
std::optional<Finding> moved_mount(const Explained& whole, const DiagnosisOptions& options);

}  // namespace egocal::detail
