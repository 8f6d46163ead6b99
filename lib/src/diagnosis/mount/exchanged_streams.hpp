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
  /// The residual must also be below this multiple of what the other side's own answer leaves. A sensor that
  /// was turned by 90 or 180 degrees about a vehicle's vertical has nearly the inverse rotation, but 1.7 to 6
  /// times the residual by its position. In 25 exchanged drives of four machines the largest ratio was 1.28.
  double than_own = 1.5;
};

/// Whether the answer after `time` [s] is the inverse of the one before, in rotation and in place,
/// which a mounting that moved is by chance alone. Motions as given.
bool exchanged_streams(const Motions& motions, double time, const DiagnosisOptions& options,
                       const ExchangedStreamsOptions& tuning = {});

}  // namespace egocal::detail
