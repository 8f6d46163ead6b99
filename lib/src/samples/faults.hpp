// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with the samples themselves.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/samples/named_samples.hpp"
#include "samples/sample_fit.hpp"

namespace egocal::detail {

/// Two motions: fewer show no hand-eye pose.
constexpr std::size_t least_units = 3;

/// Finding too_little_motion: fewer than least_units.
Finding too_few_poses(std::size_t units);

/// When the turns of a set say nothing.
struct SmallTurnOptions {
  /// Three quarters of the motions turn by less than this in both lists [rad]: 3 degrees, where a set
  /// wants 20.
  double least_turn = 0.05235987755982988;
  /// Noise is more than this part of the turn, as motions of which a third is not explained contradict each
  /// other (DiagnosisOptions::doubtful_misfit).
  double much_noise = 0.33;
  /// The ways of both lists differ by less than this part: honest ones by hundredths, rows in a wrong order
  /// by a third.
  double alike = 0.1;
};

/// Finding too_little_motion: turns that are no larger than their noise, between positions that agree.
std::optional<Finding> turns_too_small(std::span<const PoseSample> samples, const SampleNoise& noise,
                                       const SmallTurnOptions& options = {});

/// When few samples may agree by chance. Study: sets of 4 to 7 with the rotations of one list inverted, or
/// its rows in a wrong order, whose noise is 4 % and more; honest detections have 1 % at most.
struct ChanceOptions {
  std::size_t few = 8;       ///< units; as many and more do not agree by chance
  double much_noise = 0.03;  ///< standard deviation of one sample, in parts of the length or in radians
  /// Any number of samples agrees badly from here on: a target that was moved half-way by 10 to 20 cm leaves
  /// 0.1 and more, and twenty samples of it were `incomplete` without a word.
  double too_much_noise = 0.09;
};

/// Whether so few samples would agree as badly if they did not belong together.
bool agree_by_chance(const SampleSet& set, const SampleNoise& noise, const ChanceOptions& options = {});

/// Whether the noise of one sample is larger than that of any arm or detector.
bool agree_badly(const SampleSet& set, const SampleNoise& noise, const ChanceOptions& options = {});

/// Whether the poses of both lists are the same to the digits that files keep, read alike or one as the
/// inverse.
bool given_twice(const SampleSet& set, std::span<const PoseSample> samples);

/// Finding wrong_samples, of those that were rejected.
Finding wrong_samples(const std::vector<SampleResidual>& residuals, const SampleNames& names);

}  // namespace egocal::detail
