// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>

#include "certificate/assess.hpp"

namespace egocal::detail {

/// Whether q is unit to the last digits: normalising it again would only move them.
inline bool unit_to_rounding(const DualQuaternion& q) {
  constexpr double tolerance = 4 * std::numeric_limits<double>::epsilon();
  return std::abs(q.real.squaredNorm() - 1) <= tolerance &&
         std::abs(q.real.dot(q.dual)) <= tolerance * q.dual.norm();
}

/// verify(), where a bound may be proven already, in units of length_scale(): solve_dual does so. Q is
/// exactly symmetric then.
Certificate verify(const Matrix8d& Q, const DualQuaternion& q, const CertificateOptions& options,
                   const std::optional<ProvenBound>& proven);

}  // namespace egocal::detail
