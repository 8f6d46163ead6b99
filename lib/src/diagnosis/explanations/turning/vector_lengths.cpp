// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/vector_lengths.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/motions/at_ends.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Right orientations at the begins and ends of the motions of one stream.
using Orientations = AtEnds<Rotation>;

Rotation orientation(const PosePair& poses, Side side) {
  return to_pose(side == Side::a ? poses.a : poses.b).rotation;
}

/// Rotation vectors over a factor below one: a file holds all of the right one.
Orientations with_longer_vectors(const Instants& instants, const std::vector<std::size_t>& motions,
                                 std::size_t span, Side side, double factor) {
  const auto right = [&](std::size_t i) {
    return rotation_exp(rotation_log(orientation(instants.at(i), side)) / factor);
  };
  Orientations result(motions, span);
  for (const std::size_t begin : motions) {
    result.begins.push_back(right(begin));
    result.ends.push_back(right(begin + span));
  }
  return result;
}

/// Half the rotation vectors of a stream, along the way that they went: a file holds the turn of a vector
/// longer than half a turn from the other side.
class HalfVectors {
 public:
  /// begins_with_more: whether the first one is longer.
  HalfVectors(const std::vector<std::size_t>& motions, std::size_t span, bool begins_with_more)
      : orientations(motions, span), begins_with_more_(begins_with_more) {}

  /// The orientation at an instant. To be called in order, for all instants.
  void pass(std::size_t i, const Rotation& given) {
    // half the vector of a unit quaternion: the square root of it, else that of the same with the other sign
    const double sign = given.w() < 0 ? -1 : 1, w = sign * given.w();
    const Vector3d vector = sign * given.vec();
    Rotation best = quaternion(1 + w, vector);
    if (vector.squaredNorm() > 0) {
      const Rotation other = quaternion(1 - w, -vector);
      if (i == 0 ? begins_with_more_ : std::abs(other.dot(last_)) > std::abs(best.dot(last_))) best = other;
    }
    orientations.pass(i, last_ = best);
  }

  Orientations orientations;

 private:
  static Rotation quaternion(double w, const Vector3d& vector) {
    return Rotation(w, vector.x(), vector.y(), vector.z()).normalized();
  }

  bool begins_with_more_;
  Rotation last_ = Rotation::Identity();
};

Explained explained_by_vectors(const Instants& instants, const Explained& given,
                               const std::vector<std::size_t>& begins, Side side, const Orientations& right,
                               const DiagnosisOptions& options) {
  Explained result{given.motions, {}};
  for (std::size_t i = 0; i < begins.size(); ++i) {
    Motion& motion = result.motions.all[i];
    const PosePair poses = instants.at(begins[i]);
    const Matrix3d begin = right.begins[i].toRotationMatrix(), end = right.ends[i].toRotationMatrix();
    const Vector3d t = begin.transpose() * (rotation_of(side == Side::a ? poses.a : poses.b) *
                                            (side == Side::a ? motion.t_a : motion.t_b));
    const Rotation rotation(Matrix3d(begin.transpose() * end));
    set_turned_motion(motion, side, rotation, t);
  }
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

/// A way to read the rotation vectors of one stream.
struct VectorReading {
  Side side = Side::b;
  double factor = 1;  ///< by which they are too long
  Orientations right;
};

std::vector<VectorReading> vector_readings(const Instants& instants, const std::vector<std::size_t>& begins,
                                           std::size_t span) {
  constexpr std::array<Side, 2> sides{Side::b, Side::a};
  // of b and of a, each beginning with a shorter and with a longer vector: one pass over the drive
  std::vector<HalfVectors> halves;
  for (int i = 0; i < 2; ++i)
    for (const bool begins_with_more : {false, true}) halves.emplace_back(begins, span, begins_with_more);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const PosePair poses = instants.at(i);
    for (std::size_t k = 0; k < halves.size(); ++k) halves[k].pass(i, orientation(poses, sides[k / 2]));
  }
  std::vector<VectorReading> readings;
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const Side side = sides[k / 2];
    readings.push_back({side, 2, std::move(halves[k].orientations)});
    if (k % 2 == 0) continue;
    for (const double factor : {0.5, radians_per_degree})
      readings.push_back({side, factor, with_longer_vectors(instants, begins, span, side, factor)});
  }
  return readings;
}

}  // namespace

std::optional<Finding> vectors_of_another_length(const Instants& instants, const Explained& given,
                                                 const DiagnosisOptions& options, double least_gain) {
  std::optional<Finding> best;
  const std::vector<std::size_t> begins = begins_of(instants, given.motions);
  for (const VectorReading& reading :
       vector_readings(instants, begins, static_cast<std::size_t>(given.motions.stride))) {
    const Explained here =
        explained_by_vectors(instants, given, begins, reading.side, reading.right, options);
    const Comparison comparison = compare(given, here);
    if (!explains(here, options) || !better(comparison, least_gain, options) ||
        (best && best->improvement > std::exp(comparison.gain)))
      continue;
    const char which = reading.side == Side::a ? 'a' : 'b';
    best.emplace();
    best->code = std::string("turning_scale_") + which;
    best->certain = true;
    best->improvement = std::exp(comparison.gain);
    best->T_a_b = to_pose(here.fit.T);
    best->value = reading.factor;
    say(*best,
        format("The rotation vectors of %s, from its world, are %.4g times as long as they should be: the "
               "squared residuals are %.3g times smaller without that.",
               mark(which), reading.factor, best->improvement),
        format("Correct the conversion of the rotations of %s: a quaternion has half the angle of its "
               "rotation vector, in radians.",
               mark(which)));
  }
  return best;
}

}  // namespace egocal::detail
