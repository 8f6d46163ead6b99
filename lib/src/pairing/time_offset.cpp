// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/time_offset_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pairing/offset/correlation.hpp"
#include "pairing/offset/line_fit.hpp"
#include "pairing/offset/refinement.hpp"
#include "pairing/offset/schedule.hpp"
#include "pairing/offset/turning.hpp"

namespace egocal {

using namespace detail;

namespace {

constexpr double second_us = 1e6;  // unit
/// Offset of one part of the drive.
struct WindowOffset {
  double time = 0;    ///< of its middle [s since the begin of b]
  double offset = 0;  ///< [grid steps]
};

/// offset = level + slope * time. Needs two different times.
std::pair<double, double> line_through(const std::vector<WindowOffset>& points) {
  LineFit line;
  for (const WindowOffset& point : points) line.add(point.time, point.offset);
  const double slope = line.slope();
  return {line.level(slope), slope};
}

}  // namespace

struct TimeOffsetSearch::Impl {
  struct Stream {
    Trajectory poses;
    std::vector<Detour> detours;
    Series angles;
  };

  Impl(const Trajectory& given_a, const Trajectory& given_b, const TimeOffsetOptions& given)
      : options(given) {
    a.poses = thinned(given_a, static_cast<std::int64_t>(options.least_spacing * second_us));
    b.poses = thinned(given_b, static_cast<std::int64_t>(options.least_spacing * second_us));
    schedule.add(1, [this] { prepare(); });
  }

  bool long_enough() const { return a.poses.size() >= 10 && b.poses.size() >= 10; }

  void prepare() {
    if (!long_enough()) return;
    const std::int64_t period_us = std::max(median_period_us(a.poses), median_period_us(b.poses));
    const auto period = static_cast<double>(period_us);
    step_us = static_cast<std::int64_t>(std::max(
        std::clamp(period, options.finest_grid * second_us, options.coarsest_grid * second_us), period / 4));
    max_gap_us = static_cast<std::int64_t>(std::clamp(options.max_gap * second_us, 3 * period, 20 * period));
    for (Stream* stream : {&a, &b})
      stream->poses = dense_part(stream->poses, max_gap_us, options.most_sparse);
    if (!long_enough()) return;
    // several times: of neighbouring glitches only the furthest one is found at once
    for (int round = 0; round < options.glitch_rounds; ++round)
      for (Stream* stream : {&a, &b}) schedule.add(1, [this, stream] { remove_glitches(*stream); });
    schedule.add(1, [this] { sample_angles(); });
  }

  void remove_glitches(Stream& stream) {
    stream.detours.assign(stream.poses.size(), {});
    schedule.add_range(stream.poses.size(), [&stream](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) stream.detours[i] = detour(stream.poses, i);
    });
    schedule.add(stream.poses.size() / 4,
                 [this, &stream] { stream.poses = without_glitches(stream.poses, stream.detours, options); });
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
          if (here.significance > best.significance) best = here;
        });
      schedule.add(1, [this] { track(); });
      return;
    }
    lags.emplace(a.angles, b.angles, least_count);
    schedule.add(1, [this] { search_lags(); });
  }

  void search_lags() {
    if (!lags->next()) return schedule.add(lags->size() / 8, [this] { search_lags(); });
    const Correlation found = lags->best();
    lags.reset();
    // a drift smears the correlation of a long drive: its liveliest part shows the offset there
    const bool smeared = !searched_part && found.value < options.smeared_correlation &&
                         b.angles.size() > 2 * points(options.liveliest_part);
    if (best.value == 0 || found.value > best.value) best = found;
    if (!smeared) return track();
    searched_part = true;
    lags.emplace(a.angles, liveliest_part(b.angles, points(options.liveliest_part)),
                 points(options.least_overlap));
    schedule.add(1, [this] { search_lags(); });
  }

  /// The series, known only in the part of this length that turns most.
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

  /// The offset in each part of a long drive, outwards from where both streams agree best. A clock that
  /// drifts smears the correlation of the whole.
  void track() {
    if (!(best.significance > 0)) return;
    const std::size_t size = points(options.part), count = b.angles.size() / std::max<std::size_t>(1, size);
    if (count < 3) return refine(static_cast<double>(best.lag), 0);
    windows.assign(count, {});
    for (std::size_t i = 0; i < count; ++i)
      schedule.add(size / 2, [this, i] { windows[i] = best_in_window(i, best.lag, points(1)); });
    schedule.add(count, [this] { track_outwards(); });
  }

  Correlation best_in_window(std::size_t i, std::ptrdiff_t centre, std::size_t reach) const {
    const std::size_t size = points(options.part);
    Correlation result;
    const auto far = static_cast<std::ptrdiff_t>(reach);
    for (std::ptrdiff_t lag = centre - far; lag <= centre + far; ++lag) {
      const Correlation here = correlation_at(a.angles, b.angles, i * size, (i + 1) * size, lag, size / 4);
      if (here.significance > result.significance) result = here;
    }
    return result;
  }

  void track_outwards() {
    std::size_t start = 0;
    for (std::size_t i = 1; i < windows.size(); ++i)
      if (windows[i].significance > windows[start].significance) start = i;
    const std::size_t reach = std::max<std::size_t>(1, points(options.part_drift * options.part)) + 1;
    const auto follow = [this, reach](std::size_t i, std::ptrdiff_t& lag) {
      windows[i] = best_in_window(i, lag, reach);
      // a part without turns shows no offset
      if (windows[i].value > options.part_correlation) lag = windows[i].lag;
    };
    schedule.add(1, [this, start, follow, forwards = std::make_shared<std::ptrdiff_t>(windows[start].lag),
                     backwards = std::make_shared<std::ptrdiff_t>(windows[start].lag)] {
      for (std::size_t i = start + 1; i < windows.size(); ++i)
        schedule.add(points(options.part) / 4, [follow, i, forwards] { follow(i, *forwards); });
      for (std::size_t i = start; i-- > 0;)
        schedule.add(points(options.part) / 4, [follow, i, backwards] { follow(i, *backwards); });
      schedule.add(windows.size(), [this] { fit_line(); });
    });
  }

  void fit_line() {
    std::vector<WindowOffset> points_;
    for (std::size_t i = 0; i < windows.size(); ++i)
      if (windows[i].value > options.part_correlation)
        points_.push_back(
            {(static_cast<double>(i) + 0.5) * options.part, static_cast<double>(windows[i].lag)});
    const auto global = static_cast<double>(best.lag);
    if (points_.size() < 3) return refine(global, 0);
    auto [level, slope] = line_through(points_);
    // parts that found another peak
    std::vector<double> distances;
    for (const WindowOffset& point : points_)
      distances.push_back(std::abs(point.offset - level - slope * point.time));
    std::vector<double> sorted = distances;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    const double limit = 1 + 3 * sorted[sorted.size() / 2];
    std::vector<WindowOffset> near;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (distances[i] <= limit) near.push_back(points_[i]);
    if (near.size() >= 3) std::tie(level, slope) = line_through(near);
    const double step = static_cast<double>(step_us) / second_us;
    const double middle = 0.5 * options.part * static_cast<double>(windows.size());
    const double rate = slope * step;
    // what three grid points at both ends cannot show is left to the refinement
    if (!(std::abs(rate) < 2 * options.part_drift) || std::abs(rate) * middle < 3 * step)
      return refine(global, 0);
    refine(level + slope * middle, rate);
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
    model.at_b_us = rate != 0 ? begin_b + static_cast<std::int64_t>(0.5 * options.part * second_us *
                                                                    static_cast<double>(windows.size()))
                              : from + (to - from) / 2;
    model.at_a_us = model.at_b_us + offset_us;
    model.rate = rate;
    refinement.emplace(a.poses, b.poses, options, max_gap_us, schedule, [] {});
    refinement->begin(model, static_cast<double>(step_us));
  }

  TimeOffsetOptions options;
  Schedule schedule;
  Stream a, b;
  std::int64_t step_us = 0, max_gap_us = 0;
  std::optional<LagSearch> lags;
  Correlation best;
  bool searched_part = false;
  std::vector<Correlation> windows;
  std::optional<Refinement> refinement;
};

TimeOffsetSearch::TimeOffsetSearch(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options)
    : impl_(std::make_unique<Impl>(a, b, options)) {}
TimeOffsetSearch::~TimeOffsetSearch() = default;
TimeOffsetSearch::TimeOffsetSearch(TimeOffsetSearch&&) noexcept = default;
TimeOffsetSearch& TimeOffsetSearch::operator=(TimeOffsetSearch&&) noexcept = default;

bool TimeOffsetSearch::step(std::size_t work) {
  return impl_->schedule.run(work);
}

std::optional<TimeOffset> TimeOffsetSearch::finish() {
  while (!step(1'000'000)) {
  }
  return impl_->refinement ? impl_->refinement->result() : std::nullopt;
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
