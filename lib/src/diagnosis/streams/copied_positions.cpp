// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/copied_positions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/motions/reading.hpp"
#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

Finding positions_of_one() {
  Finding finding;
  finding.code = "same_stream";
  finding.message =
      "Both streams travel the same distances to rounding, as two sensors never do: the positions of one "
      "were copied from the other's, or both are of a third sensor. The translation of the answer is the one "
      "that was put in.";
  finding.remedy =
      "Give what each sensor measured by itself; ignore this where the positions were simulated without "
      "noise.";
  return finding;
}

}  // namespace

std::optional<Finding> copied_positions(const Instants& instants, const Motions& motions,
                                        const CopiedPositionsOptions& options) {
  const auto stride = static_cast<std::size_t>(std::max(1, motions.stride));
  const std::size_t each = std::max<std::size_t>(1, instants.size() / options.looked_at);
  std::vector<double> distances, differences;
  for (std::size_t i = 0; i + stride < instants.size(); i += each) {
    if (instants.between_poses(i) || instants.between_poses(i + stride)) continue;
    const PosePair from = instants.at(i), to = instants.at(i + stride);
    if (rotation_angle(conjugate(from.a) * to.a) < options.turning) continue;
    const double of_a = (position_of(to.a) - position_of(from.a)).norm(),
                 of_b = (position_of(to.b) - position_of(from.b)).norm();
    distances.push_back(of_a);
    differences.push_back(std::abs(of_a - of_b));
  }
  if (distances.size() < options.fewest) return std::nullopt;
  const double least = options.of_distance * median(std::move(distances));
  const auto agree = std::count_if(differences.begin(), differences.end(),
                                   [least](double difference) { return difference <= least; });
  if (!(least > 0) || static_cast<double>(agree) < options.part * static_cast<double>(differences.size()))
    return std::nullopt;
  return positions_of_one();
}

}  // namespace egocal::detail
