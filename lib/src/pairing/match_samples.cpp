// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/match_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/match_rows.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal {

namespace {

constexpr std::size_t least_samples = 3;  // mathematics: what an answer needs

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

/// Poses of a list in the order of their times, of equal times the first.
struct InTime {
  Trajectory poses;
  std::vector<std::size_t> places;  ///< of each in the list
};

InTime in_time(const PosesOfFile& list, double factor) {
  InTime result;
  const auto time_of = [&](std::size_t i) { return list.poses[i].time_us; };
  std::vector<std::size_t> places(list.poses.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(),
                   [&](std::size_t i, std::size_t j) { return time_of(i) < time_of(j); });
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (k > 0 && time_of(places[k]) == time_of(places[k - 1])) continue;
    StampedPose pose = list.poses[places[k]];
    pose.time_us = std::llround(factor * static_cast<double>(pose.time_us));
    result.poses.push_back(pose);
    result.places.push_back(places[k]);
  }
  return result;
}

void add(const PosesOfFile& a, const PosesOfFile& b, std::size_t i, std::size_t j, MatchedSamples& matched) {
  matched.samples.push_back({a.poses[i].pose, b.poses[j].pose});
  matched.rows_a.push_back(a.rows[i]);
  matched.rows_b.push_back(b.rows[j]);
}

/// Difference of stamps up to which they belong together [us].
double largest_difference(const InTime& a, const InTime& b, const MatchingOptions& options) {
  return options.nearest_part *
         static_cast<double>(std::min(typical_period_us(a.poses), typical_period_us(b.poses)));
}

MatchedSamples by_stamp(const PosesOfFile& list_a, const PosesOfFile& list_b, double factor,
                        const MatchingOptions& options) {
  MatchedSamples matched;
  const InTime a = in_time(list_a, 1), b = in_time(list_b, factor);
  const double limit = largest_difference(a, b, options);
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const std::int64_t time_us = a.poses[i].time_us;
    const std::size_t j = nearest(b.poses, time_us);
    if (nearest(a.poses, b.poses[j].time_us) != i) continue;
    if (static_cast<double>(std::llabs(time_us - b.poses[j].time_us)) > limit) continue;
    add(list_a, list_b, a.places[i], b.places[j], matched);
  }
  matched.without_partner = a.poses.size() + b.poses.size() - 2 * matched.samples.size();
  return matched;
}

/// The poses of the same rows.
MatchedSamples row_by_row(const PosesOfFile& a, const PosesOfFile& b) {
  MatchedSamples matched;
  matched.by_stamp = false;
  for (std::size_t i = 0, j = 0; i < a.poses.size() && j < b.poses.size();) {
    if (a.rows[i] == b.rows[j]) add(a, b, i, j, matched);
    const std::size_t row = std::min(a.rows[i], b.rows[j]);
    if (a.rows[i] == row) ++i;
    if (b.rows[j] == row) ++j;
  }
  matched.without_partner = a.poses.size() + b.poses.size() - 2 * matched.samples.size();
  return matched;
}

/// Whether all times remain such that a file may hold, times this factor.
bool are_plausible(const PosesOfFile& list, double factor) {
  return std::all_of(list.poses.begin(), list.poses.end(), [&](const StampedPose& pose) {
    return std::abs(factor * static_cast<double>(pose.time_us)) <= static_cast<double>(limits::latest_us);
  });
}

bool times_repeat(const PosesOfFile& list) {
  return in_time(list, 1).poses.size() < list.poses.size();
}

/// Whether the stamps of the same rows agree, too.
bool rows_agree_by_stamp(const PosesOfFile& list_a, const PosesOfFile& list_b, double factor,
                         const MatchingOptions& options) {
  const double limit = largest_difference(in_time(list_a, 1), in_time(list_b, factor), options);
  if (list_a.rows != list_b.rows) return false;
  for (std::size_t i = 0; i < list_a.poses.size(); ++i) {
    const double b_us = factor * static_cast<double>(list_b.poses[i].time_us);
    if (std::abs(static_cast<double>(list_a.poses[i].time_us) - b_us) > limit) return false;
  }
  return true;
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
  /// Units that the times of b may have been read in, in those of a. They are tried where no more than `most`
  /// of the shorter list agree, and taken where more do.
  std::array<double, 4> units = {1e-3, 1e3, 1e-6, 1e6};
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
  if (stamps.samples.size() < least_samples) return false;
  if (rows.samples.size() < least_samples) return true;
  const double by_stamps = unlike_turns(stamps.samples) + options.nothing;
  const double by_rows = unlike_turns(rows.samples) + options.nothing;
  if (by_rows * options.clearly < by_stamps) return false;
  if (by_stamps * options.clearly < by_rows) return true;
  return static_cast<double>(stamps.samples.size()) > options.most * static_cast<double>(rows.samples.size());
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

PosesOfFile as_rows(const Trajectory& trajectory) {
  PosesOfFile poses;
  poses.poses = trajectory;
  poses.rows.resize(trajectory.size());
  std::iota(poses.rows.begin(), poses.rows.end(), std::size_t{0});
  poses.count = trajectory.size();
  return poses;
}

MatchedRows match_rows(const PosesOfFile& a, const PosesOfFile& b, const MatchingOptions& options) {
  MatchedRows result;
  MatchedSamples& matched = result.matched;
  const ChoiceOptions choice;
  const std::size_t shorter = std::min(a.poses.size(), b.poses.size());
  if (shorter > 0) {
    const auto are_most = [&](const MatchedSamples& samples) {
      return samples.samples.size() >= least_samples &&
             static_cast<double>(samples.samples.size()) > choice.most * static_cast<double>(shorter);
    };
    matched = by_stamp(a, b, 1, options);
    for (const double factor : choice.units) {
      if (are_most(matched)) break;
      if (!are_plausible(b, factor)) continue;
      MatchedSamples other = by_stamp(a, b, factor, options);
      if (!are_most(other)) continue;
      matched = std::move(other);
      result.times_of_b = factor;
    }
    if (matched.samples.size() < shorter && a.count == b.count) {
      MatchedSamples rows = row_by_row(a, b);
      if (rows_agree_by_stamp(a, b, result.times_of_b, options) || !stamps_decide(matched, rows, choice)) {
        result.stamps_repeat = times_repeat(a) || times_repeat(b);
        matched = std::move(rows);
        result.times_of_b = 1;
      }
    }
  }
  if (matched.samples.size() < least_samples)
    throw Error("samples: expected at least 3 rows of a and b that belong together, found " +
                std::to_string(matched.samples.size()) + " (" + std::to_string(a.count) + " rows of a, " +
                std::to_string(b.count) + " of b); give equally many rows, or stamps that agree");
  return result;
}

MatchedSamples match_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options) {
  return match_rows(as_rows(a), as_rows(b), options).matched;
}

bool look_like_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options) {
  if (a.size() != b.size() || a.size() < 3 || a.size() > options.most_samples) return false;
  return turns_like_samples(a, options) && turns_like_samples(b, options);
}

}  // namespace egocal
