// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/stream_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnosis/rounded_copy.hpp"
#include "diagnosis/stillest_point.hpp"
#include "diagnosis/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/pairing/match_samples.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "statistics/median.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

struct Steps {
  std::size_t all = 0, equal = 0;           ///< steps; of these the same in both streams
  std::size_t frozen_a = 0, frozen_b = 0;   ///< one pose repeated while the other one moves
  double travelled_a = 0, travelled_b = 0;  ///< size of the other stream's motion meanwhile
  double travelled = 0;                     ///< size of all motions
};

/// Largest part of a motion: half-angles and half-lengths as they come.
double size_of(const DualQuaternion& motion) {
  return std::max(motion.real.tail<3>().norm(), motion.dual.norm());
}

/// What computing with a pose adds to a motion from it.
double rounding_of(const DualQuaternion& pose, const StreamCheckOptions& options) {
  return options.rounding * (1 + pose.dual.norm());
}

Steps steps_of(const Instants& instants, const StreamCheckOptions& options) {
  Steps steps;
  const std::size_t n = instants.size();
  const std::size_t each = std::max<std::size_t>(1, n / options.most);
  for (std::size_t i = 0; i + 1 < n; i += each) {
    const PosePair from = instants.at(i), to = instants.at(i + 1);
    const DualQuaternion a = canonical_sign(conjugate(from.a) * to.a),
                         b = canonical_sign(conjugate(from.b) * to.b);
    const double size_a = size_of(a), size_b = size_of(b);
    const bool still_a = size_a < rounding_of(from.a, options),
               still_b = size_b < rounding_of(from.b, options);
    if (still_a && still_b) continue;
    ++steps.all;
    steps.travelled += std::max(size_a, size_b);
    // digits of a file: with coordinates of a map these may be those of a motion
    const double digits = options.same * (1 + from.a.dual.norm() + from.b.dual.norm());
    const double alike = std::max(rounding_of(from.a, options) + rounding_of(from.b, options),
                                  std::min(digits, options.same_part * std::max(size_a, size_b)));
    if ((a.vec() - b.vec()).norm() < alike) ++steps.equal;
    if (still_a) {
      ++steps.frozen_a;
      steps.travelled_a += size_b;
    }
    if (still_b) {
      ++steps.frozen_b;
      steps.travelled_b += size_a;
    }
  }
  return steps;
}

Finding frozen(char which, double part) {
  Finding finding;
  finding.code = std::string("frozen_") + which;
  finding.certain = true;
  say(finding,
      format("%s repeats its pose during %.0f %% of the way that the other one travels: it is frozen or "
             "has no new poses.",
             mark(which), 100 * part),
      format("Look at the odometry of %s; use the part of the drive where both move.", mark(which)));
  return finding;
}

/// A stream whose positions lack a coordinate: one that never changes although the sensor tilts, which on a
/// plane it would not.
struct Flatness {
  char coordinate = 0;  ///< x, y or z of the file; 0: none
  double tilt = 0;      ///< root mean square of the turning out of the plane of the other two [rad]
};

/// How a stream tilts in motions of one length beside one that turns in a plane, whatever its axes are: root
/// mean squares [rad].
struct Tilting {
  double tilt = 0;   ///< of the axis that tilts least
  double noise = 0;  ///< difference of what both streams turn about that axis and in the plane
};

const DualQuaternion& motion_of(const Motion& motion, Side side) {
  return side == Side::a ? motion.a : motion.b;
}

/// The axis of a sensor that its motions move least, and the root mean square of how far [rad].
std::pair<Eigen::Vector3d, double> stillest_axis(const Motions& motions, Side side) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Motion& motion : motions.all) {
    const Eigen::Matrix3d moved = rotation_of(motion_of(motion, side)) - Eigen::Matrix3d::Identity();
    squares += moved.transpose() * moved;
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  return {eigen.vectors.col(0),
          std::sqrt(std::max(0.0, eigen.values[0]) / static_cast<double>(motions.all.size()))};
}

Tilting tilting(const Instants& instants, Side side, const StreamCheckOptions& options) {
  const int stride = std::max(1, static_cast<int>(instants.size() / options.parts));
  const Motions motions = motions_of(instants, {}, {}, stride, options.most);
  if (motions.all.size() < options.least) return {};
  const Side plane = side == Side::a ? Side::b : Side::a;
  const auto [axis, tilt] = stillest_axis(motions, side);
  const Eigen::Vector3d normal = stillest_axis(motions, plane).first;
  const auto about = [](const Eigen::Vector3d& up, const QuaternionVector& q) {
    return 2 * std::atan2(up.dot(q.tail<3>()), q[0]);
  };
  double same = 0, opposite = 0;  // either end of an axis may be up
  for (const Motion& motion : motions.all) {
    const double turned = about(axis, motion_of(motion, side).real),
                 in_plane = about(normal, motion_of(motion, plane).real);
    same += std::pow(turned - in_plane, 2);
    opposite += std::pow(turned + in_plane, 2);
  }
  return {tilt, std::sqrt(std::min(same, opposite) / static_cast<double>(motions.all.size()))};
}

Flatness flatness(const Trajectory& trajectory, const StreamCheckOptions& options) {
  Flatness result;
  if (trajectory.size() < options.least) return result;
  const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
  const Pose first = to_pose(trajectory.front().pose);
  Eigen::Vector3d low = first.translation, high = low, tilt = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < trajectory.size(); i += each, count += 1) {
    const Pose pose = to_pose(trajectory[i].pose);
    low = low.cwiseMin(pose.translation);
    high = high.cwiseMax(pose.translation);
    const Eigen::Vector3d turn = 2 * (pose.rotation * first.rotation.conjugate()).vec();
    tilt += (turn.squaredNorm() - turn.array().square()).matrix();
  }
  const Eigen::Vector3d range = high - low;
  Eigen::Index flat = 0;
  if (range.minCoeff(&flat) > options.flat * range.maxCoeff() || !(range.maxCoeff() > 0)) return result;
  // a stream that moves along one axis lacks two coordinates, and any motion along it is that of a plane
  if ((range.array() <= options.flat * range.maxCoeff()).count() > 1) return result;
  result.coordinate = "xyz"[flat];
  result.tilt = std::sqrt(tilt[flat] / count);
  return result;
}

/// Whether a stream turns, and about one axis of its world alone.
bool turns_about_one_axis(const Trajectory& trajectory, const StreamCheckOptions& options) {
  if (trajectory.size() < options.least) return false;
  const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
  const Rotation back = to_pose(trajectory.front().pose).rotation.conjugate();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < trajectory.size(); i += each, count += 1) {
    const Eigen::Vector3d turn = 2 * (to_pose(trajectory[i].pose).rotation * back).vec();
    squares += turn * turn.transpose();
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  return std::sqrt(std::max(0.0, eigen.values[0] + eigen.values[1]) / count) <= options.level &&
         std::sqrt(eigen.values[2] / count) > options.least_tilt;
}

/// tilt: of the other stream [rad].
Finding never_tilts(char which, double tilt) {
  Finding finding;
  finding.code = std::string("flat_") + which;
  finding.certain = true;
  say(finding,
      format("The rotations of %s are about one axis alone although %s tilts by %.1f deg: roll and pitch are "
             "missing.",
             mark(which), mark(which == 'a' ? 'b' : 'a'), tilt * 180 / std::numbers::pi),
      format("Give whole rotations of %s, or ground planes (planar mode).", mark(which)));
  return finding;
}

/// tilt: its own, or that of the other stream where it has none itself [rad].
Finding flat(char which, char coordinate, double tilt, bool of_other) {
  Finding finding;
  finding.code = std::string("flat_") + which;
  finding.certain = true;
  const std::string claim =
      of_other ? format(
                     "The positions of %s never change in %c, and it turns about that axis alone, although "
                     "%s tilts by %.1f deg: an odometry in two dimensions beside one in three.",
                     mark(which), coordinate, mark(which == 'a' ? 'b' : 'a'), tilt * 180 / std::numbers::pi)
               : format(
                     "The positions of %s never change in %c although it tilts by %.1f deg: a coordinate is "
                     "missing.",
                     mark(which), coordinate, tilt * 180 / std::numbers::pi);
  say(finding, claim,
      format("Give positions of %s in three dimensions, or ground planes (planar mode).", mark(which)));
  return finding;
}

/// A stream of which one half never changes while the other sensor has it: positions that were never filled
/// in, rotations that are all the identity.
std::optional<Finding> without_part(char which, const Trajectory& own, const Trajectory& other,
                                    const StreamCheckOptions& options) {
  struct Sizes {
    double travelled = 0, turned = 0;
    double rounding = 0;  ///< of either
  };
  const auto sizes = [&](const Trajectory& trajectory) {
    Sizes sum;
    const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
    for (std::size_t i = 0; i + each < trajectory.size(); i += each) {
      const DualQuaternion motion = conjugate(trajectory[i].pose) * trajectory[i + each].pose;
      sum.travelled += motion.dual.norm();
      sum.turned += motion.real.tail<3>().norm();
      sum.rounding += rounding_of(trajectory[i].pose, options);
    }
    return sum;
  };
  if (own.size() < options.least || other.size() < options.least) return std::nullopt;
  const Sizes here = sizes(own), there = sizes(other);
  // to rounding as well: poses that were inverted far from their origin travel a million times as far
  const bool travels = here.travelled > std::min(options.flat * there.travelled, here.rounding);
  const bool turns = here.turned > options.flat * there.turned;
  const bool no_positions = !travels && turns && there.travelled > there.rounding;
  const bool no_rotations = !turns && travels && there.turned > options.least_tilt;
  if (no_positions == no_rotations) return std::nullopt;
  Finding finding;
  finding.code = std::string("missing_") + which;
  finding.certain = true;
  say(finding,
      format("The %s of %s never change although %s: they are missing.",
             no_positions ? "positions" : "rotations", mark(which),
             no_positions ? "the other sensor travels" : "the other sensor turns"),
      format("Give poses of %s with positions and rotations.", mark(which)));
  return finding;
}

Finding samples() {
  Finding finding;
  finding.code = "samples";
  say(finding, "These look like still poses of an arm rather than streams.", "{solve}--samples");
  return finding;
}

/// Angles of both streams in one part of the drive, [rad]; medians, which outliers do not change.
struct Window {
  double begin = 0, end = 0;  ///< [s]
  double turned = 0;
  double difference = 0;
  std::vector<double> differences;  ///< of all motions

  double misfit() const { return difference / turned; }
};

std::vector<Window> windows_of(const Motions& motions, std::size_t count) {
  std::vector<Window> windows;
  const std::size_t n = motions.all.size();
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t first = w * n / count, last = (w + 1) * n / count;
    if (first == last) return {};
    std::vector<double> turned, difference;
    for (std::size_t i = first; i < last; ++i) {
      turned.push_back(0.5 * (motions.all[i].angle_a + motions.all[i].angle_b));
      difference.push_back(std::abs(motions.all[i].angle_a - motions.all[i].angle_b));
    }
    const double typical = median(difference);
    windows.push_back({motions.all[first].time, motions.all[last - 1].time, median(std::move(turned)),
                       typical, std::move(difference)});
  }
  return windows;
}

/// What separates windows that agree from those that do not, if anything does: the widest step in the order
/// of their misfits.
std::optional<double> limit_of_agreement(const std::vector<Window>& windows,
                                         const StreamCheckOptions& options) {
  std::vector<double> misfits;
  misfits.reserve(windows.size());
  for (const Window& window : windows) misfits.push_back(std::max(window.misfit(), options.same));
  std::sort(misfits.begin(), misfits.end());
  std::optional<double> limit;
  double widest = options.step;
  for (std::size_t i = 1; i < misfits.size(); ++i) {
    const double agreeing = misfits[i - 1], other = misfits[i];
    if (agreeing > options.agree || other < options.disagree || other < widest * agreeing) continue;
    widest = other / agreeing;
    limit = std::sqrt(agreeing * other);
  }
  return limit;
}

}  // namespace

Finding same_stream() {
  Finding finding;
  finding.code = "same_stream";
  finding.certain = true;
  finding.message = "Both streams are the same to rounding: one sensor was given twice.";
  finding.remedy = "Give the poses of the other sensor.";
  finding.T_a_b = Pose{};
  return finding;
}

std::vector<Finding> check_streams(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                   const StreamCheckOptions& options) {
  std::vector<Finding> findings;
  if (look_like_samples(a, b)) findings.push_back(samples());
  const Steps steps = steps_of(instants, options);
  if (steps.equal >= options.least && steps.equal == steps.all) findings.push_back(same_stream());
  const auto check = [&](char which, std::size_t count, double travelled) {
    if (count < options.least || !(travelled > options.least_frozen * steps.travelled)) return;
    findings.push_back(frozen(which, travelled / steps.travelled));
  };
  for (const char which : {'a', 'b'}) {
    const Flatness found = flatness(which == 'a' ? a : b, options);
    if (found.coordinate != 0 && found.tilt > options.least_tilt) {
      findings.push_back(flat(which, found.coordinate, found.tilt, false));
    } else if (found.coordinate != 0 ? found.tilt <= options.level
                                     : turns_about_one_axis(which == 'a' ? a : b, options)) {
      const Tilting other = tilting(instants, which == 'a' ? Side::b : Side::a, options);
      if (other.tilt > options.least_tilt && other.tilt > options.over_noise * other.noise)
        findings.push_back(found.coordinate != 0 ? flat(which, found.coordinate, other.tilt, true)
                                                 : never_tilts(which, other.tilt));
    }
    if (std::optional<Finding> missing =
            which == 'a' ? without_part('a', a, b, options) : without_part('b', b, a, options))
      findings.push_back(*std::move(missing));
  }
  check('a', steps.frozen_a, steps.travelled_a);
  check('b', steps.frozen_b, steps.travelled_b);
  if (findings.empty())
    if (std::optional<Finding> copy = rounded_copy(a, b, instants)) findings.push_back(*std::move(copy));
  return findings;
}

bool travel_together(const Motions& motions, const StreamCheckOptions& options) {
  std::vector<double> of_a, of_b, ratios;
  for (const Motion& motion : motions.all) {
    const double a = motion.t_a.norm(), b = motion.t_b.norm();
    if (!(a > 0 && b > 0)) continue;
    of_a.push_back(std::log(a));
    of_b.push_back(std::log(b));
    ratios.push_back(std::log(b / a));
  }
  if (ratios.size() < options.least) return false;
  const auto scatter = [](const std::vector<double>& values) {
    const double middle = median(values);
    std::vector<double> deviations;
    for (const double value : values) deviations.push_back(std::abs(value - middle));
    return median(std::move(deviations));
  };
  return scatter(ratios) < options.lengths_agree * std::min(scatter(of_a), scatter(of_b));
}

std::vector<Finding> unrelated_part(const Motions& motions, const StreamCheckOptions& options) {
  std::vector<Window> windows = windows_of(motions, options.windows);
  std::erase_if(windows, [&](const Window& window) {
    return !(window.turned > options.least_turning * motions.rotation);
  });
  if (windows.size() < 4) return {};
  const std::optional<double> limit = limit_of_agreement(windows, options);
  if (!limit) return {};
  const auto disagrees = [&](const Window& window) { return window.misfit() > *limit; };
  // one run of windows
  const auto first = std::find_if(windows.begin(), windows.end(), disagrees);
  const auto end = std::find_if_not(first, windows.end(), disagrees);
  if (std::find_if(end, windows.end(), disagrees) != windows.end()) return {};
  if (end - first < 2 || static_cast<std::ptrdiff_t>(windows.size()) - (end - first) < 2) return {};
  // noise of one size is a large part of the angle where little is turned
  std::vector<double> other, all_others;
  for (auto window = first; window != end; ++window) {
    other.push_back(window->difference);
    all_others.insert(all_others.end(), window->differences.begin(), window->differences.end());
  }
  double agreeing = 0;
  for (const Window& window : windows)
    if (!disagrees(window)) agreeing = std::max(agreeing, window.difference);
  if (!(median(std::move(other)) > options.step * agreeing)) return {};
  // wrong poses spoil some of the motions; of another drive all are wrong
  const auto agrees = [&](double difference) { return difference <= options.step * agreeing; };
  const auto count = static_cast<double>(std::count_if(all_others.begin(), all_others.end(), agrees));
  if (count > options.most_agreeing * static_cast<double>(all_others.size())) return {};
  const auto last = end - 1;
  Finding finding;
  finding.code = "unrelated";
  finding.certain = true;
  finding.time = first->begin;
  finding.message = format(
      "The two streams do not turn together from %.0f to %.0f s after the start, and do in the rest of the "
      "drive: another recording, a clock that jumped, or an odometry that was lost.",
      first->begin, last->end);
  finding.remedy = "Use the part of the drive where the streams belong together.";
  return {finding};
}

std::vector<Finding> in_one_frame(const Answered& answered, const StreamCheckOptions& options) {
  const Vector6d x = frame_a_difference(DualQuaternion{}, answered.T_a_b);
  const Observability& seen = answered.observability;
  int known_translations = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const bool known =
        seen.observable[i] && seen.stddev[i] < (i < 3 ? options.known_translation : options.known_rotation);
    if (!known && i < 3) continue;
    if (!known || !(std::abs(x[static_cast<Eigen::Index>(i)]) <=
                    std::max(i < 3 ? options.close : options.parallel, 3 * seen.stddev[i])))
      return {};
    if (i < 3) ++known_translations;
  }
  if (known_translations < 2) return {};
  Finding finding;
  finding.code = "same_stream";
  finding.message = format(
      "The answer is the identity to %.2f deg and %.1f cm: both streams may be of one frame, such as that of "
      "the vehicle.",
      x.tail<3>().norm() * 180 / std::numbers::pi, 100 * x.head<3>().norm());
  finding.remedy =
      "Give the poses of the sensors themselves, not moved to a common frame; ignore this where the sensors "
      "really sit side by side and look the same way.";
  return {finding};
}

std::vector<Finding> made_from_each_other(const Fit& fit, const StreamCheckOptions& options) {
  if (fit.rotation_median > options.of_rounding || fit.translation_relative_median > options.of_rounding)
    return {};
  Finding finding;
  finding.code = "same_stream";
  finding.message =
      "The motions agree to rounding, as those of two sensors never do: one stream was made from the other, "
      "or "
      "both were simulated without noise.";
  finding.remedy = "Give what each sensor measured by itself; ignore this where the streams were simulated.";
  return {finding};
}

}  // namespace egocal::detail
