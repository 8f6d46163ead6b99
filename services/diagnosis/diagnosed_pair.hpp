// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "diagnosis/diagnosing_options.hpp"
#include "diagnosis/drive_sample.hpp"
#include "diagnosis/followed_clock.hpp"
#include "diagnosis/judged_answer.hpp"
#include "diagnosis/memory.hpp"
#include "diagnosis/unseen.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/scale.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

/// What a diagnosis process knows of one sensor pair: its poses, its newest problem and the last verdict.
/// Times named mono_us are the loop's monotonic time [us], all others stamps of the sensors on the clock of
/// a.
struct DiagnosedPair {
  /// unscaled: whose scale is to be found.
  DiagnosedPair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& pair,
                std::optional<Side> unscaled, const DriveSampleOptions& options);

  /// The sensor's clock was set back: its earlier poses belong to another timeline.
  void begin_anew(Side side);
  void take_pose(Side side, const StampedPose& pose, std::int64_t mono_us);
  /// Takes the newest problem and scale, if some have come. Returns why a scale was refused; empty: it was
  /// not.
  std::string take_problem(std::int64_t mono_us);
  /// Continues from a saved memory.
  void restore(DriveSample saved_sample, FollowedClock saved_clock, PairMemory saved);
  PairMemory memory() const;

  /// Whether a new problem, or poses alone, are to be judged. early: only if nothing more comes, so that the
  /// judgement need not wait.
  bool to_be_judged(std::int64_t mono_us, bool early, const DiagnosingOptions& options) const;
  /// Whether the newest answer is far from the judged one (DiagnosingOptions::far_from_judged). True at most
  /// once for each problem; a solve takes microseconds.
  bool left_what_was_judged(const DiagnosingOptions& options);
  /// The scale of the newest problem, which comes in a separate message; empty: it has not come.
  std::optional<double> scale_in_force() const;
  /// The part of the session that cannot be judged. poses: number of poses of each stream at common times.
  Unseen unseen(std::size_t poses) const;
  /// Time until which both streams have poses [us]; 0: one of them has none.
  std::int64_t common_end_us() const;

  bus::PairConfig config;
  std::optional<Side> unscaled;
  ProblemInbox inbox;
  bus::Newest<scale_problem_t> scales;
  bus::ScaleCheck scale;
  DriveSample sample;
  FollowedClock clock;
  std::optional<ReceivedProblem> newest;
  std::int64_t newest_mono_us = 0;       ///< when its number was new
  PairMemory known;                      ///< without its sample and offsets
  bool continues[2] = {};                ///< of each side: no pose has come since the restart
  std::int64_t judged_seq = -1;          ///< of the newest problem's session; -1: none
  std::int64_t judged_until_us = 0;      ///< time of the last poses that were judged
  std::int64_t newest_pose_mono_us = 0;  ///< arrival
  std::optional<verdict_t> verdict;      ///< the last one, of the newest problem's session
  std::optional<JudgedAnswer> judged;    ///< what that is about; empty: it called the answer no good
  std::int64_t compared_seq = -1;        ///< of the newest problem whose answer was compared with it
  std::string error;                     ///< why its last diagnosis failed; empty: it did not
  bool paused = false;

 private:
  bool idle(std::int64_t mono_us, const DiagnosingOptions& options) const;
  void begin_session(const problem_t& message);
  void note_what_was_missed(Side side, const StampedPose& pose);
  void forget_what_was_missed();
};

}  // namespace egocal::services
