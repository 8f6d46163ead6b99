// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Two streams that are exchanged from some time on, as where topics were swapped during the drive.
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct ExchangedStreamsOptions {
  /// Typical residual, as a part of the typical motion: the inverse of one side's answer leaves less than
  /// `most` on the other side, and less than `part` of what that answer itself leaves there
  /// (LargeMoveOptions::contradicts, own).
  double most = 0.3, part = 0.4;
};

/// Whether the answer after `time` [s] is the inverse of the one before, which a mounting that moved becomes
/// by chance alone: one in 100,000 such turns is as near as 3 degrees. Motions as given.
bool exchanged_streams(const Motions& motions, double time, const DiagnosisOptions& options,
                       const ExchangedStreamsOptions& tuning = {});

}  // namespace egocal::detail
