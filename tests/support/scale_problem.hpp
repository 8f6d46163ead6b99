// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/scale/scale_drive.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// The scale problem of a simulated drive of 300 poses with 1 % of noise, in which the lengths of b are too
/// short by this factor.
inline ScaleProblem scale_problem_of_b(double scale) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = 300;
  options.relative_noise = 0.01;
  options.faults.resize(2);
  options.faults[1].scale = scale;
  const Streams streams = simulated_drive(options);
  ScaleDriveOptions of_b;
  of_b.scale.side = Side::b;
  ScaleDrive drive(of_b);
  for (std::size_t i = 0; i < streams.a.size(); ++i) {
    drive.push(Side::a, streams.a[i]);
    drive.push(Side::b, streams.b[i]);
  }
  return *drive.scale_problem();
}

}  // namespace egocal::testing
