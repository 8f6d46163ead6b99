// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The offset of two clocks, followed while the poses come.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/clock_drives.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::test_clock_offset {
namespace {

using namespace testing;

MotionPairing followed(const Trajectory& a, const Trajectory& b, std::uint64_t interleave,
                       bool drift_seen = false) {
  testing::Random random(interleave);
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const std::uint64_t run = interleave == 0 ? 1 : 1 + random.below(200);
    for (std::uint64_t k = 0; k < run; ++k) {
      // by what has gone by since each began
      const bool from_a =
          j == b.size() || (i < a.size() && a[i].time_us - a[0].time_us <= b[j].time_us - b[0].time_us);
      if (from_a && i < a.size()) drive.push(Side::a, a[i++]);
      if (!from_a && j < b.size()) drive.push(Side::b, b[j++]);
    }
    for (std::uint64_t k = 0; interleave != 0 && k < random.below(100) && i < a.size(); ++k)
      drive.push(Side::a, a[i++]);
  }
  drive.finish();
  EXPECT_EQ(drive.state().clock.changes > 1, drift_seen);
  return drive;
}

TEST(ClockOffset, IsFoundOnTheWayAndCostsOnlyTheLastPose) {
  const Streams data = simulated(0.01, 3);
  const MotionPairing together = pair_motions({}, data.a, data.b).drive;
  for (const double shift : {0.0, -250.0, 1e6}) {
    const MotionPairing drive = followed(data.a, shifted(data.b, shift), 0);
    ASSERT_TRUE(drive.time_offset());
    EXPECT_NEAR(*drive.time_offset(), -shift, 0.005);
    // the last pose waits for the next one, as the stamps differ by what is not known of the clocks
    EXPECT_GE(drive.counts().synchronised, together.counts().synchronised - 1);
    const ExtrinsicError error = extrinsic_error(data.T, solve(drive.problem(), Method::dual).T_a_b);
    const ExtrinsicError best = extrinsic_error(data.T, solve(together.problem(), Method::dual).T_a_b);
    EXPECT_LT(error.rotation, 2 * best.rotation + 2e-3);
    EXPECT_LT(error.translation, 2 * best.translation + 0.01);
  }
}

TEST(ClockOffset, DoesNotDependOnHowTheStreamsInterleave) {
  const Streams data = simulated(0.01, 4, 90);
  const Trajectory b = shifted(data.b, 77);
  const MotionPairing expected = followed(data.a, b, 0);
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const MotionPairing drive = followed(data.a, b, seed);
    EXPECT_EQ(drive.time_offset(), expected.time_offset());
    EXPECT_EQ(sum_blocks(drive.problem().blocks).dual_rows, sum_blocks(expected.problem().blocks).dual_rows)
        << seed;
  }
}

TEST(ClockOffset, DriftIsFollowed) {
  const Streams data = simulated(0.005, 5, 240);
  // a clock that is slow by two in ten thousand
  const MotionPairing drive = followed(data.a, drifting(data.b, 2e-4), 0, true);
  const double end = 2e-4 * 1e-6 * static_cast<double>(data.b.back().time_us - data.b[0].time_us);
  // the newest estimate is of the minute before; another comes into force at five milliseconds
  EXPECT_NEAR(*drive.time_offset(), end, 0.018);
  EXPECT_GT(*drive.time_offset(), 0.02);
}

TEST(ClockOffset, ContinuesFromItsStateBitForBit) {
  const Streams data = simulated(0.01, 6, 60);
  const Trajectory b = shifted(data.b, -5);
  const Problem expected = followed(data.a, b, 0).problem();
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t i = 0, j = 0;
  while (i < data.a.size() || j < b.size()) {
    if ((i + j) % 500 == 0) drive = MotionPairing(drive.options(), drive.state());
    const bool from_a = j == b.size() || (i < data.a.size() && data.a[i].time_us - data.a[0].time_us <=
                                                                   b[j].time_us - b[0].time_us);
    from_a ? drive.push(Side::a, data.a[i++]) : drive.push(Side::b, b[j++]);
  }
  drive.finish();
  EXPECT_EQ(sum_blocks(drive.problem().blocks).dual_rows, sum_blocks(expected.blocks).dual_rows);
}

TEST(ClockOffset, StreamsThatNeverMatchAreHeldBoundedAndCounted) {
  const Streams data = simulated(0.01, 7, 400), other = simulated(0.01, 8, 400);
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t j = 0;
  for (const StampedPose& pose : data.a) {
    StampedPose still = pose;
    still.pose = {};
    drive.push(Side::a, still);
    while (j < other.b.size() && other.b[j].time_us <= pose.time_us) drive.push(Side::b, other.b[j++]);
    if (j % 50 == 0)
      for (const auto& stream : drive.state().clock.streams) {
        ASSERT_LE(stream.window.size(), 195u * 50u);
        ASSERT_LE(stream.held.size(), 181u * 50u);
      }
  }
  EXPECT_FALSE(drive.time_offset());
  EXPECT_EQ(drive.counts().synchronised, 0u);
  EXPECT_GT(drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)], 200u * 50u);
}

TEST(ClockOffset, IsFoundInSpiteOfGlitches) {
  for (const double part : {0.01, 0.05})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Streams data = simulated(0.01, seed, 60);
      const MotionPairing drive =
          followed(glitched(data.a, part, seed), glitched(shifted(data.b, -7), part, seed + 10), 0);
      ASSERT_TRUE(drive.time_offset()) << part << " " << seed;
      EXPECT_NEAR(*drive.time_offset(), 7, 0.005) << part << " " << seed;
      EXPECT_GT(drive.counts().matched, 300u);
    }
}

/// b's clock is set forward by a fifth of a second after two minutes.
Trajectory set_forward(Trajectory path) {
  for (StampedPose& pose : path)
    if (pose.time_us - path.front().time_us > 120'000'000) pose.time_us += 200'000;
  return path;
}

TEST(ClockOffset, NoMotionSpansAChange) {
  const Streams data = simulated(0.01, 5, 240);
  const Trajectory b = set_forward(data.b);
  PairingOptions options;
  options.track_time_offset = true;
  options.stride = 5;
  options.balance = Balance{};
  MotionPairing drive(options);
  std::vector<MotionPair> pairs;
  const auto keep = [&pairs](const std::vector<MotionPair>& more) {
    pairs.insert(pairs.end(), more.begin(), more.end());
  };
  std::uint64_t before = 0;
  std::int64_t changed_us = 0;
  for (std::size_t i = 0, j = 0; i < data.a.size() || j < b.size();) {
    const bool from_a = j == b.size() || (i < data.a.size() && data.a[i].time_us <= b[j].time_us);
    keep(from_a ? drive.push(Side::a, data.a[i++]) : drive.push(Side::b, b[j++]));
    if ((i + j) % 20 != 0) continue;
    const std::uint64_t changes = drive.state().clock.changes;
    if (changes > 1 && before != changes) {
      before = changes;
      changed_us = drive.state().accumulator.instants.back().time_us;
    }
  }
  EXPECT_GT(before, 1u);
  EXPECT_NEAR(*drive.time_offset(), -0.2, 0.01);
  EXPECT_GT(drive.state().accumulator.instants.back().chain, 1u);
  EXPECT_GT(pairs.back().begin_us, changed_us);
  // those of the last change, which everything before it was paired by
  for (const MotionPair& pair : pairs)
    EXPECT_FALSE(pair.begin_us <= changed_us - 500'000 && pair.end_us >= changed_us + 500'000);
}

TEST(ClockOffset, AChangeDoesNotDependOnHowTheStreamsInterleave) {
  const Streams data = simulated(0.01, 6, 200);
  const Trajectory b = shifted(set_forward(data.b), 33);
  const MotionPairing expected = followed(data.a, b, 0, true);
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const MotionPairing drive = followed(data.a, b, seed, true);
    EXPECT_EQ(drive.time_offset(), expected.time_offset());
    EXPECT_EQ(drive.counts().synchronised, expected.counts().synchronised);
    EXPECT_EQ(sum_blocks(drive.problem().blocks).dual_rows, sum_blocks(expected.problem().blocks).dual_rows)
        << seed;
  }
}

TEST(ClockOffset, ContinuesFromItsStateInTheMiddleOfASearch) {
  const Streams data = simulated(0.01, 6, 40);
  const Trajectory b = shifted(data.b, -5);
  const Problem expected = followed(data.a, b, 0).problem();
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  for (std::size_t i = 0, j = 0; i < data.a.size() || j < b.size();) {
    if ((i + j) % 7 == 0) drive = MotionPairing(drive.options(), drive.state());
    const bool from_a = j == b.size() || (i < data.a.size() && data.a[i].time_us - data.a[0].time_us <=
                                                                   b[j].time_us - b[0].time_us);
    from_a ? drive.push(Side::a, data.a[i++]) : drive.push(Side::b, b[j++]);
  }
  drive.finish();
  EXPECT_EQ(sum_blocks(drive.problem().blocks).dual_rows, sum_blocks(expected.blocks).dual_rows);
}

/// Two streams of one rate [Hz], b's clock 5 s behind.
Streams of_rate(double rate, int seconds) {
  Streams streams = testing::simulated_drive({.terrain = Terrain::free,
                                              .poses = static_cast<int>(rate * seconds),
                                              .rate = rate,
                                              .speed = 2,
                                              .relative_noise = 0.01,
                                              .seed = 4});
  streams.b = shifted(streams.b, -5);
  return streams;
}

Trajectory poses_in(const Trajectory& path, std::int64_t begin_us, std::int64_t end_us) {
  Trajectory result;
  for (const StampedPose& pose : path)
    if (pose.time_us > begin_us && pose.time_us <= end_us) result.push_back(pose);
  return result;
}

/// Slow streams have few poses until an estimate should come into force: the rest was done in one step, 16 ms
/// at 10 Hz.
TEST(ClockOffset, NoPoseWaitsForMoreThanItsShareOfAnEstimate) {
  constexpr std::int64_t window_us = 60'000'000;
  const PairingOptions options;
  for (const double rate : {5.0, 10.0, 20.0}) {
    const Streams data = of_rate(rate, 80);
    ClockFollower follower(options);
    std::size_t pushes = 0, compared = 0;
    for (std::size_t i = 0; i < data.a.size(); ++i)
      for (const Side side : {Side::a, Side::b}) {
        const ClockState before = follower.state();
        follower.push(side, (side == Side::a ? data.a : data.b)[i]);
        const auto reached = [&](std::size_t k) {
          return before.streams[k].newest_us &&
                 *before.streams[k].newest_us - *before.streams[k].begin_us >= before.next_us;
        };
        pushes = reached(0) && reached(1) ? pushes + 1 : 1;
        if (!before.in_force || before.next_us == follower.state().next_us) continue;
        TimeOffsetOptions near;
        near.near = to_seconds(data.a[0].time_us - data.b[0].time_us);
        const auto window = [&](const Trajectory& path, std::size_t k) {
          const std::int64_t end_us = *before.streams[k].begin_us + before.next_us;
          return poses_in(path, end_us - window_us, end_us);
        };
        TimeOffsetSearch search(window(data.a, 0), window(data.b, 1), near);
        while (!search.step(options.clock.work_per_pose)) {
        }
        // the offset in force is not quite the given one
        const auto shares = static_cast<double>(search.steps());
        EXPECT_GE(static_cast<double>(pushes), 0.9 * shares) << rate << " Hz";
        EXPECT_LE(static_cast<double>(pushes), 1.1 * shares + 2 * 2 * rate) << rate << " Hz";
        ++compared;
      }
    EXPECT_GE(compared, 1u);
  }
}

/// A thousand poses wait for the first estimate.
TEST(ClockOffset, HeldPosesAreReleasedAFewAtATime) {
  const Streams data = of_rate(50, 30);
  ClockFollower follower(PairingOptions{});
  std::size_t most = 0, released = 0;
  for (std::size_t i = 0; i < data.a.size(); ++i)
    for (const Side side : {Side::a, Side::b}) {
      const std::size_t here = follower.push(side, (side == Side::a ? data.a : data.b)[i]).size();
      most = std::max(most, here);
      released += here;
    }
  EXPECT_LE(most, 10u);
  EXPECT_GE(released, data.a.size() + data.b.size() - 2);
}

/// The log of a drive may end while its first poses wait. Where it goes on after all, nothing has changed.
TEST(ClockOffset, HeldPosesAreReleasedInASilenceWithoutAnyOtherEffect) {
  const Streams data = of_rate(50, 60);
  ClockFollower steady{PairingOptions{}}, silent{PairingOptions{}};
  std::vector<ReleasedPose> expected, found;
  const auto append = [](std::vector<ReleasedPose>& all, const std::vector<ReleasedPose>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  std::size_t in_the_silence = 0;
  for (std::size_t i = 0; i < data.a.size(); ++i) {
    for (const Side side : {Side::a, Side::b}) {
      const StampedPose& pose = (side == Side::a ? data.a : data.b)[i];
      append(expected, steady.push(side, pose));
      append(found, silent.push(side, pose));
    }
    if (i % 20 != 0) continue;
    const bool can = silent.can_release();
    const std::vector<ReleasedPose> released = silent.release_held();
    EXPECT_EQ(can, !released.empty());
    EXPECT_FALSE(silent.can_release());
    in_the_silence += released.size();
    append(found, released);
  }
  append(expected, steady.finish());
  append(found, silent.finish());
  EXPECT_GE(in_the_silence, 500u);
  // how both streams interleave is not what pairing depends on
  const auto a_first = [](const ReleasedPose& x, const ReleasedPose& y) { return x.side < y.side; };
  std::stable_sort(expected.begin(), expected.end(), a_first);
  std::stable_sort(found.begin(), found.end(), a_first);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].side, expected[k].side) << k;
    ASSERT_EQ(found[k].pose.time_us, expected[k].pose.time_us) << k;
    ASSERT_EQ(found[k].segment, expected[k].segment) << k;
  }
}

/// To the pose: each push releases the same poses as without the interruptions.
TEST(ClockOffset, ARestartInTheMiddleOfAnEstimateDelaysNothing) {
  const Streams data = of_rate(10, 50);
  const PairingOptions options;
  ClockFollower follower(options), restarted(options);
  for (std::size_t i = 0; i < data.a.size(); ++i)
    for (const Side side : {Side::a, Side::b}) {
      if (i % 7 == 0) restarted = ClockFollower(options, restarted.state());
      const StampedPose& pose = (side == Side::a ? data.a : data.b)[i];
      const std::vector<ReleasedPose> expected = follower.push(side, pose),
                                      found = restarted.push(side, pose);
      ASSERT_EQ(found.size(), expected.size()) << i;
      for (std::size_t k = 0; k < found.size(); ++k)
        ASSERT_EQ(found[k].pose.time_us, expected[k].pose.time_us) << i;
    }
  EXPECT_TRUE(follower.seconds());
  EXPECT_EQ(follower.seconds(), restarted.seconds());
}

/// Far in the future, or in the past: nothing waits for it, nothing grows.
TEST(ClockOffset, StrayStampsCostOnlyThemselves) {
  const Streams data = simulated(0.01, 3, 60);
  for (const std::int64_t stray_us : {std::int64_t{0}, std::int64_t{4'000'000'000'000'000}})
    for (const std::size_t at : {std::size_t{0}, std::size_t{1000}}) {
      Trajectory a = data.a;
      a.insert(a.begin() + static_cast<std::ptrdiff_t>(at), StampedPose{stray_us, {}});
      PairingOptions options;
      options.track_time_offset = true;
      MotionPairing drive(options);
      for (std::size_t i = 0, j = 0; i < a.size(); ++i) {
        drive.push(Side::a, a[i]);
        if (i % 5 == 4 && j < data.b.size()) drive.push(Side::b, data.b[j++]);
        for (const auto& stream : drive.state().clock.streams) ASSERT_LE(stream.held.size(), 700u);
      }
      ASSERT_TRUE(drive.time_offset()) << stray_us << " " << at;
      EXPECT_NEAR(*drive.time_offset(), 0, 0.005);
      EXPECT_GT(drive.counts().synchronised, 500u);
      EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)] <= 60u, true)
          << drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)];
    }
}

}  // namespace
}  // namespace egocal::test_clock_offset
