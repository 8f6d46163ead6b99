// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the model makes of the reasons for which processes reject messages, poses and motions.
#include <algorithm>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

const std::string prefix = "rejected: ";

}  // namespace

/// The first of each kind is an event.
void Model::watch_rejections(ProcessState& process, const status_t& message, Now now) {
  for (const counter_t& counter : message.counters) {
    if (counter.value <= 0 || !counter.name.starts_with(prefix)) continue;
    const std::string reason = counter.name.substr(prefix.size(), max_text);
    const auto known = std::find_if(process.rejections.begin(), process.rejections.end(),
                                    [&](const bus::Refusal& refusal) { return refusal.reason == reason; });
    if (known != process.rejections.end()) {
      known->count = counter.value;
    } else if (process.rejections.size() < options_.most_reasons) {
      process.rejections.push_back({reason, bus::cure_of_rejection(reason), counter.value});
      const std::string& cure = process.rejections.back().cure;
      note(Severity::info, process.status.name, "rejects: " + reason + (cure.empty() ? "" : ": " + cure),
           now);
    }
  }
}

}  // namespace egocal::monitor
