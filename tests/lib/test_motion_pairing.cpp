// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "../support/standing.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::test_motion_pairing {
namespace {

using Simulated = testing::Streams;

Simulated simulated(Terrain terrain, double noise, int poses = 1001, std::uint64_t seed = 1) {
  return testing::simulated_drive(
      {.terrain = terrain, .poses = poses, .relative_noise = noise, .seed = seed});
}

bool same_bits(const Problem& x, const Problem& y) {
  if (x.blocks.size() != y.blocks.size() || x.balance.translation != y.balance.translation) return false;
  for (std::size_t i = 0; i < x.blocks.size(); ++i)
    if (x.blocks[i].dual_rows != y.blocks[i].dual_rows || x.blocks[i].count != y.blocks[i].count)
      return false;
  return true;
}

ExtrinsicError error_of(const Simulated& data, const MotionPairing& drive) {
  return extrinsic_error(data.T, solve(drive.problem(), Method::dual).T_a_b);
}

struct Stand {
  std::size_t at = 0;        ///< pose
  std::int64_t periods = 0;  ///< of 0.1 s
  double jitter = 0;         ///< [m]
  std::uint64_t seed = 0;    ///< of the jitter
};

/// Compares the drive with the same one without the stand.
void expect_no_harm(Terrain terrain, const Stand& stand) {
  Simulated data = simulated(terrain, 0.01);
  const MotionPairing plain = pair_motions({}, data.a, data.b).drive;
  testing::Random random(stand.seed);
  for (Trajectory* stream : {&data.a, &data.b})
    *stream = testing::with_stand(*stream, stand.at, stand.periods, 100'000, stand.jitter, random);
  const MotionPairing drive = pair_motions({}, data.a, data.b).drive;
  const PairingCounts counts = drive.counts();
  const std::string what = std::to_string(static_cast<int>(terrain)) + " at " + std::to_string(stand.at) +
                           " jitter " + std::to_string(1e9 * stand.jitter) + "e-9";
  EXPECT_EQ(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)], 0u) << what;
  if (terrain == Terrain::flat) return;  // shows no height
  EXPECT_LT(error_of(data, drive).rotation, 3 * error_of(data, plain).rotation + 5e-4) << what;
  EXPECT_LT(error_of(data, drive).translation, 3 * error_of(data, plain).translation + 0.02) << what;
}

/// A vehicle that stands at the start shows no noise, or only that of its wheel odometry, which says nothing
/// about the drive that follows.
TEST(MotionPairing, StandingRejectsNothingOfTheDriveThatFollows) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (const double jitter : {0.0, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3})
      for (const std::size_t at : {std::size_t{1}, std::size_t{500}})
        expect_no_harm(terrain, {.at = at, .periods = 700, .jitter = jitter, .seed = 3});
}

/// The typical sizes then come from motions that are all zero, whichever estimate is due when the last motion
/// of the drive is forgotten.
TEST(MotionPairing, ParkingForLongerThanWhatIsRemembered) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double jitter : {0.0, 1e-6, 1e-4})
      for (const std::size_t at : {300u, 364u, 428u, 492u, 800u})
        expect_no_harm(terrain, {.at = at, .periods = 1800, .jitter = jitter, .seed = 5});
}

TEST(MotionPairing, AfterStandingWrongPosesAreRejectedAsBefore) {
  Simulated data = simulated(Terrain::rough, 0.01);
  testing::Random random(4);
  data.a = testing::with_stand(data.a, 1, 700, 100'000, 0, random);
  data.b = testing::with_stand(data.b, 1, 700, 100'000, 0, random);
  for (std::size_t i = 900; i < 1600; i += 50)
    data.b[i].pose = data.b[i].pose * testing::displacement({0, 0, 0.1}, {1, 0, 0});
  const PairingCounts counts = pair_motions({}, data.a, data.b).drive.counts();
  EXPECT_GE(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)], 14u);
  EXPECT_LE(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)], 20u);
}

TEST(MotionPairing, PerfectDataGiveThePerfectAnswer) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    const Simulated data = simulated(terrain, 0);
    const MotionPairing drive = pair_motions({}, data.a, data.b).drive;
    const Answer answer = solve(drive.problem(), Method::dual);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified);
    EXPECT_LT(error_of(data, drive).rotation, 1e-9);
    EXPECT_LT(error_of(data, drive).translation, 1e-9);
    for (const std::uint64_t count : drive.counts().rejected) EXPECT_EQ(count, 0u);
  }
}

TEST(MotionPairing, EveryMotionOfOneStepIsPaired) {
  const Simulated data = simulated(Terrain::rough, 0.01);
  const PairingResult result = pair_motions({.stride = 1, .balance = Balance{}}, data.a, data.b);
  EXPECT_EQ(result.drive.counts().matched, 1000u);
  EXPECT_EQ(result.pairs.size(), 1000u);
  EXPECT_EQ(result.drive.counts().synchronised, 1001u);
  EXPECT_EQ(result.drive.choice().reason, "fixed");
}

TEST(MotionPairing, DoesNotDependOnHowTheStreamsInterleave) {
  const Simulated data = simulated(Terrain::rough, 0.01, 600);
  const Problem expected = pair_motions({}, data.a, data.b).drive.problem();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    testing::Random random(seed);
    MotionPairing drive{PairingOptions{}};
    std::size_t i = 0, j = 0;
    while (i < data.a.size() || j < data.b.size()) {
      // one stream may run ahead of the other by many poses
      std::size_t run = 1 + random.below(100);
      const bool from_a = random.uniform() < 0.5;
      for (; run > 0 && from_a && i < data.a.size(); --run) drive.push(Side::a, data.a[i++]);
      for (; run > 0 && !from_a && j < data.b.size(); --run) drive.push(Side::b, data.b[j++]);
    }
    drive.finish();
    EXPECT_TRUE(same_bits(drive.problem(), expected)) << seed;
  }
}

TEST(MotionPairing, ContinuesFromItsStateBitForBit) {
  const Simulated data = simulated(Terrain::rough, 0.01, 400);
  const Problem expected = pair_motions({}, data.a, data.b).drive.problem();
  for (const std::size_t cut : {0u, 3u, 9u, 63u, 64u, 65u, 200u, 399u}) {
    MotionPairing first{PairingOptions{}};
    for (std::size_t i = 0; i < cut; ++i) {
      first.push(Side::a, data.a[i]);
      first.push(Side::b, data.b[i]);
    }
    MotionPairing second(first.options(), first.state());
    for (std::size_t i = cut; i < data.a.size(); ++i) {
      second.push(Side::a, data.a[i]);
      second.push(Side::b, data.b[i]);
    }
    second.finish();
    EXPECT_TRUE(same_bits(second.problem(), expected)) << cut;
  }
}

TEST(MotionPairing, InterpolatesTheFasterStream) {
  // a ten times as fast as b, its stamps never the same
  const Simulated data = simulated(Terrain::free, 0, 4001);
  Trajectory slow;
  for (std::size_t i = 5; i < data.b.size(); i += 10) {
    slow.push_back(data.b[i]);
  }
  Trajectory fast;
  for (std::size_t i = 0; i < data.a.size(); ++i)
    if (i % 10 != 5) fast.push_back(data.a[i]);
  const PairingResult result = pair_motions({.stride = 1, .balance = Balance{1, 0.01}}, fast, slow);
  EXPECT_EQ(result.drive.counts().matched, slow.size() - 2);  // the last pose waits for the next one
  EXPECT_EQ(result.drive.state().synchroniser.keys, Side::b);
  const PairingResult swapped = pair_motions({.stride = 1, .balance = Balance{1, 0.01}}, slow, fast);
  EXPECT_EQ(swapped.drive.state().synchroniser.keys, Side::a);
  EXPECT_LT(error_of(data, result.drive).rotation, 2e-3);
  EXPECT_LT(error_of(data, result.drive).translation, 0.05);
}

TEST(MotionPairing, ALostPoseMakesALongerMotionNotAWrongOne) {
  Simulated data = simulated(Terrain::rough, 0, 400);
  testing::Random random(3);
  for (Trajectory* trajectory : {&data.a, &data.b})
    std::erase_if(*trajectory, [&](const StampedPose&) { return random.uniform() < 0.2; });
  PairingOptions options{.stride = 1, .balance = Balance{}};
  options.max_gap = 0.05;  // no interpolation: only instants that both have
  const MotionPairing drive = pair_motions(options, data.a, data.b).drive;
  EXPECT_GT(drive.counts().matched, 200u);
  EXPECT_LT(error_of(data, drive).rotation, 1e-9);
  EXPECT_LT(error_of(data, drive).translation, 1e-8);
}

/// Packets overtake each other: a pose that comes late costs nothing while nothing after it has been paired.
TEST(MotionPairing, LatePosesFindTheirPlace) {
  const Simulated data = simulated(Terrain::rough, 0.01, 400);
  const PairingOptions options{.stride = 1, .balance = Balance{}};
  const Problem expected = pair_motions(options, data.a, data.b).drive.problem();
  testing::Random random(9);
  Trajectory late = data.a;
  for (std::size_t i = 20; i + 4 < late.size(); i += 4)
    if (random.uniform() < 0.3) std::swap(late[i], late[i + 1 + random.below(2)]);
  MotionPairing drive(options);
  for (std::size_t i = 0; i < late.size() + 4; ++i) {  // b comes a little later than a
    if (i < late.size()) drive.push(Side::a, late[i]);
    if (i >= 4) drive.push(Side::b, data.b[i - 4]);
  }
  drive.finish();
  EXPECT_TRUE(same_bits(drive.problem(), expected));
  EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::out_of_order)], 0u);

  // too late: its neighbours have been paired without it
  MotionPairing strict(options);
  for (std::size_t i = 0; i < data.a.size(); ++i) {
    if (i != 200) strict.push(Side::a, data.a[i]);
    strict.push(Side::b, data.b[i]);
    if (i == 210) strict.push(Side::a, data.a[200]);
    if (i == 220) strict.push(Side::a, data.a[220]);  // known
  }
  EXPECT_EQ(strict.counts().rejected[static_cast<std::size_t>(Rejection::out_of_order)], 2u);
}

TEST(MotionPairing, GapsAreNotBridged) {
  Simulated data = simulated(Terrain::rough, 0.001, 600);
  std::erase_if(data.a, [&](const StampedPose& pose) {
    return pose.time_us > data.b[200].time_us && pose.time_us < data.b[300].time_us;
  });
  const MotionPairing drive = pair_motions({.stride = 1, .balance = Balance{}}, data.a, data.b).drive;
  EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::gap)], 99u + 1u);
  EXPECT_EQ(drive.counts().matched, 599u - 100u);
}

TEST(MotionPairing, BadPosesAreCountedByReasonAndCostOnlyThemselves) {
  const Simulated data = simulated(Terrain::rough, 0.001, 300);
  MotionPairing drive({.stride = 1, .balance = Balance{}});
  for (std::size_t i = 0; i < data.a.size(); ++i) {
    drive.push(Side::a, data.a[i]);
    drive.push(Side::b, data.b[i]);
    StampedPose bad = data.a[i];
    bad.pose.dual[1] = std::numeric_limits<double>::quiet_NaN();
    drive.push(Side::a, bad);
    drive.push(Side::b, data.b[i]);           // repeated
    drive.push(Side::b, data.b[i / 2]);       // late
    bad.pose = {{3, 0, 0, 0}, {0, 0, 0, 0}};  // not unit
    drive.push(Side::b, bad);
  }
  const auto& rejected = drive.counts().rejected;
  EXPECT_EQ(rejected[static_cast<std::size_t>(Rejection::not_finite)], 600u);
  EXPECT_EQ(rejected[static_cast<std::size_t>(Rejection::out_of_order)], 600u);
  const MotionPairing clean = pair_motions({.stride = 1, .balance = Balance{}}, data.a, data.b).drive;
  EXPECT_TRUE(same_bits(drive.problem(), clean.problem()));
}

TEST(MotionPairing, JumpsAreLeftOut) {
  const Simulated clean = simulated(Terrain::rough, 0.01, 1001, 4);
  Simulated data = clean;
  testing::Random random(5);
  // relocalisations: from there on all poses of b are elsewhere
  DualQuaternion jump;
  int jumps = 0;
  for (std::size_t i = 100; i < data.b.size(); ++i) {
    if (i % 100 == 50) {
      jump = testing::random_displacement(random, 0.3, 5) * jump;
      ++jumps;
    }
    data.b[i].pose = normalized(jump * data.b[i].pose);
  }
  const MotionPairing with = pair_motions({}, data.a, data.b).drive,
                      without = pair_motions({}, clean.a, clean.b).drive;
  EXPECT_EQ(with.counts().rejected[static_cast<std::size_t>(Rejection::screw_congruence)],
            static_cast<std::uint64_t>(jumps));
  EXPECT_EQ(without.counts().rejected[static_cast<std::size_t>(Rejection::screw_congruence)], 0u);
  EXPECT_LT(error_of(data, with).rotation, 2 * error_of(clean, without).rotation + 2e-4);
}

/// Before anything is known of what is typical: a motion of many steps across the jump would stay wrong.
TEST(MotionPairing, JumpsAmongTheFirstPosesAreLeftOut) {
  const Simulated clean = simulated(Terrain::free, 0.01, 1001, 4);
  for (const std::size_t first : {1u, 5u, 20u}) {
    Simulated data = clean;
    const DualQuaternion jump = testing::displacement({0.5, -2, 0.3}, {1, -3, 2});
    for (std::size_t i = first; i < data.b.size(); ++i) data.b[i].pose = normalized(jump * data.b[i].pose);
    const MotionPairing with = pair_motions({}, data.a, data.b).drive,
                        without = pair_motions({}, clean.a, clean.b).drive;
    EXPECT_EQ(with.counts().rejected[static_cast<std::size_t>(Rejection::screw_congruence)], 1u) << first;
    EXPECT_EQ(with.state().accumulator.instants.back().chain, 1u) << first;
    EXPECT_LE(with.counts().outliers, without.counts().outliers) << first;
    EXPECT_LT(error_of(data, with).rotation, 2 * error_of(clean, without).rotation + 2e-4) << first;
  }
}

TEST(MotionPairing, AFrozenSensorIsLeftOutAndAVehicleAtRestIsNot) {
  const Simulated clean = simulated(Terrain::free, 0.01, 1001, 4);
  const auto frozen = [](const MotionPairing& drive) {
    return drive.counts().rejected[static_cast<std::size_t>(Rejection::frozen)];
  };
  // b samples between the poses of a: what is repeated is an interpolation
  for (const std::int64_t later_us : {0, 33'000}) {
    Simulated data = clean;
    for (StampedPose& pose : data.b) pose.time_us += later_us;
    PairingOptions options;
    options.time_offset = -1e-6 * static_cast<double>(later_us) / 2;
    const double error_clean = error_of(data, pair_motions(options, data.a, data.b).drive).rotation;
    for (std::size_t i = 401; i < 600; ++i) data.b[i].pose = data.b[400].pose;
    const MotionPairing drive = pair_motions(options, data.a, data.b).drive;
    EXPECT_NEAR(static_cast<double>(frozen(drive)), 199, 1) << later_us;
    if (later_us == 0) {
      EXPECT_LT(error_of(data, drive).rotation, 3 * error_clean);
    }
    for (std::size_t i = 401; i < 600; ++i) data.a[i].pose = data.a[400].pose;
    EXPECT_LE(frozen(pair_motions(options, data.a, data.b).drive), 2u) << later_us;
  }
  PairingOptions trusting;
  trusting.robust = false;
  Simulated data = clean;
  for (std::size_t i = 401; i < 600; ++i) data.b[i].pose = data.b[400].pose;
  EXPECT_EQ(frozen(pair_motions(trusting, data.a, data.b).drive), 0u);
}

TEST(MotionPairing, TimeOffsetIsAddedToB) {
  Simulated data = simulated(Terrain::rough, 0, 300);
  for (StampedPose& pose : data.b) pose.time_us -= 12'345'678;
  PairingOptions options;
  options.time_offset = 12.345678;
  const MotionPairing drive = pair_motions(options, data.a, data.b).drive;
  EXPECT_LT(error_of(data, drive).rotation, 1e-9);
}

TEST(MotionPairing, StreamsThatDoNotOverlapGiveNothingAndSaySo) {
  Simulated data = simulated(Terrain::rough, 0, 300);
  for (StampedPose& pose : data.b) pose.time_us += 1'000'000'000;
  const MotionPairing drive = pair_motions({}, data.a, data.b).drive;
  EXPECT_EQ(drive.counts().matched, 0u);
  EXPECT_TRUE(drive.problem().blocks.empty());
  EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)], 300u);
}

TEST(MotionPairing, ShortDrivesArePairedAtTheEnd) {
  const Simulated data = simulated(Terrain::rough, 0, 3);
  EXPECT_EQ(pair_motions({}, data.a, data.b).drive.counts().matched, 2u);
}

TEST(MotionPairing, MemoryIsBoundedWhateverOneStreamDoes) {
  MotionPairing drive{PairingOptions{}};
  for (int i = 0; i < 100'000; ++i) drive.push(Side::a, {i * 1000, {}});
  EXPECT_LE(drive.state().synchroniser.waiting[0].size(), 4096u);
  EXPECT_GT(drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)], 90'000u);
}

TEST(MotionPairing, ChoosesLongMotionsForNoiseThatDoesNotGrow) {
  // absolute poses with jitter (a camera that sees a target): short steps are useless, long ones good
  Simulated data = simulated(Terrain::free, 0, 2001);
  testing::Random random(6);
  for (StampedPose& pose : data.b) pose.pose = pose.pose * testing::normal_displacement(random, 0.01, 0.02);
  const MotionPairing chosen = pair_motions({}, data.a, data.b).drive;
  const MotionPairing equal = pair_motions({.stride = 1, .balance = Balance{}}, data.a, data.b).drive;
  EXPECT_GE(chosen.choice().stride, 8);
  EXPECT_LT(error_of(data, chosen).rotation, 0.6 * error_of(data, equal).rotation);
}

TEST(MotionPairing, AutomaticSettingsBeatEqualWeights) {
  std::vector<double> equal, chosen;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulated data = simulated(Terrain::rough, 0.01, 1001, seed);
    equal.push_back(
        error_of(data, pair_motions({.stride = 1, .balance = Balance{}}, data.a, data.b).drive).rotation);
    chosen.push_back(error_of(data, pair_motions({}, data.a, data.b).drive).rotation);
  }
  std::sort(equal.begin(), equal.end());
  std::sort(chosen.begin(), chosen.end());
  EXPECT_LT(chosen[10] * 57.3, 0.13);
  EXPECT_LT(chosen[10], 0.3 * equal[10]);
}

TEST(MotionPairing, RefusesOptionsThatMakeNoSense) {
  EXPECT_THROW(MotionPairing({.stride = 0}), Error);
  PairingOptions planar;
  planar.mode = Mode::planar;
  planar.plane_a.normal = {0, 0, 2};
  EXPECT_THROW(MotionPairing{planar}, Error);
}

TEST(Simulation, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Simulated x = simulated(Terrain::rough, 0.01, 100, 1), y = simulated(Terrain::rough, 0.01, 100, 1);
  const Simulated z = simulated(Terrain::rough, 0.01, 100, 2);
  for (std::size_t i = 0; i < x.a.size(); ++i) EXPECT_EQ(x.b[i].pose.vec(), y.b[i].pose.vec());
  EXPECT_NE(x.b.back().pose.vec(), z.b.back().pose.vec());
}

TEST(Simulation, FlatIsPlanarRoughHasOneDominantAxis) {
  const auto rotation_about = [](Terrain terrain) {
    SimulationOptions options;
    options.terrain = terrain;
    const Trajectory path = simulate(options)[0];
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < path.size(); ++i)
      squares += rotation_log(to_pose(conjugate(path[i - 1].pose) * path[i].pose).rotation).cwiseAbs2();
    return squares.cwiseSqrt().eval();
  };
  const Eigen::Vector3d flat = rotation_about(Terrain::flat), rough = rotation_about(Terrain::rough);
  EXPECT_LT(flat.head<2>().norm(), 1e-12);
  EXPECT_GT(rough.head<2>().norm(), 0.02 * rough.z());
  EXPECT_LT(rough.head<2>().norm(), 0.7 * rough.z());
}

TEST(Simulation, NoiseHasTheSizeThatWasAskedFor) {
  const Simulated clean = simulated(Terrain::free, 0, 4001), noisy = simulated(Terrain::free, 0.1, 4001);
  double rotation = 0, error = 0;
  for (std::size_t i = 1; i < clean.a.size(); ++i) {
    const DualQuaternion motion = conjugate(clean.a[i - 1].pose) * clean.a[i].pose;
    const DualQuaternion seen = conjugate(noisy.a[i - 1].pose) * noisy.a[i].pose;
    rotation += screw_of(motion).angle;
    const double off = extrinsic_error(motion, seen).rotation;
    error += off * off;
  }
  const double count = static_cast<double>(clean.a.size() - 1);
  EXPECT_NEAR(std::sqrt(error / count / 3), 0.1 * rotation / count, 0.005 * rotation / count);
}

}  // namespace
}  // namespace egocal::test_motion_pairing
