// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/wrong_poses.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "egocal/statistics/median.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

class WrongPoses {
 public:
  WrongPoses(const Instants& instants, const Pose& T_a_b, const WrongPosesOptions& options)
      : options_(options), T_a_b_(T_a_b) {
    poses_.reserve(instants.size());
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const PosePair pair = instants.at(i);
      poses_.emplace_back(to_pose(pair.a), to_pose(pair.b));
    }
    for (std::size_t steps = 1; steps <= options.most_in_a_row + 1; ++steps)
      usual_.push_back(usual_over(steps));
  }

  /// Whether the poses of each instant are wrong.
  std::vector<bool> found() const {
    std::vector<bool> wrong(poses_.size(), false);
    std::size_t good = 0;
    while (good + 2 < poses_.size()) {
      const std::size_t next = keeps(good, good + 1, options_.contradict) ? good + 1 : past(good);
      std::fill(wrong.begin() + static_cast<std::ptrdiff_t>(good) + 1,
                wrong.begin() + static_cast<std::ptrdiff_t>(next), true);
      good = next;
    }
    return wrong;
  }

 private:
  /// What the answer leaves of the motion from instant i to k.
  Residual left(std::size_t i, std::size_t k) const {
    const auto& [a_i, b_i] = poses_[i];
    const auto& [a_k, b_k] = poses_[k];
    const Pose rest = inverse(inverse(a_i) * a_k * T_a_b_) * (T_a_b_ * (inverse(b_i) * b_k));
    return {rotation_log(rest.rotation).norm(), rest.translation.norm()};
  }

  Residual usual_over(std::size_t steps) const {
    std::vector<double> rotations, translations;
    for (std::size_t i = 0; i + steps < poses_.size(); ++i) {
      const Residual residual = left(i, i + steps);
      rotations.push_back(residual.rotation);
      translations.push_back(residual.translation);
    }
    return {std::max(quantile(std::move(rotations), options_.usual), options_.rounding),
            std::max(quantile(std::move(translations), options_.usual), options_.rounding)};
  }

  /// Whether the residual of the motion is at most this multiple of the usual one for its length.
  bool keeps(std::size_t i, std::size_t k, double times) const {
    const Residual residual = left(i, k);
    const Residual& usual = usual_[k - i - 1];
    return residual.rotation <= times * usual.rotation && residual.translation <= times * usual.translation;
  }
  bool agrees(std::size_t i, std::size_t k) const { return keeps(i, k, options_.agree); }

  /// The next instant that agrees with this one, and goes on; the very next one where none does.
  std::size_t past(std::size_t good) const {
    for (std::size_t next = good + 2; next <= good + 1 + options_.most_in_a_row; ++next)
      if (next < poses_.size() && agrees(good, next) && goes_on(next)) return next;
    return good + 1;
  }

  /// Whether some later instant agrees with this one; the next ones may be wrong again.
  bool goes_on(std::size_t i) const {
    for (std::size_t next = i + 1; next <= i + 1 + options_.most_in_a_row && next < poses_.size(); ++next)
      if (agrees(i, next)) return true;
    return false;
  }

  const WrongPosesOptions& options_;
  Pose T_a_b_;
  std::vector<std::pair<Pose, Pose>> poses_;
  std::vector<Residual> usual_;  ///< of motions over 1, 2, ... steps
};

}  // namespace

Instants without_wrong_poses(const Instants& instants, const Pose& T_a_b, const WrongPosesOptions& options) {
  if (instants.size() > options.most || instants.size() < options.most_in_a_row + 3) return instants;
  const std::vector<bool> wrong = WrongPoses(instants, T_a_b, options).found();
  const auto count = static_cast<double>(std::count(wrong.begin(), wrong.end(), true));
  const auto all = static_cast<double>(wrong.size());
  if (count < options.least_wrong * all || count > options.most_wrong * all) return instants;
  return instants.without(wrong);
}

bool spoiled_by_wrong_poses(const Motions& motions, const Pose& T_a_b, double begin, double end,
                            const SpoiledPartOptions& options) {
  const std::vector<bool> rest = at_rest(motions, T_a_b);
  std::vector<std::size_t> inside;
  std::vector<double> rotations, translations;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    if (rest[i]) continue;
    if (motions.all[i].time >= begin && motions.all[i].time <= end) {
      inside.push_back(i);
      continue;
    }
    const Residual residual = residual_at(motions.all[i], T_a_b);
    rotations.push_back(residual.rotation);
    translations.push_back(residual.translation);
  }
  if (inside.size() < options.least) return true;
  if (rotations.empty()) return false;
  const double rotation = options.agree * median(std::move(rotations)),
               translation = options.agree * median(std::move(translations));
  // short motions agree with anything; a wrong pose makes those of its own stream long
  double agreeing = 0, all = 0;
  std::size_t in_a_row = 0, longest = 0;
  for (const std::size_t i : inside) {
    const Motion& motion = motions.all[i];
    const double size = std::min(motion.angle_a, motion.angle_b) / motions.rotation +
                        std::min(motion.t_a.norm(), motion.t_b.norm()) / motions.translation;
    const Residual residual = residual_at(motion, T_a_b);
    all += size;
    const bool agrees = residual.rotation <= rotation && residual.translation <= translation;
    if (agrees) agreeing += size;
    in_a_row = agrees ? 0 : in_a_row + 1;
    longest = std::max(longest, in_a_row);
  }
  return agreeing > options.most_agreeing * all && longest <= options.most_in_a_row;
}

}  // namespace egocal::detail
