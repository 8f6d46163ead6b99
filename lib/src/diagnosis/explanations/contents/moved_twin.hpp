// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One stream is inverted, and the mounting moved.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// "Inverted" below is one stream, "twin" the same with the other one instead.
struct MovedTwinOptions {
  std::size_t places = 15;       ///< as in LargeMoveOptions
  std::size_t least_blocks = 4;  ///< likewise, on either side of the move
  /// Mean log ratio of the squares that the move must gain in the right twin. Knocked by 3 to 10 degrees, on
  /// ten machines: 0.77 to 2.5. The wrong twin of drives without a knock, on ten: 0 to 0.32.
  double gain = 0.5;
};

/// Findings of explain(). With the wrong one of two streams inverted the answer is the transform between two
/// worlds, which stays whatever the mounting does: beside an inversion a knock is not seen, and the wrong
/// stream fits better. So where findings name one, the twin is tried with a mounting that moved once, at
/// once. Where it fits as well in parts of the motions and in metres, both are named, none of them is
/// certain, and the one that fits better comes first. The answer of the moved one is that after the move.
void doubt_inversion(const Evidence& evidence, const DiagnosisOptions& options,
                     std::vector<Finding>& findings);

}  // namespace egocal::detail
