// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/stream_parts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "egocal/limits.hpp"

namespace egocal::detail {

bool possible(const NumberedPose& sample) {
  return plausible_relative_time(sample.pose.time_us) && (sample.seq == -1 || plausible_count(sample.seq));
}

bool sent_in_order(const NumberedPose& x, const NumberedPose& y) {
  return x.seq < 0 || y.seq < 0 ? x.seq == y.seq : y.seq > x.seq;
}

void append(std::vector<NumberedPose>& out, std::vector<NumberedPose> more) {
  std::move(more.begin(), more.end(), std::back_inserter(out));
}

std::int64_t newest_time(const std::map<std::int64_t, NumberedPose>& samples) {
  std::int64_t newest = samples.begin()->second.pose.time_us;
  for (const auto& [number, sample] : samples) newest = std::max(newest, sample.pose.time_us);
  return newest;
}

}  // namespace egocal::detail
