// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::bus::test_messages {
namespace {

Problem example_problem() {
  Problem problem;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int block = 0; block < 3; ++block) {
    Statistics statistics;
    for (int i = 0; i < 10; ++i) {
      const auto any = [&] {
        return to_dual_quaternion(Pose{rotation_exp({normal(random), normal(random), normal(random)}),
                                       {normal(random), normal(random), normal(random)}});
      };
      statistics.add(any(), any());
    }
    problem.blocks.push_back(statistics);
  }
  problem.prior = to_dual_quaternion(Pose{rotation_exp({0.1, 0.2, 0.3}), {1, 2, 3}});
  return problem;
}

problem_t example_message() {
  problem_t message = to_message(example_problem());
  message.utime = 1'600'000'000'000'000;
  message.session = 5;
  message.sensor_a = "left";
  message.sensor_b = "right";
  return message;
}

template <class Message>
Message example();
template <>
odometry_t example() {
  odometry_t message = to_message(StampedPose{1000, {}}, 3);
  message.covariance_size = 36;
  message.covariance.assign(36, 0.5);
  return message;
}
template <>
bot_core::pose_t example() {
  return to_pose_message(StampedPose{1000, {}});
}
template <>
motion_pair_t example() {
  return to_message(MotionPair{});
}
template <>
problem_t example() {
  return example_message();
}
template <>
calibration_t example() {
  calibration_t message = to_message(solve(example_problem(), Method::dual), example_message());
  message.solver = "egocal-global";
  return message;
}
template <>
status_t example() {
  status_t message{};
  message.name = "egocal-fast";
  message.n_counters = 2;
  message.counters.resize(2);
  message.counters[1].name = "in";
  message.n_acknowledgements = 1;
  message.acknowledgements.resize(1);
  message.acknowledgements[0].channel = "ODO";
  return message;
}
template <>
command_t example() {
  command_t message{};
  message.to = "*";
  return message;
}

template <>
verdict_t example() {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::contradictory;
  diagnosis.reason = "lengths of b times 2.7 fit";
  diagnosis.findings.resize(2);
  diagnosis.findings[0].code = "scale";
  diagnosis.findings[1].code = "inverted_both";
  diagnosis.goal.emplace().missing = {"z", "yaw"};
  verdict_t message = to_message(diagnosis, Judged{});
  message.sensor_a = "left";
  message.sensor_b = "right";
  message.sender = "egocal-diagnosis";
  return message;
}

ScaleProblem scale_problem() {
  ScaleProblem problem;
  problem.options.side = Side::b;
  ScaleStatistics block;
  for (int i = 0; i < 20; ++i) {
    const double x = 0.1 * i;
    block.add(to_dual_quaternion(Pose{rotation_exp({0.1, 0.2 * x, 0.3 - x}), {x, 1 - x, x * x}}),
              to_dual_quaternion(Pose{rotation_exp({0.3 - x, 0.1, 0.2 * x}), {x * x, x, 1 - x}}));
  }
  problem.blocks = {block, block};
  return problem;
}

template <>
scale_problem_t example() {
  scale_problem_t message = to_message(scale_problem());
  message.sensor_a = "left";
  message.sensor_b = "right";
  return message;
}
template <>
scale_t example() {
  scale_t message = to_message(ScaleSolution{}, example<scale_problem_t>());
  message.solver = "egocal-global";
  return message;
}

template <class Message>
class EveryMessage : public ::testing::Test {};
using Messages = ::testing::Types<odometry_t, bot_core::pose_t, motion_pair_t, problem_t, calibration_t,
                                  status_t, command_t, verdict_t, scale_problem_t, scale_t>;
TYPED_TEST_SUITE(EveryMessage, Messages);

TYPED_TEST(EveryMessage, RoundTrips) {
  const auto bytes = encode(example<TypeParam>());
  TypeParam message{};
  ASSERT_TRUE(decode(bytes, message));
  EXPECT_EQ(encode(message), bytes);
}

TYPED_TEST(EveryMessage, HasAName) {
  const std::string package = std::is_same_v<TypeParam, bot_core::pose_t> ? "bot_core." : "egocal.";
  EXPECT_EQ(type_name(encode(example<TypeParam>())), package + TypeParam::getTypeName());
}

TYPED_TEST(EveryMessage, MustFillTheBytes) {
  auto bytes = encode(example<TypeParam>());
  TypeParam message{};
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_FALSE(decode(Bytes(bytes).first(size), message)) << size;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode(bytes, message));
}

TYPED_TEST(EveryMessage, WithAnotherFingerprintIsRefused) {
  auto bytes = encode(example<TypeParam>());
  bytes[3] ^= std::byte{1};
  TypeParam message{};
  EXPECT_FALSE(decode(bytes, message));
}

/// What a decoded message holds beyond itself [bytes], by its encoded size.
template <class Message>
std::size_t memory_of(const Message& message) {
  return static_cast<std::size_t>(message.getEncodedSize());
}

TYPED_TEST(EveryMessage, DamagedAnywhereIsNeverLargerThanItsBytes) {
  const auto bytes = encode(example<TypeParam>());
  int decoded = 0;
  for (std::size_t at = 8; at < bytes.size(); ++at)
    for (const std::byte value : {std::byte{0}, std::byte{0x7f}, std::byte{0x80}, std::byte{0xff}}) {
      auto damaged = bytes;
      damaged[at] = value;
      TypeParam message{};
      if (!decode(damaged, message)) continue;
      ++decoded;
      EXPECT_EQ(memory_of(message), bytes.size()) << "byte " << at;
    }
  EXPECT_GT(decoded, 0);
}

TEST(Pose, RoundTrips) {
  const StampedPose pose{123, to_dual_quaternion(Pose{rotation_exp({1, -2, 0.5}), {10, -20, 30}})};
  for (const Checked<StampedPose>& back :
       {to_stamped_pose(to_message(pose, 4)), to_stamped_pose(to_pose_message(pose))}) {
    ASSERT_TRUE(back) << back.reason;
    EXPECT_EQ(back.value->time_us, 123);
    const ExtrinsicError error = extrinsic_error(pose.pose, back.value->pose);
    EXPECT_LT(error.translation, 1e-13);
    EXPECT_LT(error.rotation, 1e-15);
  }
}

TEST(Pose, OutOfRangeIsRefusedWithAReason) {
  const auto reason = [](auto change) {
    odometry_t message = to_message(StampedPose{1000, {}}, 0);
    change(message);
    return to_stamped_pose(message).reason;
  };
  EXPECT_EQ(reason([](odometry_t&) {}), "");
  EXPECT_EQ(reason([](odometry_t& m) { m.pos[2] = std::nan(""); }), "position not finite");
  EXPECT_EQ(reason([](odometry_t& m) { m.pos[2] = 1e12; }), "position out of range");
  EXPECT_EQ(reason([](odometry_t& m) { m.quat[1] = INFINITY; }), "quaternion not finite");
  EXPECT_EQ(reason([](odometry_t& m) { m.quat[0] = 0; }), "quaternion not of unit length");
  EXPECT_EQ(reason([](odometry_t& m) { m.utime = -1; }), "time out of range");
  EXPECT_EQ(reason([](odometry_t& m) { m.utime = std::numeric_limits<std::int64_t>::max(); }),
            "time out of range");
  EXPECT_EQ(reason([](odometry_t& m) { m.seq = -2; }), "sequence number out of range");
}

TEST(Problem, RoundTripsToTheBit) {
  const Problem problem = example_problem();
  const Checked<Problem> back = to_problem(example_message());
  ASSERT_TRUE(back) << back.reason;
  ASSERT_EQ(back.value->blocks.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(back.value->blocks[i].dual_rows == problem.blocks[i].dual_rows);
    EXPECT_EQ(back.value->blocks[i].count, problem.blocks[i].count);
    EXPECT_EQ(back.value->blocks[i].weight, problem.blocks[i].weight);
  }
  EXPECT_LT(extrinsic_error(*problem.prior, *back.value->prior).translation, 1e-14);
}

/// Blocks may touch each other: then the last one takes off what is in two of them, and nothing else may.
TEST(Problem, OnlyTheLastBlockTakesOffWhatOthersShare) {
  const auto with_taken_off = [](std::size_t at, double part) {
    Problem problem = example_problem();
    Statistics& block = problem.blocks.at(at);
    block = problem.blocks.front();
    block.dual_rows *= -part;
    block.weight *= -part;
    problem_t message = to_message(problem);
    message.sensor_a = "a";
    message.sensor_b = "b";
    return to_problem(message);
  };
  EXPECT_TRUE(with_taken_off(2, 0.5));
  EXPECT_FALSE(with_taken_off(1, 0.5));
  EXPECT_FALSE(with_taken_off(2, 1e6));
  EXPECT_EQ(with_taken_off(2, 0.5).value->blocks.back().weight, -0.5 * example_problem().blocks[0].weight);
}

TEST(Problem, OutOfRangeIsRefused) {
  const auto refused = [](auto change) {
    problem_t message = example_message();
    change(message);
    return !to_problem(message);
  };
  EXPECT_FALSE(refused([](problem_t&) {}));
  EXPECT_FALSE(refused([](problem_t& m) { m.time_offset = -1.7e9; })) << "since the start of a machine";
  EXPECT_TRUE(refused([](problem_t& m) { m.time_offset = -4.2e9; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.blocks[1].q[0] = std::nan(""); }));
  EXPECT_TRUE(refused([](problem_t& m) { m.blocks[1].q[0] = -1; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.blocks[1].q[1] = 1e9; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.blocks[1].weight = 0; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.blocks[1].count = -1; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.mode = 2; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.mode = 1, m.plane_b[2] = 0; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.weight_rotation = -1; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.sensor_a = "\x1b[2J"; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.prior_quat[0] = INFINITY; }));
  EXPECT_TRUE(refused([](problem_t& m) { m.seq = -1; }));
}

TEST(Answer, RoundTrips) {
  const Answer answer = solve(example_problem(), Method::dual);
  const Checked<Answer> back = to_answer(example<calibration_t>());
  ASSERT_TRUE(back) << back.reason;
  EXPECT_EQ(back.value->certificate.optimality, answer.certificate.optimality);
  EXPECT_EQ(back.value->certificate.cost, answer.certificate.cost);
  EXPECT_EQ(back.value->observability.stddev, answer.observability.stddev);
  EXPECT_LT(extrinsic_error(answer.T_a_b, back.value->T_a_b).translation, 1e-14);
  calibration_t message = example<calibration_t>();
  message.stddev[2] = -1;
  EXPECT_FALSE(to_answer(message));
  message = example<calibration_t>();
  message.gap = std::nan("");
  EXPECT_FALSE(to_answer(message));
}

TEST(Text, IsMadePrintable) {
  EXPECT_EQ(printable("a\x1b[2Jb\n"), "a [2Jb ");
  EXPECT_EQ(printable(std::string(500, 'x')).size(), 200u);
  EXPECT_EQ(printable("M\xc3\xbcnchen \xe2\x82\xac"), "M\xc3\xbcnchen \xe2\x82\xac");
  // no JSON and no terminal takes what is not UTF-8
  EXPECT_EQ(printable("a\xff\xc3(\xe2\x82"), std::string("a?") + "?(?" + "?");
  EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80"), std::string(9, '?'));
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            " 2J");
  EXPECT_EQ(printable("abc\xc3\xbc", 4), "abc") << "cut inside a character";
  // breaks of the line, the other direction, nothing to be seen
  EXPECT_EQ(printable("a\u2028b\u202ec\u2066d\u200be\ufefff\u061cg"), "a b c d e f g");
  EXPECT_EQ(printable("\u200c\u200d\u2010\u2027\u202f\u2070"), "\u200c\u200d\u2010\u2027\u202f\u2070");
}

}  // namespace
}  // namespace egocal::bus::test_messages
