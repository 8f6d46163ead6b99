// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/smoothed_rotations.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "diagnosis/explanations/times/late_rotations.hpp"
#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/mount_fit.hpp"
#include "diagnosis/motions/speeds.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int mean_delay = first_number, of_acceleration = second_number;

/// The rotations of one stream, seen with the mounting in force.
class SmoothedStream {
 public:
  SmoothedStream(const Instants& instants, const Explained& given, Side side,
                 const SmoothedRotationsOptions& options)
      : instants_(instants),
        side_(side),
        T_((side == Side::b ? to_pose(given.fit.T) : inverse(to_pose(given.fit.T))).rotation),
        span_(static_cast<std::size_t>(given.motions.stride)),
        reach_(reach_of_rates(instants, options.least_span, options.most_instants)),
        longest_(options.times.across_a_gap * static_cast<double>(span_ + 2 * reach_) * instants.period) {}

  std::vector<LinearMotion> motions(const Explained& given, std::size_t most) const {
    const std::vector<std::size_t> all = begins_of(instants_, given.motions);
    const std::size_t n = std::min(all.size(), most);
    std::vector<LinearMotion> motions;
    for (std::size_t k = 0; k < n; ++k)
      if (const std::size_t i = all[k * all.size() / n]; has(i)) motions.push_back(motion(i));
    return motions;
  }

 private:
  struct Rates {
    Vector3d turning, acceleration;  ///< [rad/s, rad/s^2], in the frame of the stream
  };

  bool has(std::size_t i) const {
    const std::size_t last = i + span_ + reach_;
    return i >= reach_ && last < instants_.size() &&
           instants_.time(last) - instants_.time(i - reach_) <= longest_;
  }
  Rotation own(std::size_t i) const {
    const PosePair poses = instants_.at(i);
    return to_pose(side_ == Side::b ? poses.b : poses.a).rotation;
  }
  Rotation other(std::size_t i) const {
    const PosePair poses = instants_.at(i);
    return to_pose(side_ == Side::b ? poses.a : poses.b).rotation;
  }
  Rates rates(std::size_t i) const {
    const Rotation here = own(i);
    const double before = instants_.time(i) - instants_.time(i - reach_),
                 after = instants_.time(i + reach_) - instants_.time(i);
    const Vector3d from = rotation_log(own(i - reach_).conjugate() * here) / before,
                   to = rotation_log(here.conjugate() * own(i + reach_)) / after;
    const double both = before + after;
    return {(from * after + to * before) / both, 2 * (to - from) / both};
  }
  /// A filter with response h gives y = x - m x' + (m^2 + v) x'' / 2 - ..., with the mean delay m and its
  /// variance v. So x = y + m y' + (m^2 - v) y'' / 2, in the frame of the stream and for rotations likewise:
  ///   log(R_T' R_a R_T R_b') = (1 - R_b) turn + m (R_b w' - w) + (m^2 - v) / 2 (R_b u' - u)
  /// with turning rates w, accelerations u, and ' at the end of the motion.
  LinearMotion motion(std::size_t i) const {
    const Rates from = rates(i), to = rates(i + span_);
    const Rotation of_other = other(i).conjugate() * other(i + span_),
                   of_own = own(i).conjugate() * own(i + span_);
    const Matrix3d turned = of_own.toRotationMatrix();
    LinearMotion result;
    result.rotation = rotation_log(T_.conjugate() * of_other * T_ * of_own.conjugate());
    result.translation.setZero();
    result.of_translation.setZero();
    result.of_rotation << Matrix3d::Identity() - turned, Matrix3d::Zero(), turned * to.turning - from.turning,
        turned * to.acceleration - from.acceleration;
    return result;
  }

  const Instants& instants_;
  Side side_;
  Rotation T_;
  std::size_t span_, reach_;
  double longest_;
};

/// Whether a filter that delays by so much smooths by so much.
bool is_of_filter(const SmoothedRotations& found, double delay, const SmoothedRotationsOptions& options) {
  return found.width() > options.least_width * delay && found.width() < options.most_width * delay;
}

bool is_smoothed(const SmoothedRotations& found, const SmoothedRotationsOptions& options) {
  return found.sigmas() > options.sigmas && found.gain > options.least_gain;
}

/// By how much the answer moves with the positions of the stream on time, and the rotations late by `delay`
/// [s], from the one with both at the time of the rotations: in the frame of a. Empty: the positions have
/// that time.
std::optional<Vector6d> moved_by_positions_on_time(const OnClock& clock, Side side, double delay,
                                                   const SmoothedRotationsOptions& options) {
  const StreamOfTwoTimes stream(clock.instants, clock.explained, side, options.times);
  const std::vector<LinearMotion> motions = stream.motions(clock.explained, options.fit.most);
  if (motions.size() < options.least) return std::nullopt;
  const MountFit together(motions, options.fit);
  const MountNumbers positions = MountNumbers::Unit(time_of_positions);
  const double shown = positions.dot(together.best(FreeNumbers::two)),
               near = options.positions_sigmas * together.stddev(positions);
  // where the clock suits the rotations, positions on time are those of times that are later by the delay
  if (std::abs(shown) < near && std::abs(shown - delay) > near) return std::nullopt;
  std::vector<LinearMotion> positions_on_time = motions;
  for (LinearMotion& motion : positions_on_time) {
    motion.rotation -= delay * motion.of_rotation.col(time_of_positions);
    motion.translation -= delay * motion.of_translation.col(time_of_positions);
  }
  const MountFit apart(positions_on_time, options.fit);
  return frame_a_difference(stream.T_a_b(together.best(FreeNumbers::none)),
                            stream.T_a_b(apart.best(FreeNumbers::none)));
}

/// Positions that may be on time beside smoothed rotations of their stream.
struct OnTime {
  SmoothedRotations rotations;
  double delay = 0;   ///< of the rotations [s]
  Vector6d moved;     ///< of moved_by_positions_on_time()
  bool clear = true;  ///< in size as well; else in most parts of the drive alone
};

/// offset: of the clock that suits the rotations from the one in force [s]; empty: the clock in force suits
/// them, and may have their delay in it.
std::optional<OnTime> on_time(const OnClock& clock, Side side, std::optional<double> offset,
                              const SmoothedRotationsOptions& options) {
  const std::optional<SmoothedRotations> found =
      smoothed_rotations(clock.instants, clock.explained, side, options);
  if (!found) return std::nullopt;
  const bool clear = is_smoothed(*found, options);
  // beside a clock there is a delay to compare the width with, and the parts of the drive decide
  if (!clear && !(offset && found->agreement > options.agreement)) return std::nullopt;
  double delay = found->width();
  if (offset) {
    delay = found->delay + (side == Side::b ? -*offset : *offset);
    if (!is_of_filter(*found, delay, options)) return std::nullopt;
  }
  const std::optional<Vector6d> moved = moved_by_positions_on_time(clock, side, delay, options);
  if (!moved) return std::nullopt;
  return OnTime{*found, delay, *moved, clear};
}

/// Something else that the rotations may look smoothed by, or that is named for it already.
bool explains_smoothed(const Finding& finding) {
  return (certain_of_either(finding) && finding.code != "clock_offset") ||
         finding.code.starts_with("late_positions_") || finding.code == "mount_moved" ||
         finding.code == "too_little_motion";
}

/// T_a_b: the answer with the positions on time.
Finding worded_smoothed(const OnTime& found, const DualQuaternion& T_a_b) {
  const char which = found.rotations.side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("late_positions_") + which;
  finding.improvement = std::exp(std::max(0.0, found.rotations.gain));
  finding.T_a_b = to_pose(T_a_b);
  finding.value = -found.delay;
  say(finding,
      format(
          "The rotations of %s lack fast turns, as those of a filter that delays them by about %.2g s, and "
          "its positions may be on time",
          mark(which), found.delay),
      format("Give positions and rotations of %s of the same times: no filter that smooths or delays one of "
             "them.",
             mark(which)),
      format(": the turns show the filter by %.0f standard deviations, and the positions do not show which "
             "time is theirs. The answer is another one then.",
             found.rotations.sigmas()));
  return finding;
}

}  // namespace

double SmoothedRotations::sigmas() const {
  return variance_stddev > 0 ? variance / variance_stddev : 0;
}

double SmoothedRotations::width() const {
  return std::sqrt(std::max(0.0, variance));
}

std::optional<SmoothedRotations> smoothed_rotations(const Instants& instants, const Explained& given,
                                                    Side side, const SmoothedRotationsOptions& options) {
  const SmoothedStream stream(instants, given, side, options);
  const std::vector<LinearMotion> motions = stream.motions(given, options.fit.most);
  if (motions.size() < options.least) return std::nullopt;
  const MountFit fit(motions, options.fit);
  const MountNumbers x = fit.best(FreeNumbers::two);
  SmoothedRotations found;
  found.side = side;
  found.delay = x[mean_delay];
  found.variance = found.delay * found.delay - 2 * x[of_acceleration];
  const MountNumbers of_variance =
      2 * found.delay * MountNumbers::Unit(mean_delay) - 2 * MountNumbers::Unit(of_acceleration);
  found.variance_stddev = fit.stddev(of_variance);
  found.agreement = fit.agreement(of_variance, found.variance);
  found.gain = fit.gain(fit.best(FreeNumbers::first), x);
  return found;
}

void name_smoothed_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                             Answered& answered, Diagnosis& result,
                             const SmoothedRotationsOptions& smoothed) {
  std::vector<Finding>& findings = result.findings;
  if (std::any_of(findings.begin(), findings.end(), explains_smoothed)) return;
  const auto named = std::find_if(findings.begin(), findings.end(), [](const Finding& one) {
    return one.certain && one.code == "clock_offset" && one.value && one.T_a_b;
  });
  const bool certain_clock = named != findings.end();
  const OnClock clock = certain_clock ? on_clock(evidence, *named->value, max_gap, options)
                                      : OnClock{evidence.instants, evidence.given.explained};
  if (clock.explained.motions.all.empty()) return;
  std::optional<double> offset;
  if (certain_clock) offset = *named->value - evidence.clock.offset;
  std::optional<OnTime> found = on_time(clock, Side::b, offset, smoothed);
  if (!found) found = on_time(clock, Side::a, offset, smoothed);
  if (!found) return;
  const Vector6d moved = in_known_directions(found->moved, answered.observability);
  const double stddevs = found->clear ? smoothed.matters : smoothed.matters_by_agreement;
  if (!matters(moved, answered, options, smoothed.least_move, stddevs)) return;
  const DualQuaternion on_its_clock = certain_clock ? to_dual_quaternion(*named->T_a_b) : answered.T_a_b,
                       T_a_b = frame_a_moved(on_its_clock, moved);
  findings.insert(certain_clock ? std::next(named) : findings.begin(), worded_smoothed(*found, T_a_b));
  widen_by(in_known_directions(frame_a_difference(answered.T_a_b, T_a_b), answered.observability), answered,
           result);
}

}  // namespace egocal::detail
