// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations of one stream that are a factor too large about the vertical: the scale of a gyroscope, or a
// compass that is not calibrated.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Study: docs/trust_measured.md, "Mistakes".
struct TurningScaleOptions {
  /// Parts by which both sensors turn unlike, least and most that are looked at: gyroscopes err by up to some
  /// per cent, and motions that noise and interpolation shorten by less than half a per cent.
  double least = 0.005, most = 0.3;
  double around = 0.01;  ///< searched on either side of the ratio of the angles
  int steps = 14;        ///< of the golden section: to 1e-5
  /// Mean log ratio of the squared residuals of rotation vectors of another length, at least.
  double gain_of_vectors = 2;
};

/// The stream that turns too far, or not far enough, about one axis of its world, the extrinsic without that,
/// and by how much the motions then fit better, where they clearly do. Both streams, the better one first,
/// where either may be the one. The positions of such a stream are right, or were made from its rotations:
/// both are tried. Or the stream whose rotation vectors are twice or half as long as they should be, or of
/// degrees taken as radians the other way round. instants, given: the drive, and its motions with the
/// extrinsic that suits them as they are.
std::vector<Finding> turning_scale(const Instants& instants, const Explained& given,
                                   const DiagnosisOptions& options, const TurningScaleOptions& turning = {});

}  // namespace egocal::detail
