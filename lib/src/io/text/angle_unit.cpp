// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/angle_unit.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/degrees.hpp"

namespace egocal::detail {

namespace {

/// 1 - R of directions: 0 where all are the same, about 1 where they are spread over the circle.
double spread(const std::complex<double>& sum, int count) {
  return 1 - std::abs(sum) / count;
}

/// Half way between two angles, doubled.
std::complex<double> doubled_middle(double from, double to) {
  const std::complex<double> sum = std::polar(1.0, 2 * from) + std::polar(1.0, 2 * to);
  const double size = std::abs(sum);
  return size > 0 ? sum / size : std::complex<double>(0);
}

}  // namespace

AngleUnit::AngleUnit(const AngleUnitOptions& options) : options_(options) {
  for (double length = options_.shortest_chord; length <= options_.longest_chord; length *= 2) {
    chords_.emplace_back();
    chords_.back().length = length;
  }
}

void AngleUnit::add_other(double angle) {
  largest_ = std::max(largest_, std::abs(angle));
}

void AngleUnit::add(double time, const std::optional<Eigen::Vector2d>& position, double angle) {
  if (!any_) {
    first_ = angle_at_window_ = angle;
    window_begin_ = time;
  }
  any_ = true;
  add_other(angle);
  // rows may be out of order: what counts is how far apart they are in time
  if (const double elapsed = std::abs(time - window_begin_); elapsed >= options_.window) {
    fastest_ = std::max(fastest_, std::abs(angle - angle_at_window_) / elapsed);
    window_begin_ = time;
    angle_at_window_ = angle;
  }
  if (!position) return;
  for (Chords& chords : chords_) {
    if (!chords.begin) {
      chords.begin = position;
      chords.angle_at_begin = angle;
    }
    const Eigen::Vector2d chord = *position - *chords.begin;
    if (chord.norm() < chords.length) continue;
    const std::complex<double> direction = std::polar(1.0, 2 * std::atan2(chord.y(), chord.x()));
    const std::complex<double> as_radians = doubled_middle(chords.angle_at_begin, angle);
    const std::complex<double> as_degrees =
        doubled_middle(radians_per_degree * chords.angle_at_begin, radians_per_degree * angle);
    ++chords.count;
    chords.path += direction;
    chords.radians[0] += direction * std::conj(as_radians);
    chords.radians[1] += direction * as_radians;
    chords.degrees[0] += direction * std::conj(as_degrees);
    chords.degrees[1] += direction * as_degrees;
    chords.begin = position;
    chords.angle_at_begin = angle;
  }
}

/// A vehicle turns with its direction of travel: in the right unit the angle between the two is the same all
/// along the drive. True: degrees.
std::optional<bool> AngleUnit::of_travel() const {
  struct Spreads {
    double radians = 1, degrees = 1, path = 1;
    double least() const { return std::min(radians, degrees); }
  } best;
  for (const Chords& chords : chords_) {
    if (chords.count < options_.least_chords) continue;
    const auto least = [&](const std::complex<double>(&sums)[2]) {
      return std::min(spread(sums[0], chords.count), spread(sums[1], chords.count));
    };
    const Spreads spreads{least(chords.radians), least(chords.degrees), spread(chords.path, chords.count)};
    if (spreads.least() < best.least()) best = spreads;
  }
  // of a path that is straight no direction tells anything
  if (options_.ratio * best.radians < std::min(best.degrees, best.path)) return false;
  if (options_.ratio * best.degrees < std::min(best.radians, best.path)) return true;
  return std::nullopt;
}

AngleUnit::Decision AngleUnit::decide() const {
  const std::optional<bool> travel = of_travel();
  if (largest_ <= options_.largest_turn) {
    if (travel == true) return {true, "as the direction of travel turns by as many"};
    return {false, "by their size"};
  }
  // beyond a turn: degrees, or radians whose turns are summed; rates of turning are no sums
  if (!any_) return {true, "by their size"};
  const bool too_fast = fastest_ > options_.fastest;
  if (travel == false && too_fast) return {std::nullopt, ""};
  if (travel) return {travel, "as the direction of travel turns by as many"};
  if (too_fast) return {true, "by their size, and nothing turns as fast in radians"};
  // sums of turns begin within one
  if (std::abs(first_) > options_.largest_turn) return {true, "by their size"};
  return {std::nullopt, ""};
}

}  // namespace egocal::detail
