// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/pairing/match_samples.hpp"

namespace egocal {

/// Tuning of calibrate_samples(). The study behind the numbers is tests/bench/sample_study.cpp.
struct SampleOptions {
  /// Find samples that contradict the others and reject them. Fewer than least_to_judge cannot outvote a
  /// wrong one.
  bool robust = true;
  std::size_t least_to_judge = 6;  ///< different ones may be one less: two samples of one pose, one wrong
  /// A sample is wrong where noise alone would explain its residual less often than this. Real detections
  /// have heavier tails than a normal distribution, so it is far below the usual 1e-3.
  double wrong_probability = 1e-6;
  /// A sample is not wrong, either, where it is nearer to the others than this many standard deviations,
  /// learnt from the median of all: detections have heavy tails, which belong to them (8 in the real sets of
  /// the study).
  double heaviest_tail = 8;
  /// Part of the samples that must agree before the others are judged. Up to 40 % may be wrong.
  double least_agreeing = 0.6;
  /// Triples of samples that the search for agreeing ones starts from. 60 draws meet a triple without a wrong
  /// one with a probability of 1 - 1e-6 where 40 % are wrong.
  int starts = 60;
  /// Standard deviation of the logarithm of the ratio of the two noise variances around that of the typical
  /// length: how far few samples may move the weights. 2: between a seventh and seven times the length.
  double prior_log_ratio = 2;
  Reading read_a, read_b;               ///< for poses that do not mean what their format says
  std::optional<DualQuaternion> prior;  ///< taken where the samples show nothing
  DiagnosisOptions diagnosis;           ///< the tolerances are those of the answer called good
  /// The tolerance of the translation is this part of the typical distance to the target where it is smaller
  /// than diagnosis.tolerance_translation: an arm wants less than a vehicle. A degree.
  double tolerance_of_distance = 0.0174;
  /// Motions that the fit is judged on, at most: its medians are good to a tenth. All pairs of 25 samples.
  std::size_t most_motions = 300;
  /// Up to this many samples, the answer without each sample is solved for. Beyond, that answer is taken one
  /// Newton step away: what this misses is of second order in a step that is a thirtieth of the noise. Where
  /// the samples do not show a direction, that step is not small. Then the samples are divided into this many
  /// groups, and the answer without each group is solved for.
  std::size_t most_solved = 30;
};

/// How well one sample fits: the target as this sample sees it, less the target as all see it.
struct SampleResidual {
  double rotation = 0;     ///< [rad]
  double translation = 0;  ///< [m]
  bool wrong = false;      ///< rejected
};

/// Hand-eye and target pose from still poses.
struct SampleCalibration {
  Calibration calibration;  ///< T_a_b is the hand-eye pose (sensor b in sensor a)
  Pose T_world_a_world_b;   ///< the target in the base (eye in hand), or in the hand (eye to hand)
  std::vector<SampleResidual> residuals;  ///< per sample, in the order given
  std::size_t repeated = 0;               ///< samples that repeat another one exactly: they count once
  /// Samples where those that share one pose of a, or one of b, count as one: what the standard deviations
  /// are judged on. Several images at one pose of the arm share its error.
  std::size_t different = 0;
  double spread_median = 0;      ///< of the target's position over the samples that count [m]
  double spread_rms = 0;         ///< [m]
  double spread_largest = 0;     ///< [m]
  double noise_rotation = 0;     ///< standard deviation of one sample, each axis [rad]
  double noise_translation = 0;  ///< [m]
};

/// Solves a X = Y b for X = T_a_b and Y from at least 3 samples in any order; the order changes no bit of the
/// answer, only the finding mount_moved takes it for that in time. Minimises the sum over all motions between
/// two samples of the squared differences of their targets, rotation and position each weighted by the
/// inverse of its variance, which is maximum likelihood for independent noise of both; the minimum of the
/// weighted cost is global, with the certificate of every other solve. The unit of length changes nothing,
/// nor do samples that repeat others exactly. Throws Error where there are fewer than 3 samples. Thread-safe.
SampleCalibration calibrate_samples(std::span<const PoseSample> samples, const SampleOptions& options = {});

}  // namespace egocal
