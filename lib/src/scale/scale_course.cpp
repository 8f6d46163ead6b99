// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/scale_course.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/scale/estimate_scale.hpp"
#include "egocal/statistics/median.hpp"
#include "scale/scale_segments.hpp"
#include "scale/unjudged_motions.hpp"

namespace egocal {

namespace {

double residual(const detail::ScaleSample& sample, double scale) {
  return std::max(0.0, sample.square * scale * scale - 2 * sample.product * scale + sample.rest);
}

std::int64_t middle_of(const MotionPair& pair) {
  return pair.begin_us + (pair.end_us - pair.begin_us) / 2;
}

/// The motions divided by the course, as far as it is known: the rest has one scale.
std::vector<MotionPair> with_course(std::span<const MotionPair> pairs, const ScaleCourse& course, Side side) {
  std::vector<MotionPair> result(pairs.begin(), pairs.end());
  for (MotionPair& pair : result) {
    DualQuaternion& motion = side == Side::a ? pair.a : pair.b;
    motion = scaled(motion, course.at(middle_of(pair)));
  }
  return result;
}

ScaleCourse constant(double scale) {
  ScaleCourse course;
  course.segments.push_back({0, 0, scale, scale, 0});
  return course;
}

bool alike(const ScaleCourse& i, const ScaleCourse& k) {
  return std::equal(i.segments.begin(), i.segments.end(), k.segments.begin(), k.segments.end(),
                    [](const ScaleSegment& x, const ScaleSegment& y) {
                      return x.begin_us == y.begin_us &&
                             std::abs(x.begin_scale - y.begin_scale) < 1e-4 * std::abs(x.begin_scale) &&
                             std::abs(x.end_scale - y.end_scale) < 1e-4 * std::abs(x.end_scale);
                    });
}

}  // namespace

double ScaleCourse::at(std::int64_t time_us) const {
  if (segments.empty()) return 1;
  std::size_t k = 0;
  while (k + 1 < segments.size() && segments[k + 1].begin_us <= time_us) ++k;
  const ScaleSegment& segment = segments[k];
  if (segment.end_us <= segment.begin_us) return segment.begin_scale;
  const double part = std::clamp(static_cast<double>(time_us - segment.begin_us) /
                                     static_cast<double>(segment.end_us - segment.begin_us),
                                 0.0, 1.0);
  return segment.begin_scale * std::pow(segment.end_scale / segment.begin_scale, part);
}

bool ScaleCourse::changes() const {
  return segments.size() > 1 || (segments.size() == 1 && segments[0].begin_scale != segments[0].end_scale);
}

ScaleCourse find_scale_course(const Trajectory& a, const Trajectory& b, const PairingOptions& given,
                              const ScaleSolution& solution, Side side, const ScaleCourseOptions& options) {
  if (!solution.observable) return constant(solution.scale);
  PairingOptions pairing = given;
  // the height of the scaled sensor's plane is not to be scaled
  (side == Side::a ? pairing.plane_a : pairing.plane_b).distance = 0;
  return find_scale_course(detail::unjudged_motions(a, b, pairing, options.motion), pairing.mode, solution,
                           side, options);
}

ScaleCourse find_scale_course(std::span<const MotionPair> pairs, Mode mode, const ScaleSolution& solution,
                              Side side, const ScaleCourseOptions& options) {
  ScaleCourse unchanged = constant(solution.scale);
  ScaleCourse course = unchanged;
  if (!solution.observable || pairs.size() < options.least_blocks * options.least_block) return unchanged;
  DriveScaleOptions scale;
  scale.scale.side = side;
  scale.scale.mode = mode;
  scale.scale.balance = solution.balance;
  DualQuaternion q = solution.q;
  for (int round = 0; round < options.rounds; ++round) {
    std::vector<detail::ScaleSample> samples;
    std::vector<double> residuals;
    for (const MotionPair& pair : pairs) {
      samples.push_back(detail::scale_sample(pair, q, side));
      residuals.push_back(residual(samples.back(), course.at(middle_of(pair))));
    }
    const double limit = options.most_residual * detail::median(residuals);
    std::size_t i = 0;
    // at first a whole part of the drive may fit badly
    if (round > 0) std::erase_if(samples, [&](const detail::ScaleSample&) { return residuals[i++] > limit; });
    ScaleCourse next;
    next.segments = detail::scale_segments(samples, options, round == 0);
    if (!next.changes()) return unchanged;
    const bool same = alike(course, next);
    course = std::move(next);
    if (same) break;
    // what is left is one scale, near one: its extrinsic is better
    q = estimate_scale(with_course(pairs, course, side), scale).q;
  }
  for (std::size_t k = 0; k + 1 < course.segments.size(); ++k)
    course.segments[k].end_us = course.segments[k + 1].begin_us;
  return course;
}

Trajectory scaled(const Trajectory& trajectory, const ScaleCourse& course) {
  Trajectory result;
  result.reserve(trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i == 0) {
      result.push_back(trajectory[0]);
      continue;
    }
    const std::int64_t middle =
        trajectory[i - 1].time_us + (trajectory[i].time_us - trajectory[i - 1].time_us) / 2;
    const DualQuaternion step = normalized(conjugate(trajectory[i - 1].pose) * trajectory[i].pose);
    result.push_back({trajectory[i].time_us,
                      canonical_sign(normalized(result.back().pose * scaled(step, course.at(middle))))});
  }
  return result;
}

}  // namespace egocal
