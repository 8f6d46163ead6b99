// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "egocal/pairing/time_offset.hpp"
#include "egocal/problem/cost.hpp"
#include "pairing/offset/schedule.hpp"

namespace egocal::detail {

/// Clock of b seen from that of a: t_a - at_a_us = (1 + rate) (t_b - at_b_us) + shift_us.
struct ClockLine {
  std::int64_t at_a_us = 0, at_b_us = 0;
  double shift_us = 0;
  double rate = 0;
};

/// Tuning of the Refinement besides TimeOffsetOptions. Study: tests/lib/test_time_offset.cpp.
struct RefinementOptions {
  std::size_t blocks = 32;        ///< parts of the drive, for the standard deviation: as StrideBlocks has
  std::size_t size_classes = 4;   ///< of the motions, each with its own typical difference: quartiles
  std::size_t least_motions = 8;  ///< of all classes; fewer show nothing typical
  /// Least distance of the three offsets, in periods of the slower stream. Half a period, as before
  /// interpolation was smooth, is no parabola when a car is shaken at a third of the rate: offsets were wrong
  /// by up to 16 ms (test_time_offset.cpp).
  double least_arm = 0.15;
};

/// Minimises the certified minimum of the cost (18) over offset and rate of the clock, by parabolas through
/// three offsets; with the rate from how the slopes differ between the parts of the drive. Motions that are
/// outliers at all three offsets are not looked at.
class Refinement {
 public:
  /// a, b: without glitches. arm: error of the model at most [us]. The work is added to the schedule, which
  /// calls `done` at its end.
  Refinement(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options,
             std::int64_t max_gap_us, Schedule& schedule, std::function<void()> done,
             const RefinementOptions& tuning = {});

  void begin(const ClockLine& model, double arm_us);
  const std::optional<TimeOffset>& result() const { return result_; }
  /// The clock at which the refinement ended; with a result only.
  const ClockLine& clock() const { return model_; }
  const DualQuaternion& extrinsic() const { return *q_; }

 private:
  struct Motion {
    std::size_t from = 0, to = 0;  ///< poses of the slower stream
    DualQuaternion motion;         ///< of the slower stream
    double angle = 0;
  };
  /// The motion of the other stream over the same time on its clock.
  struct Other {
    DualQuaternion motion;
    double angle = 0;
    bool known = false;
  };

  struct NewtonStep {
    std::size_t parts = 0;                                                 ///< of the drive that hold motions
    double stddev_without_rate = std::numeric_limits<double>::infinity();  ///< of the offset [s]
    bool with_rate = false;                                                ///< both are determined
    Eigen::Vector2d step = Eigen::Vector2d::Zero(), stddev = Eigen::Vector2d::Zero();  ///< [s, s/s]
  };

  void collect_motions();
  void round();
  void sample(std::size_t which, std::size_t begin, std::size_t end);
  void find_outliers();
  void accumulate(std::size_t begin, std::size_t end);
  NewtonStep newton_step(double arm, const Balance& balance) const;
  void conclude();
  void report(double stddev, double rate, double rate_stddev);
  MotionPair pair(std::size_t which, std::size_t k) const;

  const Trajectory &a_, &b_;
  TimeOffsetOptions options_;
  RefinementOptions tuning_;
  double max_gap_us_;
  Schedule& schedule_;
  std::function<void()> done_;
  bool keys_are_b_ = true;
  double period_us_ = 0;

  ClockLine model_;
  double arm_us_ = 0, least_arm_us_ = 0, duration_ = 0;
  int round_ = 0;
  bool drifts_ = false;
  std::vector<Motion> motions_;
  std::array<std::vector<Other>, 3> others_;  ///< at shift - arm, shift, shift + arm
  std::vector<char> inlier_;
  std::optional<DualQuaternion> q_;  ///< minimiser of the round before
  std::array<std::vector<Statistics>, 3> statistics_;
  std::vector<double> times_;  ///< of the blocks, sum over their motions [s since at_us]
  std::optional<TimeOffset> result_;
};

}  // namespace egocal::detail
