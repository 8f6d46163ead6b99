// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/time_offset_search.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "egocal/microseconds.hpp"
#include "pairing/offset/candidates.hpp"
#include "pairing/offset/correlation.hpp"
#include "pairing/offset/lasting_jumps.hpp"
#include "pairing/offset/part_search.hpp"
#include "pairing/offset/refinement.hpp"
#include "pairing/offset/schedule.hpp"
#include "pairing/offset/turning.hpp"

namespace egocal {

using namespace detail;

struct TimeOffsetSearch::Impl {
  struct Stream {
    Trajectory poses;
    std::int64_t period_us = 0;  ///< median
    std::vector<Detour> detours;
    Detour typical;
    std::size_t kept = 0;  ///< of the poses looked at so far, at the front
    std::vector<StepDifference> steps;
    Series angles;
  };

  Impl(const Trajectory& given_a, const Trajectory& given_b, const TimeOffsetOptions& given)
      : options(given) {
    a.poses = given_a;
    b.poses = given_b;
    const auto least_us = to_microseconds(options.least_spacing);
    for (Stream* stream : {&a, &b}) {
      schedule.add_range(stream->poses.size(), [stream, least_us](std::size_t begin, std::size_t end) {
        stream->kept = thin(stream->poses, begin, end, stream->kept, least_us);
      });
      schedule.add(stream->poses.size() / 16, [stream] {
        stream->poses.resize(stream->kept);
        if (stream->poses.size() > 1) stream->period_us = median_period_us(stream->poses);
      });
    }
    schedule.add((a.poses.size() + b.poses.size()) / 16, [this] { prepare(); });
  }

  bool long_enough() const { return a.poses.size() >= 10 && b.poses.size() >= 10; }

  void prepare() {
    if (!long_enough()) return;
    const std::int64_t period_us = std::max(a.period_us, b.period_us);
    const auto period = static_cast<double>(period_us);
    step_us = static_cast<std::int64_t>(std::max(
        std::clamp(period, options.finest_grid * second_us, options.coarsest_grid * second_us), period / 4));
    max_gap_us = static_cast<std::int64_t>(std::clamp(options.max_gap * second_us, 3 * period, 20 * period));
    for (Stream* stream : {&a, &b})
      stream->poses = dense_part(std::move(stream->poses), max_gap_us, options.most_sparse);
    if (!long_enough()) return;
    // several rounds, as one round finds only the furthest one of neighbouring glitches
    for (int round = 0; round < options.glitch_rounds; ++round)
      for (Stream* stream : {&a, &b}) schedule.add(1, [this, stream] { remove_glitches(*stream); });
    for (Stream* stream : {&a, &b}) schedule.add(1, [this, stream] { remove_lasting_jumps(*stream); });
    schedule.add(1, [this] { sample_angles(); });
  }

  void remove_glitches(Stream& stream) {
    stream.detours.assign(stream.poses.size(), {});
    schedule.add_range(stream.poses.size(), [&stream](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) stream.detours[i] = detour(stream.poses, i);
    });
    if (stream.poses.size() < 3) return;
    schedule.add(stream.poses.size() / 16,
                 [&stream] { stream.typical.angle = median_of(stream.detours, &Detour::angle); });
    schedule.add(stream.poses.size() / 16, [&stream] {
      stream.typical.length = median_of(stream.detours, &Detour::length);
      stream.kept = 0;
    });
    schedule.add_range(stream.poses.size(), [this, &stream](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (!is_glitch(stream.detours, i, stream.typical, options))
          stream.poses[stream.kept++] = stream.poses[i];
    });
    schedule.add(1, [&stream] { stream.poses.resize(stream.kept); });
  }

  void remove_lasting_jumps(Stream& stream) {
    if (stream.poses.size() < 4) return;
    stream.steps.assign(stream.poses.size() - 1, {});
    schedule.add_range(
        stream.steps.size(),
        [this, &stream](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            stream.steps[i] = step_difference(stream.poses, i, max_gap_us);
        },
        2);
    schedule.add(stream.poses.size() / 4,
                 [&stream] { stream.poses = without_lasting_jumps(stream.poses, stream.steps); });
  }

  void sample_angles() {
    if (!long_enough()) return;
    for (Stream* stream : {&a, &b}) {
      stream->angles.resize(grid_size(stream->poses, step_us));
      schedule.add_range(stream->angles.size(), [this, stream](std::size_t begin, std::size_t end) {
        const std::int64_t first_us =
            stream->poses.front().time_us + static_cast<std::int64_t>(begin) * step_us;
        const auto after =
            std::upper_bound(stream->poses.begin(), stream->poses.end(), first_us,
                             [](std::int64_t time, const StampedPose& pose) { return time < pose.time_us; });
        auto from = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - stream->poses.begin()) - 1);
        for (std::size_t k = begin; k < end; ++k)
          stream->angles[k] = turn_at(stream->poses, k, step_us, max_gap_us, from);
      });
      schedule.add(stream->angles.size() / 8, [stream] { limit_largest(stream->angles); });
    }
    schedule.add(1, [this] { correlate(); });
  }

  std::size_t points(double seconds) const {
    return static_cast<std::size_t>(seconds * second_us / static_cast<double>(step_us));
  }

  void correlate() {
    const std::size_t least_count = points(options.least_overlap);
    if (options.near) {
      const double between = static_cast<double>(a.poses.front().time_us - b.poses.front().time_us);
      const auto centre = static_cast<std::ptrdiff_t>(
          std::llround((*options.near * second_us - between) / static_cast<double>(step_us)));
      const auto reach = static_cast<std::ptrdiff_t>(points(options.near_by));
      for (std::ptrdiff_t lag = centre - reach; lag <= centre + reach; ++lag)
        schedule.add(b.angles.size() / 64 + 1, [this, lag, least_count] {
          const Correlation here = correlation_at(a.angles, b.angles, 0, b.angles.size(), lag, least_count);
          near_significances.push_back(static_cast<float>(here.significance));
          if (here.significance > best.significance) best = here;
        });
      schedule.add(1, [this, first = centre - reach] {
        peaks = significant_peaks(near_significances, first, best.significance);
        track();
      });
      return;
    }
    lags.emplace(a.angles, b.angles, least_count);
    schedule.add(1, [this] { search_lags(); });
  }

  void search_lags() {
    if (!lags->next()) return schedule.add(lags->size() / 8, [this] { search_lags(); });
    const Correlation found = lags->best();
    std::vector<Peak> here = significant_peaks(lags->significances(), lags->first_lag(), found.significance);
    lags.reset();
    // a drift smears the correlation of a long drive, so its part with most turning is used
    const bool smeared = !searched_part && found.value < options.smeared_correlation &&
                         b.angles.size() > 2 * points(options.liveliest_part);
    if (best.value == 0 || found.value > best.value) {
      best = found;
      peaks = std::move(here);
    }
    if (!smeared) return track();
    searched_part = true;
    lags.emplace(a.angles, liveliest_part(b.angles, points(options.liveliest_part)),
                 points(options.least_overlap));
    schedule.add(1, [this] { search_lags(); });
  }

  /// The most significant ones first.
  std::vector<Peak> significant_peaks(std::span<const float> significances, std::ptrdiff_t first_lag,
                                      double most) const {
    std::vector<Peak> found = peaks_of(significances, first_lag, options.candidate_significance * most,
                                       options.candidate_depth * most);
    std::stable_sort(found.begin(), found.end(),
                     [](const Peak& x, const Peak& y) { return x.significance > y.significance; });
    return found;
  }

  /// The series with only the part of this length that turns most; the rest is unknown.
  static Series liveliest_part(const Series& series, std::size_t length) {
    const auto turn = [&](std::size_t i) { return std::max(0.0, series[i]); };
    double here = 0, most = -1;
    std::size_t end = length;
    for (std::size_t i = 0; i < series.size(); ++i) {
      here += turn(i) - (i >= length ? turn(i - length) : 0);
      if (i + 1 >= length && here > most) {
        most = here;
        end = i + 1;
      }
    }
    Series part(series.size(), -1);
    for (std::size_t i = end - length; i < end; ++i) part[i] = series[i];
    return part;
  }

  void track() {
    if (!(best.significance > 0)) return;
    parts.emplace(a.angles, b.angles, step_us, options, schedule,
                  [this](double lag, double rate) { refine(lag, rate); });
    parts->begin(best.lag);
  }

  /// lag [grid steps], in the middle of b where the clock drifts.
  void refine(double lag, double rate) {
    const std::int64_t begin_a = a.poses.front().time_us, begin_b = b.poses.front().time_us;
    const auto shift_us = static_cast<std::int64_t>(std::llround(lag * static_cast<double>(step_us)));
    const std::int64_t offset_us = begin_a - begin_b + shift_us;
    const std::int64_t from = std::max(begin_b, begin_a - offset_us),
                       to = std::min(b.poses.back().time_us, a.poses.back().time_us - offset_us);
    if (to <= from) return;
    ClockLine model;
    model.at_b_us =
        rate != 0 ? begin_b + static_cast<std::int64_t>(parts->middle() * second_us) : from + (to - from) / 2;
    model.at_a_us = model.at_b_us + offset_us;
    model.rate = rate;
    refinement.emplace(a.poses, b.poses, options, max_gap_us, schedule, [this] { compare_candidates(); });
    refinement->begin(model, static_cast<double>(step_us));
  }

  /// The offset to prefer among those that fit equally well [us]: the given one, or zero if by the stamps
  /// most of the shorter stream overlaps the other one. Clocks that share nothing have no such offset; then
  /// it is that of the best correlation.
  double preferred_us(double best_us) const {
    if (options.near) return *options.near * second_us;
    const auto lasts = [](const Trajectory& poses) { return poses.back().time_us - poses.front().time_us; };
    const std::int64_t common = std::min(a.poses.back().time_us, b.poses.back().time_us) -
                                std::max(a.poses.front().time_us, b.poses.front().time_us);
    return 2 * common > std::min(lasts(a.poses), lasts(b.poses)) ? 0 : best_us;
  }

  /// Compares candidates: the motion may repeat, so that another offset fits as well.
  void compare_candidates() {
    if (!refinement->result()) return;
    result = refinement->result();
    const ClockLine& found = refinement->clock();
    const double best_us = static_cast<double>(found.at_a_us - found.at_b_us) + found.shift_us,
                 preferred = preferred_us(best_us);
    const auto step = static_cast<double>(step_us);
    std::vector<double> offsets{best_us};
    const auto add = [&](double offset) {
      for (const double other : offsets)
        if (std::abs(offset - other) < 2 * step) return;
      offsets.push_back(offset);
    };
    const auto offset_of = [&](const Peak& peak) {
      return best_us + static_cast<double>(peak.lag - best.lag) * step;
    };
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      if (std::abs(offset_of(peaks[i]) - preferred) < std::abs(offset_of(peaks[nearest]) - preferred))
        nearest = i;
      if (offsets.size() < options.most_candidates) add(offset_of(peaks[i]));
    }
    if (!peaks.empty()) add(offset_of(peaks[nearest]));
    add(preferred);
    if (offsets.size() < 2) return;
    std::vector<ClockLine> starts;
    for (const double offset : offsets) {
      starts.push_back(found);
      starts.back().at_a_us += std::llround(offset - best_us);
    }
    candidates.emplace(a.poses, b.poses, options, max_gap_us, schedule, [this] { take_candidate(); });
    candidates->begin(std::move(starts), step, preferred);
  }

  void take_candidate() {
    if (candidates->first()) return conclude();
    refinement.emplace(a.poses, b.poses, options, max_gap_us, schedule, [this] {
      result = refinement->result();
      conclude();
    });
    refinement->begin(candidates->clock(), 0);
  }

  void conclude() {
    if (!result || options.near) return;
    result->stddev = std::max({result->stddev, candidates->farthest_us() / second_us,
                               std::abs(candidates->unsure_us()) / second_us});
    if (!candidates->alone()) result->rival = result->seconds + candidates->nearest_us() / second_us;
  }

  TimeOffsetOptions options;
  Schedule schedule;
  std::size_t steps = 0;
  bool finished = false;
  Stream a, b;
  std::int64_t step_us = 0, max_gap_us = 0;
  std::optional<LagSearch> lags;
  std::vector<float> near_significances;
  Correlation best;
  std::vector<Peak> peaks;
  bool searched_part = false;
  std::optional<PartSearch> parts;
  std::optional<Refinement> refinement;
  std::optional<CandidateComparison> candidates;
  std::optional<TimeOffset> result;
};

TimeOffsetSearch::TimeOffsetSearch(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options)
    : impl_(std::make_unique<Impl>(a, b, options)) {}
TimeOffsetSearch::~TimeOffsetSearch() = default;
TimeOffsetSearch::TimeOffsetSearch(TimeOffsetSearch&&) noexcept = default;
TimeOffsetSearch& TimeOffsetSearch::operator=(TimeOffsetSearch&&) noexcept = default;

bool TimeOffsetSearch::step(std::size_t work) {
  if (finished()) return true;
  ++impl_->steps;
  return impl_->finished = impl_->schedule.run(work);
}

std::size_t TimeOffsetSearch::steps() const {
  return impl_->steps;
}

bool TimeOffsetSearch::finished() const {
  return impl_->finished;
}

std::optional<TimeOffset> TimeOffsetSearch::finish() {
  while (!step(1'000'000)) {
  }
  return impl_->result;
}

std::optional<TimeOffset> estimate_time_offset(const Trajectory& a, const Trajectory& b,
                                               const TimeOffsetOptions& options) {
  return TimeOffsetSearch(a, b, options).finish();
}

std::int64_t on_clock_of_a(const TimeOffset& offset, std::int64_t time_us) {
  const double drift = offset.drifts ? offset.rate * static_cast<double>(time_us - offset.at_us) : 0;
  return time_us + std::llround(offset.seconds * second_us + drift);
}

Trajectory on_clock_of_a(const TimeOffset& offset, Trajectory b) {
  for (StampedPose& pose : b) pose.time_us = on_clock_of_a(offset, pose.time_us);
  return b;
}

}  // namespace egocal
