// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that were summed up from the transforms to the row before in place of those from it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_reversed_steps {
namespace {

using testing::drive;
using testing::find;

enum class Wrong { step, rotation };

/// Starts at the first pose; each step is the wrong way round.
Trajectory summed_up(const Trajectory& right, Wrong wrong) {
  Trajectory result = right;
  for (std::size_t i = 1; i < right.size(); ++i) {
    const Pose step = to_pose(conjugate(right[i - 1].pose) * right[i].pose);
    const Pose taken =
        wrong == Wrong::step ? inverse(step) : Pose{step.rotation.conjugate(), step.translation};
    result[i].pose = canonical_sign(normalized(result[i - 1].pose * to_dual_quaternion(taken)));
  }
  return result;
}

void expect_answer(const Finding& finding, const DualQuaternion& T, const std::string& where) {
  ASSERT_TRUE(finding.T_a_b) << where;
  const ExtrinsicError error = extrinsic_error(T, to_dual_quaternion(*finding.T_a_b));
  EXPECT_LT(error.rotation, 0.01) << where;
  EXPECT_LT(error.translation, 0.3) << where;
}

TEST(ReversedSteps, AreNamedInEitherStream) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2}) {
      const testing::Streams right = drive(terrain, seed);
      EXPECT_EQ(find(calibrate(right.a, right.b), "reversed_steps"), nullptr);
      for (const bool in_a : {false, true}) {
        const std::string where = std::to_string(seed) + (in_a ? " a" : " b");
        const Calibration calibration = in_a ? calibrate(summed_up(right.a, Wrong::step), right.b)
                                             : calibrate(right.a, summed_up(right.b, Wrong::step));
        EXPECT_EQ(calibration.verdict, Verdict::contradictory) << where << calibration.reason;
        const Finding* finding = find(calibration, "reversed_steps");
        ASSERT_NE(finding, nullptr) << where << calibration.reason;
        EXPECT_TRUE(finding->certain) << where;
        expect_answer(*finding, right.T, where);
      }
    }
}

TEST(ReversedSteps, OfRotationsAloneAreNamed) {
  for (const std::uint64_t seed : {1, 2}) {
    const testing::Streams right = drive(Terrain::free, seed);
    const Calibration calibration = calibrate(right.a, summed_up(right.b, Wrong::rotation));
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
    const Finding* finding = find(calibration, "axes_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_NE(finding->message.find("rotation of each step inverted"), std::string::npos) << finding->message;
    expect_answer(*finding, right.T, std::to_string(seed));
  }
}

/// A car on flat ground; b measures with noise, in or against the direction of its steps.
struct FlatDrive {
  Trajectory a, b, reversed_b;
  Pose T{rotation_exp({0, 0, 0.1}), {0.8, -0.3, 0}};
};

FlatDrive flat_drive() {
  FlatDrive result;
  Pose here;
  for (int i = 0; i < 900; ++i) {
    const double t = 0.1 * i, rate = 0.4 * std::sin(0.11 * t + 1) + 0.3 * std::sin(0.37 * t);
    const double noise = 1e-3 * std::sin(12.9898 * i) + 1e-3 * std::sin(78.233 * i);
    const Pose step{rotation_exp({0, 0, 0.1 * rate}), {0.3, 0, 0}};
    here = here * step;
    result.a.push_back({i * 100'000, canonical_sign(to_dual_quaternion(here))});
    const Pose of_b = here * result.T;
    result.b.push_back({i * 100'000, canonical_sign(to_dual_quaternion(Pose{
                                         (of_b.rotation * rotation_exp({0, 0, 0.2 * noise})).normalized(),
                                         of_b.translation + Eigen::Vector3d(noise, -noise, 0)}))});
  }
  result.reversed_b = summed_up(result.b, Wrong::step);
  return result;
}

/// There the motions are also those of a sensor that is mounted back to front and upside down.
TEST(ReversedSteps, OnFlatGroundBothReadingsAreNamed) {
  const FlatDrive flat = flat_drive();
  const Calibration right = calibrate(flat.a, flat.b);
  EXPECT_EQ(find(right, "reversed_steps"), nullptr);
  const Calibration wrong = calibrate(flat.a, flat.reversed_b);
  EXPECT_EQ(wrong.verdict, right.verdict) << wrong.reason;
  const Finding* finding = find(wrong, "reversed_steps");
  ASSERT_NE(finding, nullptr) << wrong.reason;
  EXPECT_FALSE(finding->certain);
  ASSERT_TRUE(finding->T_a_b);
  const ExtrinsicError error =
      extrinsic_error(to_dual_quaternion(flat.T), to_dual_quaternion(*finding->T_a_b));
  EXPECT_LT(error.rotation, 0.02);
}

}  // namespace
}  // namespace egocal::test_reversed_steps
