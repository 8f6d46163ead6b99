// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/motions/reading.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "samples/agreeing.hpp"

namespace egocal::detail {

/// The samples as understood by the readings, unit and with canonical signs.
std::vector<PoseSample> reread(std::span<const PoseSample> samples, const PoseReading& read_a,
                               const PoseReading& read_b);
/// The samples as understood by the readings of the options.
std::vector<PoseSample> reread(std::span<const PoseSample> samples, const Reading& read_a,
                               const Reading& read_b);

/// Numbers of the search for other readings. Study: tests/bench/sample_study.cpp, mistakes in real and
/// simulated sets.
struct SampleReadingOptions {
  std::size_t least_samples = 4;  ///< fewer fit many readings
  /// A reading is another one where it makes the squared residuals this many times smaller: a wrong one
  /// leaves residuals as large as the motions, a hundred times those of a right one and more.
  double least_improvement = 10;
  /// A first look takes this many samples. A reading is dropped there whose rotations alone, at their best,
  /// have this many times the variance, or that does not make the squared residuals this many times smaller.
  std::size_t most_at_first = 32;
  double most_worse_rotation = 10, least_at_first = 2;
  double scale_by_chance = 1e-6;  ///< probability of a scale other than 1 by chance, below which it is named
  /// A scale that makes them less smaller is still reported, as uncertain, where it is this far from 1: a
  /// lens is calibrated to a few parts in a thousand, and a printer that fits to the page shrinks by 3 %.
  double least_scale = 0.01;
  double unit_tolerance = 0.05;  ///< a power of ten to this part is a unit
  int rounds_of_signs = 3;       ///< of the quaternions and the sum alternately: settled after two
};

/// Readings of the poses under which they fit far better than as given: one list inverted, another order of
/// the quaternion, positions in other axes than the rotations or both in left-handed ones, another unit of
/// length; or better than chance allows: another size of the target.
std::vector<Finding> find_other_readings(std::span<const PoseSample> samples, const AgreeingSamples& given,
                                         const SampleOptions& options,
                                         const SampleReadingOptions& search = {});

}  // namespace egocal::detail
