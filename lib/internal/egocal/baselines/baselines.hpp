// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal {

/// Answer of a method that the paper compares with. valid is false where the method's own assumption is
/// violated; note then says which. The cost matrix plays no part: these methods minimise other things.
struct BaselineAnswer {
  DualQuaternion T_a_b;
  bool valid = false;
  bool certified = false;  ///< matrix only: its own duality gap is closed
  double gap = 0;          ///< matrix only
  std::string note;
};

/// When solve_analytic() calls its answer valid. Study: tests/lib/test_baselines.cpp, noise and motions about
/// one axis.
struct AnalyticOptions {
  /// Largest ratio of the seventh singular value to the sixth, in descending order: the seventh and eighth
  /// belong to the answer and are "almost zero".
  double largest_ratio = 0.3;
  /// The rotation axes must leave their principal direction by more than the noise moves them: by this factor
  /// in the second moment. Two sensors on one body turn by the same angle, so the noise shows in the
  /// difference.
  double least_axis_signal = 10;
  /// Both null vectors are combinations of (r, d) and (0, r): their real parts must be parallel, up to this
  /// sine.
  double largest_real_sine = 0.1;
};

/// Daniilidis [19]: null space of the stacked vector parts; assumes two singular values near zero and two
/// axes.
BaselineAnswer solve_analytic(std::span<const MotionPair> pairs, const AnalyticOptions& options = {});
/// Giamou et al. [8]: rotation-matrix QCQP with its 22 constraints, by its Lagrangian dual.
BaselineAnswer solve_matrix(std::span<const MotionPair> pairs);
/// Brookshire and Teller [7]: nonlinear least squares on the Lie algebra of dual quaternions.
BaselineAnswer solve_local(std::span<const MotionPair> pairs, const DualQuaternion& start = {});

}  // namespace egocal
