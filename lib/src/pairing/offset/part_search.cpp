// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/part_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/offset/line_fit.hpp"

namespace egocal::detail {

namespace {

/// Offset of one part of the drive.
struct PartOffset {
  double time = 0;    ///< of its middle [s since the begin of b]
  double offset = 0;  ///< [grid steps]
};

/// offset = level + slope * time. Needs two different times.
std::pair<double, double> line_through(const std::vector<PartOffset>& points) {
  LineFit line;
  for (const PartOffset& point : points) line.add(point.time, point.offset);
  const double slope = line.slope();
  return {line.level(slope), slope};
}

}  // namespace

PartSearch::PartSearch(const Series& a, const Series& b, std::int64_t step_us,
                       const TimeOffsetOptions& options, Schedule& schedule, Done done)
    : a_(a), b_(b), step_us_(step_us), options_(options), schedule_(schedule), done_(std::move(done)) {}

std::size_t PartSearch::points(double seconds) const {
  return static_cast<std::size_t>(seconds * second_us / static_cast<double>(step_us_));
}

double PartSearch::middle() const {
  return 0.5 * options_.part * static_cast<double>(parts_.size());
}

void PartSearch::begin(std::ptrdiff_t lag) {
  lag_ = lag;
  const std::size_t size = points(options_.part), count = b_.size() / std::max<std::size_t>(1, size);
  if (count < 3) return done_(static_cast<double>(lag), 0);
  parts_.assign(count, {});
  for (std::size_t i = 0; i < count; ++i)
    schedule_.add(size / 2, [this, i] { parts_[i] = best_in_part(i, lag_, points(1)); });
  schedule_.add(count, [this] { follow_outwards(); });
}

Correlation PartSearch::best_in_part(std::size_t i, std::ptrdiff_t centre, std::size_t reach) const {
  const std::size_t size = points(options_.part);
  Correlation result;
  const auto far = static_cast<std::ptrdiff_t>(reach);
  for (std::ptrdiff_t lag = centre - far; lag <= centre + far; ++lag) {
    const Correlation here = correlation_at(a_, b_, i * size, (i + 1) * size, lag, size / 4);
    if (here.significance > result.significance) result = here;
  }
  return result;
}

void PartSearch::follow_outwards() {
  std::size_t start = 0;
  for (std::size_t i = 1; i < parts_.size(); ++i)
    if (parts_[i].significance > parts_[start].significance) start = i;
  const std::size_t reach = std::max<std::size_t>(1, points(options_.part_drift * options_.part)) + 1;
  const auto follow = [this, reach](std::size_t i, std::ptrdiff_t& lag) {
    parts_[i] = best_in_part(i, lag, reach);
    // a part without turns shows no offset
    if (parts_[i].value > options_.part_correlation) lag = parts_[i].lag;
  };
  schedule_.add(1, [this, start, follow, forwards = std::make_shared<std::ptrdiff_t>(parts_[start].lag),
                    backwards = std::make_shared<std::ptrdiff_t>(parts_[start].lag)] {
    for (std::size_t i = start + 1; i < parts_.size(); ++i)
      schedule_.add(points(options_.part) / 4, [follow, i, forwards] { follow(i, *forwards); });
    for (std::size_t i = start; i-- > 0;)
      schedule_.add(points(options_.part) / 4, [follow, i, backwards] { follow(i, *backwards); });
    schedule_.add(parts_.size(), [this] { fit_line(); });
  });
}

void PartSearch::fit_line() {
  std::vector<PartOffset> shown;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (parts_[i].value > options_.part_correlation)
      shown.push_back({(static_cast<double>(i) + 0.5) * options_.part, static_cast<double>(parts_[i].lag)});
  const auto global = static_cast<double>(lag_);
  if (shown.size() < 3) return done_(global, 0);
  auto [level, slope] = line_through(shown);
  // parts that found another peak
  std::vector<double> distances;
  distances.reserve(shown.size());
  for (const PartOffset& point : shown)
    distances.push_back(std::abs(point.offset - level - slope * point.time));
  const double limit = 1 + 3 * median(distances);
  std::vector<PartOffset> near;
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (distances[i] <= limit) near.push_back(shown[i]);
  if (near.size() >= 3) std::tie(level, slope) = line_through(near);
  const double step = static_cast<double>(step_us_) / second_us;
  const double rate = slope * step;
  // a drift that moves the offset by less than three grid points is left to the refinement
  if (!(std::abs(rate) < 2 * options_.part_drift) || std::abs(rate) * middle() < 3 * step)
    return done_(global, 0);
  done_(level + slope * middle(), rate);
}

}  // namespace egocal::detail
