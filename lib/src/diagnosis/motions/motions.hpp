// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The motions that explanations are compared on: of all poses, none screened or rejected, for a wrong reading
// makes right poses look wrong.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "diagnosis/motions/reading.hpp"
#include "diagnosis/motions/remembered_poses.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal::detail {

/// The clock of b as seen from that of a: offset + rate * (time - middle of the overlap) is added to b's
/// stamps.
struct ClockModel {
  double offset = 0;  ///< [s]
  double rate = 0;    ///< [s/s]
  double middle = 0;  ///< [s], on b's clock

  /// A time of b's clock on that of a [s].
  double on_clock_of_a(double time) const { return time + offset + rate * (time - middle); }
};

/// The times of a stream under a clock [s] since an origin, worked out when they are asked for: a drive of a
/// million poses is looked at dozens of times. The trajectory must still be there.
class Times {
 public:
  Times(const Trajectory& trajectory, std::int64_t origin_us, const ClockModel& clock)
      : trajectory_(&trajectory), origin_us_(origin_us), clock_(clock) {}
  std::size_t size() const { return trajectory_->size(); }
  double operator[](std::size_t i) const {
    return clock_.on_clock_of_a(to_seconds((*trajectory_)[i].time_us - origin_us_));
  }

 private:
  const Trajectory* trajectory_;
  std::int64_t origin_us_;
  ClockModel clock_;
};

/// Poses of both sensors at one time.
struct PosePair {
  DualQuaternion a, b;
};

/// Both poses at the stamps of the slower stream; the other one is interpolated when it is asked for, as the
/// comparison of two clocks looks at a few hundred motions of a drive of any length.
class Instants {
 public:
  double period = 0;  ///< median distance [s]

  bool empty() const { return places_.empty(); }
  std::size_t size() const { return places_.size(); }
  /// [s], since the first stamp of a.
  double time(std::size_t i) const { return (*key_times_)[places_[i].key]; }
  /// Poses of both sensors at instant i under readings of the streams, interpolated as read and as pairing
  /// does (pairing/synchroniser.hpp); the trajectories of synchronised() must still be there.
  PosePair at(std::size_t i, const PoseReading& read_a = {}, const PoseReading& read_b = {}) const;
  /// Whether a pose is interpolated at instant i.
  bool between_poses(std::size_t i) const { return part_of_way(places_[i]) > 0; }
  /// Whether the stream of b gives the stamps, and that of a is interpolated.
  bool b_slower() const { return b_slower_; }
  /// The same instants, which remember what at() interpolates in a stream as it was given, unless there are
  /// too many: for instants that are looked at again and again.
  Instants remembering() const;
  /// The same instants, interpolated through another number of poses (SynchroniserOptions::smooth_poses).
  Instants through(std::size_t smooth_poses) const;
  /// The instants that are not marked as wrong. wrong: per instant.
  Instants without(const std::vector<bool>& wrong) const;
  /// Has the memory of what at() needs brought near: a long drive does not fit into the processor's caches.
  /// Nothing where there is no such instant.
  void fetch(std::size_t i) const;

 private:
  friend Instants synchronised(const Trajectory&, const Trajectory&, const ClockModel&, double, std::size_t,
                               const MotionSampleOptions&);

  /// Kept small, as a long drive has millions.
  struct Place {
    std::uint32_t key = 0;     ///< pose of the slower stream
    std::uint32_t before = 0;  ///< pose of the other one, at or before the instant
  };
  /// Where the instant lies between the pose of the other stream and the next one: 0 at the pose, below 1.
  double part_of_way(const Place& place) const;
  /// Both poses at instant i, of the slower stream first.
  PosePair interpolated(std::size_t i, double part, const PoseReading& read_key,
                        const PoseReading& read_other) const;
  /// The pose of the other stream from several ones on both sides, where that can be.
  std::optional<DualQuaternion> interpolated_smoothly(const Place& place, double part,
                                                      const PoseReading& read_other) const;

  const Trajectory* keys_ = nullptr;
  const Trajectory* others_ = nullptr;
  std::optional<Times> key_times_, other_times_;
  std::int64_t max_gap_us_ = 0;
  bool b_slower_ = false;
  SynchroniserOptions interpolation_;
  std::vector<Place> places_;
  std::shared_ptr<RememberedPoses> remembered_;  ///< of the other stream as it was given; empty: none
};

/// each: only every such pose of the slower stream is an instant.
Instants synchronised(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                      std::size_t each = 1, const MotionSampleOptions& options = {});

/// Poses at the ends of motions over `steps` instants, one of which begins at each `each`-th instant: mostly
/// the end of one is the begin of a later one, and is worked out once. The instants must still be there.
class MotionEnds {
 public:
  MotionEnds(const Instants& instants, const PoseReading& read_a, const PoseReading& read_b,
             std::size_t steps, std::size_t each);
  /// Poses at instant i, in the order of the motions.
  PosePair at(std::size_t i);
  /// Has the poses of the motion after the one from instant i to k brought near.
  void fetch_next(std::size_t i, std::size_t k) const;

 private:
  struct Known {
    std::size_t end = 0;  ///< number of the instant, from 1; 0: none yet
    PosePair poses;
  };
  const Instants* instants_;
  PoseReading read_a_, read_b_;
  std::size_t each_;
  std::vector<Known> known_;
};

/// One motion of both sensors, in the parts that residuals are made of.
struct Motion {
  DualQuaternion a, b;
  Eigen::Matrix3d R_a;
  Eigen::Vector3d t_a, t_b;
  double angle_a = 0, angle_b = 0;  ///< [rad]
  double time = 0;                  ///< of its middle [s]
};

struct Motions {
  std::vector<Motion> all;
  double rotation = 0;     ///< typical angle, mean over both sensors (geometric) [rad]
  double translation = 0;  ///< typical length [m]
  int stride = 1;          ///< instants that one motion spans
  std::size_t blocks = 1;  ///< consecutive runs that are long enough to be independent
};

/// Motions over `stride` instants, at most `most` of them, evenly spread.
Motions motions_of(const Instants& instants, const PoseReading& read_a, const PoseReading& read_b, int stride,
                   std::size_t most, const MotionSampleOptions& options = {});

/// Motions that come as such; their order takes the place of time.
Motions motions_of(std::span<const MotionPair> pairs, const MotionSampleOptions& options = {});

/// Sets the typical motion from all of them.
void measure_sizes(Motions& motions);

/// The motions [first, last), measured by the typical motion of the whole drive.
Motions part_of(const Motions& motions, std::size_t first, std::size_t last);

/// The same motions with the lengths of b multiplied.
Motions scaled(const Motions& motions, double scale_b);

}  // namespace egocal::detail
