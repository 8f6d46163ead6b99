// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/unseen.hpp"

#include <cstdio>

namespace egocal::services {

void limit_to_what_was_seen(const Unseen& unseen, Diagnosis& diagnosis, const UnseenOptions& options) {
  if (diagnosis.verdict != Verdict::good) return;
  char text[200];
  if (unseen.poses < options.least_poses) {
    std::snprintf(text, sizeof text,
                  "Whether the motions agree is not known: egocal-diagnosis has %zu poses of each sensor at "
                  "common times and needs %zu. Are their clocks the same, and in microseconds?",
                  unseen.poses, options.least_poses);
    diagnosis.reason = text;
  } else if (unseen.share > options.largest_share) {
    std::snprintf(text, sizeof text,
                  "%s%.0f s are not judged (egocal-diagnosis was started later, or a clock was set): "
                  "drive on, or reset the pair. Since then: ",
                  unseen.within ? "" : "The first ", unseen.seconds);
    diagnosis.reason = text + diagnosis.reason;
  } else {
    return;
  }
  diagnosis.verdict = Verdict::incomplete;
}

}  // namespace egocal::services
