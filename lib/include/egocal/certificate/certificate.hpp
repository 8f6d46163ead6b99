// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string_view>

#include "egocal/problem/cost.hpp"

namespace egocal {

enum class Optimality {
  certified,    ///< no extrinsic has a lower cost, up to the rounding of Q; or none further than the options
                ///< allow
  not_optimal,  ///< a better extrinsic is known
  undecided,    ///< too imprecise to decide
};
/// "certified", "not optimal", "undecided": the words of JSON, tables and Python.
std::string_view to_string(Optimality optimality);

struct CertificateOptions {
  /// An answer is also certified when every better one is proven to lie this close to it.
  double reach_translation = 1e-6;  ///< [m]
  double reach_rotation = 1e-6;     ///< [rad]
  /// No answer is certified where the rounding of its cost exceeds this part of trace(Q): it lies so far out
  /// along a direction without curvature that its cost says nothing.
  double largest_rounding = 1e-9;
};
EGOCAL_SAME_LAYOUT(CertificateOptions)

/// Optimality of one answer. docs/method.md holds the proofs.
struct Certificate {
  Optimality optimality = Optimality::undecided;
  double cost = 0;
  /// Every extrinsic within the domain has a cost of at least this. A bound above zero is proven for the
  /// given numbers, wherever lambda comes from; zero is a bound up to the competitor's own cost_rounding().
  /// -infinity where nothing is proven.
  double lower_bound = 0;
  double gap = 0;         ///< cost - lower_bound, >= 0
  double rounding = 0;    ///< cost_rounding() of the answer
  double scaled_gap = 0;  ///< gap / rounding
  /// Any extrinsic within the domain with a cost at most this answer's lies within this reach of it, proven;
  /// infinite where the cost is flat.
  double reach_translation = 0;  ///< [m]
  double reach_rotation = 0;     ///< [rad]
  /// Infinite, but for rotations without noise: where D is singular up to rounding, bound and reach are
  /// stated for extrinsics within this distance of the answer only. At least 1e4 lengths at which turning and
  /// sliding cost alike [m].
  double domain = std::numeric_limits<double>::infinity();
  Multipliers lambda;  ///< proposed by (28)
};
EGOCAL_SAME_LAYOUT(Certificate)

/// Costs q'Qq that differ by less than this cannot be distinguished: Q was summed from numbers of the size of
/// its traces, rounded.
double cost_rounding(const Matrix8d& Q, const DualQuaternion& q);

/// Verification of a solution (28), III-F. Q: symmetric up to rounding, finite, its largest diagonal element
/// between 1e-250 and 1e250 or all of it zero. q: a unit dual quaternion (5) to 1e-6, normalised then.
/// Anything else is undecided with an infinite cost, and so is a Q with negative costs: it is no sum of
/// squares. Thread-safe.
Certificate verify(const Matrix8d& Q, const DualQuaternion& q, const CertificateOptions& options = {});
/// The same under (26); Q and T_p as in solve_planar. T_p: planar to 1e-6.
Certificate verify_planar(const Matrix8d& Q_planar, const DualQuaternion& T_p,
                          const CertificateOptions& options = {});

}  // namespace egocal
