// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "egocal/degrees.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

struct LoopOptions {
  /// A loop is open if its misfit exceeds this many times the sum of the standard deviations of its three
  /// answers. Their errors are dependent; the sum is an upper bound for any dependence.
  double sigmas = 3;
  /// And these minima, because systematic errors of odometry repeat in every part of a drive (docs/rigs.md).
  double least_rotation = 0.15 * radians_per_degree;  ///< [rad]
  double least_translation = 0.01;                    ///< [m]
};

/// T_ab T_bc T_ca of the answers that count for three pairs. The identity if they agree.
struct Loop {
  std::array<std::string, 3> sensors;
  double rotation = 0, translation = 0;              ///< misfit [rad, m]
  double rotation_limit = 0, translation_limit = 0;  ///< [rad, m]; infinite: a direction is not observable
  bool open() const { return rotation > rotation_limit || translation > translation_limit; }
};

/// All loops of three pairs that have an answer, in the order of the pairs.
std::vector<Loop> loops_of(const Model& model, const LoopOptions& options = {});

/// The sensor that is in all open loops and in no closed one; empty: there is none, or more than one.
std::string sensor_to_blame(const std::vector<Loop>& loops);

}  // namespace egocal::monitor
