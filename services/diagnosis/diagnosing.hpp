// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/drive_sample.hpp"
#include "diagnosis/followed_clock.hpp"
#include "diagnosis/judged_answer.hpp"
#include "diagnosis/memory.hpp"
#include "diagnosis/saved_memory.hpp"
#include "diagnosis/unseen.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/stream.hpp"
#include "program/commands.hpp"
#include "solving/problems.hpp"

namespace egocal::services {

struct DiagnosingOptions {
  /// Part of a core that diagnoses may take. The next diagnosis waits until the processor time of the last
  /// one is at most this part of the time since that began.
  double share = 0.04;
  /// A new answer farther from the judged one than this is judged once without waiting. In standard
  /// deviations stated with the judged answer. Without it a good verdict stood beside answers metres away for
  /// seconds. Study: docs/processes.md, "The diagnosis".
  double far_from_judged = 6;
  double least_distance = 1;  ///< [s] between two diagnoses, however quick
  /// A pair without a new problem for this time [s] is judged once without waiting, because the drive has
  /// ended.
  double idle = 0.6;
  /// Poses without a new problem are judged in steps of this [s]. If all motions are rejected, as after a
  /// sensor was lost, nothing else reports it. Shorter than a finding needs, much longer than a period of a
  /// sensor.
  double pose_step = 2;
  /// Chance of a false alarm of a moved mount in one diagnosis, and how long before its end [s] the drive
  /// must have shown the move (MountCheckOptions). An hour has 2,000 diagnoses. Study: docs/moves.md, "Live".
  double false_alarms = 4e-4;
  double shown_before = 2;
  /// Messages of one sensor that may wait while a diagnosis takes its time: half a second at 2 kHz.
  int queue_capacity = 1024;
  DriveSampleOptions sample;
  UnseenOptions unseen;
  /// Time between two saved states [s], and the part of the time that saving may take. A slow disk is written
  /// to less often, and messages wait no longer than one save.
  double save_distance = 2;
  double save_share = 0.02;
  /// The diagnosis of the library; tests pass one that fails.
  using Diagnose = Diagnosis(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                             const Answered& answered, const DiagnosisOptions& options);
  std::function<Diagnose> diagnose = static_cast<Diagnose*>(&egocal::diagnose);
};

/// egocal-diagnosis: from the poses of the sensors and the problems to verdict_t. Judges the certified
/// optimum of the newest problem, which it computes itself, so it needs and trusts no solver process. It
/// judges the poses that it has received; a saved memory adds those of an earlier process.
class Diagnosing {
 public:
  Diagnosing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig,
             std::unique_ptr<SavedMemory> saved = nullptr, const DiagnosingOptions& options = {});
  ~Diagnosing();
  Diagnosing(const Diagnosing&) = delete;
  Diagnosing& operator=(const Diagnosing&) = delete;

 private:
  struct Sensor {
    bus::Sensor config;
    Stream stream;
    std::int64_t in = 0;
  };
  struct Pair {
    Pair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& pair,
         std::optional<Side> whose_scale, const DriveSampleOptions& options)
        : config(pair),
          unscaled(whose_scale),
          inbox(loop, heartbeat, pair),
          scales(loop, bus::scale_problem_channel(pair.a, pair.b)),
          sample(options) {}
    bus::PairConfig config;
    std::optional<Side> unscaled;  ///< whose scale is to be found
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
  };

  void take(std::size_t sensor, const bus::Arrival& arrival);
  void take_problems();
  void look();
  bool left_what_was_judged(Pair& pair) const;
  bool idle(const Pair& pair) const;
  bool to_be_judged(const Pair& pair, bool early) const;
  void restore(Memory memory);
  void save();
  Memory memory() const;
  static void note_what_was_missed(Pair& pair, Side side, const StampedPose& pose);
  static void forget_what_was_missed(Pair& pair);
  static Unseen unseen_of(const Pair& pair, std::size_t poses);
  void judge(Pair& pair);
  void restart_after_move(Pair& pair, const Diagnosis& diagnosis);
  void repeat();
  void obey(Verb verb, const command_t& command);
  void report();
  std::string error() const;
  void count();

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  bus::Rig rig_;
  DiagnosingOptions options_;
  std::vector<Sensor> sensors_;
  std::vector<std::unique_ptr<Pair>> pairs_;
  std::unique_ptr<SavedMemory> saved_;  ///< empty: no state is kept
  std::int64_t save_mono_us_ = 0;       ///< not before
  std::int64_t saved_poses_ = -1;       ///< received when the last state was written
  std::string save_error_;
  std::size_t turn_ = 0;                 ///< the pair that is judged next where several wait
  std::int64_t not_before_mono_us_ = 0;  ///< see DiagnosingOptions::share
  bool hurried_ = false;                 ///< the last diagnosis did not wait until then
};

}  // namespace egocal::services
