// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/moves/find_moves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "egocal/microseconds.hpp"
#include "moves/change_place.hpp"
#include "moves/change_test.hpp"
#include "moves/linear_blocks.hpp"
#include "moves/moving_pairs.hpp"
#include "moves/segment_test.hpp"
#include "statistics/order_statistic.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

using detail::ChangeTest;
using detail::Linearised;
using detail::Parameters;
using Pairs = std::span<const MotionPair>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Converts tangent coordinates to (dt, dtheta) in the frame of sensor a [m, rad]; length: unit of the
/// blocks.
detail::Vector6d in_frame_a(const Parameters& x, double length, const Problem& problem) {
  detail::Vector6d result = detail::Vector6d::Zero();
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
void describe_change(const detail::ParameterMatrix& covariance, double length, const Problem& problem,
                     Move& move) {
  detail::Vector6d variance = detail::Vector6d::Constant(infinity);
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
  const detail::Vector6d change = detail::frame_a_difference(move.before, move.after);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    move.change[i] = change[k];
    move.stddev[i] = std::sqrt(std::max(0.0, variance[k]));
  }
}

std::size_t part_of(std::size_t blocks, double part) {
  return static_cast<std::size_t>(std::ceil(part * static_cast<double>(blocks)));
}

/// Blocks on each side of a change, at least.
std::size_t least_side(std::size_t blocks, const MovesOptions& options) {
  return std::max({std::size_t{1}, options.least_side_blocks, part_of(blocks, options.least_side)});
}

class Finder {
 public:
  /// pairs: only those in which the vehicle moves. Times are counted from origin_us.
  Finder(Pairs pairs, std::int64_t origin_us, const Problem& problem, const MovesOptions& options)
      : pairs_(pairs),
        origin_us_(origin_us),
        problem_(detail::weighted_by_noise(pairs, problem, options.test)),
        options_(options),
        overlap_(detail::overlap_of(pairs)) {}

  MovesResult run() {
    MovesResult result;
    if (blocks_in(0, pairs_.size()) < options_.least_blocks) return result;
    result.tested = true;
    search(0, pairs_.size());
    result.chance = std::min(1.0, chance_);
    settle();
    join_same();
    for (const Found& found : found_)
      if (std::optional<Move> move = described(found)) result.moves.push_back(*std::move(move));
    return result;
  }

 private:
  struct Found {
    std::size_t from = 0, to = 0;  ///< the stretch that was tested, pairs
    std::size_t at = 0;            ///< first pair after
    ChangeTest test;
    Linearised stretch;
    bool creep = false;
    bool of_two = false;  ///< found with another one: not tested by itself yet
    bool certain = true;
  };

  std::size_t blocks_in(std::size_t from, std::size_t to) const {
    const auto of = [&](std::size_t pairs) {
      return (to - from) / std::max<std::size_t>({1, pairs, 3 * overlap_});
    };
    const std::size_t count = of(options_.block_pairs);
    if (count >= options_.least_blocks) return std::min(options_.most_blocks, count);
    return std::min(options_.least_blocks, of(options_.least_block_pairs));
  }

  /// With blocks of this number of pairs.
  double false_alarms(std::size_t block_pairs) const {
    return options_.false_alarms * (block_pairs < options_.block_pairs ? options_.of_short_blocks : 1);
  }

  /// The best change within the stretch, if it is significant and large enough to report.
  std::optional<Found> best(std::size_t from, std::size_t to) {
    const std::size_t count = blocks_in(from, to);
    if (count < options_.least_blocks) return std::nullopt;
    Found found;
    found.from = from;
    found.to = to;
    found.stretch = detail::linearise(pairs_.subspan(from, to - from), problem_, count, options_.test);
    if (found.stretch.blocks.empty()) return std::nullopt;
    found.test = detail::test_change(found.stretch.blocks, least_side(count, options_), options_.test);
    if (found.test.split == 0) return std::nullopt;
    chance_ = std::min({chance_, found.test.false_alarm, 2 * found.test.even_false_alarm});
    const double alarms = false_alarms((to - from) / count);
    found.creep = found.test.even && found.test.even_false_alarm <= 0.5 * alarms;
    if (found.creep) {
      found.test.false_alarm = 2 * found.test.even_false_alarm;
      found.test.change = found.test.end - found.test.begin;
      found.test.covariance = found.test.even_covariance;
    }
    if (!(found.test.false_alarm <= alarms) || !large_enough(found)) return std::nullopt;
    found.at = from + found.stretch.begin[found.test.split];
    return found;
  }

  /// A mount that moved and fell back: both changes, each with its own stretch. One division shows little of
  /// it (docs/moves.md, "Falling back").
  std::optional<std::array<Found, 2>> best_two(std::size_t from, std::size_t to) {
    const std::size_t count = blocks_in(from, to);
    if (count < options_.least_blocks) return std::nullopt;
    Found found;
    found.stretch = detail::linearise(pairs_.subspan(from, to - from), problem_, count, options_.test);
    if (found.stretch.blocks.empty()) return std::nullopt;
    const std::size_t side = least_side(count, options_);
    const detail::SegmentTest test =
        detail::test_segment(found.stretch.blocks, side,
                             std::max(2 * side, part_of(count, options_.least_displaced)), options_.test);
    if (test.part.to == 0) return std::nullopt;
    found.test.split = test.part.from;
    found.test.false_alarm = std::min(1.0, test.chance / options_.of_falling_back);
    found.test.correlation = test.correlation;
    found.test.change = test.change;
    found.test.covariance = test.covariance;
    found.of_two = true;
    chance_ = std::min(chance_, found.test.false_alarm);
    const bool fell_back =
        test.chance_of_rest > options_.confirmation || test.rest_by_change <= options_.most_left;
    if (!(found.test.false_alarm <= false_alarms((to - from) / count)) || !large_enough(found) ||
        !(test.chance_of_halves <= options_.confirmation) || !fell_back)
      return std::nullopt;
    std::array<Found, 2> two = {found, found};
    two[0].from = from;
    two[0].at = two[1].from = from + found.stretch.begin[test.part.from];
    two[0].to = two[1].at = from + found.stretch.begin[test.part.to];
    two[1].to = to;
    two[1].test.change = -test.change;
    return two;
  }

  enum class Shown { no, perhaps, clearly };

  /// Noise that wanders for longer than a block makes neighbouring blocks alike, and the test believes it.
  /// Where it still wanders in the longest blocks, its memory is a guess from few of them.
  Shown shown_in_longer_blocks(const Found& found) const {
    double correlation = found.test.correlation, chance = found.test.false_alarm;
    for (std::size_t count = blocks_in(found.from, found.to) / 2;
         correlation > options_.most_correlation && count >= options_.least_blocks; count /= 2) {
      const Linearised stretch = detail::linearise(pairs_.subspan(found.from, found.to - found.from),
                                                   problem_, count, options_.test);
      if (stretch.blocks.empty()) return Shown::no;
      const auto split = std::lower_bound(stretch.begin.begin(), stretch.begin.end(), found.at - found.from) -
                         stretch.begin.begin();
      const detail::ChangeAt longer = detail::test_change_at(stretch.blocks, static_cast<std::size_t>(split),
                                                             least_side(count, options_), options_.test);
      if (!(longer.chance <= options_.false_alarms)) return Shown::no;
      correlation = longer.correlation;
      chance = longer.chance;
    }
    return correlation <= options_.most_correlation ||
                   chance <= options_.false_alarms * options_.of_short_blocks
               ? Shown::clearly
               : Shown::perhaps;
  }

  bool large_enough(const Found& found) const {
    const Eigen::Index shifts = problem_.mode == Mode::planar ? 2 : 3;
    const Parameters& x = found.test.change;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double shown = std::abs(x[i]) - 2 * std::sqrt(std::max(0.0, found.test.covariance(i, i)));
      const double least =
          i < shifts ? options_.least_translation / found.stretch.length : options_.least_rotation;
      if (shown >= least) return true;
    }
    return problem_.mode == Mode::spatial && turned_enough(found);
  }

  /// About an axis across two or three of the frame's no component needs to be large. Noise of three
  /// components makes a length of 1.6 standard deviations, hence one more than for a component.
  bool turned_enough(const Found& found) const {
    const Eigen::Vector3d turned = found.test.change.tail<3>();
    const double angle = turned.norm();
    if (!(angle > 0)) return false;
    const Eigen::Vector3d axis = turned / angle;
    const double variance = axis.dot(found.test.covariance.bottomRightCorner<3, 3>() * axis);
    return angle - 3 * std::sqrt(std::max(0.0, variance)) >= options_.least_rotation;
  }

  /// Divides the stretch until no part shows a change.
  void search(std::size_t from, std::size_t to) {
    if (found_.size() >= options_.most_moves) return;
    const std::optional<Found> found = best(from, to);
    if (!found) {
      search_two(from, to);
      return;
    }
    found_.push_back(*found);
    if (found->creep) return;
    search(from, found->at);
    search(found->at, to);
  }

  void search_two(std::size_t from, std::size_t to) {
    std::optional<std::array<Found, 2>> two = best_two(from, to);
    if (!two) return;
    auto& [moved, back] = *two;
    // motion by motion, as the rest of a block with the other extrinsic would be a change of its own
    move_to_place(moved);
    back.from = moved.at;
    move_to_place(back);
    moved.to = back.at;
    found_.insert(found_.end(), two->begin(), two->end());
    search(from, moved.at);
    search(moved.at, back.at);
    search(back.at, to);
  }

  /// Tests every change again between its neighbours. One that is no longer significant was an echo of them,
  /// or of noise that wanders. Done last, because other changes also make neighbouring blocks alike.
  void settle() {
    std::sort(found_.begin(), found_.end(), [](const Found& x, const Found& y) { return x.at < y.at; });
    for (std::size_t i = 0; i < found_.size();) {
      if (found_[i].creep) {
        ++i;
        continue;
      }
      const std::size_t from = i > 0 ? found_[i - 1].at : 0;
      const std::size_t to = i + 1 < found_.size() ? found_[i + 1].at : pairs_.size();
      const bool tested = found_[i].from == from && found_[i].to == to && !found_[i].of_two;
      const std::optional<Found> again = tested ? found_[i] : best(from, to);
      Shown shown = again ? Shown::clearly : Shown::no;
      if (again && blocks_in(from, to) >= options_.least_blocks) shown = shown_in_longer_blocks(*again);
      if (shown == Shown::no && blocks_in(from, to) >= options_.least_blocks) {
        found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(i));
        continue;
      }
      if (again && !again->creep) found_[i] = *again;
      found_[i].certain = shown != Shown::perhaps;
      ++i;
    }
  }

  /// Minimiser over pairs [from, to) (planar mode: T_p).
  DualQuaternion minimiser(std::size_t from, std::size_t to) const {
    const std::size_t count = std::clamp<std::size_t>((to - from) / 16, 1, options_.most_blocks);
    return detail::gated_blocks(pairs_.subspan(from, to - from), problem_, count, options_.test).q;
  }
  DualQuaternion extrinsic(const DualQuaternion& q) const {
    if (problem_.mode == Mode::spatial) return canonical_sign(q);
    return extrinsic_from_planar(q, plane_frame(problem_.plane_a), plane_frame(problem_.plane_b));
  }

  double seconds(std::int64_t time_us) const { return to_seconds(time_us - origin_us_); }

  detail::ChangePlace place(const Found& found, const DualQuaternion& before,
                            const DualQuaternion& after) const {
    detail::ChangePlace place =
        detail::locate_change(pairs_.subspan(found.from, found.to - found.from), problem_, before, after,
                              found.test.correlation, overlap_, options_);
    for (std::size_t* index : {&place.at, &place.earliest, &place.latest}) *index += found.from;
    return place;
  }

  std::size_t placed(const Found& found) const {
    return place(found, minimiser(found.from, found.at), minimiser(found.at, found.to)).at;
  }
  void move_to_place(Found& found) const {
    const std::size_t at = placed(found);
    if (at > found.from && at < found.to) found.at = at;
  }

  /// Joins two changes that are one change within a block, found from both of its ends.
  void join_same() {
    for (std::size_t i = 0; i + 1 < found_.size();) {
      const Found &x = found_[i], &y = found_[i + 1];
      if (x.creep || y.creep || placed(x) != placed(y)) {
        ++i;
        continue;
      }
      const std::optional<Found> again = best(x.from, y.to);
      Found joined = again && !again->creep ? *again : y;
      joined.from = x.from;
      found_[i] = std::move(joined);
      found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  }

  /// How much worse the motions of one side fit the answer of the other side than their own: ratio of root
  /// mean squares, without the tails.
  double contradiction(Pairs side, const DualQuaternion& own, const DualQuaternion& other) const {
    std::vector<double> fits;
    for (const MotionPair& pair : side) fits.push_back(detail::pair_residual(pair, own, problem_.balance));
    const double most = options_.place_residual * detail::order_statistic(fits, fits.size() / 2);
    double fit = 0, misfit = 0;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      fit += std::min(fits[i], most);
      misfit += std::min(detail::pair_residual(side[i], other, problem_.balance), most);
    }
    return fit > 0 ? std::sqrt(misfit / fit) : infinity;
  }

  /// Empty where a large turn is not credible.
  std::optional<Move> described(const Found& found) const {
    Move move;
    move.false_alarm = found.test.false_alarm;
    move.certain = found.certain;
    if (found.creep) {
      move.kind = MoveKind::creep;
      const DualQuaternion q = detail::in_units_of(1 / found.stretch.length, found.stretch.q);
      const auto moved = [&](const Parameters& x) {
        return extrinsic(detail::frame_a_moved(q, in_frame_a(x, found.stretch.length, problem_)));
      };
      move.before = moved(found.test.begin);
      move.after = moved(found.test.end);
      move.time = move.earliest = seconds(pairs_[found.from].begin_us);
      move.latest = seconds(pairs_[found.to - 1].end_us);
    } else {
      DualQuaternion before = minimiser(found.from, found.at), after = minimiser(found.at, found.to);
      detail::ChangePlace at = place(found, before, after);
      // once more, with the answers of the better division
      if (at.at != found.at && at.at > found.from && at.at < found.to) {
        before = minimiser(found.from, at.at);
        after = minimiser(at.at, found.to);
        at = place(found, before, after);
      }
      move.before = extrinsic(before);
      move.after = extrinsic(after);
      if (to_pose(before).rotation.angularDistance(to_pose(after).rotation) > options_.large_turn &&
          std::min(contradiction(pairs_.subspan(found.from, at.at - found.from), before, after),
                   contradiction(pairs_.subspan(at.at, found.to - at.at), after, before)) <
              options_.large_turn_contradicts)
        return std::nullopt;
      const auto middle = [&](std::size_t i) {
        return 0.5 * (seconds(pairs_[i].begin_us) + seconds(pairs_[i].end_us));
      };
      move.time = 0.5 * (middle(at.at - 1) + middle(at.at));
      move.earliest = seconds(pairs_[at.earliest > 0 ? at.earliest - 1 : 0].begin_us);
      move.latest = seconds(pairs_[std::min(at.latest, pairs_.size() - 1)].end_us);
    }
    describe_change(found.test.covariance, found.stretch.length, problem_, move);
    return move;
  }

  Pairs pairs_;
  std::int64_t origin_us_;
  Problem problem_;
  const MovesOptions& options_;
  std::size_t overlap_;
  double chance_ = 1;  ///< of the strongest evidence
  std::vector<Found> found_;
};

}  // namespace

MovesResult find_moves(Pairs pairs, const Problem& problem, const MovesOptions& options) {
  std::vector<MotionPair> kept;
  const Pairs moving = detail::moving_pairs(pairs, options.least_motion, kept);
  if (moving.size() < 2) return {};
  return Finder(moving, pairs.front().begin_us, problem, options).run();
}

std::optional<double> chance_of_move(Pairs pairs, const Problem& problem, MoveKind kind, std::int64_t time_us,
                                     const MovesOptions& options) {
  std::vector<MotionPair> kept;
  pairs = detail::moving_pairs(pairs, options.least_motion, kept);
  if (pairs.size() < 2) return std::nullopt;
  const std::size_t least = std::max(options.block_pairs, 3 * detail::overlap_of(pairs));
  const std::size_t count = std::min(options.most_blocks, pairs.size() / std::max<std::size_t>(1, least));
  const std::size_t side = least_side(count, options);
  if (count < options.least_blocks || count < 2 * side + 1) return std::nullopt;
  const Linearised stretch =
      detail::linearise(pairs, detail::weighted_by_noise(pairs, problem, options.test), count, options.test);
  if (stretch.blocks.empty()) return std::nullopt;
  if (kind == MoveKind::creep) return detail::chance_of_even_change(stretch.blocks, options.test);
  std::size_t split = 0;
  while (split < count && pairs[stretch.begin[split]].begin_us < time_us) ++split;
  return detail::test_change_at(stretch.blocks, split, side, options.test).chance;
}

}  // namespace egocal
