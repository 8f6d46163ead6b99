// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "diagnosis/motions/motions.hpp"

namespace egocal::detail {

/// Number of instants on each side of an instant, 1 to `most`, between which a rate is measured: over at
/// least `seconds` where `most` allows it.
std::size_t reach_of_rates(const Instants& instants, double seconds, std::size_t most);

/// Velocities of a stream in its world [m/s]: about an instant, from the positions on either side of it. The
/// instants must exist as long as this.
class Speeds {
 public:
  /// seconds, most: as of reach_of_rates().
  Speeds(const Instants& instants, double seconds, std::size_t most);

  Eigen::Vector3d at(std::size_t i, Side side) const;
  /// [m]
  Eigen::Vector3d position(std::size_t i, Side side) const;

 private:
  const Instants& instants_;
  std::size_t reach_;
};

}  // namespace egocal::detail
