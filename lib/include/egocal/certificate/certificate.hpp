// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/problem/constraints.hpp"

namespace egocal {

enum class Optimality {
  certified,    ///< no extrinsic has a lower cost, up to the rounding of Q; or none further than the options
                ///< allow
  not_optimal,  ///< a better extrinsic is known
  undecided,    ///< too imprecise to decide
};

struct CertificateOptions {
  /// An answer is also certified when every better one is proven to lie this close to it.
  double reach_translation = 1e-6;  ///< [m]
  double reach_rotation = 1e-6;     ///< [rad]
  /// No answer is certified where the rounding of its cost exceeds this part of trace(Q): it lies so far out
  /// along a direction without curvature that its cost says nothing.
  double largest_rounding = 1e-9;
};

/// Optimality of one answer. docs/method.md holds the proofs.
struct Certificate {
  Optimality optimality = Optimality::undecided;
  double cost = 0;
  double lower_bound =
      0;  ///< J >= lower_bound - rounding for every unit dual quaternion: rigorous whoever proposed lambda
  double gap = 0;       ///< cost - lower_bound, >= 0
  double rounding = 0;  ///< costs that differ by less than this cannot be told apart: Q is known to eps only
  double scaled_gap = 0;  ///< gap / rounding
  /// Any extrinsic with a cost at most this answer's lies within this reach of it; infinite where the cost is
  /// flat.
  double reach_translation = 0;  ///< [m]
  double reach_rotation = 0;     ///< [rad]
  Multipliers lambda;            ///< proposed by (28)
};

/// Verification of a solution (28), III-F.
Certificate verify(const Matrix8d& Q, const DualQuaternion& q, const CertificateOptions& options = {});
/// The same under (26); Q and T_p as in solve_planar.
Certificate verify_planar(const Matrix8d& Q_planar, const DualQuaternion& T_p,
                          const CertificateOptions& options = {});

}  // namespace egocal
