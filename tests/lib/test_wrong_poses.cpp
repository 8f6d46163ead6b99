// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Single wrong poses in short streams of low rates: one pose of b is beside two instants, and spoils the
// motions that begin or end there, which may be most of a tenth of the drive. Half of such drives were
// contradictory, with answers that were right.
#include <gtest/gtest.h>

#include <cstdint>

#include "../support/simulated_drive.hpp"
#include "diagnosis/streams/wrong_poses.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_wrong_poses {
namespace {

using testing::Streams;

/// 26 s at 7 Hz each, b between the stamps of a; a share of the poses is wrong by some 0.2 rad and a second's
/// way, and one of thirty is missing.
Streams streams_of(Terrain terrain, std::uint64_t seed, double wrong = 0) {
  SensorFaults fault;
  fault.outliers = wrong;
  fault.outlier_translation = 8;
  fault.dropped = wrong > 0 ? 0.03 : 0;
  SimulationOptions options;
  options.terrain = terrain;
  options.rate = 7;
  options.poses = 182;
  options.relative_noise = 0.005;
  options.seed = seed;
  options.faults = {fault, fault};
  options.faults[1].phase = 0.06;
  return testing::simulated_drive(options);
}

TEST(WrongPoses, MakeNoDriveContradictory) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Streams streams = streams_of(terrain, seed, 0.05);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_LT(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
      EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b)).rotation, 0.02) << seed;
    }
}

detail::Instants instants_of(const Streams& streams) {
  return detail::synchronised(streams.a, streams.b, {}, 0.5);
}

TEST(WrongPoses, AreFoundByTheMotionsPastThem) {
  Streams streams = streams_of(Terrain::free, 3);
  const std::size_t all = instants_of(streams).size();
  EXPECT_EQ(without_wrong_poses(instants_of(streams), to_pose(streams.T)).size(), all);
  for (const std::size_t i : {20U, 40U, 60U, 61U, 80U, 140U, 160U})
    streams.a[i].pose = streams.a[i].pose * to_dual_quaternion(Pose{rotation_exp({0.3, 0, 0}), {5, -4, 2}});
  streams.b[100].pose = streams.b[100].pose * to_dual_quaternion(Pose{rotation_exp({0, 0.3, 0}), {5, -4, 2}});
  const std::size_t left = without_wrong_poses(instants_of(streams), to_pose(streams.T)).size();
  // b's is beside two instants, and bends the path to their neighbours
  EXPECT_LE(left, all - 9);
  EXPECT_GE(left, all - 16);
}

/// A sensor that was moved does not come back: at most one run of instants beside the move is omitted.
TEST(WrongPoses, AKnockStays) {
  Streams streams = streams_of(Terrain::free, 4);
  const DualQuaternion knock = to_dual_quaternion(Pose{rotation_exp({0.2, 0.1, 0}), {1, 0, 0.5}});
  for (std::size_t i = 90; i < streams.b.size(); ++i)
    streams.b[i].pose = canonical_sign(normalized(streams.b[i].pose * knock));
  const detail::Instants instants = instants_of(streams);
  EXPECT_GE(without_wrong_poses(instants, to_pose(streams.T)).size(), instants.size() - 8);
}

}  // namespace
}  // namespace egocal::test_wrong_poses
