// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The first stage of the pairing: instants at which both sensors have a pose.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "../support/pairing_stages.hpp"
#include "../support/random_motion.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_synchroniser {
namespace {

using testing::displacement;
using testing::period_us;
using testing::rejected;
using testing::simulated;
using testing::Streams;

TEST(Synchroniser, InterpolatesTheFasterStreamAtTheStampsOfTheSlowerOne) {
  Synchroniser synchroniser{PairingOptions{}};
  std::vector<Instant> instants;
  const auto take = [&](const std::vector<Instant>& more) {
    instants.insert(instants.end(), more.begin(), more.end());
  };
  for (int i = 0; i < 200; ++i) {
    take(synchroniser.push(Side::a, {i * 10'000, displacement({0, 0, 0.001 * i}, {0.1 * i, 0, 0})}));
    if (i % 10 == 5) take(synchroniser.push(Side::b, {i * 10'000 + 4'000, {}}));
  }
  take(synchroniser.finish());
  ASSERT_EQ(instants.size(), 20u);
  EXPECT_EQ(synchroniser.period_us(), 100'000);
  for (std::size_t k = 0; k < instants.size(); ++k) {
    EXPECT_EQ(instants[k].time_us, static_cast<std::int64_t>(k) * 100'000 + 54'000);
    EXPECT_EQ(instants[k].number, k + 1);
    EXPECT_NEAR(screw_of(instants[k].a).angle, 0.001 * (10 * static_cast<double>(k) + 5.4), 1e-12);
  }
}

TEST(Synchroniser, ANewClockBeginsANewChainAcrossWhichNothingIsInterpolated) {
  Synchroniser synchroniser{PairingOptions{}};
  std::vector<Instant> instants;
  const auto take = [&](const std::vector<Instant>& more) {
    instants.insert(instants.end(), more.begin(), more.end());
  };
  for (int i = 0; i < 40; ++i) {
    if (i == 20) take(synchroniser.begin_chain());
    take(synchroniser.push(Side::a, {i * 100'000, {}}));
    take(synchroniser.push(Side::b, {i * 100'000 + 50'000, {}}));
  }
  take(synchroniser.finish());
  const auto& state = synchroniser.state();
  for (const Instant& instant : instants) {
    EXPECT_EQ(instant.chain, instant.time_us < 2'000'000 ? 0u : 1u);
    EXPECT_FALSE(instant.time_us > 1'900'000 && instant.time_us < 2'000'000);
  }
  EXPECT_EQ(instants.size() + rejected(state.rejections, Rejection::no_partner), 40u);
  EXPECT_EQ(instants.size(), 32u);  // the last four of a clock wait for poses that do not come
}

/// Two sensors on a body in free motion whose path is smooth, at one rate and half a period apart.
Streams apart(double rate, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.rate = 100;
  options.poses = 6001;
  options.seed = seed;
  options.faults.resize(2);
  for (SensorFaults& faults : options.faults) faults.rate = rate;
  options.faults[1].phase = 0.5 / rate;
  return testing::simulated_drive(options);
}

std::vector<Instant> synchronised(const Streams& data, const PairingOptions& options, bool b_first = false) {
  Synchroniser synchroniser(options);
  std::vector<Instant> instants;
  const auto push = [&](Side side, const Trajectory& poses) {
    for (const StampedPose& pose : poses)
      for (const Instant& instant : synchroniser.push(side, pose)) instants.push_back(instant);
  };
  push(b_first ? Side::b : Side::a, b_first ? data.b : data.a);
  push(b_first ? Side::a : Side::b, b_first ? data.a : data.b);
  for (const Instant& instant : synchroniser.finish()) instants.push_back(instant);
  return instants;
}

/// How far the instants' motions are from a rigid mounting: root mean square over all [m].
double slack(const std::vector<Instant>& instants, const DualQuaternion& T) {
  double squares = 0;
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const DualQuaternion a = motion_between(instants[i - 1].a, instants[i].a),
                         b = motion_between(instants[i - 1].b, instants[i].b);
    const double miss = translation_length(normalized(conjugate(a) * T * b * conjugate(T)));
    squares += miss * miss / static_cast<double>(instants.size() - 1);
  }
  return std::sqrt(squares);
}

/// Along screws, as where the path is not smooth.
PairingOptions cut_alike() {
  PairingOptions options;
  options.synchroniser.smooth_poses = 0;
  return options;
}

PairingOptions not_cut() {
  PairingOptions options = cut_alike();
  options.synchroniser.cut_alike = false;
  return options;
}

TEST(Synchroniser, BothStreamsLoseAlikeByInterpolationAlongScrews) {
  for (const double rate : {5.0, 10.0, 20.0}) {
    const Streams data = apart(rate, 3);
    const std::vector<Instant> smooth = synchronised(data, {}), cut = synchronised(data, cut_alike()),
                               plain = synchronised(data, not_cut());
    EXPECT_EQ(cut.size() + 1, plain.size());
    std::printf("%g Hz: %.2f mm off a rigid mounting, along screws %.2f mm, not cut alike %.2f mm\n", rate,
                1e3 * slack(smooth, data.T), 1e3 * slack(cut, data.T), 1e3 * slack(plain, data.T));
    EXPECT_LT(slack(cut, data.T), 0.5 * slack(plain, data.T));
    // the path changes a hundred times a second, faster than either can follow
    EXPECT_LT(slack(smooth, data.T), 1.05 * slack(cut, data.T));
  }
}

TEST(Synchroniser, PosesOfTheSameStampStayAsTheyAre) {
  const Streams data = simulated(300);
  const std::vector<Instant> instants = synchronised(data, {});
  ASSERT_EQ(instants.size(), data.b.size());
  for (std::size_t i = 0; i < instants.size(); ++i) {
    EXPECT_EQ(instants[i].a.vec(), data.a[i].pose.vec());
    EXPECT_EQ(instants[i].b.vec(), data.b[i].pose.vec());
  }
}

TEST(Synchroniser, WhichStreamComesFirstChangesNoBitOfWhatIsCut) {
  const Streams data = apart(10, 4);
  const std::vector<Instant> a_first = synchronised(data, {}), b_first = synchronised(data, {}, true);
  ASSERT_EQ(a_first.size(), b_first.size());
  for (std::size_t i = 0; i < a_first.size(); ++i) {
    EXPECT_EQ(a_first[i].a.vec(), b_first[i].a.vec());
    EXPECT_EQ(a_first[i].b.vec(), b_first[i].b.vec());
  }
}

// Keys are those of b, whose periods are as long.
TEST(Synchroniser, AWrongPoseAndAJumpStayWhereTheyAre) {
  const Streams right = apart(10, 5);
  Streams wrong = right;
  const DualQuaternion jump = displacement({0.2, -0.3, 0.4}, {1.5, -1, 2});
  wrong.b[100].pose = normalized(wrong.b[100].pose * jump);
  for (std::size_t i = 200; i < wrong.b.size(); ++i) wrong.b[i].pose = normalized(jump * wrong.b[i].pose);
  const std::vector<Instant> before = synchronised(right, cut_alike()),
                             after = synchronised(wrong, cut_alike());
  ASSERT_EQ(before.size(), after.size());
  const auto at = [&](const std::vector<Instant>& instants, std::size_t key) {
    for (const Instant& instant : instants)
      if (instant.time_us == right.b[key].time_us) return instant.b;
    return DualQuaternion{};
  };
  for (std::size_t key = 90; key < 250; ++key) {
    const DualQuaternion expected = key >= 200 ? normalized(jump * at(before, key)) : at(before, key);
    if (key == 100) {
      EXPECT_EQ(at(after, key).vec(), wrong.b[key].pose.vec());
      continue;
    }
    // a pose beside a wrong one does not know how its path bends: it stays as it is, or is cut as before
    const DualQuaternion off = conjugate(at(after, key)) * expected;
    const bool beside = key == 99 || key == 101 || key == 199 || key == 200;
    EXPECT_LT(translation_length(normalized(off)), beside ? 0.05 : 1e-9) << key;
  }
}

TEST(Synchroniser, AKeyWaitsForFourPosesOfTheOtherStream) {
  Synchroniser synchroniser{PairingOptions{}};
  for (int i = 0; i < 20; ++i) {
    synchroniser.push(Side::a, {i * 100'000, displacement({}, {0.1 * i, 0, 0})});
    synchroniser.push(Side::b, {i * 100'000 + 40'000, displacement({}, {0.1 * i + 0.04, 0, 0})});
  }
  EXPECT_EQ(synchroniser.state().synchronised, 16u);
  synchroniser.push(Side::a, {2'000'000, displacement({}, {2, 0, 0})});
  EXPECT_EQ(synchroniser.state().synchronised, 17u);
  EXPECT_TRUE(synchroniser.finish().empty());
  EXPECT_EQ(rejected(synchroniser.state().rejections, Rejection::no_partner), 3u);
}

TEST(Synchroniser, AlongScrewsAKeyWaitsForTheNextOne) {
  Synchroniser synchroniser{cut_alike()};
  for (int i = 0; i < 20; ++i) {
    synchroniser.push(Side::a, {i * 100'000, displacement({}, {0.1 * i, 0, 0})});
    synchroniser.push(Side::b, {i * 100'000 + 40'000, displacement({}, {0.1 * i + 0.04, 0, 0})});
  }
  EXPECT_EQ(synchroniser.state().synchronised, 19u);
  synchroniser.push(Side::a, {2'000'000, displacement({}, {2, 0, 0})});
  EXPECT_EQ(synchroniser.state().synchronised, 19u);
  EXPECT_TRUE(synchroniser.finish().empty());
  EXPECT_EQ(rejected(synchroniser.state().rejections, Rejection::no_partner), 1u);
}

}  // namespace
}  // namespace egocal::test_synchroniser
