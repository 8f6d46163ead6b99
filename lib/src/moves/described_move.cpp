// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/described_move.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "egocal/microseconds.hpp"
#include "moves/change_place.hpp"
#include "statistics/order_statistic.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Pairs = std::span<const MotionPair>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Converts tangent coordinates to (dt, dtheta) in the frame of sensor a [m, rad]; length: unit of the
/// blocks.
Vector6d in_frame_a(const Parameters& x, double length, const Problem& problem) {
  Vector6d result = Vector6d::Zero();
  if (problem.mode == Mode::spatial) {
    result = x;
  } else {
    result << x[0], x[1], 0, 0, 0, x[2];
  }
  result.head<3>() *= length;
  return result;
}

/// Sets the change of a move and its standard deviations in sensor a's frame. covariance: in tangent
/// coordinates, with unit lengths of the block.
void describe_change(const ParameterMatrix& covariance, double length, const Problem& problem, Move& move) {
  Vector6d variance = Vector6d::Constant(infinity);
  if (problem.mode == Mode::spatial) {
    variance = covariance.diagonal();
  } else {
    // plane a's axes in sensor a; the directions that the planes fix have no variance of their own
    const Eigen::Matrix3d R = to_pose(plane_frame(problem.plane_a)).rotation.toRotationMatrix();
    Eigen::Matrix3d shift = Eigen::Matrix3d::Zero();
    shift.topLeftCorner<2, 2>() = covariance.topLeftCorner(2, 2);
    variance.head<3>() = (R * shift * R.transpose()).diagonal();
    variance.tail<3>() = covariance(2, 2) * R.col(2).cwiseAbs2();
  }
  variance.head<3>() *= length * length;
  const Vector6d change = frame_a_difference(move.before, move.after);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    move.change[i] = change[k];
    move.stddev[i] = std::sqrt(std::max(0.0, variance[k]));
  }
}

/// Minimiser over pairs [from, to) (planar mode: T_p).
DualQuaternion minimiser_of(const TestedDrive& drive, std::size_t from, std::size_t to) {
  const std::size_t count = std::clamp<std::size_t>((to - from) / 16, 1, drive.options.most_blocks);
  return gated_blocks(drive.pairs.subspan(from, to - from), drive.problem, count, drive.options.test).q;
}
DualQuaternion extrinsic(const Problem& problem, const DualQuaternion& q) {
  if (problem.mode == Mode::spatial) return canonical_sign(q);
  return extrinsic_from_planar(q, plane_frame(problem.plane_a), plane_frame(problem.plane_b));
}

double seconds(const TestedDrive& drive, std::int64_t time_us) {
  return to_seconds(time_us - drive.origin_us);
}

ChangePlace place_of(const TestedDrive& drive, const FoundChange& found, const DualQuaternion& before,
                     const DualQuaternion& after) {
  ChangePlace place = locate_change(drive.pairs.subspan(found.from, found.to - found.from), drive.problem,
                                    before, after, found.test.correlation, drive.overlap, drive.options);
  for (std::size_t* index : {&place.at, &place.earliest, &place.latest}) *index += found.from;
  return place;
}

/// How much worse the motions of one side fit the answer of the other side than their own: ratio of root
/// mean squares, without the tails.
double contradiction(const TestedDrive& drive, Pairs side, const DualQuaternion& own,
                     const DualQuaternion& other) {
  std::vector<double> fits;
  for (const MotionPair& pair : side) fits.push_back(pair_residual(pair, own, drive.problem.balance));
  const double most = drive.options.place_residual * order_statistic(fits, fits.size() / 2);
  double fit = 0, misfit = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    fit += std::min(fits[i], most);
    misfit += std::min(pair_residual(side[i], other, drive.problem.balance), most);
  }
  return fit > 0 ? std::sqrt(misfit / fit) : infinity;
}

/// A slow change: from the first motion of the stretch to the last one.
void describe_creep(const TestedDrive& drive, const FoundChange& found, Move& move) {
  move.kind = MoveKind::creep;
  const DualQuaternion q = in_units_of(1 / found.stretch.length, found.stretch.q);
  const auto moved = [&](const Parameters& x) {
    return extrinsic(drive.problem, frame_a_moved(q, in_frame_a(x, found.stretch.length, drive.problem)));
  };
  move.before = moved(found.test.begin);
  move.after = moved(found.test.end);
  move.time = move.earliest = seconds(drive, drive.pairs[found.from].begin_us);
  move.latest = seconds(drive, drive.pairs[found.to - 1].end_us);
}

/// Describes a step; false where a large turn is not credible.
bool describe_step(const TestedDrive& drive, const FoundChange& found, Move& move) {
  DualQuaternion before = minimiser_of(drive, found.from, found.at),
                 after = minimiser_of(drive, found.at, found.to);
  ChangePlace at = place_of(drive, found, before, after);
  // once more, with the answers of the better division
  if (at.at != found.at && at.at > found.from && at.at < found.to) {
    before = minimiser_of(drive, found.from, at.at);
    after = minimiser_of(drive, at.at, found.to);
    at = place_of(drive, found, before, after);
  }
  move.before = extrinsic(drive.problem, before);
  move.after = extrinsic(drive.problem, after);
  if (to_pose(before).rotation.angularDistance(to_pose(after).rotation) > drive.options.large_turn &&
      std::min(contradiction(drive, drive.pairs.subspan(found.from, at.at - found.from), before, after),
               contradiction(drive, drive.pairs.subspan(at.at, found.to - at.at), after, before)) <
          drive.options.large_turn_contradicts)
    return false;
  const auto middle = [&](std::size_t i) {
    return 0.5 * (seconds(drive, drive.pairs[i].begin_us) + seconds(drive, drive.pairs[i].end_us));
  };
  move.time = 0.5 * (middle(at.at - 1) + middle(at.at));
  move.earliest = seconds(drive, drive.pairs[at.earliest > 0 ? at.earliest - 1 : 0].begin_us);
  move.latest = seconds(drive, drive.pairs[std::min(at.latest, drive.pairs.size() - 1)].end_us);
  return true;
}

}  // namespace

std::size_t placed(const TestedDrive& drive, const FoundChange& found) {
  return place_of(drive, found, minimiser_of(drive, found.from, found.at),
                  minimiser_of(drive, found.at, found.to))
      .at;
}
void move_to_place(const TestedDrive& drive, FoundChange& found) {
  const std::size_t at = placed(drive, found);
  if (at > found.from && at < found.to) found.at = at;
}

std::optional<Move> described(const TestedDrive& drive, const FoundChange& found) {
  Move move;
  move.false_alarm = found.test.false_alarm;
  move.certain = found.certain;
  if (found.creep)
    describe_creep(drive, found, move);
  else if (!describe_step(drive, found, move))
    return std::nullopt;
  describe_change(found.test.covariance, found.stretch.length, drive.problem, move);
  return move;
}

}  // namespace egocal::detail
