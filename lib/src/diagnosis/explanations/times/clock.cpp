// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/microseconds.hpp"
#include "pairing/offset/correlation.hpp"
#include "pairing/offset/line_fit.hpp"

namespace egocal::detail {

namespace {

/// Turning rate of one stream in each cell of a grid [rad/s]; negative where unknown.
Series turning_rates(const Trajectory& trajectory, std::span<const float> turning, std::int64_t origin_us,
                     double shift, double step, std::size_t count) {
  Series turned(count, 0.0);
  std::vector<double> covered(count, 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double t0 = to_seconds(trajectory[i - 1].time_us - origin_us) + shift;
    const double t1 = to_seconds(trajectory[i].time_us - origin_us) + shift;
    if (!(t1 > t0) || t1 - t0 > 10 * step) continue;
    const double angle = turning[i - 1];
    // share out over the cells that the interval touches
    const auto first = static_cast<std::ptrdiff_t>(std::floor(t0 / step));
    const auto last = static_cast<std::ptrdiff_t>(std::floor(t1 / step));
    for (std::ptrdiff_t cell = std::max<std::ptrdiff_t>(0, first);
         cell <= std::min(last, static_cast<std::ptrdiff_t>(count) - 1); ++cell) {
      const double from = std::max(t0, static_cast<double>(cell) * step);
      const double to = std::min(t1, static_cast<double>(cell + 1) * step);
      if (!(to > from)) continue;
      turned[static_cast<std::size_t>(cell)] += angle * (to - from) / (t1 - t0);
      covered[static_cast<std::size_t>(cell)] += to - from;
    }
  }
  for (std::size_t i = 0; i < count; ++i) turned[i] = covered[i] > 0.5 * step ? turned[i] / covered[i] : -1;
  return turned;
}

/// Lag in cells with the largest correlation within most_lag of zero, refined by a parabola.
std::optional<double> best_lag(const Series& x, const Series& y, std::ptrdiff_t most_lag, std::size_t first,
                               std::size_t last, std::size_t least_cells) {
  std::vector<double> values;
  for (std::ptrdiff_t lag = -most_lag; lag <= most_lag; ++lag) {
    const Correlation here = correlation_at(y, x, first, last, -lag, least_cells);
    // few common cells correlate by chance
    values.push_back(here.value * std::sqrt(here.count));
  }
  const auto best = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (!(values[best] > 0)) return std::nullopt;
  double lag = static_cast<double>(best) - static_cast<double>(most_lag);
  if (best > 0 && best + 1 < values.size()) {
    const double curvature = values[best - 1] - 2 * values[best] + values[best + 1];
    if (curvature < 0) lag += 0.5 * (values[best - 1] - values[best + 1]) / curvature;
  }
  return lag;
}

/// What is minimised: the log of the squares, which outliers do not dominate.
double misfit(const Explained& explained) {
  if (explained.motions.all.size() < 8) return INFINITY;
  double sum = 0;
  const double floor = 0.25 * explained.fit.typical;
  for (const double square : explained.fit.squares) sum += std::log(square + floor);
  return sum / static_cast<double>(explained.fit.squares.size());
}

/// Clocks from the turning rates alone.
struct CoarseClocks {
  ClockModel offset, drift;
};

std::optional<CoarseClocks> coarse_clocks(const Streams& streams, const ClockModel& start) {
  const ClockSearchOptions& options = streams.options.clock;
  const std::int64_t origin_us = streams.a.front().time_us;
  const double span = to_seconds(streams.a.back().time_us - origin_us);
  const double step = std::max(streams.grid.finest, span / static_cast<double>(options.grid));
  const auto count = static_cast<std::size_t>(span / step);
  if (count < 2 * streams.grid.least_cells) return std::nullopt;
  const Series x = turning_rates(streams.a, streams.turning_a, origin_us, 0, step, count);
  const Series y = turning_rates(streams.b, streams.turning_b, origin_us, start.offset, step, count);
  const auto most_lag = static_cast<std::ptrdiff_t>(
      std::min(options.widest / step, options.widest_part * static_cast<double>(count)));
  const std::optional<double> lag = best_lag(x, y, most_lag, 0, count, streams.grid.least_cells);
  if (!lag) return std::nullopt;
  ClockModel clock{start.offset + *lag * step, 0, 0.5 * span};
  CoarseClocks result{clock, clock};
  const Series aligned = turning_rates(streams.b, streams.turning_b, origin_us, clock.offset, step, count);
  const auto near = static_cast<std::ptrdiff_t>(std::ceil(0.5 * options.most_rate * span / step)) + 2;
  LineFit drift;
  for (std::size_t piece = 0; piece < options.pieces; ++piece) {
    const std::size_t first = piece * count / options.pieces, last = (piece + 1) * count / options.pieces;
    const std::optional<double> own =
        best_lag(x, aligned, std::min(near, most_lag), first, last, streams.grid.least_cells);
    if (!own) continue;
    drift.add(0.5 * static_cast<double>(first + last) * step - clock.middle, *own * step);
  }
  if (drift.points() < 3 || !drift.determined()) return result;
  clock.rate = std::clamp(drift.slope(), -options.most_rate, options.most_rate);
  clock.offset += drift.level(clock.rate);
  result.drift = clock;
  return result;
}

/// A clock that was tried.
struct Trial {
  ClockFit fit;
  double misfit = INFINITY;
};

Trial tried(const Streams& streams, const ClockModel& clock) {
  Trial trial{{clock, explained_by(streams, clock)}, INFINITY};
  trial.misfit = misfit(trial.fit.explained);
  return trial;
}

void take_better(Trial& best, Trial other) {
  if (other.misfit < best.misfit) best = std::move(other);
}

bool same(const ClockModel& x, const ClockModel& y) {
  return x.offset == y.offset && x.rate == y.rate && x.middle == y.middle;
}

/// Moves one number of the clock to the least misfit, from steps of `width` downwards.
void refine(const Streams& streams, double ClockModel::*number, double width, int steps, Trial& best) {
  for (int i = 0; i < steps; ++i, width /= 2.5) {
    const auto moved = [&, from = best.fit.clock](double by) {
      ClockModel clock = from;
      clock.*number += by * width;
      return tried(streams, clock);
    };
    Trial before = moved(-1), after = moved(1);
    const double curvature = before.misfit - 2 * best.misfit + after.misfit;
    const double slope = before.misfit - after.misfit;
    take_better(best, std::move(before));
    take_better(best, std::move(after));
    if (std::isfinite(curvature) && curvature > 0)
      take_better(best, moved(std::clamp(0.5 * slope / curvature, -1.0, 1.0)));
  }
}

void refine_offset(const Streams& streams, Trial& best) {
  refine(streams, &ClockModel::offset, 0.05, 3, best);
}

}  // namespace

std::vector<float> turning_of(const Trajectory& trajectory) {
  std::vector<float> angles;
  angles.reserve(trajectory.size());
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const QuaternionVector turn =
        quaternion_product(quaternion_conjugate(trajectory[i - 1].pose.real), trajectory[i].pose.real);
    angles.push_back(static_cast<float>(rotation_angle(turn)));
  }
  return angles;
}

Explained explained_by(const Streams& streams, const ClockModel& clock) {
  const Instants instants =
      synchronised(streams.a, streams.b, clock, streams.max_gap, streams.each, streams.options.motions);
  Explained result;
  if (instants.size() < 2 || !(instants.period > 0)) return result;
  const int stride = std::max(1, static_cast<int>(std::lround(streams.motion_length / instants.period)));
  result.motions = motions_of(instants, streams.read_a, streams.read_b, stride, streams.options.motions.most,
                              streams.options.motions);
  if (!result.motions.all.empty()) result.fit = robust_fit(result.motions, streams.options.fit);
  return result;
}

std::optional<ClockFit> fit_offset(const Streams& streams, const ClockModel& start) {
  const std::optional<CoarseClocks> coarse = coarse_clocks(streams, start);
  if (!coarse) return std::nullopt;
  Trial offset = tried(streams, {start.offset, start.rate, coarse->offset.middle});
  take_better(offset, tried(streams, coarse->offset));
  if (!std::isfinite(offset.misfit)) return std::nullopt;
  refine_offset(streams, offset);
  return std::move(offset.fit);
}

ClockFits fit_clock(const Streams& streams, const ClockModel& start) {
  const std::optional<CoarseClocks> coarse = coarse_clocks(streams, start);
  if (!coarse) return {};
  Trial offset = tried(streams, {start.offset, start.rate, coarse->offset.middle});
  Trial drift = offset;
  take_better(offset, tried(streams, coarse->offset));
  take_better(drift, tried(streams, coarse->drift));
  const bool alike = same(offset.fit.clock, drift.fit.clock);
  ClockFits fits;
  if (std::isfinite(offset.misfit)) {
    refine_offset(streams, offset);
    fits.offset = offset.fit;
  }
  if (std::isfinite(drift.misfit)) {
    if (alike)
      drift = std::move(offset);
    else
      refine_offset(streams, drift);
    const double span = to_seconds(streams.a.back().time_us - streams.a.front().time_us);
    refine(streams, &ClockModel::rate, 0.05 / std::max(1.0, span), 2, drift);
    refine(streams, &ClockModel::offset, 0.01, 1, drift);
    fits.drift = std::move(drift.fit);
  }
  return fits;
}

}  // namespace egocal::detail
