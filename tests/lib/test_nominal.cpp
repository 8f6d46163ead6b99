// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A nominal value that the motions contradict must not make a hidden direction look known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_nominal {
namespace {

using ::testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

using testing::drive;

Pose mounting() {
  return inverse(testing::T_vehicle_a) * testing::T_vehicle_b;
}

Calibration with_nominal(const testing::Streams& streams, const Pose& nominal) {
  CalibrationOptions options;
  options.pairing.prior = to_dual_quaternion(nominal);
  return calibrate(streams.a, streams.b, options);
}

Pose moved(double x, double y, double z, double yaw = 0) {
  Pose T = mounting();
  T.translation += Eigen::Vector3d(x, y, z);
  T.rotation = rotation_exp({0, 0, yaw}) * T.rotation;
  return T;
}

struct Mistake {
  Pose nominal;
  const char *message, *remedy;
};

std::vector<Mistake> mistakes() {
  const Pose T = mounting();
  const auto& q = T.rotation;
  return {
      {moved(2, 2, 2), " cm (x, y) from what the motions show, so z, which is taken from it",
       "pose of b in a."},
      {moved(0, 0, 0, 30 * degree), "The nominal value is 30", "the pose of b in a. Where only"},
      {inverse(T), " deg (roll, pitch, yaw)", "value, whose inverse agrees: give the pose of b in a"},
      {{Rotation(q.x(), q.y(), q.z(), q.w()), T.translation}, "deg", "whose quaternion agrees as x y z w"},
      {{T.rotation, 1000 * T.translation}, " m (x, y)", "which agrees in millimetres"},
      {moved(0, 0, -400), " cm (x, y) from what the motions show, so z", "is it in millimetres?"}};
}

TEST(Nominal, ThatTheMotionsContradictIsReportedAndDoubtful) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const testing::Streams streams = drive(Terrain::flat, seed);
    for (const Mistake& mistake : mistakes()) {
      const Calibration calibration = with_nominal(streams, mistake.nominal);
      EXPECT_EQ(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
      const Finding* finding = testing::find(calibration, "nominal");
      ASSERT_NE(finding, nullptr) << seed << ": " << mistake.message;
      EXPECT_TRUE(finding->certain);
      EXPECT_THAT(finding->message, HasSubstr(mistake.message)) << seed;
      EXPECT_THAT(finding->remedy, HasSubstr(mistake.remedy)) << seed << ": " << finding->message;
      EXPECT_EQ(calibration.reason, finding->message);
    }
  }
}

// nothing of the height leaks into x and y where the first sensor is level
TEST(Nominal, ThatIsTooLongForMetresIsReported) {
  SimulationOptions options;
  options.terrain = Terrain::flat;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, mounting()};
  const std::vector<Trajectory> both = simulate(options);
  CalibrationOptions long_one;
  long_one.pairing.prior = to_dual_quaternion(moved(0, 0, -150));
  const Calibration calibration = calibrate(both[0], both[1], long_one);
  const Finding* finding = testing::find(calibration, "nominal");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_EQ(calibration.verdict, Verdict::doubtful);
  EXPECT_THAT(finding->message, HasSubstr("The nominal value is 150 m long, so z, which is taken from it"));
  EXPECT_THAT(finding->remedy, HasSubstr("is it in millimetres?"));
}

// a thousandth of any nominal value of some metres agrees with a lever arm that is within the tolerance
TEST(Nominal, OfMetresIsNotTakenForMillimetres) {
  SimulationOptions options;
  options.terrain = Terrain::flat;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, {mounting().rotation, {0.3, 0.2, -0.3}}};
  const std::vector<Trajectory> both = simulate(options);
  CalibrationOptions wrong;
  wrong.pairing.prior = to_dual_quaternion(Pose{mounting().rotation, {2.3, 2.2, 1.7}});
  const Calibration calibration = calibrate(both[0], both[1], wrong);
  const Finding* finding = testing::find(calibration, "nominal");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_THAT(finding->remedy, HasSubstr("Where only a part of it is measured"));
}

// what a drawing of a mounting is taken to be known to: 10 cm and 0.05 rad, a standard deviation
TEST(Nominal, ThatIsAsGoodAsADrawingIsTaken) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Terrain terrain : {Terrain::flat, Terrain::free}) {
      const testing::Streams streams = drive(terrain, seed);
      for (const Pose& nominal : {mounting(), moved(0.2, -0.2, 0.1, 0.05), moved(0, 0, 1)}) {
        const Calibration calibration = with_nominal(streams, nominal);
        if (terrain == Terrain::free && nominal.translation.z() > 0)
          continue;  // it is a metre off, and shown
        EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
        EXPECT_EQ(testing::find(calibration, "nominal"), nullptr) << seed << ": " << calibration.reason;
      }
    }
}

TEST(Nominal, ThatIsNotNeededLeavesTheVerdict) {
  const testing::Streams streams = drive(Terrain::free, 1);
  const Calibration calibration = with_nominal(streams, moved(2, 0, 0));
  EXPECT_EQ(calibration.verdict, Verdict::good) << calibration.reason;
  const Finding* finding = testing::find(calibration, "nominal");
  ASSERT_NE(finding, nullptr);
  EXPECT_THAT(finding->message, HasSubstr(" cm (x) from what the motions show."));
}

TEST(Nominal, ThatStreamsAsTheyAreReadContradictIsNotBlamed) {
  testing::Streams streams = drive(Terrain::free, 1);
  for (StampedPose& pose : streams.b) pose.pose = conjugate(pose.pose);
  const Calibration calibration = with_nominal(streams, mounting());
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
  EXPECT_EQ(testing::find(calibration, "nominal"), nullptr);
}

TEST(Nominal, ThatIsRightIsNotBlamedForWhatElseIsWrong) {
  const Pose bump{rotation_exp({0, 0, 40 * degree}), Eigen::Vector3d::Zero()};
  for (const Terrain terrain : {Terrain::flat, Terrain::rough}) {
    const testing::Streams right = drive(terrain, 1);
    for (const Trajectory& wrong : {testing::knocked(right.b, 0.25, bump), testing::lengthened(right.b, 1.5),
                                    testing::late(right.b, 0.5)}) {
      const Calibration calibration = with_nominal({right.T, right.a, wrong, {}}, mounting());
      EXPECT_EQ(testing::find(calibration, "nominal"), nullptr) << calibration.reason;
      EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
    }
  }
}

}  // namespace
}  // namespace egocal::test_nominal
