// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A diagnosis on the wire and back, and what is refused on the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "egocal/bus/decode.hpp"
#include "egocal/bus/departure.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/diagnosis/as_judged.hpp"

namespace egocal::bus::test_verdict_message {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t begin_us = 1'600'000'000'000'000;

Diagnosis example() {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::contradictory;
  diagnosis.reason = "The lengths of b are 0.37 times those of a.";
  diagnosis.fit.rotation_median = 0.01;
  diagnosis.fit.translation_95 = 0.3;
  diagnosis.fit.length_ratio = 0.37;
  Finding scale{"scale", true, "b has no scale", "--scale auto", 12.5, Pose{}, std::nullopt, 2.7};
  Finding moved{"mount_moved", true, "it moved", "calibrate again", 3, std::nullopt, 138.25, std::nullopt};
  diagnosis.findings = {scale, moved};
  diagnosis.goal = Goal{false, {"z", "yaw"}, 40.0, "Take a ramp."};
  return diagnosis;
}

verdict_t message() {
  verdict_t message = to_message(example(), {DualQuaternion{}, begin_us, begin_us + 5, 800});
  message.utime = message.session = begin_us;
  message.seq = message.pairs = 900;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  message.sender = "egocal-diagnosis";
  return message;
}

TEST(VerdictMessage, ComesBackAsItWasSent) {
  const Checked<ReceivedVerdict> received = to_verdict(message());
  ASSERT_TRUE(received) << received.reason;
  const Diagnosis& diagnosis = received.value->diagnosis;
  const Diagnosis sent = example();
  EXPECT_EQ(diagnosis.verdict, sent.verdict);
  EXPECT_EQ(diagnosis.reason, sent.reason);
  EXPECT_EQ(diagnosis.fit.rotation_median, 0.01);
  EXPECT_EQ(diagnosis.fit.translation_95, 0.3);
  EXPECT_EQ(diagnosis.fit.length_ratio, 0.37);
  EXPECT_EQ(received.value->judged.poses, 800);
  ASSERT_EQ(diagnosis.findings.size(), 2u);
  EXPECT_EQ(diagnosis.findings[0].code, "scale");
  EXPECT_TRUE(diagnosis.findings[0].certain);
  EXPECT_EQ(diagnosis.findings[0].value, 2.7);
  EXPECT_TRUE(diagnosis.findings[0].T_a_b);
  EXPECT_FALSE(diagnosis.findings[0].time);
  EXPECT_EQ(diagnosis.findings[1].time, 138.25);
  EXPECT_FALSE(diagnosis.findings[1].T_a_b);
  ASSERT_TRUE(diagnosis.goal);
  EXPECT_THAT(diagnosis.goal->missing, ElementsAre("z", "yaw"));
  EXPECT_EQ(diagnosis.goal->seconds_left, 40.0);
  EXPECT_EQ(diagnosis.goal->next, "Take a ramp.");
}

/// It only travelled in words, and every listener showed what the statistics alone state.
TEST(VerdictMessage, SaysWhatIsKnownOfEachDirection) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Diagnosis diagnosis = example();
  diagnosis.timing_stddev = {0.3, 0, 0, 0, 0, 0};
  diagnosis.assumed = {false, false, true, true, true, false};
  const Observability stated{
      {true, true, false, true, true, true}, {0.4, 0.1, infinite, 1e-6, 1e-6, 0.01}, "turn"};
  Judged judged{DualQuaternion{}, begin_us, begin_us + 5, 800, as_judged(stated, diagnosis)};
  verdict_t sent = message();
  const verdict_t directions = to_message(diagnosis, judged);
  for (std::size_t i = 0; i < 6; ++i) {
    sent.observable[i] = directions.observable[i];
    sent.stddev[i] = directions.stddev[i];
    sent.stddev_added[i] = directions.stddev_added[i];
  }
  EXPECT_THAT(sent.observable, ElementsAre(1, 1, 0, 0, 0, 1));
  EXPECT_THAT(sent.stddev, ElementsAre(0.5, 0.1, infinite, infinite, infinite, 0.01));
  verdict_t decoded{};
  ASSERT_TRUE(decode(encode(sent), decoded));
  const Checked<ReceivedVerdict> received = to_verdict(decoded);
  ASSERT_TRUE(received) << received.reason;
  EXPECT_EQ(received.value->judged.observability.observable, judged.observability.observable);
  EXPECT_EQ(received.value->judged.observability.stddev, judged.observability.stddev);
  EXPECT_EQ(received.value->diagnosis.timing_stddev, diagnosis.timing_stddev);
  EXPECT_EQ(received.value->diagnosis.assumed, diagnosis.assumed);

  // of a later answer, whose statistics know more
  const Observability later = as_judged({stated.observable, {0.1, 0.1, infinite, 1e-7, 1e-7, 0.01}, "turn"},
                                        received.value->diagnosis);
  EXPECT_DOUBLE_EQ(later.stddev[0], std::hypot(0.1, 0.3));
  EXPECT_FALSE(later.observable[3]);
  EXPECT_EQ(later.stddev[3], infinite);
  EXPECT_EQ(later.stddev[5], 0.01);
  EXPECT_EQ(later.hint, "");
}

/// Fewer than six blocks of motions have no spread; a direction may be observable all the same.
TEST(VerdictMessage, MayStateAnObservableDirectionThatNoSpreadIsKnownOfUnlessItIsGood) {
  verdict_t sent = message();
  sent.observable[2] = 1;
  ASSERT_TRUE(std::isinf(sent.stddev[2]));
  sent.has_goal = 0;
  for (const char* verdict : {"incomplete", "doubtful", "contradictory"}) {
    sent.verdict = verdict;
    const Checked<ReceivedVerdict> received = to_verdict(sent);
    EXPECT_TRUE(received) << verdict << ": " << received.reason;
  }
  sent.verdict = "good";
  EXPECT_EQ(to_verdict(sent).reason, "verdict that contradicts itself");
  sent.stddev[2] = 0.1;
  EXPECT_TRUE(to_verdict(sent)) << to_verdict(sent).reason;
}

TEST(VerdictMessage, ANumberThatIsNoneNeverLeaves) {
  Diagnosis diagnosis = example();
  diagnosis.fit.length_ratio = std::numeric_limits<double>::infinity();
  diagnosis.findings[0].improvement = std::nan("");
  diagnosis.goal->seconds_left = std::numeric_limits<double>::infinity();
  verdict_t sent = message();
  const verdict_t numbers = to_message(diagnosis, {DualQuaternion{}, begin_us, begin_us, 1});
  sent.fit = numbers.fit;
  sent.findings = numbers.findings;
  sent.goal_seconds_left = numbers.goal_seconds_left;
  const Checked<ReceivedVerdict> received = to_verdict(sent);
  ASSERT_TRUE(received) << received.reason;
  EXPECT_FALSE(received.value->diagnosis.goal->seconds_left);
}

struct Damage {
  const char* what;
  void (*make)(verdict_t&);
};

TEST(VerdictMessage, IsRefusedWhereAnyFieldMakesNoSense) {
  const Damage damages[] = {
      {"verdict", [](verdict_t& m) { m.verdict = "excellent"; }},
      {"name", [](verdict_t& m) { m.sensor_a = "li\x1b[31mdar"; }},
      {"sender", [](verdict_t& m) { m.sender = ""; }},
      {"reason", [](verdict_t& m) { m.reason = "two\nlines"; }},
      {"long reason", [](verdict_t& m) { m.reason.assign(2000, 'x'); }},
      {"time", [](verdict_t& m) { m.utime = -1; }},
      {"session", [](verdict_t& m) { m.session = std::numeric_limits<std::int64_t>::max(); }},
      {"seq", [](verdict_t& m) { m.seq = -1; }},
      {"quaternion", [](verdict_t& m) { m.quat[0] = 5; }},
      {"position", [](verdict_t& m) { m.pos[1] = std::nan(""); }},
      {"standard deviation", [](verdict_t& m) { m.stddev[3] = -1; }},
      {"what is added to one", [](verdict_t& m) { m.stddev_added[0] = std::nan(""); }},
      {"observable although it is assumed",
       [](verdict_t& m) {
         m.observable[2] = 1;
         m.stddev_added[2] = std::numeric_limits<double>::infinity();
       }},
      {"known although it is not observable", [](verdict_t& m) { m.stddev[2] = 0.1; }},
      {"known better than what is added",
       [](verdict_t& m) {
         m.observable[2] = 1;
         m.stddev[2] = 0.1;
         m.stddev_added[2] = 0.2;
       }},
      {"good although nothing says how well it is known",
       [](verdict_t& m) {
         m.verdict = "good";
         m.has_goal = 0;
         m.observable[2] = 1;
       }},
      {"fit", [](verdict_t& m) { m.fit.rotation_95 = -1; }},
      {"fit is not finite",
       [](verdict_t& m) { m.fit.length_ratio = std::numeric_limits<double>::infinity(); }},
      {"code", [](verdict_t& m) { m.findings[0].code = "a b"; }},
      {"remedy", [](verdict_t& m) { m.findings[1].remedy = "\x07"; }},
      {"improvement", [](verdict_t& m) { m.findings[0].improvement = std::nan(""); }},
      {"answer of a finding", [](verdict_t& m) { m.findings[0].quat[0] = 0; }},
      {"time of a finding", [](verdict_t& m) { m.findings[1].utime = -7; }},
      {"findings without end", [](verdict_t& m) { m.findings.resize(100, m.findings[0]); }},
      {"direction", [](verdict_t& m) { m.goal_missing = "z up"; }},
      {"direction twice", [](verdict_t& m) { m.goal_missing = "z z"; }},
      {"goal reached with something missing", [](verdict_t& m) { m.goal_reached = 1; }},
      {"good although the goal is missed", [](verdict_t& m) { m.verdict = "good"; }},
      {"seconds left", [](verdict_t& m) { m.goal_seconds_left = std::nan(""); }},
  };
  for (const Damage& damage : damages) {
    verdict_t damaged = message();
    damage.make(damaged);
    const Checked<ReceivedVerdict> received = to_verdict(damaged);
    EXPECT_FALSE(received) << damage.what;
    EXPECT_FALSE(received.reason.empty()) << damage.what;
  }
}

TEST(VerdictMessage, IsAboutAnAnswerNearby) {
  const Pose at{rotation_exp({0.3, -0.2, 0.9}), {1, 2, 3}};
  const Judged judged{to_dual_quaternion(at), 0, 0, 0};
  const auto moved = [&](double rotation, double translation, Verdict verdict = Verdict::good) {
    return departure(
        verdict, judged,
        {at.rotation * rotation_exp({0, rotation, 0}), at.translation + Eigen::Vector3d(0, 0, translation)});
  };
  EXPECT_FALSE(moved(0, 0));
  EXPECT_FALSE(moved(0.0174, 0.59));
  ASSERT_TRUE(moved(0.0176, 0));
  EXPECT_NEAR(moved(0.0176, 0.02)->rotation, 0.0176, 1e-9);
  ASSERT_TRUE(moved(0, -0.61));
  EXPECT_NEAR(moved(0, -0.61)->translation, 0.61, 1e-9);
  EXPECT_TRUE(moved(0, std::nan("")));
  for (const Verdict verdict : {Verdict::incomplete, Verdict::doubtful, Verdict::contradictory})
    EXPECT_FALSE(moved(1, 10, verdict));
  EXPECT_EQ(in_words(*moved(0.0349, 1.2)), "the answer has moved by 2.00 deg and 120 cm since it was judged");
  EXPECT_TRUE(departure(Verdict::good, judged, {at.rotation, at.translation + Eigen::Vector3d(0.1, 0, 0)},
                        {.rotation = 0.01, .translation = 0.05}));
}

}  // namespace
}  // namespace egocal::bus::test_verdict_message
