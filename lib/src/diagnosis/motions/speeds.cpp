// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/speeds.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/reading.hpp"

namespace egocal::detail {

using Eigen::Vector3d;

std::size_t reach_of_rates(const Instants& instants, double seconds, std::size_t most) {
  return std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(0.5 * seconds / std::max(instants.period, 1e-6))), 1, most);
}

Speeds::Speeds(const Instants& instants, double seconds, std::size_t most)
    : instants_(instants), reach_(reach_of_rates(instants, seconds, most)) {}

Vector3d Speeds::at(std::size_t i, Side side) const {
  const std::size_t before = i >= reach_ ? i - reach_ : 0, after = std::min(i + reach_, instants_.size() - 1);
  const double seconds = instants_.time(after) - instants_.time(before);
  if (!(seconds > 0)) return Vector3d::Zero();
  return (position(after, side) - position(before, side)) / seconds;
}

Vector3d Speeds::position(std::size_t i, Side side) const {
  const PosePair poses = instants_.at(i);
  return position_of(side == Side::a ? poses.a : poses.b);
}

}  // namespace egocal::detail
