// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/turning_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/turning/turning_of_steps.hpp"
#include "diagnosis/explanations/turning/vector_lengths.hpp"
#include "diagnosis/motions/at_ends.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One end of a motion: the orientation that the file states, and how far it had turned about the axis [rad].
struct End {
  Matrix3d R;
  double turned = 0;
};

/// What the motions of one stream are made of.
struct AboutAxis {
  Vector3d axis;  ///< of most turning, in the stream's world
  std::vector<End> begins, ends;
};

/// Calls each(instant, orientation, rotation vector from the orientation before, in the stream's world
/// [rad]).
template <typename Each>
void for_each_turn(const Instants& instants, Side side, const Each& each) {
  Matrix3d last = Matrix3d::Identity();
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const PosePair poses = instants.at(i);
    const Matrix3d R = rotation_of(side == Side::a ? poses.a : poses.b);
    each(i, R, i == 0 ? Vector3d(Vector3d::Zero()) : rotation_log(Rotation(R * last.transpose())));
    last = R;
  }
}

AboutAxis turning_of(const Instants& instants, const Motions& motions, Side side) {
  Matrix3d squares = Matrix3d::Zero();
  for_each_turn(instants, side, [&](std::size_t, const Matrix3d&, const Vector3d& turn) {
    squares += turn * turn.transpose();
  });
  const Vector3d axis = symmetric_eigen<3>(squares).vectors.col(2);
  const std::vector<std::size_t> begins = begins_of(instants, motions);
  AtEnds<End> ends(begins, static_cast<std::size_t>(motions.stride));
  double turned = 0;
  // the turns are worked out again, as those of a long drive take much memory
  for_each_turn(instants, side, [&](std::size_t i, const Matrix3d& R, const Vector3d& turn) {
    turned += axis.dot(turn);
    ends.pass(i, {R, turned});
  });
  return {axis, std::move(ends.begins), std::move(ends.ends)};
}

/// The motions with a part of the turning of one stream taken off. right_positions: those of the file, else
/// those that were summed in its own frame.
Motions without(const Motions& given, const AboutAxis& turning, Side side, double part,
                bool right_positions) {
  Motions motions = given;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    Motion& motion = motions.all[i];
    const auto corrected = [&](const End& end) {
      return Matrix3d(rotation_exp(-part * end.turned * turning.axis).toRotationMatrix() * end.R);
    };
    const Matrix3d begin = corrected(turning.begins[i]), end = corrected(turning.ends[i]);
    Vector3d t = side == Side::a ? motion.t_a : motion.t_b;
    if (right_positions) t = begin.transpose() * (turning.begins[i].R * t);
    const Rotation rotation(begin.transpose() * end);
    set_turned_motion(motion, side, rotation, t);
  }
  return motions;
}

/// The part by which the stream turns too far, of the motions that turn most.
double excess(const Motions& motions, Side side) {
  std::vector<double> angles;
  for (const Motion& motion : motions.all) angles.push_back(motion.angle_a);
  const double least = median(std::vector<double>(angles));
  std::vector<double> ratios;
  for (const Motion& motion : motions.all)
    if (motion.angle_a >= least && motion.angle_a > 0 && motion.angle_b > 0)
      ratios.push_back(side == Side::a ? motion.angle_b / motion.angle_a : motion.angle_a / motion.angle_b);
  return ratios.empty() ? 0 : 1 - median(std::move(ratios));
}

double most_turned(const AboutAxis& turning) {
  double most = 0;
  for (const End& end : turning.ends) most = std::max(most, std::abs(end.turned));
  return most;
}

struct Scaled {
  Side side = Side::b;
  double part = 0;
  Explained explained;
  Comparison comparison;
};

/// centre, around: where the part is looked for.
Scaled fitted(const Explained& given, const AboutAxis& turning, Side side, double centre, double around,
              bool right_positions, const DiagnosisOptions& options, const TurningScaleOptions& search) {
  constexpr double golden = 0.6180339887498949;  // mathematics: the golden section
  const auto left_over = [&](double part) {
    return quick_fit(without(given.motions, turning, side, part, right_positions), options.fit).typical;
  };
  double low = centre - around, high = centre + around;
  double x = high - golden * (high - low), y = low + golden * (high - low);
  double at_x = left_over(x), at_y = left_over(y);
  for (int step = 0; step < search.steps; ++step) {
    if (at_x < at_y) {
      high = std::exchange(y, x);
      at_y = at_x;
      x = high - golden * (high - low);
      at_x = left_over(x);
    } else {
      low = std::exchange(x, y);
      at_x = at_y;
      y = low + golden * (high - low);
      at_y = left_over(y);
    }
  }
  Scaled result{side, 0.5 * (low + high), {}, {}};
  result.explained.motions = without(given.motions, turning, side, result.part, right_positions);
  result.explained.fit = robust_fit(result.explained.motions, options.fit);
  result.comparison = compare(given, result.explained);
  return result;
}

Finding worded(const Scaled& scaled) {
  const char which = scaled.side == Side::a ? 'a' : 'b';
  Finding finding =
      finding_of(std::string("turning_scale_") + which, scaled.explained, scaled.comparison, true);
  finding.value = 1 / (1 - scaled.part);
  say(finding,
      format(
          "The rotations of %s turn %.4g times as far as they should about one axis: the squared residuals "
          "are %.3g times smaller without that.",
          mark(which), *finding.value, finding.improvement),
      format("Calibrate the gyroscope or the compass of %s, then record again.", mark(which)));
  return finding;
}

}  // namespace

std::vector<Finding> turning_scale(const Instants& instants, const Explained& given,
                                   const DiagnosisOptions& options, const TurningScaleOptions& turning) {
  if (instants.size() < 3 || given.motions.all.size() < options.motions.least) return {};
  if (std::optional<Finding> vectors =
          vectors_of_another_length(instants, given, options, turning.gain_of_vectors))
    return {*std::move(vectors)};
  std::vector<Scaled> best;  // of each stream
  for (const Side side : {Side::b, Side::a}) {
    const double centre = excess(given.motions, side);
    if (!(std::abs(centre) >= turning.least && std::abs(centre) <= turning.most)) continue;
    const AboutAxis of_side = turning_of(instants, given.motions, side);
    // right positions show the part more exactly, but only near it: beyond, their headings are turned round
    const double most = most_turned(of_side);
    double near = centre, around = turning.around;
    std::optional<Scaled> better_one;
    for (const bool right_positions : {false, true}) {
      Scaled here = fitted(given, of_side, side, near, around, right_positions, options, turning);
      near = here.part;
      around = std::min(turning.around, 1 / std::max(1.0, most));
      if (!(std::abs(here.part) >= turning.least) || !explains(here.explained, options) ||
          !better(here.comparison, options.gain, options))
        continue;
      if (!better_one || here.comparison.gain > better_one->comparison.gain) better_one = std::move(here);
    }
    if (better_one) best.push_back(*std::move(better_one));
  }
  if (best.empty()) return turning_of_steps(instants, given, options);
  std::stable_sort(best.begin(), best.end(),
                   [](const Scaled& x, const Scaled& y) { return x.comparison.gain > y.comparison.gain; });
  std::vector<Finding> findings;
  for (const Scaled& scaled : best) {
    // both streams with the same error nearly agree: which one has it may be open
    if (scaled.comparison.gain < best.front().comparison.gain - options.alike) break;
    findings.push_back(worded(scaled));
  }
  return findings;
}

}  // namespace egocal::detail
