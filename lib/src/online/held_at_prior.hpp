// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/uncertainty/observability.hpp"

namespace egocal::detail {

struct HoldOptions {
  /// Curvature of the added squares over that of the motions. With it, noise pulls the answer from the prior
  /// by less than 1e-5 of the difference, and rounding costs five of the sixteen digits of a proof.
  double stiffness = 1e5;
  /// A hidden direction with more than this part of its square in translation is held as one, others as turns
  /// about a line. The motions of what turns about a line are as long as its arm makes them, and they set the
  /// unit of length: at most four fifths of a turn are translation. Of a translation that is all but what
  /// noise mixes into it. So this is 1 - 0.3^2, from where ObservabilityOptions::hinted_part counts a turn.
  /// 0.8 to 0.99 have the same answers; with 0.5 turns with long arms were held as translations, and roll and
  /// pitch were off by up to 45 standard deviations. Study: docs/method.md, "Hidden turns".
  double mostly_translation = 0.91;
  /// An answer closer to the prior than this is at the prior: rounding [m, rad].
  double there = 1e-9;
  /// Rotations about several axes do not commute, so each is brought to the prior in turn, in this many
  /// rounds.
  int sweeps = 8;
};

struct HeldCost {
  Matrix8d Q;            ///< a cost matrix as (16), with terms that hold the hidden directions
  DualQuaternion start;  ///< the minimiser, moved along them to the prior
};

/// Noise gives the cost a slope along directions that no motion shows, and its minimum a place there that
/// means nothing. To Q are added squares c (p'q)^2 that are zero where the answer has the prior's height
/// (or angle) along each hidden direction. They are quadratic in q, so the relaxation of (18) stays tight,
/// and the certificate is about this cost. hidden: hidden_directions() at the minimiser of Q. Empty where the
/// minimiser is at the prior already.
std::optional<HeldCost> held_at_prior(const Matrix8d& Q, const DualQuaternion& minimiser,
                                      const DualQuaternion& prior, const DirectionBasis& hidden,
                                      const HoldOptions& options = {});

}  // namespace egocal::detail
