// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/unlike_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/without_lever_arms.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Which column of the file is x, y and z.
using Order = std::array<int, 3>;
constexpr std::array<Order, 6> orders{{{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}}};

/// One motion of one stream: what the columns of its file change by, and the orientation of its world in the
/// frame of the begin of the motion.
struct Change {
  Vector3d columns;
  Matrix3d back;
};

std::vector<Change> changes_of(const Instants& instants, const Motions& motions, Side side) {
  std::vector<Change> changes;
  const std::vector<std::size_t> begins = begins_of(instants, motions);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const PosePair poses = instants.at(begins[i]);
    const Matrix3d R = rotation_of(side == Side::a ? poses.a : poses.b);
    const Motion& motion = motions.all[i];
    changes.push_back({R * (side == Side::a ? motion.t_a : motion.t_b), R.transpose()});
  }
  return changes;
}

struct Stretched {
  Side side = Side::b;
  Order order = orders.front();
  Vector3d factors = Vector3d::Ones();
  Explained explained;
  Comparison comparison;         ///< with one factor for all columns
  double gain_over_given = 0;    ///< as other findings state it
  double unlike = 0;             ///< largest factor over the smallest, as a logarithm
  std::array<bool, 3> counts{};  ///< columns that UnlikeColumnsOptions::least_part counts
};

Vector3d in_order(const Vector3d& columns, const Order& order) {
  return {columns[order[0]], columns[order[1]], columns[order[2]]};
}

Explained stretched(const Motions& given, const std::vector<Change>& changes, const Stretched& how,
                    const DiagnosisOptions& options) {
  Explained result{given, {}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Motion& motion = result.motions.all[i];
    const Vector3d t = changes[i].back * how.factors.cwiseProduct(in_order(changes[i].columns, how.order));
    set_motion(motion, how.side, to_pose(how.side == Side::a ? motion.a : motion.b).rotation, t);
  }
  measure_sizes(result.motions);
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

/// Root mean squares of the columns.
Vector3d sizes_of(const std::vector<Change>& changes, const Order& order) {
  Vector3d squares = Vector3d::Zero();
  for (const Change& change : changes) squares += in_order(change.columns, order).cwiseAbs2();
  return (squares / static_cast<double>(changes.size())).cwiseSqrt();
}

Stretched fitted(const Motions& given, const std::vector<Change>& changes, Side side, const Order& order,
                 const DiagnosisOptions& options, const UnlikeColumnsOptions& columns) {
  Stretched result;
  result.side = side;
  result.order = order;
  const Vector3d sizes = sizes_of(changes, order);
  std::vector<Matrix3d> added;
  for (const Change& change : changes) {
    Vector3d parts = in_order(change.columns, order);
    for (int k = 0; k < 3; ++k) parts[k] = sizes[k] > 0 ? parts[k] / sizes[k] : 0;
    added.push_back(change.back * parts.asDiagonal());
  }
  result.explained = stretched(given, changes, result, options);
  for (int round = 0; round < columns.rounds; ++round) {
    const Vector3d more = best_numbers<3>(result.explained, added, side);
    for (int k = 0; k < 3; ++k)
      if (sizes[k] > 0) result.factors[k] += more[k] / sizes[k];
    result.explained = stretched(given, changes, result, options);
  }
  const Vector3d ways = result.factors.cwiseProduct(sizes).cwiseAbs();
  double least = INFINITY, most = 0;
  for (int k = 0; k < 3; ++k) {
    if (!(ways[k] >= columns.least_part * ways.sum())) continue;
    result.counts[static_cast<std::size_t>(k)] = true;
    least = std::min(least, std::abs(result.factors[k]));
    most = std::max(most, std::abs(result.factors[k]));
  }
  if (most > 0) result.unlike = std::log(most / least);
  return result;
}

/// Squared residual of each motion in the columns as the file has them: what the other stream says they
/// changed by, in parts of their sizes.
std::vector<double> left_in_columns(const Explained& explained, const std::vector<Change>& changes,
                                    const Stretched& found, const Order& order, const Vector3d& factors) {
  const Pose T = to_pose(explained.fit.T);
  const Matrix3d R = T.rotation.toRotationMatrix();
  const Vector3d sizes = sizes_of(changes, order);
  std::vector<double> squares;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Motion& motion = explained.motions.all[i];
    const Vector3d by_arm = motion.R_a * T.translation - T.translation;
    const Vector3d by_other = found.side == Side::a ? Vector3d(R * motion.t_b - by_arm)
                                                    : Vector3d(R.transpose() * (motion.t_a + by_arm));
    const Vector3d of_file = in_order(changes[i].columns, order);
    const Vector3d there = changes[i].back.transpose() * by_other;
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      if (!found.counts[static_cast<std::size_t>(k)]) continue;
      const double left = (there[k] / factors[k] - of_file[k]) / sizes[k];
      square += left * left;
    }
    squares.push_back(square);
  }
  return squares;
}

/// Mean logarithm by which the squared residuals in the columns of the file are smaller than with one factor.
/// A factor below one shrinks the noise of its column, and where lever arms can take over what the column
/// moves by, that alone makes the residuals in metres smaller.
double gain_in_columns(const Explanation& one_scale, const Stretched& found,
                       const std::vector<Change>& changes) {
  const double one_factor = found.side == Side::b ? one_scale.scale : 1;
  // the same columns of the file, wherever they are written
  Stretched as_given = found;
  for (std::size_t k = 0; k < 3; ++k)
    as_given.counts[static_cast<std::size_t>(found.order[k])] = found.counts[k];
  const std::vector<double> before =
      left_in_columns(one_scale.explained, changes, as_given, orders.front(), Vector3d::Constant(one_factor));
  const std::vector<double> after =
      left_in_columns(found.explained, changes, found, found.order, found.factors);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!(before[i] > 0 && after[i] > 0)) continue;
    sum += std::log(before[i] / after[i]);
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

Finding worded_columns(const Stretched& found, const UnlikeColumnsOptions& columns) {
  const char which = found.side == Side::a ? 'a' : 'b';
  const auto column = [&](std::size_t k) { return "xyz"[found.order[k]]; };
  Finding finding;
  finding.certain = found.unlike >= columns.certain || found.order != orders.front();
  const bool of_columns = finding.certain || found.unlike >= columns.of_columns;
  finding.code = of_columns ? std::string("axes_") + which : "odometry";
  finding.improvement = std::exp(found.gain_over_given);
  finding.T_a_b = to_pose(found.explained.fit.T);
  const auto from = [&](int k) {
    return format("%s%c", found.factors[k] < 0 ? "-" : "", column(static_cast<std::size_t>(k)));
  };
  if (found.unlike < columns.certain && finding.certain) {
    // factors of about one are no units
    say(finding, format("The columns of the position of %s are exchanged", mark(which)),
        format("Write positions and rotations of %s in the same axes.", mark(which)),
        format(
            ": x from %s, y from %s and z from %s suit its rotations, the squared residuals are %.3g times "
            "smaller then.",
            from(0).c_str(), from(1).c_str(), from(2).c_str(), finding.improvement));
    return finding;
  }
  const std::string evidence = format(
      ": x as %.4g %c, y as %.4g %c and z as %.4g %c suit its rotations, the squared residuals are "
      "%.3g times smaller then.",
      found.factors[0], column(0), found.factors[1], column(1), found.factors[2], column(2),
      finding.improvement);
  if (finding.certain)
    say(finding, format("The columns of the position of %s are in unlike units", mark(which)),
        format("Give all coordinates of %s in metres along three axes: latitude and longitude are angles.",
               mark(which)),
        evidence);
  else
    say(finding, format("The positions of %s are stretched by unlike factors along its axes", mark(which)),
        "Compare with another drive; give all coordinates in metres along three axes.", evidence);
  return finding;
}

}  // namespace

std::vector<Finding> unlike_columns(const Evidence& evidence, const DiagnosisOptions& options,
                                    const UnlikeColumnsOptions& columns) {
  const Motions& given = evidence.given.explained.motions;
  if (given.all.size() < options.motions.least) return {};
  // one factor for all columns is another finding
  const Explained& one_scale = evidence.scaled.explained;
  const bool agrees = explains(one_scale, options);
  std::vector<Stretched> found;
  for (const Side side : {Side::b, Side::a}) {
    std::optional<Stretched> best;
    const std::vector<Change> changes = changes_of(evidence.instants, given, side);
    for (const Order& order : orders) {
      if (agrees && order != orders.front()) break;
      Stretched here = fitted(given, changes, side, order, options, columns);
      if (!(here.unlike >= columns.least) || !here.factors.allFinite() || !explains(here.explained, options))
        continue;
      here.comparison = compare(one_scale, here.explained);
      const double length = here.explained.motions.translation;
      if (!better(here.comparison, options.gain, options) ||
          !better(compare(without_lever_arms(one_scale, length), without_lever_arms(here.explained, length)),
                  options.least_gain, LeverArmOptions{}.sigmas))
        continue;
      if (!(gain_in_columns(evidence.scaled, here, changes) >= columns.least_gain_in_columns)) continue;
      // columns as they are come first
      if (!best ||
          here.comparison.gain > best->comparison.gain + (order != orders.front() ? options.alike : 0))
        best = std::move(here);
    }
    if (!best) continue;
    best->gain_over_given = compare(evidence.given.explained, best->explained).gain;
    // a free scale may fit worse than none, where few motions decide
    if (best->gain_over_given >= options.gain) found.push_back(*std::move(best));
  }
  std::stable_sort(found.begin(), found.end(), [](const Stretched& x, const Stretched& y) {
    return x.comparison.gain > y.comparison.gain;
  });
  std::vector<Finding> findings;
  for (const Stretched& one : found) {
    // worlds with parallel axes do not show which stream it is
    if (one.comparison.gain < found.front().comparison.gain - options.alike) break;
    Finding finding = worded_columns(one, columns);
    if (findings.empty() || finding.code != findings.front().code) findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace egocal::detail
