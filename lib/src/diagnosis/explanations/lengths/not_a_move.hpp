// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What looks like a mount that moved and is something else.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Finding scale_change: the scale of b changes along the drive, and at the scales found no mount moves.
/// Empty where the scale is one, or where the motions do not fit better. moves: found so far, each of which
/// may be a change of the scale.
std::optional<Finding> changing_scale(const PairingOptions& pairing, const Evidence& evidence,
                                      const Answered& answered, const DiagnosisOptions& options,
                                      const std::vector<Finding>& moves = {});

/// Comparison::gain of an extrinsic for each part between the moves, over one for the drive.
double gain_of_parts(const Evidence& evidence, const std::vector<Finding>& moves,
                     const DiagnosisOptions& options);

/// Readings of both streams alike that the findings call possible: world-to-sensor, or inverse rotations.
std::vector<PoseReading> readings_of_both(const std::vector<Finding>& findings);

/// Finding axes_both, uncertain: inverse rotations of both streams, under which no mount moves, and the
/// motions fit better than as given (CommonAxesOptions::gain_beside_move) and about as well as with the
/// moves.
std::optional<Finding> inverse_rotations_instead(const Evidence& evidence, const std::vector<Finding>& moves,
                                                 const Answered& answered, const DiagnosisOptions& options);

/// Judges findings mount_moved by their rivals. They are
/// - replaced by scale_change if that explains the motions better, or as well with another unit,
/// - dropped if a scale that wanders as those of odometries do explains the motions as well,
/// - made uncertain if, under one of the readings of_both of both streams, no mount moves and one extrinsic
///   explains the motions about as well as one for each part between the moves,
/// - otherwise returned as they are.
std::vector<Finding> moves_or_else(std::vector<Finding> moves, const PairingOptions& pairing,
                                   const Evidence& evidence, const Answered& answered,
                                   const std::vector<PoseReading>& of_both, const DiagnosisOptions& options);

}  // namespace egocal::detail
