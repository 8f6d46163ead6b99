// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What may be done beside something else has the same bits in any order and at the same time.
#include "egocal/beside.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "../support/mistakes.hpp"
#include "../support/standing.hpp"
#include "egocal/calibrate_beside.hpp"
#include "egocal/error.hpp"

namespace egocal::test_beside {
namespace {

using Work = std::function<void()>;

/// Every order in which two things can be done.
std::vector<Beside> all_orders() {
  return {[](const Work& first, const Work& second) {
            first();
            second();
          },
          [](const Work& first, const Work& second) {
            second();
            first();
          },
          [](const Work& first, const Work& second) {
            std::thread other(second);
            first();
            other.join();
          }};
}

bool same_bits(const Problem& x, const Problem& y) {
  if (x.blocks.size() != y.blocks.size() || x.balance.rotation != y.balance.rotation ||
      x.balance.translation != y.balance.translation)
    return false;
  for (std::size_t i = 0; i < x.blocks.size(); ++i)
    if (x.blocks[i].dual_rows != y.blocks[i].dual_rows || x.blocks[i].count != y.blocks[i].count)
      return false;
  return true;
}

testing::Streams drive(int poses, std::uint64_t seed = 1) {
  return testing::simulated_drive({.poses = poses, .relative_noise = 0.01, .seed = seed});
}

void expect_same_pairing(const testing::Streams& data, const PairingOptions& options, const char* what) {
  const MotionPairing alone = paired(options, data.a, data.b);
  ASSERT_FALSE(alone.problem().blocks.empty()) << what;
  for (const Beside& beside : all_orders()) {
    const MotionPairing other = paired(options, data.a, data.b, beside);
    EXPECT_TRUE(same_bits(other.problem(), alone.problem())) << what;
    EXPECT_TRUE(same_bits(other.single_stride_problem(), alone.single_stride_problem())) << what;
    EXPECT_EQ(other.choice().reason, alone.choice().reason) << what;
    EXPECT_EQ(other.choice().mean_stride, alone.choice().mean_stride) << what;
    EXPECT_EQ(other.counts().matched, alone.counts().matched) << what;
    EXPECT_EQ(other.counts().jumps, alone.counts().jumps) << what;
  }
}

TEST(Beside, PairingHasTheSameBits) {
  for (const int poses : {60, 1500, 12'000}) expect_same_pairing(drive(poses), {}, "plain");
  testing::Streams jumps = drive(6000);
  for (std::size_t i = 3000; i < jumps.b.size(); ++i)
    jumps.b[i].pose =
        normalized(to_dual_quaternion(Pose{rotation_exp({0, 0, 0.3}), {2, 1, 0}}) * jumps.b[i].pose);
  expect_same_pairing(jumps, {}, "with a jump");
  PairingOptions fixed;
  fixed.stride = 4;
  fixed.balance = Balance{};
  expect_same_pairing(drive(3000), fixed, "without sums over strides");
  PairingOptions rig;
  rig.accumulator.choice_phase = 0.6;
  expect_same_pairing(drive(6000), rig, "with delayed choices");
}

/// What is typical becomes known late, and the first instants come a second time.
TEST(Beside, PairingBeginsAnewAsAlone) {
  testing::Streams data = drive(9000);
  testing::Random random(3);
  data.a = testing::with_stand(data.a, 20, 5000, 100'000, 0, random);
  data.b = testing::with_stand(data.b, 20, 5000, 100'000, 1e-4, random);
  expect_same_pairing(data, {}, "with one stream that is frozen");
}

std::string in_words(const Calibration& x) {
  std::string text = x.reason + "; " + x.choice.reason;
  for (const Finding& finding : x.findings)
    text += "; " + finding.code + ": " + finding.message + " " + std::to_string(finding.improvement);
  for (const double one : x.observability.stddev) text += " " + std::to_string(1e9 * one);
  return text;
}

TEST(Beside, CalibrationHasTheSameBits) {
  const testing::Streams plain = drive(1200);
  struct Case {
    const char* what;
    Trajectory a, b;
    CalibrationOptions options;
  };
  std::vector<Case> cases{{"plain", plain.a, plain.b, {}},
                          {"inverted", plain.a, testing::inverted(plain.b), {}},
                          {"late", plain.a, testing::late(plain.b, 0.004), {}},
                          {"scaled", plain.a, testing::lengthened(plain.b, 1.2), {}},
                          {"planar", plain.a, plain.b, {}},
                          {"offset", plain.a, testing::late(plain.b, 0.3), {}}};
  cases[3].options.estimate_scale = true;
  cases[4].options.pairing.mode = Mode::planar;
  cases[5].options.estimate_time_offset = true;
  for (const Case& one : cases) {
    const Calibration alone = calibrate(one.a, one.b, one.options);
    for (const Beside& beside : all_orders()) {
      const Calibration other = calibrate(one.a, one.b, one.options, beside);
      EXPECT_EQ(in_words(other), in_words(alone)) << one.what;
      EXPECT_TRUE(other.T_a_b.translation == alone.T_a_b.translation) << one.what;
      EXPECT_TRUE(other.T_a_b.rotation.coeffs() == alone.T_a_b.rotation.coeffs()) << one.what;
      EXPECT_EQ(other.observability.stddev, alone.observability.stddev) << one.what;
      EXPECT_TRUE(same_bits(other.problem, alone.problem)) << one.what;
    }
  }
}

TEST(Beside, RefusalsAreTheSame) {
  const testing::Streams data = drive(1200);
  const Trajectory later = testing::late(data.b, 1e6);
  std::string alone;
  try {
    calibrate(data.a, later);
  } catch (const Error& error) {
    alone = error.what();
  }
  ASSERT_FALSE(alone.empty());
  for (const Beside& beside : all_orders()) {
    try {
      calibrate(data.a, later, {}, beside);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), alone);
    }
  }
}

}  // namespace
}  // namespace egocal::test_beside
