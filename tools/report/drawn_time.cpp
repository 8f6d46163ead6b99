// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/drawn_time.hpp"

#include <algorithm>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::tools {

DrawnTime::DrawnTime(const Trajectory& a, std::int64_t origin_us, const DrawnTimeOptions& options)
    : origin_us_(a.empty() ? origin_us : a.front().time_us) {
  if (a.size() < 2) return;
  std::vector<std::int64_t> periods;
  periods.reserve(a.size() - 1);
  for (std::size_t i = 1; i < a.size(); ++i) periods.push_back(a[i].time_us - a[i - 1].time_us);
  const double usual = to_seconds(detail::median(std::move(periods)));
  const double least = std::max(options.least_seconds, options.least_periods * usual);
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (!(seconds_between(a[i - 1].time_us, a[i].time_us) > least)) continue;
    places_.push_back(seconds(a[i - 1].time_us));
    breaks_.push_back({a[i - 1].time_us, a[i].time_us});
  }
}

double DrawnTime::seconds(std::int64_t time_us) const {
  std::int64_t skipped = 0;
  for (const Break& one : breaks_) {
    if (time_us <= one.begin_us) break;
    skipped += std::min(time_us, one.end_us) - one.begin_us;
  }
  return seconds_between(origin_us_ + skipped, time_us);
}

std::size_t DrawnTime::part_of(std::int64_t time_us) const {
  return static_cast<std::size_t>(std::count_if(breaks_.begin(), breaks_.end(), [&](const Break& one) {
    return one.begin_us + (one.end_us - one.begin_us) / 2 < time_us;
  }));
}

}  // namespace egocal::tools
