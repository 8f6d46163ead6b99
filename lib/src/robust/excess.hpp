// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "egocal/robust/consensus.hpp"

namespace egocal::detail {

/// Mean squared size of the motions of a part in the metric of the cost (16): the cost of a wrong extrinsic
/// of this scale.
inline double squared_size(const Matrix8d& Q) {
  return Q.topLeftCorner<4, 4>().trace();
}

/// Ratio of a residual to what is typical of motions of this size. residual, size: mean squared.
inline double excess(double residual, double size, const ResidualScale& scale,
                     const ConsensusOptions& options) {
  return std::min(residual / scale.absolute,
                  residual / (size * std::max(scale.relative, options.least_relative)));
}

}  // namespace egocal::detail
