// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A nominal value that the motions contradict, where they show anything.
#pragma once

#include <optional>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct NominalCheckOptions {
  /// Standard deviations of the answer, and of what a nominal value is taken to be known to
  /// (ObservabilityOptions::prior_translation and prior_rotation), that may be chance.
  double sigmas = 3;
  /// A direction is named where its part of the difference is at least this: a tenth adds half a percent to
  /// its size (mathematics), and is of no use to who looks for the wrong number.
  double least_part = 0.1;
  /// Another reading of the nominal value is named where it leaves less than this part of the difference, as
  /// a part of the limits. Nominal values of other mistakes leave more than the limits in some direction.
  double much_nearer = 0.5;
  /// A lever arm of a centimetre in millimetres; a shorter one agrees with any of less than the tolerance
  /// [m].
  double least_millimetres = 10;
  /// Lever arms of a vehicle are shorter [m]; in millimetres one of ten centimetres is as long.
  double longest = 100;
};

/// Finding "nominal": the nominal value differs from the answer, in the directions that the motions show (and
/// those that the ground planes give, in planar mode), by more than the tolerance of the verdict and
/// `sigmas`; or it is too long for one in metres. Names the reading of it that would agree: its inverse, the
/// other order of its quaternion, millimetres. Empty without a nominal value, where it agrees, and where
/// nothing is shown that could be compared.
std::optional<Finding> contradicted_nominal(const Answered& answered, const DiagnosisOptions& options,
                                            const NominalCheckOptions& check = {});

}  // namespace egocal::detail
