// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "experiments/data_set.hpp"

namespace egocal::tools {

struct DriveOptions {
  int motions = 1000;
  double step = 1;         ///< along the path on the ground [m]
  double roughness = 1.8;  ///< amplitude of the surface [m]
  std::uint64_t seed = 1;  ///< of path and surface
};

/// One simulated drive (V-A) of two sensors, seen again and again with new noise: what differs between two
/// runs is noise alone.
class NoisyDrive {
 public:
  NoisyDrive(const DriveOptions& options, const Pose& T_a_b);

  /// Mean of sensor a's motions without noise [m, rad].
  double mean_translation() const { return means_[0].translation; }
  double mean_rotation() const { return means_[0].rotation; }

  /// The motions with unbiased Gaussian noise per axis, as a part of each sensor's mean motion. mixed: as
  /// many, each drawn at random from all of the drive. The same seed gives the same bits.
  std::vector<MotionPair> run(double relative_noise, bool mixed, std::uint64_t seed) const;

 private:
  struct Mean {
    double translation = 0, rotation = 0;
  };
  std::vector<MotionPair> pairs_;
  Mean means_[2];
};

}  // namespace egocal::tools
