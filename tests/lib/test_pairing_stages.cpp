// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Each stage of the pairing by itself, and what all of them together decide.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "../support/corruption.hpp"
#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal {
namespace {

using testing::Corruption;
using testing::displacement;
using testing::Random;
using testing::Streams;

Streams simulated(int poses, double noise = 0.01, std::uint64_t seed = 1) {
  return testing::simulated_drive(
      {.terrain = Terrain::free, .poses = poses, .relative_noise = noise, .seed = seed});
}

std::uint64_t rejected(const Rejections& rejections, Rejection reason) {
  return rejections.by_reason[static_cast<std::size_t>(reason)];
}

std::vector<Instant> instants_of(const Streams& data) {
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < data.a.size(); ++i)
    instants.push_back({data.a[i].time_us, data.a[i].pose, data.b[i].pose, 0, i + 1});
  return instants;
}

constexpr std::int64_t period_us = 100'000;

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
  ASSERT_EQ(instants.size(), 19u);  // the last one waits for the next
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
  EXPECT_GE(instants.size(), 36u);
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

PairingOptions not_cut() {
  PairingOptions options;
  options.synchroniser.cut_alike = false;
  return options;
}

TEST(Synchroniser, BothStreamsLoseAlikeByInterpolation) {
  for (const double rate : {5.0, 10.0, 20.0}) {
    const Streams data = apart(rate, 3);
    const std::vector<Instant> cut = synchronised(data, {}), plain = synchronised(data, not_cut());
    EXPECT_EQ(cut.size() + 1, plain.size());
    std::printf("%g Hz: %.2f mm off a rigid mounting, not cut alike %.2f mm\n", rate,
                1e3 * slack(cut, data.T), 1e3 * slack(plain, data.T));
    EXPECT_LT(slack(cut, data.T), 0.5 * slack(plain, data.T));
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
  const std::vector<Instant> before = synchronised(right, {}), after = synchronised(wrong, {});
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

TEST(Synchroniser, AKeyWaitsForTheNextOne) {
  Synchroniser synchroniser{PairingOptions{}};
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

TEST(Screening, RejectsGlitchesAndBeginsAChainWhereTrackingJumped) {
  Streams data = simulated(400);
  for (const std::size_t i : {100u, 151u, 202u})
    data.b[i].pose = normalized(data.b[i].pose * displacement({0.5, 0.2, 0}, {2, 0, 0}));
  const DualQuaternion jump = displacement({0.4, 0.3, 1}, {3, -2, 1});
  for (std::size_t i = 300; i < data.b.size(); ++i) data.b[i].pose = normalized(jump * data.b[i].pose);
  Screening screening{ScreeningOptions{}};
  std::vector<Instant> accepted;
  for (const Instant& instant : instants_of(data)) {
    const Screened screened = screening.push(instant, period_us);
    if (screened.replaces) accepted.clear();
    accepted.insert(accepted.end(), screened.accepted.begin(), screened.accepted.end());
  }
  screening.finish();
  EXPECT_EQ(rejected(screening.state().rejections, Rejection::screw_congruence), 4u);
  EXPECT_EQ(accepted.size(), 397u);  // the jump itself is counted, and costs no instant
  for (const Instant& instant : accepted) {
    EXPECT_NE(instant.number, 101u);
    EXPECT_EQ(instant.chain, instant.time_us >= data.a[300].time_us ? 1u : 0u);
  }
}

TEST(Screening, DoesNotCompareAcrossClocks) {
  Streams data = simulated(200);
  const DualQuaternion jump = displacement({0.4, 0.3, 1}, {3, -2, 1});
  for (std::size_t i = 100; i < data.b.size(); ++i) data.b[i].pose = normalized(jump * data.b[i].pose);
  std::vector<Instant> instants = instants_of(data);
  for (std::size_t i = 100; i < instants.size(); ++i) instants[i].chain = 1;
  Screening screening{ScreeningOptions{}};
  std::size_t accepted = 0;
  for (const Instant& instant : instants) {
    const Screened screened = screening.push(instant, period_us);
    accepted = screened.accepted.size() + (screened.replaces ? 0 : accepted);
  }
  screening.finish();
  EXPECT_EQ(accepted, 200u);
  EXPECT_EQ(rejected(screening.state().rejections, Rejection::screw_congruence), 0u);
}

/// The tip of a crane's boom is 60 m from its cabin, and the boom nods: lengths differ by metres a second.
TEST(Screening, LongLeverArmsAreAnOption) {
  const DualQuaternion T = displacement({0.1, 0.2, 0.3}, {60, 3, 5});
  Random random(3);
  std::vector<Instant> instants;
  DualQuaternion a;
  for (std::uint64_t i = 0; i < 600; ++i) {
    // still for a while, then turning
    const double turn = i % 100 < 50 ? 0.0005 : 0.05;
    a = normalized(a * random_displacement(random, turn, 0.02));
    const DualQuaternion noise = normal_displacement(random, 1e-5, 1e-3);
    instants.push_back({static_cast<std::int64_t>(i) * period_us, a, normalized(a * T * noise), 0, i + 1});
  }
  const auto rejections = [&](double longest_lever_arm) {
    Screening screening{ScreeningOptions{.congruence = {.longest_lever_arm = longest_lever_arm}}};
    for (const Instant& instant : instants) screening.push(instant, period_us);
    screening.finish();
    return rejected(screening.state().rejections, Rejection::screw_congruence);
  };
  EXPECT_GT(rejections(10), 0u);
  EXPECT_EQ(rejections(100), 0u);
}

TEST(Accumulator, NoMotionJoinsTwoChains) {
  const Streams data = simulated(300);
  PairingOptions options{.stride = 4, .balance = Balance{}};
  Accumulator accumulator(options);
  accumulator.begin(period_us);
  std::size_t pairs = 0;
  for (Instant instant : instants_of(data)) {
    instant.chain = instant.number > 150 ? 1 : 0;
    for (const MotionPair& pair : accumulator.add(instant)) {
      ++pairs;
      EXPECT_FALSE(pair.begin_us < data.a[150].time_us && pair.end_us >= data.a[150].time_us);
    }
  }
  EXPECT_EQ(pairs, 300u - 2 * 4);
  EXPECT_EQ(accumulator.inlier_pairs() + accumulator.outlier_pairs(), pairs);
}

TEST(Accumulator, ContinuesFromItsStateBitForBit) {
  const std::vector<Instant> instants = instants_of(simulated(300));
  PairingOptions options;
  Accumulator whole(options), parts(options);
  whole.begin(period_us);
  parts.begin(period_us);
  for (const Instant& instant : instants) {
    whole.add(instant);
    if (instant.number % 37 == 0) parts = Accumulator(options, parts.state());
    parts.add(instant);
  }
  EXPECT_EQ(cost_matrix(whole.problem()), cost_matrix(parts.problem()));
  EXPECT_EQ(whole.choice().stride, parts.choice().stride);
}

TEST(Accumulator, SpreadsLooksForOutliersAndChoicesOverPoses) {
  Accumulator accumulator{PairingOptions{}};
  accumulator.begin(period_us);
  AccumulatorState before = accumulator.state();
  std::size_t looks = 0, choices = 0, waited = 0;
  std::uint64_t due = before.sums->next_choice;
  for (const Instant& instant : instants_of(simulated(700))) {
    accumulator.add(instant);
    const AccumulatorState now = accumulator.state();
    std::size_t here = 0;
    for (std::size_t i = 0; i < now.strides.size(); ++i)
      if (now.strides[i].statistics.state().next_look != before.strides[i].statistics.state().next_look)
        ++here;
    EXPECT_LE(here, 2u) << "pose " << instant.number;  // the stride in force looks more often
    looks += here;
    const bool chose = now.next_choice != before.next_choice;
    ASSERT_TRUE(now.sums);
    const bool chose_sums = now.sums->next_choice != before.sums->next_choice;
    // a drive may end here: weights of an older choice would be worse (docs/benchmarks.md); but two choices
    // in one step take too long
    EXPECT_FALSE(chose && chose_sums) << "pose " << instant.number;
    const bool waits = now.sums->next_index >= now.sums->next_choice;
    EXPECT_FALSE(waits && !chose) << "pose " << instant.number;
    waited += waits ? 1 : 0;
    // the wait does not move the choices that follow
    if (chose_sums) {
      EXPECT_LE(now.sums->next_choice, due + std::max<std::uint64_t>(1, due / 4));
    }
    due = now.sums->next_choice;
    choices += (chose ? 1 : 0) + (chose_sums ? 1 : 0);
    before = now;
  }
  EXPECT_GT(looks, 40u);
  EXPECT_GT(choices, 15u);
  EXPECT_GE(waited, 1u);
  EXPECT_LE(waited, 3u);
}

TEST(Accumulator, PairsOfOneRigChooseAtDifferentTimes) {
  constexpr std::size_t pairs = 8;
  const std::vector<Instant> instants = instants_of(simulated(1000));
  const auto choices_at_once = [&instants](bool staggered) {
    std::vector<Accumulator> all;
    for (std::size_t k = 0; k < pairs; ++k) {
      PairingOptions options;
      if (staggered) options.accumulator.choice_phase = static_cast<double>(k) / pairs;
      all.emplace_back(options).begin(period_us);
    }
    std::vector<std::uint64_t> next(pairs);
    std::size_t most = 0, sum = 0;
    for (const Instant& instant : instants) {
      std::size_t here = 0;
      for (std::size_t k = 0; k < pairs; ++k) {
        all[k].add(instant);
        const std::uint64_t now = all[k].state().sums->next_choice;
        here += now != next[k] ? 1 : 0;
        next[k] = now;
      }
      // the first choices are made within eight poses
      if (instant.number > 200) most = std::max(most, here);
      sum += here;
    }
    return std::pair{most, sum};
  };
  const auto [at_once, count] = choices_at_once(false);
  const auto [staggered, count_staggered] = choices_at_once(true);
  EXPECT_EQ(at_once, pairs);
  EXPECT_LE(staggered, 2u);
  EXPECT_NEAR(static_cast<double>(count_staggered), static_cast<double>(count),
              0.1 * static_cast<double>(count));
}

TEST(PairingOptions, OutOfTheirRangeAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = HUGE_VAL;
  const auto refused = [](const PairingOptions& options, const std::string& name) {
    try {
      MotionPairing{options};
    } catch (const Error& error) {
      return std::string(error.what()).find(name) != std::string::npos;
    }
    return false;
  };
  for (const double value : {nan, infinity, -infinity, 1e300, 0.0, -1.0}) {
    EXPECT_TRUE(refused({.max_gap = value}, "max_gap")) << value;
    if (value == 0.0 || value == -1.0) continue;
    EXPECT_TRUE(refused({.time_offset = value}, "time_offset")) << value;
  }
  EXPECT_TRUE(refused({.stride = 0}, "stride"));
  EXPECT_TRUE(refused({.stride = 1'000'000'000}, "stride"));
  EXPECT_TRUE(refused({.balance = Balance{-1, 1}}, "rotation weight"));
  EXPECT_TRUE(refused({.balance = Balance{1, 0}}, "translation weight"));
  EXPECT_TRUE(refused({.balance = Balance{1, nan}}, "translation weight"));
  PairingOptions options;
  options.screening.congruence.longest_lever_arm = nan;
  EXPECT_TRUE(refused(options, "longest_lever_arm"));
  options = {};
  options.accumulator.balances = {};
  EXPECT_TRUE(refused(options, "balances"));
}

/// Extreme stamps, positions and everything else that is no pose are counted, and move nothing.
TEST(MotionPairing, PosesBeyondTheLimitsAreCountedAndIgnored) {
  const Streams data = simulated(200);
  MotionPairing drive{PairingOptions{}};
  const MotionPairing clean = pair_motions({}, data.a, data.b).drive;
  std::uint64_t bad = 0;
  for (std::size_t i = 0; i < data.a.size(); ++i) {
    for (const std::int64_t time :
         {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(),
          std::int64_t{-9'000'000'000'000'000'000}}) {
      drive.push(Side::a, {time, data.a[i].pose});
      ++bad;
    }
    StampedPose far = data.b[i];
    far.pose = displacement({0, 0, 0}, {1e12, 0, 0});
    drive.push(Side::b, far);
    ++bad;
    drive.push(Side::a, data.a[i]);
    drive.push(Side::b, data.b[i]);
  }
  drive.finish();
  EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::not_finite)], bad);
  EXPECT_EQ(cost_matrix(drive.problem()), cost_matrix(clean.problem()));
}

/// Which instants are believed, in which chain, of drives with every kind of corruption. Whole numbers only:
/// they are the same on every machine. Values of the first version, whose statistics the stages kept bit by
/// bit on 122 drives.
TEST(MotionPairing, BelievesWhatTheFirstVersionBelieved) {
  std::uint64_t hash = 1469598103934665603u;
  const auto mix = [&hash](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((value >> (8 * byte)) & 0xff)) * 1099511628211u;
  };
  for (const Corruption corruption : testing::corruptions) {
    const Streams data = simulated(1000, 0.01, 5);
    const Trajectory b = testing::corrupted(data.b, corruption, 6);
    Synchroniser synchroniser{PairingOptions{}};
    Screening screening{ScreeningOptions{}};
    std::vector<Instant> accepted;
    const auto take = [&](const std::vector<Instant>& instants) {
      for (const Instant& instant : instants) {
        const Screened screened = screening.push(instant, synchroniser.period_us());
        if (screened.replaces) accepted.clear();
        accepted.insert(accepted.end(), screened.accepted.begin(), screened.accepted.end());
      }
    };
    for (const StampedPose& pose : data.a) take(synchroniser.push(Side::a, pose));
    for (const StampedPose& pose : b) take(synchroniser.push(Side::b, pose));
    take(synchroniser.finish());
    screening.finish();
    for (const Instant& instant : accepted) {
      mix(static_cast<std::uint64_t>(instant.time_us));
      mix(instant.chain);
    }
    for (const Rejections* stage : {&synchroniser.state().rejections, &screening.state().rejections})
      for (const std::uint64_t count : stage->by_reason) mix(count);
    mix(accepted.size());
  }
  EXPECT_EQ(hash, 12234235260429120617u);
}

}  // namespace
}  // namespace egocal
