// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model handles the reasons for which processes reject messages, poses and motions.
#include <algorithm>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// Counts rejections by their reason. The first of each kind is an event.
void Model::watch_rejections(ProcessState& process, const std::string& reason, std::int64_t count, Now now) {
  const auto known = std::find_if(process.rejections.begin(), process.rejections.end(),
                                  [&](const bus::Refusal& refusal) { return refusal.reason == reason; });
  if (known != process.rejections.end()) {
    known->count = count;
  } else if (process.rejections.size() < options_.most_reasons) {
    process.rejections.push_back({reason, bus::cure_of_rejection(reason), count});
    const std::string& cure = process.rejections.back().cure;
    note(Severity::info, process.status.name, "rejects: " + reason + (cure.empty() ? "" : ": " + cure), now);
  }
}

}  // namespace egocal::monitor
