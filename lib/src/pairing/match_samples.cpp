// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/match_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal {

namespace {

std::int64_t typical_period_us(const Trajectory& trajectory) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    periods.push_back(trajectory[i].time_us - trajectory[i - 1].time_us);
  return detail::median(std::move(periods));
}

/// Row of the nearest stamp.
std::size_t nearest(const Trajectory& trajectory, std::int64_t time_us) {
  const auto next =
      std::lower_bound(trajectory.begin(), trajectory.end(), time_us,
                       [](const StampedPose& pose, std::int64_t t) { return pose.time_us < t; });
  if (next == trajectory.begin()) return 0;
  const auto at = static_cast<std::size_t>(next - trajectory.begin());
  if (next == trajectory.end()) return at - 1;
  return time_us - trajectory[at - 1].time_us <= next->time_us - time_us ? at - 1 : at;
}

void add(const Trajectory& a, const Trajectory& b, std::size_t i, std::size_t j, MatchedSamples& matched) {
  matched.samples.push_back({a[i].pose, b[j].pose});
  matched.rows_a.push_back(i);
  matched.rows_b.push_back(j);
}

MatchedSamples by_stamp(const Trajectory& a, const Trajectory& b, const MatchingOptions& options) {
  MatchedSamples matched;
  const auto limit =
      options.nearest_part * static_cast<double>(std::min(typical_period_us(a), typical_period_us(b)));
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t j = nearest(b, a[i].time_us);
    if (nearest(a, b[j].time_us) != i) continue;
    if (static_cast<double>(std::llabs(a[i].time_us - b[j].time_us)) > limit) continue;
    add(a, b, i, j, matched);
  }
  return matched;
}

/// Tuning of the choice between stamps and rows, where the lists are equally long and stamps leave rows over.
/// Study: tests/lib/test_samples.cpp, RowsThatLackAPartner and CountersThatBeginElsewhere.
struct ChoiceOptions {
  /// Stamps are believed where more than this part of the rows agrees by them. Those of two clocks that have
  /// nothing to do with each other agree by chance in a half at most: nearest_part to both sides.
  double most = 0.5;
  /// The turn from one sample to another is the same in a and b. Where that holds this many times better by
  /// rows, or by the stamps of fewer rows, it decides [-].
  double clearly = 3;
  double nothing = 1e-6;  ///< difference of turns that is rounding [rad]
};

double turn_between(const DualQuaternion& from, const DualQuaternion& to) {
  return 2 * std::acos(std::min(1.0, std::abs(from.real.dot(to.real))));
}

/// How much turns of a and b differ [rad], the lower quartile: up to 40 % of the samples may be wrong. It is
/// the same for inverted poses and for quaternions in another order.
double unlike_turns(const std::vector<PoseSample>& samples) {
  std::vector<double> differences;
  const std::size_t n = samples.size();
  // neighbours may be alike: samples are in an order
  for (const std::size_t step : {std::size_t{1}, n / 3, n / 2})
    for (std::size_t i = 0; i + step < n && step > 0; ++i) {
      const PoseSample &from = samples[i], &to = samples[i + step];
      differences.push_back(std::abs(turn_between(from.a, to.a) - turn_between(from.b, to.b)));
    }
  return detail::order_statistic_in_place(differences, differences.size() / 4);
}

/// Whether rows that agree by their stamps are the samples, and not all rows in their order.
bool stamps_decide(const MatchedSamples& stamps, const MatchedSamples& rows,
                   const ChoiceOptions& options = {}) {
  if (stamps.samples.size() < 3) return false;
  const double by_stamps = unlike_turns(stamps.samples) + options.nothing;
  const double by_rows = unlike_turns(rows.samples) + options.nothing;
  if (by_rows * options.clearly < by_stamps) return false;
  if (by_stamps * options.clearly < by_rows) return true;
  return static_cast<double>(stamps.samples.size()) > options.most * static_cast<double>(rows.samples.size());
}

MatchedSamples row_by_row(const Trajectory& a, const Trajectory& b) {
  MatchedSamples matched;
  matched.by_stamp = false;
  for (std::size_t i = 0; i < a.size(); ++i) add(a, b, i, i, matched);
  return matched;
}

/// Median turn between poses `apart` rows apart [rad].
double median_turn(const Trajectory& trajectory, std::size_t apart) {
  std::vector<double> turns;
  for (std::size_t i = apart; i < trajectory.size(); ++i)
    turns.push_back(turn_between(trajectory[i - apart].pose, trajectory[i].pose));
  return detail::median(std::move(turns));
}

bool turns_like_samples(const Trajectory& trajectory, const MatchingOptions& options) {
  const double near = median_turn(trajectory, 1), far = median_turn(trajectory, trajectory.size() / 2);
  return near > options.large_turn && near > options.unlike_a_stream * far;
}

}  // namespace

MatchedSamples match_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options) {
  MatchedSamples matched;
  if (!a.empty() && !b.empty()) {
    matched = by_stamp(a, b, options);
    if (matched.samples.size() < a.size() && a.size() == b.size()) {
      MatchedSamples rows = row_by_row(a, b);
      if (!stamps_decide(matched, rows)) matched = std::move(rows);
    }
  }
  if (matched.samples.size() < 3)
    throw Error("samples: expected at least 3 rows of a and b that belong together, found " +
                std::to_string(matched.samples.size()) + " (" + std::to_string(a.size()) + " rows of a, " +
                std::to_string(b.size()) + " of b); give equally many rows, or stamps that agree");
  matched.without_partner = a.size() + b.size() - 2 * matched.samples.size();
  return matched;
}

bool look_like_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options) {
  if (a.size() != b.size() || a.size() < 3 || a.size() > options.most_samples) return false;
  return turns_like_samples(a, options) && turns_like_samples(b, options);
}

}  // namespace egocal
