// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numbers>
#include <optional>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// When the part of a cost that is rotation noise is taken off. Study: tests/lib/test_attenuation.cpp and
/// docs/paper.md, "How errors fall with the number of motions".
struct AttenuationOptions {
  /// A pull is corrected where it is larger than this part of the standard deviation. Smaller ones widen an
  /// interval by at most 5 %.
  double least_pull = 1.0 / 3;
  /// Largest part of the curvature that the noise makes where a direction is corrected: beyond, the
  /// correction doubles the error of what is known.
  double most_noise = 0.5;
  /// A direction that has 30 times the curvature of the noise is shown by the rotations. Others must differ
  /// from zero by 4 standard deviations, as noise that the sensors share also pulls there
  /// (ObservabilityOptions::shared_noise, shown_sigmas).
  double shown_curvature = 30, shown_sigmas = 4;
  /// A spread needs at least this many blocks (ObservabilityOptions::least_blocks).
  std::size_t least_blocks = 6;
  /// Where no translation needs it by itself, or in the plane, it is corrected where no standard deviation
  /// becomes more than this many times as large: twice the variance. Study: docs/method.md, "Errors in
  /// variables".
  double most_loss = std::numbers::sqrt2;
  /// What it may turn the answer by, at most [rad]; beyond, the corrected cost has another minimum. In slow
  /// drives of 100 motions with noise of a tenth (tests/lib/test_selection.cpp) those are 20 to 150 degrees
  /// away, corrections of real drives and of the public benchmark turn by less than one.
  double most_turn = 0.35;
  /// The noise that is left along the rotation itself, in multiples of the least that keeps D positive
  /// semidefinite; and the factor by which more is left until Q is positive definite.
  double reserve = 4;
};

/// What to take off the blocks of a problem: D_k - (r'D_k r) taken_off.
struct Attenuation {
  Eigen::Matrix<double, 4, 1, Eigen::DontAlign> r;          ///< rotation of the minimiser
  Eigen::Matrix<double, 4, 4, Eigen::DontAlign> taken_off;  ///< symmetric, eigenvalues in [0, 1]
  double pull = 0;  ///< largest ratio of a pull to the standard deviation along it

  bool operator==(const Attenuation&) const = default;
};

/// Errors in variables (docs/method.md has the derivation). Independent noise of the two rotations adds N I
/// to D, where N = r'Dr is the mean squared rotation residual. The minimiser of (18) is then pulled towards
/// zero: along an eigenvector of D with the eigenvalue mu it is (1 - N / mu) times as long. This function
/// decides along which eigenvectors across r the noise is taken off D. It is taken off if the pull is larger
/// than AttenuationOptions::least_pull standard deviations, and if the standard deviation, which the
/// correction makes 1 / (1 - N / mu) times as large, grows by less than the pull. On circles of nearly one
/// radius x, y and yaw are observable only together, and the pull is far larger. So if no single eigenvector
/// needs the correction, the noise is taken off all that lose little certainty, provided that the answer
/// changes by more than least_pull standard deviations in an observable direction. In the plane it is taken
/// off both x and y, or off neither, by the same rule. Empty if nothing is to be taken off, or if the blocks
/// are too few for a spread.
std::optional<Attenuation> find_attenuation(const Problem& problem, const AttenuationOptions& options = {});

/// The same along all eigenvectors that `most_noise` allows, however small the pull. Empty in planar mode.
std::optional<Attenuation> whole_attenuation(const Problem& problem, const AttenuationOptions& options = {});

/// The problem with its noise taken off, at the balance {0, 1}: the blocks hold the rotation part in their
/// upper left. Each block loses its own noise, so that leaving it out leaves out what is known of the noise
/// from it. D stays positive semidefinite, so there is no duality gap; empty where D or Q would not be.
std::optional<Problem> without_attenuation(const Problem& problem, const Attenuation& attenuation);

}  // namespace egocal
