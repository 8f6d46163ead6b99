// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "egocal/diagnosis/options.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/outcome.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/robust/outlier_proof.hpp"
#include "egocal/scale/scale_solution.hpp"

namespace egocal {

/// Options of calibrate(). The defaults need no tuning.
struct CalibrationOptions {
  PairingOptions pairing;             ///< mode, ground planes, stride, weights, time offset, outliers, prior
  Method method = Method::dual;       ///< solver of (18); every answer is verified, whichever solver found it
  bool estimate_time_offset = false;  ///< estimate the clock offset of b first; replaces pairing.time_offset
  Reading read_a, read_b;             ///< for streams that do not mean what their format says
  DiagnosisOptions diagnosis;         ///< when an answer counts as known, and the goal
  double scale = 1;                   ///< the translations of scale_side are multiplied by it first
  bool estimate_scale = false;        ///< estimate that scale from the drive; replaces `scale`
  Side scale_side = Side::a;          ///< the extrinsic is in the other sensor's unit
};

/// Everything that is known about one pair of sensors. Lengths in metres, angles in radians.
struct Calibration {
  Pose T_a_b;    ///< pose of sensor b in the frame of sensor a: p_a = T_a_b p_b
  Pose T_b_a;    ///< its inverse: p_b = T_b_a p_a
  Pose minimum;  ///< of the motions alone; T_a_b but where the prior holds directions
  Verdict verdict = Verdict::incomplete;  ///< whether the answer can be used
  std::string reason;                     ///< of the verdict, one sentence
  Fit fit;                                ///< how well the answer explains the motions, in units
  std::vector<Finding> findings;          ///< what else explains the motions; most important first
  std::optional<Goal> goal;               ///< where one was given
  Certificate certificate;                ///< optimality: whether a better extrinsic for (18) can exist
  Observability observability;            ///< per direction x y z roll pitch yaw, in the frame of a
  SolverStatus status{};                  ///< of the solver
  Choice choice;                          ///< stride and weights in force, and why
  PairingCounts counts;                   ///< poses, instants, inliers, outliers, rejections by reason
  std::optional<OutlierProof> outliers;   ///< of the choice of outliers, where there was one
  std::optional<TimeOffset> time_offset;  ///< the estimate, where one was asked for
  double time_offset_applied = 0;         ///< added to the stamps of b [s]
  std::optional<ScaleSolution> scale;     ///< the estimate, where one was asked for
  double scale_applied = 1;               ///< the translations of one sensor were multiplied by it
  Problem problem;                        ///< the statistics that were solved, in blocks
};

/// The extrinsic of two rigidly mounted sensors from their trajectories, each in its own odometry frame.
/// Throws Error where the options contradict each other, the time offset cannot be estimated, or no motion
/// pair is found; the message counts the rejections by reason. Deterministic. Thread-safe: no shared state.
Calibration calibrate(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options = {});

/// The same from motion pairs of unit dual quaternions, in any order. Of options.pairing it uses mode,
/// planes, balance, robust and prior. Throws Error where `pairs` is empty.
Calibration calibrate(std::span<const MotionPair> pairs, const CalibrationOptions& options = {});

/// The same, one pose at a time, in bounded memory: the extrinsic after the last pose and finish() is that of
/// calibrate() on the whole trajectories, to the last bit. No poses are kept, which has three consequences.
/// Other explanations are not tried and `fit` is not measured, so no verdict is `good`: use calibrate() on
/// the recorded drive for that. The choice of outliers is not proven. With estimate_time_offset the offset is
/// followed while the poses arrive. Use one object per pair of sensors; one thread at a time.
class Calibrator {
 public:
  /// Throws Error where the options contradict each other, and for estimate_scale, which needs the whole
  /// drive.
  explicit Calibrator(CalibrationOptions options = {});
  ~Calibrator();
  Calibrator(Calibrator&&) noexcept;
  Calibrator& operator=(Calibrator&&) noexcept;

  /// Takes the next pose of one sensor, as it was measured: read_a, read_b and scale are applied here. The
  /// two streams may interleave in any way.
  void add(Side side, const StampedPose& pose);

  /// No more poses will come: pairs what a drive too short to show its slower stream has held back.
  void finish();

  /// The answer from all poses so far; empty while there is no motion pair. A few microseconds.
  std::optional<Calibration> answer() const;

  PairingCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The rejections of a pairing in words, for messages: "rejected: 3 gap, 1 out of order", or "none rejected".
std::string rejections_in_words(const PairingCounts& counts);
/// The motions that were solved for, how they are weighted, and why.
std::string motions_in_words(const Calibration& calibration);

}  // namespace egocal
