// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/order_statistic.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "statistics/select.hpp"

namespace egocal::detail {

namespace {

/// Values that are sorted first, to know about where the wanted one is; of fewer than `few` in all it is not
/// worth it. It is looked for this many places of the sample to either side.
constexpr std::size_t sample_size = 32, few = 128, margin = 5;

}  // namespace

double order_statistic(std::span<const double> values, std::size_t place, const Expected& expected) {
  const std::size_t room = 2 * values.size();
  const auto numbers = std::make_unique_for_overwrite<double[]>(room);
  const std::span<double> kept(numbers.get(), room);
  const auto [low, high] = expected;
  std::size_t below = 0, within = 0;
  for (const double value : values) {  // without a branch that the processor could guess wrongly
    const auto from_low = static_cast<unsigned>(value >= low), to_high = static_cast<unsigned>(value <= high);
    kept[within] = value;
    within += from_low & to_high;
    below += 1 - from_low;
  }
  if (place >= below && place - below < within) return selected({kept.data(), within}, place - below, kept);
  return selected(values, place, kept);
}

double order_statistic(std::span<const double> values, std::size_t place) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Expected expected{-infinity, infinity};
  if (values.size() >= few) {
    std::array<double, sample_size> sample;
    for (std::size_t i = 0; i < sample_size; ++i) sample[i] = values[i * values.size() / sample_size];
    std::sort(sample.begin(), sample.end());
    const std::size_t about = place * sample_size / values.size();
    if (about >= margin) expected.low = sample[about - margin];
    if (about + margin < sample_size) expected.high = sample[about + margin];
  }
  return order_statistic(values, place, expected);
}

}  // namespace egocal::detail
