// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/mixed_frames_jumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Motions from one instant to the next one.
struct FrameStep {
  Pose of_a, of_b;
  double seconds = 0;
  bool follows = false;  ///< the one before
};

/// Steps that follow one another in runs, as the order of jumps counts.
std::vector<FrameStep> frame_steps(const Instants& instants, const FrameJumpsOptions& options) {
  std::vector<FrameStep> steps;
  const std::size_t n = instants.size() - 1, run = n <= options.most ? n : options.run;
  const std::size_t each = std::max(run, n * options.run / options.most);
  for (std::size_t begin = 0; begin + run <= n; begin += each) {
    PosePair before = instants.at(begin);
    for (std::size_t i = begin; i < begin + run; ++i) {
      const PosePair after = instants.at(i + 1);
      steps.push_back({inverse(to_pose(before.a)) * to_pose(after.a),
                       inverse(to_pose(before.b)) * to_pose(after.b), instants.time(i + 1) - instants.time(i),
                       i > begin});
      before = after;
    }
  }
  return steps;
}

/// The offset T of the frames by a step of a stream, M', and the one that the other stream says, M. There,
/// M' = M T; back, M' = inv(T) M.
struct OffsetOfStep {
  Pose there, back;
};

OffsetOfStep offset_of(const FrameStep& step, Side side, const Pose& T_a_b) {
  const Pose said = side == Side::b ? inverse(T_a_b) * step.of_a * T_a_b : T_a_b * step.of_b * inverse(T_a_b);
  const Pose& own = side == Side::b ? step.of_b : step.of_a;
  return {inverse(said) * own, said * inverse(own)};
}

/// Half of a pose: the rotation vector [rad] or the position [m].
Eigen::Vector3d half_of(const Pose& pose, bool rotation) {
  return rotation ? rotation_log(pose.rotation) : pose.translation;
}

enum class Jump { none, there, back, either, unlike };  ///< either: a half turn is its own inverse

bool jumps(Jump jump) {
  return jump == Jump::there || jump == Jump::back || jump == Jump::either;
}

struct HalfOffset {
  Eigen::Vector3d there, back;
};

Jump jump_of(const HalfOffset& step, const Eigen::Vector3d& offset, double radius) {
  const double size = radius * offset.norm();
  const bool there = (step.there - offset).norm() <= size, back = (step.back - offset).norm() <= size;
  if (there || back) return !back ? Jump::there : !there ? Jump::back : Jump::either;
  return step.there.norm() <= size ? Jump::none : Jump::unlike;
}

std::vector<Jump> jumps_by(const std::vector<HalfOffset>& halves, const Eigen::Vector3d& offset,
                           double radius) {
  std::vector<Jump> result;
  result.reserve(halves.size());
  for (const HalfOffset& half : halves) result.push_back(jump_of(half, offset, radius));
  return result;
}

bool enough(std::ptrdiff_t part, double least, std::size_t all) {
  return static_cast<double>(part) >= least * static_cast<double>(all);
}

/// The jumps by the step whose offset explains most of the steps; empty where none explains enough.
std::vector<Jump> best_jumps(const std::vector<HalfOffset>& halves, const FrameJumpsOptions& options) {
  std::vector<std::size_t> order(halves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    return halves[i].there.squaredNorm() < halves[k].there.squaredNorm();
  });
  std::vector<Jump> best;
  std::ptrdiff_t most = 0;
  for (std::size_t k = 0; k < options.tries; ++k) {
    const HalfOffset& tried = halves[order[(2 * k + 1) * order.size() / (2 * options.tries)]];
    for (const Eigen::Vector3d& offset : {tried.there, tried.back}) {
      std::vector<Jump> labels = jumps_by(halves, offset, options.radius);
      const auto unlike = std::count(labels.begin(), labels.end(), Jump::unlike);
      const auto explained = static_cast<std::ptrdiff_t>(labels.size()) - unlike;
      if (explained <= most || !enough(explained, options.least_explained, labels.size()) ||
          !enough(std::count_if(labels.begin(), labels.end(), jumps), options.least_jumps, labels.size()))
        continue;
      most = explained;
      best = std::move(labels);
    }
  }
  return best;
}

/// A jump there is followed by one back. What is neither may have been any of them.
bool alternate(const std::vector<FrameStep>& steps, const std::vector<Jump>& labels, double least) {
  std::size_t followed = 0;
  std::ptrdiff_t alternating = 0;
  Jump last = Jump::unlike;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!steps[i].follows || labels[i] == Jump::unlike) last = Jump::unlike;
    if (!jumps(labels[i])) continue;
    if (last != Jump::unlike) {
      ++followed;
      if (labels[i] != last || last == Jump::either) ++alternating;
    }
    last = labels[i];
  }
  return followed > 0 && enough(alternating, least, followed);
}

/// Share of the poses in the frame that has fewer, among those whose frame is known.
double share_of(const std::vector<FrameStep>& steps, const std::vector<Jump>& labels) {
  std::array<double, 2> count{};
  std::optional<bool> other;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!steps[i].follows || labels[i] == Jump::unlike) other.reset();
    if (labels[i] == Jump::either && other) other = !*other;
    if (labels[i] == Jump::there || labels[i] == Jump::back) other = labels[i] == Jump::there;
    if (other) ++count[*other ? 1 : 0];
  }
  return std::min(count[0], count[1]) / std::max(1.0, count[0] + count[1]);
}

Eigen::Vector3d median_of_each(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::Vector3d result;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Eigen::Vector3d& vector : vectors) values.push_back(vector[k]);
    result[k] = median(std::move(values));
  }
  return result;
}

/// What the steps of a stream show of the frames in one half of the poses.
class JumpsOfHalf {
 public:
  JumpsOfHalf(const std::vector<FrameStep>& steps, const Pose& T_a_b, bool rotation,
              const FrameJumpsOptions& options)
      : steps_(steps), T_a_b_(T_a_b), rotation_(rotation), options_(options) {}

  std::optional<OtherFrame> find() {
    // either stream may be the one: seen from the other one the offset is as constant
    for (const FrameStep& step : steps_) {
      const OffsetOfStep offset = offset_of(step, Side::b, T_a_b_);
      halves_.push_back({half_of(offset.there, rotation_), half_of(offset.back, rotation_)});
    }
    labels_ = best_jumps(halves_, options_);
    if (labels_.empty()) return std::nullopt;
    offset_ = median_of_each(offsets());
    labels_ = jumps_by(halves_, offset_, options_.radius);
    if (!alternate(steps_, labels_, options_.least_alternating) || rounding()) return std::nullopt;
    OtherFrame frame;
    frame.noise = std::max(noise(), spread()) / offset_.norm();
    if (frame.noise > options_.most_noise) return std::nullopt;
    frame.side = contrast(Side::a) > contrast(Side::b) ? Side::a : Side::b;
    frame.share = share_of(steps_, labels_);
    // two jumps for each of its rows
    const auto jumped = static_cast<double>(std::count_if(labels_.begin(), labels_.end(), jumps));
    if (2 * frame.share * static_cast<double>(labels_.size()) > options_.most_in_a_row * jumped)
      return std::nullopt;
    measure(frame);
    frame.certain = across_the_way(frame) || constant(frame);
    return frame;
  }

 private:
  std::vector<Eigen::Vector3d> offsets() const {
    std::vector<Eigen::Vector3d> result;
    for (std::size_t i = 0; i < labels_.size(); ++i)
      if (jumps(labels_[i])) result.push_back(labels_[i] == Jump::back ? halves_[i].back : halves_[i].there);
    return result;
  }
  bool rounding() const {
    std::vector<double> sizes_a, sizes_b;
    for (const FrameStep& step : steps_) {
      sizes_a.push_back(half_of(step.of_a, rotation_).norm());
      sizes_b.push_back(half_of(step.of_b, rotation_).norm());
    }
    const double moved = std::max(median(std::move(sizes_a)), median(std::move(sizes_b)));
    return !(offset_.norm() > options_.least_part * moved);
  }
  /// Median residual of steps within a frame.
  double noise() const {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < labels_.size(); ++i)
      if (labels_[i] == Jump::none) sizes.push_back(halves_[i].there.norm());
    return median(std::move(sizes));
  }
  /// Median distance of the jumps from the typical one.
  double spread() const {
    std::vector<double> sizes;
    for (const Eigen::Vector3d& offset : offsets()) sizes.push_back((offset - offset_).norm());
    return median(std::move(sizes));
  }
  Eigen::Vector3d own(std::size_t i, Side side) const {
    return half_of(side == Side::a ? steps_[i].of_a : steps_[i].of_b, rotation_);
  }
  /// How much a stream's own motions there differ from those back, each from its neighbours: those of a body
  /// do not.
  double contrast(Side side) const {
    std::array<std::vector<Eigen::Vector3d>, 2> changes;
    for (std::size_t i = 1; i + 1 < labels_.size(); ++i)
      if (jumps(labels_[i]) && steps_[i].follows && steps_[i + 1].follows)
        changes[labels_[i] == Jump::back ? 1 : 0].push_back(own(i, side) -
                                                            0.5 * (own(i - 1, side) + own(i + 1, side)));
    return (median_of_each(changes[0]) - median_of_each(changes[1])).norm();
  }
  /// Size of the offset in the stream that it is of.
  void measure(OtherFrame& frame) const {
    std::vector<double> distances, angles;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (!jumps(labels_[i])) continue;
      const OffsetOfStep offset = offset_of(steps_[i], frame.side, T_a_b_);
      const Pose& T = labels_[i] == Jump::back ? offset.back : offset.there;
      distances.push_back(T.translation.norm());
      angles.push_back(rotation_log(T.rotation).norm());
    }
    frame.distance = median(std::move(distances));
    frame.angle = median(std::move(angles));
  }
  /// Motion of the body by the stream of one frame, seen from b.
  Eigen::Vector3d way(std::size_t i, Side mixed) const {
    return half_of(mixed == Side::a ? steps_[i].of_b : inverse(T_a_b_) * steps_[i].of_a * T_a_b_, rotation_);
  }
  bool across_the_way(const OtherFrame& frame) const {
    if (rotation_) return false;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (!jumps(labels_[i])) continue;
      const Eigen::Vector3d along = way(i, frame.side).normalized(),
                            offset = labels_[i] == Jump::back ? halves_[i].back : halves_[i].there;
      lengths.push_back((offset - along.dot(offset) * along).norm());
    }
    return median(std::move(lengths)) > std::max(options_.across * offset_.norm(), 2 * noise());
  }
  /// Whether the jumps are of constant size. Jumps of late stamps are a part of the speed instead, by the
  /// stamps or by even times, whichever are right.
  bool constant(const OtherFrame& frame) const {
    std::vector<double> sizes, of_steps, of_speeds;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (!jumps(labels_[i]) || !(steps_[i].seconds > 0)) continue;
      sizes.push_back((labels_[i] == Jump::back ? halves_[i].back : halves_[i].there).norm());
      of_steps.push_back(sizes.back() / std::max(way(i, frame.side).norm(), 1e-12));
      of_speeds.push_back(of_steps.back() * steps_[i].seconds);
    }
    return options_.clearly_constant * relative_deviation(std::move(sizes)) <
           std::min(relative_deviation(std::move(of_steps)), relative_deviation(std::move(of_speeds)));
  }

  const std::vector<FrameStep>& steps_;
  const Pose& T_a_b_;
  bool rotation_;
  const FrameJumpsOptions& options_;
  std::vector<HalfOffset> halves_;
  std::vector<Jump> labels_;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();  ///< of the frames, seen from b
};

}  // namespace

std::optional<OtherFrame> jumps_between_frames(const Instants& instants, const Pose& T_a_b,
                                               const FrameJumpsOptions& options) {
  if (instants.size() <= options.least) return std::nullopt;
  const std::vector<FrameStep> steps = frame_steps(instants, options);
  std::optional<OtherFrame> possible;
  for (const bool rotation : {false, true}) {
    std::optional<OtherFrame> frame = JumpsOfHalf(steps, T_a_b, rotation, options).find();
    if (frame && frame->certain) return frame;
    if (!possible) possible = frame;
  }
  return possible;
}

}  // namespace egocal::detail
