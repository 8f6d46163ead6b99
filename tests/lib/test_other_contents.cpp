// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Files that hold something else than poses in metres and one frame: their motions contradict each other, and
// the finding says what they hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "diagnosis/explanations/turning/turning_of_steps.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/twist_integrator.hpp"
#include "egocal/simulation/simulation.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::test_other_contents {
namespace {

using detail::Instants;
using detail::Motion;
using detail::Motions;
using detail::motions_of;
using detail::synchronised;
using detail::turns_too_far_by_more_than_noise;
using testing::certain_finding;
using testing::drive;
using testing::expect_cured;
using testing::find;

TEST(OtherContents, AGyroscopeThatIsSummedUpInHalfOrDoubleAnglesIsNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double factor : {0.5, 2.0}) {
      const testing::Streams right = drive(terrain);
      const Calibration calibration = calibrate(right.a, testing::with_scaled_steps(right.b, factor));
      const Finding of_b = certain_finding(calibration, "turning_scale_b");
      EXPECT_NEAR(of_b.value.value_or(0) / factor, 1, 0.02);
      EXPECT_NE(of_b.message.find("from each pose to the next one"), std::string::npos) << of_b.message;
      expect_cured(right, calibration, of_b, 0.01, 0.5);
    }
}

TEST(OtherContents, LatitudeAndLongitudeInDegreesAreNamed) {
  const testing::Streams right = drive(Terrain::free);
  Eigen::Matrix3d in_degrees;
  in_degrees << 0, 1 / 111e3, 0, 1 / 71e3, 0, 0, 0, 0, 1;  // latitude first
  const Calibration calibration = calibrate(right.a, testing::with_position_columns(right.b, in_degrees));
  const Finding columns = certain_finding(calibration, "axes_b");
  EXPECT_NE(columns.message.find("in unlike units"), std::string::npos) << columns.message;
  expect_cured(right, calibration, columns, 0.01, 0.1);
}

/// Three factors and a rotation look like one factor on a road, which is nearly level.
TEST(OtherContents, AHeightInFeetIsNotCalledAScale) {
  const testing::Streams right = drive(Terrain::rough);
  const Calibration calibration =
      calibrate(right.a, testing::with_position_columns(right.b, Eigen::Vector3d(1, 1, 3.2808).asDiagonal()));
  const Finding columns = certain_finding(calibration, "axes_b");
  EXPECT_NE(columns.message.find("in unlike units"), std::string::npos) << columns.message;
  EXPECT_EQ(find(calibration, "scale"), nullptr);
  expect_cured(right, calibration, columns, 0.02, 1);
}

/// An odometry that drifts stretches its positions by some per cent, too: no reading of its file cures that.
// Worlds with parallel axes do not show which stream it is.
TEST(OtherContents, AStretchedAxisOfParallelSensorsIsThatOfEither) {
  SimulationOptions options;
  options.roughness = 0.3;
  options.poses = 601;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {{Rotation::Identity(), {0, 0, 1.5}}, {Rotation::Identity(), {0.5, 0, 1.5}}};
  const Eigen::Matrix3d stretch = Eigen::Vector3d(1.6, 1, 1).asDiagonal();
  for (const std::uint64_t seed : {3, 4, 5}) {
    options.seed = seed;
    const std::vector<Trajectory> streams = simulate(options);
    certain_finding(calibrate(testing::with_position_columns(streams[0], stretch), streams[1]), "axes_a");
    certain_finding(calibrate(streams[0], testing::with_position_columns(streams[1], stretch)), "axes_b");
  }
}

TEST(OtherContents, PositionsThatAreStretchedALittleAreOnlySaidToBe) {
  const testing::Streams right = drive(Terrain::free);
  const Eigen::Vector3d little(1.05, 0.97, 1), more(1.6, 1, 1);
  const Calibration drifts = calibrate(right.a, testing::with_position_columns(right.b, little.asDiagonal()));
  EXPECT_EQ(find(drifts, "axes_b"), nullptr) << drifts.reason;
  const Finding* odometry = find(drifts, "odometry");
  ASSERT_NE(odometry, nullptr) << drifts.reason;
  EXPECT_FALSE(odometry->certain);
  EXPECT_EQ(drifts.verdict, Verdict::good) << drifts.reason;
  certain_finding(calibrate(right.a, testing::with_position_columns(right.b, more.asDiagonal())), "axes_b");
}

/// Hills under a lidar whose heights drift: the answer is right to half a degree.
TEST(OtherContents, HeightsThatAreStretchedAreNoContradictionWhereTheAnswerStays) {
  SimulationOptions options;
  options.roughness = 0.5;
  options.poses = 301;
  options.relative_noise = 0.002;
  options.T_vehicle_sensor = {{Rotation::Identity(), {0, 0, 1.8}}, {Rotation::Identity(), {0.5, -0.4, 1.5}}};
  for (const double factor : {1.16, 0.84}) {
    const Eigen::Matrix3d stretch = Eigen::Vector3d(1, 1, factor).asDiagonal();
    const std::vector<Trajectory> streams = simulate(options);
    const Calibration calibration =
        calibrate(streams[0], testing::with_position_columns(streams[1], stretch));
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << factor << ": " << calibration.reason;
    const Pose right{Rotation::Identity(), {0.5, -0.4, -0.3}};
    EXPECT_LT(extrinsic_error(to_dual_quaternion(right), to_dual_quaternion(calibration.T_a_b)).rotation,
              0.0175);
  }
}

TEST(OtherContents, PositionsThatAreTurnedByLessThanTheToleranceAreNoContradiction) {
  const testing::Streams right = testing::noisy_drive(Terrain::rough, 0.002, 301);
  const auto turned = [&](double degrees) {
    const Rotation turn = rotation_exp({0, 0, degrees * std::numbers::pi / 180});
    return calibrate(right.a, testing::with_position_columns(right.b, turn.toRotationMatrix()));
  };
  EXPECT_LE(turned(0.6).verdict, Verdict::incomplete) << turned(0.6).reason;
  EXPECT_EQ(turned(3).verdict, Verdict::contradictory) << turned(3).reason;
}

TEST(OtherContents, AnglesOfTheWrongSignOrderAndUnitAreNamed) {
  const auto angles = [](const Trajectory& poses, const std::function<Eigen::Vector3d(Eigen::Vector3d)>& f) {
    return testing::with_angles(poses, f);
  };
  const double degrees = std::numbers::pi / 180;
  const testing::Streams right = drive(Terrain::free);
  for (const auto& [words, wrong] :
       {std::pair<const char*, Trajectory>{"compass heading", angles(right.b,
                                                                     [=](Eigen::Vector3d x) {
                                                                       return Eigen::Vector3d(
                                                                           x[0], x[1], 90 * degrees - x[2]);
                                                                     })},
        {"its roll taken with the opposite sign",
         angles(right.b, [](Eigen::Vector3d x) { return Eigen::Vector3d(-x[0], x[1], x[2]); })},
        {"its pitch taken with the opposite sign",
         angles(right.b, [](Eigen::Vector3d x) { return Eigen::Vector3d(x[0], -x[1], x[2]); })},
        {"radians that were taken as degrees",
         angles(right.b, [=](Eigen::Vector3d x) { return Eigen::Vector3d(degrees * x); })},
        {"turned in the opposite order", testing::with_angles_in_another_order(right.b)}}) {
    const Calibration calibration = calibrate(right.a, wrong);
    const Finding finding = certain_finding(calibration, "axes_b");
    EXPECT_NE(finding.message.find(words), std::string::npos) << words << ": " << finding.message;
    expect_cured(right, calibration, finding, 0.02, 0.2);
  }
}

/// Axes of positions that are turned explain a part of them, and a mount that shakes does.
TEST(OtherContents, AnglesOfTheWrongSignOfEitherStreamAreNamedOnRoads) {
  using Change = std::function<Eigen::Vector3d(Eigen::Vector3d)>;
  const std::vector<std::pair<const char*, Change>> changes{
      {"its yaw taken with the opposite sign",
       [](Eigen::Vector3d x) { return Eigen::Vector3d(x[0], x[1], -x[2]); }},
      {"compass heading",
       [](Eigen::Vector3d x) { return Eigen::Vector3d(x[0], x[1], std::numbers::pi / 2 - x[2]); }},
      {"its pitch taken with the opposite sign",
       [](Eigen::Vector3d x) { return Eigen::Vector3d(x[0], -x[1], x[2]); }}};
  for (const double roughness : {0.05, 0.3}) {
    SimulationOptions options;
    options.roughness = roughness;
    options.poses = 301;
    options.relative_noise = 0.01;
    const testing::Streams right = testing::simulated_drive(options);
    for (const auto& [words, change] : changes)
      for (const char side : {'a', 'b'}) {
        testing::Streams streams = right;
        Trajectory& wrong = side == 'a' ? streams.a : streams.b;
        wrong = testing::with_angles(wrong, change);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding finding = certain_finding(calibration, std::string("axes_") + side);
        EXPECT_NE(finding.message.find(words), std::string::npos)
            << words << " of " << side << ": " << finding.message;
        EXPECT_EQ(calibration.verdict, Verdict::contradictory);
      }
  }
}

/// Small angles turn by nearly nothing, and the streams would be said to hardly turn.
TEST(OtherContents, RadiansThatWereTakenAsDegreesAreNamedOnARoad) {
  const testing::Streams right = testing::noisy_drive(Terrain::rough, 0.01, 301);
  const Calibration calibration = calibrate(right.a, testing::with_angles(right.b, [](Eigen::Vector3d x) {
                                              return Eigen::Vector3d(std::numbers::pi / 180 * x);
                                            }));
  const Finding finding = certain_finding(calibration, "axes_b");
  EXPECT_NE(finding.message.find("radians that were taken as degrees"), std::string::npos) << finding.message;
}

/// A drone that hovers; a has its positions from a receiver, in coordinates whose origin is kilometres away.
/// Turned by its rotations they are long motions, of which any residual is a small part.
TEST(OtherContents, PositionsFarFromTheOriginAreNotTakenToBeInTheAxesOfTheSensor) {
  const Pose mount{rotation_exp({0.3, -1.2, 0.8}), {-0.4, 0.2, 0.3}};
  const Eigen::Vector3d origin(3000, 2000, 50);
  for (const std::uint64_t seed : {1, 2, 3}) {
    testing::Random random(seed);
    testing::Streams streams;
    Eigen::Vector3d turned = Eigen::Vector3d::Zero(), position = Eigen::Vector3d::Zero();
    Eigen::Vector3d wandering = Eigen::Vector3d::Zero();
    for (int i = 0; i < 900; ++i) {
      const std::int64_t time_us = static_cast<std::int64_t>(i) * 50'000;
      turned += 0.03 * random.normal3() - 0.02 * turned;
      position += 0.03 * random.normal3() - 0.01 * position;
      wandering += 0.01 * random.normal3() - 0.02 * wandering;
      const Pose a{rotation_exp(turned), position};
      Pose measured = a;
      measured.translation += origin + wandering + 0.03 * random.normal3();
      streams.a.push_back({time_us, to_dual_quaternion(measured)});
      streams.b.push_back({time_us, to_dual_quaternion(a * mount)});
    }
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(find(calibration, "axes_a"), nullptr) << seed << ": " << calibration.reason;
    EXPECT_NE(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
  }
}

TEST(OtherContents, AHeightInFeetIsNotCalledAnotherFrame) {
  const testing::Streams right = testing::noisy_drive(Terrain::rough, 0.001, 301);
  const Eigen::Matrix3d in_feet = Eigen::Vector3d(1, 1, 3.2808).asDiagonal();
  const Calibration calibration = calibrate(testing::with_position_columns(right.a, in_feet), right.b);
  const Finding finding = certain_finding(calibration, "axes_a");
  EXPECT_NE(finding.message.find("in unlike units"), std::string::npos) << finding.message;
}

/// Two or three motions: there are no longer ones, but shorter ones, of which noise is a larger part.
TEST(OtherContents, NoiseIsNoFactorOfTheTurningInAShortDrive) {
  constexpr int poses = 100, stride = 40;
  const auto streams = [](double noise, double factor) {
    testing::Random random(3);
    testing::Streams result;
    for (int i = 0; i < poses; ++i) {
      const std::int64_t time_us = static_cast<std::int64_t>(i) * 100'000;
      const Eigen::Vector3d turned(0, 0, 0.002 * i), position(i, 0, 0);
      const Rotation jitter = rotation_exp(random.normal3(noise));
      result.a.push_back({time_us, to_dual_quaternion(Pose{rotation_exp(turned), position})});
      result.b.push_back({time_us, canonical_sign(to_dual_quaternion(
                                       Pose{rotation_exp(factor * turned) * jitter, position}))});
    }
    return result;
  };
  const auto turns_too_far = [](const testing::Streams& of) {
    const Instants instants = synchronised(of.a, of.b, {}, 1);
    const Motions motions = motions_of(instants, {}, {}, stride, 700);
    std::vector<double> ratios;
    for (const Motion& motion : motions.all) ratios.push_back(motion.angle_b / motion.angle_a);
    return turns_too_far_by_more_than_noise(instants, motions, detail::median(ratios), {});
  };
  EXPECT_FALSE(turns_too_far(streams(0.02, 1)));
  EXPECT_TRUE(turns_too_far(streams(0, 1.5)));
}

TEST(OtherContents, VelocitiesInPlaceOfPositionsAreNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    const testing::Streams right = drive(terrain);
    const Calibration calibration = calibrate(right.a, testing::with_velocities(right.b));
    const Finding finding = certain_finding(calibration, "missing_b");
    EXPECT_NE(finding.message.find("velocities in the axes of the world"), std::string::npos)
        << finding.message;
    EXPECT_EQ(calibration.verdict, Verdict::contradictory);
  }
}

TEST(OtherContents, PositionsInTheAxesOfTheSensorAreNamed) {
  const testing::Streams right = drive(Terrain::free);
  const Calibration calibration =
      calibrate(right.a, testing::changed(right.b, [](const Pose& pose) {
                  return Pose{pose.rotation, pose.rotation.conjugate() * pose.translation};
                }));
  EXPECT_FALSE(calibration.findings.empty());
  expect_cured(right, calibration, certain_finding(calibration, "axes_b"), 0.01, 0.1);
}

/// Rates in degrees a second that were summed up as radians: each row is the screw of its twist.
TEST(OtherContents, TurningRatesInDegreesAreNamed) {
  const testing::Streams right = drive(Terrain::rough);
  TwistIntegrator integrator;
  Trajectory wrong;
  for (std::size_t i = 1; i < right.b.size(); ++i) {
    const double seconds = 1e-6 * static_cast<double>(right.b[i].time_us - right.b[i - 1].time_us);
    const Pose step = to_pose(conjugate(right.b[i - 1].pose) * right.b[i].pose);
    const Twist twist{right.b[i].time_us, step.translation / seconds,
                      180 / std::numbers::pi * rotation_log(step.rotation) / seconds};
    if (const std::optional<DualQuaternion> pose = integrator.add(twist))
      wrong.push_back({twist.time_us, canonical_sign(*pose)});
  }
  const Calibration calibration = calibrate(right.a, wrong);
  const Finding finding = certain_finding(calibration, "turning_scale_b");
  EXPECT_NE(finding.message.find("degrees a second"), std::string::npos) << finding.message;
  EXPECT_EQ(find(calibrate(right.a, right.b), "turning_scale_b"), nullptr);
}

/// A heading alone beside a sensor that tilts with the road.
TEST(OtherContents, RotationsWithoutRollAndPitchAreNamed) {
  testing::Streams right = drive(Terrain::rough);
  right.b = testing::seen_from(right.b, to_dual_quaternion(testing::T_vehicle_b));
  EXPECT_EQ(find(calibrate(right.a, right.b), "flat_b"), nullptr);
  const Calibration calibration = calibrate(
      right.a, testing::with_angles(right.b, [](Eigen::Vector3d x) { return Eigen::Vector3d(0, 0, x[2]); }));
  const Finding finding = certain_finding(calibration, "flat_b");
  EXPECT_NE(finding.message.find("roll and pitch are missing"), std::string::npos) << finding.message;
  EXPECT_GE(calibration.verdict, Verdict::doubtful);
}

}  // namespace
}  // namespace egocal::test_other_contents
