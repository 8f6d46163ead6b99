// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/copied_positions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/motions/reading.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

namespace {

Finding positions_of_one() {
  Finding finding;
  finding.code = "same_stream";
  finding.message =
      "Both streams travel the same distances to rounding, as two sensors never do: the positions of one "
      "were "
      "copied from the other's, or both are of a third sensor. The translation of the answer is the one that "
      "was put in.";
  finding.remedy =
      "Give what each sensor measured by itself; ignore this where the positions were simulated without "
      "noise.";
  return finding;
}

}  // namespace

std::optional<Finding> copied_positions(const Instants& instants, const Motions& motions,
                                        const CopiedPositionsOptions& options) {
  if (!(motions.rotation > options.turning)) return std::nullopt;
  std::vector<double> distances, differences;
  const std::size_t each = std::max<std::size_t>(1, instants.size() / options.looked_at);
  for (std::size_t i = 0; i + each < instants.size(); i += each) {
    if (instants.between_poses(i) || instants.between_poses(i + each)) continue;
    const PosePair from = instants.at(i), to = instants.at(i + each);
    const double of_a = (position_of(to.a) - position_of(from.a)).norm(),
                 of_b = (position_of(to.b) - position_of(from.b)).norm();
    distances.push_back(of_a);
    differences.push_back(std::abs(of_a - of_b));
  }
  if (distances.size() < options.fewest) return std::nullopt;
  const double distance = median(std::move(distances));
  if (!(distance > 0) || !(median(std::move(differences)) <= options.of_distance * distance))
    return std::nullopt;
  return positions_of_one();
}

}  // namespace egocal::detail
