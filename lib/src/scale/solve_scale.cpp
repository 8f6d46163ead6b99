// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/solve_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "egocal/certificate/certificate.hpp"
#include "egocal/solvers/global.hpp"
#include "scale/joint_jackknife.hpp"
#include "solvers/minimiser.hpp"
#include "solvers/proven_dual.hpp"
#include "verification/verify.hpp"

namespace egocal {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The cost as a function of the scale alone: f(s) = min over q. In the variable x (s itself, or 1 / s) it is
/// g(x) + e(x) with g concave and e = c x^2 or c / x (docs/scale.md, "One dimension").
class ScaleCost {
 public:
  ScaleCost(const ScaleStatistics& statistics, const ScaleOptions& options)
      : statistics_(statistics), options_(options) {
    const double ratio = std::sqrt(statistics.square_b / statistics.square_a);
    anchor_ = std::isfinite(ratio) && ratio > 0 ? ratio : 1;
  }

  /// The ratio of the lengths of b's motions and a's: the scale, except for lever arms.
  double anchor() const { return anchor_; }

  double variable(double s) const { return options_.noise == ScaleNoise::metric ? s : 1 / s; }
  double scale(double x) const { return options_.noise == ScaleNoise::metric ? x : 1 / x; }

  Balance balance(double s) const {
    Balance result = options_.balance;
    if (options_.noise == ScaleNoise::both) result.translation *= anchor_ / s;
    if (options_.noise == ScaleNoise::unscaled) result.translation *= anchor_ * anchor_ / (s * s);
    return result;
  }
  /// d log(translation weight) / d log s.
  double weight_slope() const {
    return options_.noise == ScaleNoise::metric ? 0 : options_.noise == ScaleNoise::both ? -1 : -2;
  }

  /// The c of e(x).
  double convex() const {
    const double w = options_.balance.translation / statistics_.weight;
    if (options_.noise == ScaleNoise::metric) return w * statistics_.square_a;
    if (options_.noise == ScaleNoise::both) return w * anchor_ * statistics_.square_a;
    return w * anchor_ * anchor_ * statistics_.square_b;
  }
  bool reciprocal() const { return options_.noise == ScaleNoise::both; }
  double extra(double x) const { return reciprocal() ? convex() / x : convex() * x * x; }

  /// Weighted energy of the scaled translations: what the cost is compared with.
  double energy(double s) const {
    return balance(s).translation * s * s * statistics_.square_a / statistics_.weight;
  }
  /// The entries of Q(s) are sums of numbers of this size.
  double rounding(double s) const {
    return 64 * epsilon * balance(s).translation * (s * s * statistics_.square_a + statistics_.square_b) /
           statistics_.weight;
  }

  Matrix8d matrix(double s) const { return cost_matrix(at_scale(statistics_, s), balance(s)); }
  DualQuaternion minimise(const Matrix8d& Q) const { return detail::minimiser(Q, options_.mode); }
  /// The bound that the dual has proven on its way is not proven again.
  std::pair<DualQuaternion, Certificate> certified_minimum(const Matrix8d& Q) const {
    if (options_.mode == Mode::planar) {
      const DualQuaternion q = solve_planar(Q).q;
      return {q, verify_planar(Q, q)};
    }
    const detail::ProvenSolution least = detail::solve_dual_with_proof(Q);
    return {least.solution.q, detail::verify(Q, least.solution.q, {}, least.proven)};
  }
  /// The translation part of the cost, weighted.
  double translation_cost(double s, const DualQuaternion& q) const {
    return egocal::cost(cost_matrix(at_scale(statistics_, s), {0, balance(s).translation}), q);
  }
  /// d f / d log s at a minimiser q (the envelope theorem: q is not differentiated).
  double slope(double s, const DualQuaternion& q) const {
    const double w = balance(s).translation / statistics_.weight;
    const double mixed = q.real.dot(statistics_.cross * q.real) +
                         2 * q.real.dot(statistics_.coupling_a * q.dual) +
                         2 * s * statistics_.square_a * q.real.squaredNorm();
    return w * s * mixed + weight_slope() * translation_cost(s, q);
  }

 private:
  const ScaleStatistics& statistics_;
  const ScaleOptions& options_;
  double anchor_ = 1;
};

/// f at one scale, with a proven bound.
struct Node {
  double x = 0;  ///< the variable, increasing
  double s = 0;
  double cost = 0;     ///< reached by q
  double bound = 0;    ///< of f(s)
  double concave = 0;  ///< bound - e(x), of g
  DualQuaternion q;
  Certificate certificate;  ///< of q at this scale
};

/// Where D is singular (perfect rotations) and the scale is far off, the dual has hardly a feasible point. D
/// raised by a lift has many: J + lift |d|^2 is bounded instead, and competitors are those with an extrinsic
/// no longer than options.farthest.
double lifted_bound(const ScaleCost& f, const ScaleOptions& options, double s, double cost) {
  Matrix8d Q = f.matrix(s);
  const double length2 = Q.topLeftCorner<4, 4>().trace() / Q.bottomRightCorner<4, 4>().trace();
  const double lift = options.given_away * cost / (0.25 * options.farthest * options.farthest * length2);
  if (!std::isfinite(lift)) return -infinity;
  Q.diagonal().tail<4>().array() += lift;
  const Certificate certificate = f.certified_minimum(Q).second;
  return certificate.lower_bound - certificate.rounding - options.given_away * cost;
}

Node evaluate(const ScaleCost& f, const ScaleOptions& options, double s) {
  Node node;
  node.s = s;
  node.x = f.variable(s);
  std::tie(node.q, node.certificate) = f.certified_minimum(f.matrix(s));
  node.cost = node.certificate.cost;
  node.bound = node.certificate.lower_bound - node.certificate.rounding;
  if (node.cost - node.bound > options.weak_bound * node.cost + options.tolerance * f.energy(s))
    node.bound = std::max(node.bound, lifted_bound(f, options, s, node.cost));
  node.bound = std::min(node.bound, node.cost);
  node.concave = node.bound - f.extra(node.x);
  return node;
}

/// Between two nodes the chord of g, with e added, bounds f from below.
struct Chord {
  double offset = 0, slope = 0;  ///< of the chord of g in x
  double x = 0;                  ///< where the bound is least
  double bound = 0;
};

Chord chord(const ScaleCost& f, const Node& low, const Node& high) {
  Chord result;
  result.slope = (high.concave - low.concave) / (high.x - low.x);
  result.offset = low.concave - result.slope * low.x;
  const double c = f.convex();
  double x = high.x;
  if (f.reciprocal())
    x = result.slope > 0 ? std::sqrt(c / result.slope) : high.x;
  else if (c > 0)
    x = -result.slope / (2 * c);
  result.x = std::clamp(x, low.x, high.x);
  result.bound = low.concave + result.slope * (result.x - low.x) + f.extra(result.x);
  return result;
}

/// The part of [low, high] in which the bound is not above `cost`.
std::pair<double, double> not_excluded(const ScaleCost& f, const Chord& chord, double low, double high,
                                       double cost) {
  // c x^2 + slope x + offset <= cost, or slope x^2 + (offset - cost) x + c <= 0
  const double c = f.convex();
  const double square = f.reciprocal() ? chord.slope : c;
  const double linear = f.reciprocal() ? chord.offset - cost : chord.slope;
  const double constant = f.reciprocal() ? c : chord.offset - cost;
  const double discriminant = linear * linear - 4 * square * constant;
  if (!(square > 0) || !(discriminant >= 0)) return {low, high};
  const double root = std::sqrt(discriminant);
  return {std::max(low, (-linear - root) / (2 * square)), std::min(high, (-linear + root) / (2 * square))};
}

/// Nodes in the order of x, split where the bound is least until it meets the best cost.
struct Search {
  std::vector<Node> nodes;
  double bound = -infinity;  ///< of f over the whole range

  std::size_t best() const {
    std::size_t index = 0;
    for (std::size_t i = 1; i < nodes.size(); ++i)
      if (nodes[i].cost < nodes[index].cost) index = i;
    return index;
  }
};

Search branch_and_bound(const ScaleCost& f, const ScaleOptions& options) {
  Search search;
  std::vector<double> start = {options.least, options.most};
  if (f.anchor() > 1.01 * options.least && f.anchor() < options.most / 1.01) start.push_back(f.anchor());
  for (const double s : start) search.nodes.push_back(evaluate(f, options, s));
  const auto by_x = [](const Node& i, const Node& k) { return i.x < k.x; };
  std::sort(search.nodes.begin(), search.nodes.end(), by_x);
  while (true) {
    std::size_t at = 0;
    Chord least;
    least.bound = infinity;
    for (std::size_t i = 0; i + 1 < search.nodes.size(); ++i) {
      const Chord here = chord(f, search.nodes[i], search.nodes[i + 1]);
      if (!(here.bound < least.bound)) continue;
      least = here;
      at = i;
    }
    search.bound = least.bound;
    const Node& best = search.nodes[search.best()];
    search.bound = std::min(search.bound, best.cost);
    const double wanted = std::max(options.tolerance * f.energy(best.s), f.rounding(best.s));
    if (!std::isfinite(least.bound) || best.cost - search.bound <= wanted) return search;
    if (static_cast<int>(search.nodes.size()) >= options.most_solves) return search;
    const double low = search.nodes[at].x, high = search.nodes[at + 1].x;
    const double width = high - low;
    if (!(width > 8 * epsilon * high)) return search;
    double x = least.x;
    // too near to an end nothing is gained; over decades the middle is the geometric one
    if (x < low + 1e-3 * width || x > high - 1e-3 * width)
      x = high > 4 * low ? std::sqrt(low * high) : 0.5 * (low + high);
    const Node node = evaluate(f, options, f.scale(x));
    search.nodes.insert(std::upper_bound(search.nodes.begin(), search.nodes.end(), node, by_x), node);
  }
}

detail::JointForm joint_form(const ScaleCost& f, const ScaleStatistics& all, const ScaleOptions& options,
                             double s, const DualQuaternion& q) {
  return {all, {s, q, f.balance(s), f.weight_slope(), all.weight, options.mode}};
}

/// From the best node down to where the slope vanishes, by Newton steps within [low, high]. log s.
double polished(const ScaleCost& f, const ScaleStatistics& all, const ScaleOptions& options, const Node& best,
                double low, double high) {
  double log_s = std::log(best.s);
  DualQuaternion q = best.q;
  double slope = f.slope(best.s, q);
  for (int i = 0; i < 4; ++i) {
    const double curvature = joint_form(f, all, options, std::exp(log_s), q).of(all).over_scale().curvature;
    if (!(curvature > 0)) return log_s;
    const double next = std::clamp(log_s - slope / curvature, low, high);
    if (std::abs(next - log_s) < 1e-9) return next;  // the error of a step is about its square
    const double s = std::exp(next);
    const DualQuaternion q_there = f.minimise(f.matrix(s));
    const double there = f.slope(s, q_there);
    if (!(std::abs(there) < std::abs(slope))) return log_s;
    log_s = next;
    q = q_there;
    slope = there;
  }
  return log_s;
}

}  // namespace

ScaleSolution solve_scale(std::span<const ScaleStatistics> given, const ScaleOptions& options) {
  ScaleSolution result;
  result.stddev = result.attenuation = infinity;
  result.least_scale = options.least;
  result.most_scale = options.most;
  std::vector<ScaleStatistics> blocks(given.begin(), given.end());
  if (options.side == Side::b)
    for (ScaleStatistics& block : blocks) block = with_scale_on_b(block);
  const ScaleStatistics all = sum_blocks(blocks);
  const double sizes = all.square_a + all.square_b + all.rotation.trace();
  if (!(all.weight > 0) || !(all.square_a > 0) || !std::isfinite(sizes) || !(options.least > 0) ||
      !(options.most > options.least) || !std::isfinite(options.most))
    return result;

  const ScaleCost f(all, options);
  const Search search = branch_and_bound(f, options);
  const std::size_t best = search.best();
  result.solves = static_cast<int>(search.nodes.size());
  result.at_limit = best == 0 || best + 1 == search.nodes.size();

  Node answer = search.nodes[best];
  if (!result.at_limit) {
    const double ends[] = {std::log(search.nodes[best - 1].s), std::log(search.nodes[best + 1].s)};
    const double log_s =
        polished(f, all, options, answer, std::min(ends[0], ends[1]), std::max(ends[0], ends[1]));
    const Node node = evaluate(f, options, std::exp(log_s));
    if (node.cost <= answer.cost + f.rounding(answer.s)) answer = node;
  }
  const Certificate& inner = answer.certificate;
  result.scale = answer.s;
  result.q = answer.q;
  result.cost = answer.cost;
  result.balance = f.balance(answer.s);
  result.rounding = f.rounding(answer.s) + inner.rounding;
  result.lower_bound = std::min(search.bound, answer.cost);
  result.gap = answer.cost - result.lower_bound;
  const bool tight = inner.optimality == Optimality::certified ||
                     (inner.optimality == Optimality::undecided && inner.gap <= result.rounding);
  result.certified = tight && !result.at_limit &&
                     result.gap <= std::max(options.tolerance * f.energy(answer.s), result.rounding);
  double low = infinity, high = 0;
  for (std::size_t i = 0; i + 1 < search.nodes.size(); ++i) {
    const Chord here = chord(f, search.nodes[i], search.nodes[i + 1]);
    if (here.bound > answer.cost + result.rounding) continue;
    const auto [from, to] =
        not_excluded(f, here, search.nodes[i].x, search.nodes[i + 1].x, answer.cost + result.rounding);
    low = std::min({low, f.scale(from), f.scale(to)});
    high = std::max({high, f.scale(from), f.scale(to)});
  }
  result.least_scale = std::min(low, answer.s);
  result.most_scale = std::max(high, answer.s);

  const double energy = f.energy(answer.s);
  const detail::JointForm form = joint_form(f, all, options, answer.s, answer.q);
  const detail::ScaleDerivatives joint = form.of(all);
  const detail::ScaleDerivatives::OverScale over_scale = joint.over_scale();
  result.observability = std::clamp(over_scale.curvature / (2 * energy), 0.0, 1.0);
  const double noise = std::max(0.0, f.translation_cost(answer.s, answer.q));
  const double shown = result.observability * energy;
  const double share = shown > 0 ? noise / shown : infinity;
  result.attenuation = options.noise == ScaleNoise::both ? 0.5 * share : share;
  // below 1e-9 the curvature is the rounding of the differences that it is made of
  result.observable = !result.at_limit && result.observability > 1e-9 && share <= options.most_noise_share;
  result.sensitivity = over_scale.sensitivity;
  if (!result.observable) return result;
  const double spread = detail::spread_of_scale(blocks, form, joint, options.least_blocks);
  // evenly likely anywhere within the attenuation
  result.stddev =
      answer.s * std::hypot(std::hypot(spread, result.attenuation / std::sqrt(3.0)), options.doubt);
  return result;
}

std::array<double, 6> spread_by_scale(const Observability& stated, const Problem& problem,
                                      const ScaleSolution& solution) {
  Eigen::Vector3d shift(solution.sensitivity[0], solution.sensitivity[1], solution.sensitivity[2]);
  Eigen::Vector3d turn(solution.sensitivity[3], solution.sensitivity[4], solution.sensitivity[5]);
  if (problem.mode == Mode::planar) {
    const Eigen::Quaterniond R = to_pose(plane_frame(problem.plane_a)).rotation;
    shift = R * shift;
    turn = R * turn;
  }
  const double relative = solution.stddev / solution.scale;
  std::array<double, 6> result{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double per =
        std::abs(i < 3 ? shift[static_cast<Eigen::Index>(i)] : turn[static_cast<Eigen::Index>(i - 3)]);
    if (std::isfinite(relative))
      result[i] = per * relative;
    else if (per > stated.stddev[i])
      result[i] = infinity;
  }
  return result;
}

Observability with_spread_of_scale(Observability stated, const Problem& problem,
                                   const ScaleSolution& solution) {
  const std::array<double, 6> added = spread_by_scale(stated, problem, solution);
  for (std::size_t i = 0; i < 6; ++i) {
    if (added[i] > 0) stated.stddev[i] = std::hypot(stated.stddev[i], added[i]);  // else not a bit is changed
    if (std::isinf(added[i])) stated.observable[i] = false;
  }
  return stated;
}

}  // namespace egocal
