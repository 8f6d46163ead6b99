// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/rig/rig.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/statistics/median.hpp"
#include "moves/linear_blocks.hpp"
#include "problem/without_part.hpp"
#include "rig/joint.hpp"
#include "rig/loops.hpp"
#include "solvers/minimiser.hpp"

namespace egocal {

namespace {

using detail::TimedPair;

/// The answer that motions are compared with (planar mode: T_p).
DualQuaternion minimiser_of(const RigPair& pair, std::size_t blocks) {
  if (!pair.T_a_b) return detail::gated_blocks(pair.pairs, pair.problem, blocks, {}).q;
  if (pair.problem.mode == Mode::spatial) return *pair.T_a_b;
  return planar_from_extrinsic(*pair.T_a_b, plane_frame(pair.problem.plane_a),
                               plane_frame(pair.problem.plane_b));
}

/// Which motions fit the answer most_residual times worse than the median one does.
std::vector<bool> unfit(const RigPair& pair, double most_residual) {
  std::vector<bool> result(pair.pairs.size(), false);
  if (pair.pairs.size() < 16) return result;
  const std::size_t blocks = std::clamp<std::size_t>(pair.pairs.size() / 16, 1, 32);
  const DualQuaternion q = minimiser_of(pair, blocks);
  std::vector<double> residuals;
  for (const MotionPair& motion : pair.pairs)
    residuals.push_back(detail::pair_residual(motion, q, pair.problem.balance));
  const double limit = most_residual * detail::median(residuals);
  for (std::size_t i = 0; i < residuals.size(); ++i) result[i] = residuals[i] > limit;
  return result;
}

bool of_same_intervals(std::span<const RigPair> pairs) {
  const std::vector<MotionPair>& first = pairs.front().pairs;
  return std::all_of(pairs.begin(), pairs.end(), [&](const RigPair& pair) {
    return std::equal(pair.pairs.begin(), pair.pairs.end(), first.begin(), first.end(),
                      [](const MotionPair& i, const MotionPair& k) {
                        return i.begin_us == k.begin_us && i.end_us == k.end_us;
                      });
  });
}

/// Motions to reject, of every pair; with the same intervals in all of them, the same ones.
std::vector<std::vector<bool>> rejected_motions(std::span<const RigPair> pairs, double most_residual) {
  std::vector<std::vector<bool>> rejected;
  for (const RigPair& pair : pairs) rejected.push_back(unfit(pair, most_residual));
  if (!of_same_intervals(pairs)) return rejected;
  for (const std::vector<bool>& one : std::vector(rejected))
    for (std::vector<bool>& other : rejected)
      for (std::size_t i = 0; i < one.size(); ++i) other[i] = other[i] || one[i];
  return rejected;
}

std::vector<TimedPair> in_blocks(std::span<const RigPair> pairs, const RigOptions& options) {
  std::int64_t begin = std::numeric_limits<std::int64_t>::max(), end = 0;
  const auto middle = [](const MotionPair& motion) {
    return motion.begin_us + (motion.end_us - motion.begin_us) / 2;
  };
  for (const RigPair& pair : pairs)
    for (const MotionPair& motion : pair.pairs) {
      begin = std::min(begin, middle(motion));
      end = std::max(end, middle(motion));
    }
  const double width = std::max(1.0, static_cast<double>(end - begin)) / static_cast<double>(options.blocks);
  std::vector<TimedPair> result;
  const std::vector<std::vector<bool>> rejected = rejected_motions(pairs, options.most_residual);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    TimedPair timed;
    timed.blocks.resize(options.blocks);
    for (std::size_t i = 0; i < pairs[k].pairs.size(); ++i) {
      if (rejected[k][i]) continue;
      const MotionPair& motion = pairs[k].pairs[i];
      const auto index = static_cast<std::size_t>(static_cast<double>(middle(motion) - begin) / width);
      timed.blocks[std::min(index, options.blocks - 1)].add(motion);
    }
    timed.all = sum_blocks(timed.blocks);
    result.push_back(std::move(timed));
  }
  return result;
}

RigPairAnswer answer_of(const RigPair& pair, const Statistics& all) {
  RigPairAnswer answer;
  answer.a = pair.a;
  answer.b = pair.b;
  const Matrix8d Q = cost_matrix(all, pair.problem.balance);
  const Mode mode = pair.problem.mode;
  const DualQuaternion q = detail::minimiser(Q, mode);
  answer.certificate = mode == Mode::planar ? verify_planar(Q, q) : verify(Q, q);
  answer.T_a_b = detail::extrinsic_of(pair.problem, q);
  answer.residual_rotation =
      std::max(0.0, q.real.dot(all.dual_rows.bottomRightCorner<4, 4>() * q.real) / all.weight);
  answer.residual_translation = std::max(0.0, cost(cost_matrix(all, {0, 1}), q));
  return answer;
}

/// Residuals of a pair are about the sum of what both sensors add ("three-cornered hat"): least squares of
/// that, rotation and translation each as a part of its mean.
std::vector<double> noise_of(std::size_t sensors, const std::vector<RigPairAnswer>& answers) {
  if (sensors < 3) return {};
  const auto count = static_cast<Eigen::Index>(sensors);
  Eigen::MatrixXd N = 1e-9 * Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd n = Eigen::VectorXd::Zero(count);
  double rotation = 0, translation = 0;
  for (const RigPairAnswer& answer : answers) {
    rotation += answer.residual_rotation / static_cast<double>(answers.size());
    translation += answer.residual_translation / static_cast<double>(answers.size());
  }
  for (const RigPairAnswer& answer : answers) {
    const auto a = static_cast<Eigen::Index>(answer.a), b = static_cast<Eigen::Index>(answer.b);
    const double both = (rotation > 0 ? answer.residual_rotation / rotation : 0) +
                        (translation > 0 ? answer.residual_translation / translation : 0);
    for (const auto i : {a, b}) {
      for (const auto k : {a, b}) N(i, k) += 1;
      n[i] += both;
    }
  }
  const Eigen::VectorXd x = N.ldlt().solve(n);
  std::vector<double> noise;
  for (Eigen::Index i = 0; i < count; ++i) noise.push_back(std::max(0.0, x[i]));
  return noise;
}

std::optional<std::size_t> blamed_of(const std::vector<double>& noise, double ratio) {
  if (noise.size() < 3) return std::nullopt;
  std::vector<double> sorted = noise;
  std::sort(sorted.rbegin(), sorted.rend());
  if (!(sorted[0] > ratio * sorted[1])) return std::nullopt;
  return static_cast<std::size_t>(std::max_element(noise.begin(), noise.end()) - noise.begin());
}

void check(std::size_t sensors, std::span<const RigPair> pairs) {
  std::vector<bool> known(sensors, false);
  for (const RigPair& pair : pairs) {
    const std::string names = std::to_string(pair.a) + " and " + std::to_string(pair.b);
    if (!(pair.a < pair.b && pair.b < sensors))
      throw Error("rig: expected a pair a < b < " + std::to_string(sensors) + ", got " + names);
    if (pair.pairs.empty()) throw Error("rig: no motion pairs of sensors " + names);
    if (pair.a == 0) known[pair.b] = true;
  }
  for (std::size_t k = 1; k < sensors; ++k)
    if (!known[k]) throw Error("rig: sensor " + std::to_string(k) + " has no pair with sensor 0");
}

/// What is stated of the joint minimum: its own jack-knife, and what noisy rotations take off each
/// translation.
std::vector<std::array<double, 6>> spread_of(std::span<const RigPair> pairs,
                                             const std::vector<TimedPair>& timed,
                                             const std::vector<RigPairAnswer>& answers,
                                             const std::vector<RigEdge>& edges,
                                             const std::vector<DualQuaternion>& poses) {
  std::vector<std::vector<RigEdge>> without;
  for (std::size_t k = 0; k < timed.front().blocks.size(); ++k) {
    std::vector<RigEdge>& part = without.emplace_back();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      // sums, not means: a part that is omitted changes the weight of the others
      const Statistics rest = detail::without_part(timed[i].all, timed[i].blocks[k]);
      part.push_back({pairs[i].a, pairs[i].b,
                      cost_matrix(rest, pairs[i].problem.balance) * (rest.weight / timed[i].all.weight)});
    }
  }
  std::vector<DualQuaternion> optima;
  for (const RigPairAnswer& answer : answers) optima.push_back(answer.T_a_b);
  auto stddev = detail::joint_spread(edges, without, optima, poses);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].a != 0) continue;
    const Eigen::Vector3d pull = detail::attenuation(timed[i].all, answers[i].T_a_b);
    for (std::size_t k = 0; k < 3; ++k)
      stddev[pairs[i].b][k] = std::hypot(stddev[pairs[i].b][k], pull[static_cast<Eigen::Index>(k)]);
  }
  return stddev;
}

/// The joint minimum; in planar mode, which has none, the pairs with sensor 0.
ConsistentSet set_of(std::size_t sensors, std::span<const RigPair> pairs, const std::vector<TimedPair>& timed,
                     const std::vector<RigPairAnswer>& answers) {
  std::vector<RigEdge> edges;
  ConsistentSet star;
  star.poses.assign(sensors, DualQuaternion{});
  bool planar = false;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    planar = planar || pairs[i].problem.mode == Mode::planar;
    edges.push_back({pairs[i].a, pairs[i].b, cost_matrix(timed[i].all, pairs[i].problem.balance)});
    if (pairs[i].a == 0) star.poses[pairs[i].b] = answers[i].T_a_b;
  }
  if (planar) return star;
  ConsistentSet set = solve_consistent_set(sensors, edges);
  if (!set.solved) return star;
  set.stddev = spread_of(pairs, timed, answers, edges, set.poses);
  return set;
}

}  // namespace

RigSolution solve_rig(std::size_t sensors, std::span<const RigPair> pairs, const RigOptions& given) {
  RigOptions options = given;
  options.blocks = std::max<std::size_t>(2, options.blocks);
  check(sensors, pairs);
  RigSolution solution;
  const std::vector<TimedPair> timed = in_blocks(pairs, options);
  for (std::size_t i = 0; i < pairs.size(); ++i) solution.pairs.push_back(answer_of(pairs[i], timed[i].all));
  solution.loops = detail::loops_of(sensors, pairs, timed, options);
  solution.noise = noise_of(sensors, solution.pairs);
  solution.blamed = blamed_of(solution.noise, options.blame_ratio);
  solution.set = set_of(sensors, pairs, timed, solution.pairs);
  return solution;
}

}  // namespace egocal
