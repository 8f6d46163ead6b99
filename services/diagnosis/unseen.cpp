// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/unseen.hpp"

#include <cstdio>

namespace egocal::services {

void limit_to_what_was_seen(const Unseen& unseen, Diagnosis& diagnosis, const UnseenOptions& options) {
  if (diagnosis.verdict != Verdict::good || unseen.share <= options.largest_share) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "The first %.0f s are not judged, as egocal-diagnosis was started later: drive on, or reset the "
      "pair. Since then: ",
      unseen.seconds);
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.reason = text + diagnosis.reason;
}

}  // namespace egocal::services
