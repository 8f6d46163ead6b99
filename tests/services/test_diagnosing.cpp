// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What egocal-diagnosis judges, and when.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis_service.hpp"

namespace egocal::services::test_diagnosing {
namespace {

TEST_F(DiagnosisService, CallsACleanDriveGood) {
  start();
  const testing::Streams streams = drive(400);
  play(streams, 0, 400);
  ASSERT_FALSE(verdicts.empty());
  const verdict_t& last = verdicts.back();
  EXPECT_EQ(last.verdict, "good") << last.reason;
  EXPECT_EQ(last.sender, "egocal-diagnosis");
  EXPECT_EQ(last.session, streams.a.front().time_us);
  EXPECT_EQ(last.utime_begin, streams.a.front().time_us);
  EXPECT_GT(last.fit.poses, 390);
  EXPECT_LT(last.fit.translation_relative_median, 0.1);
  for (const finding_t& finding : last.findings) EXPECT_FALSE(finding.certain) << finding.message;
  EXPECT_EQ(status.state, "running");
}

// On a core that others take a diagnosis takes longer than a process may be silent.
TEST_F(DiagnosisService, AnnouncesThatItWillBeSilentWhileItJudges) {
  const auto diagnose = options.diagnose;
  std::vector<std::chrono::seconds> while_it_judged;
  options.diagnose = [&](const auto&... arguments) {
    observer.run_once({});
    while_it_judged.push_back(bus::announced_silence(status));
    return diagnose(arguments...);
  };
  start();
  play(drive(200), 0, 200);
  ASSERT_FALSE(while_it_judged.empty());
  EXPECT_THAT(while_it_judged, ::testing::Each(60s));
  EXPECT_EQ(bus::announced_silence(status), 0s);
}

// It knows nothing of the bump, whose motions are in the answer.
TEST_F(DiagnosisService, CallsNothingGoodWhoseMotionsItHasHardlySeen) {
  testing::Streams streams = drive(800);
  streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0, 0.01}), {0.01, 0, 0}});
  MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
  const auto drive_to = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      send_poses(streams, i, pairing);
      if (i % 40 == 39) publish(pairing, streams.a[0].time_us, streams.a[i].time_us, problems);
    }
    pass(2s);
  };
  drive_to(0, 480);
  start();
  drive_to(480, 800);
  ASSERT_FALSE(verdicts.empty());
  for (const verdict_t& verdict : verdicts) EXPECT_NE(verdict.verdict, "good") << verdict.reason;
}

// Its poses have no common times with the others then, and those before were forgotten.
TEST_F(DiagnosisService, AClockThatIsSetBackIsNoLackOfMotions) {
  start();
  testing::Streams streams = drive(400);
  play(streams, 0, 400);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
  for (std::size_t i = 0; i < 300; ++i) {
    StampedPose a = streams.a[i], b = streams.b[i];
    a.time_us += 40'000'000;
    b.time_us -= 1'000'000'000;
    observer.publish("ODO_LEFT", bus::to_message(a, ++seq[1]));
    observer.publish("ODO_RIGHT", bus::to_message(b, ++seq[0]));
    pass(10ms);
  }
  ++sent.seq;
  observer.publish(bus::problem_channel("left", "right"), sent);
  pass(3s);
  EXPECT_EQ(verdicts.back().seq, sent.seq);
  EXPECT_EQ(verdicts.back().verdict, "incomplete") << verdicts.back().reason;
  EXPECT_THAT(verdicts.back().reason, ::testing::HasSubstr("Are their clocks the same"));
}

// Pairing rejects all motions after a sensor was lost: no new problem comes, but poses do.
TEST_F(DiagnosisService, JudgesPosesThatMakeNoMotions) {
  start();
  testing::Streams streams = drive(800);
  const testing::Streams other = drive(800, 9);
  play(streams, 0, 400);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
  for (std::size_t i = 400; i < 800; ++i) {
    observer.publish("ODO_LEFT", bus::to_message(streams.a[i], ++seq[1]));
    observer.publish("ODO_RIGHT", bus::to_message(other.b[i], ++seq[0]));
    pass(100ms);
  }
  pass(3s);
  EXPECT_EQ(verdicts.back().verdict, "contradictory") << verdicts.back().reason;
  const std::size_t before = verdicts.size();
  pass(5s);
  EXPECT_LE(verdicts.size(), before + 6) << "repeated once a second, not judged again";
}

// It was called good until the share of the processor allowed another diagnosis: 20 s where one takes a
// second.
TEST_F(DiagnosisService, JudgesAtOnceAnAnswerThatLeftTheOneJudged) {
  options.least_distance = 60;
  start();
  testing::Streams streams = drive(700);
  streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0, 0.3}), {0.5, 0, 0}});
  MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
  std::int64_t problem_when_doubted = 0;
  for (std::size_t i = 0; i < streams.a.size() && problem_when_doubted == 0; ++i) {
    send_poses(streams, i, pairing);
    if (i >= 40) publish(pairing, streams.a[0].time_us, streams.a[i].time_us, problems);
    if (i == 340) {
      ASSERT_FALSE(verdicts.empty());
      EXPECT_THAT(verdicts.back().verdict, ::testing::AnyOf("good", "incomplete"));
    }
    if (i > 350 && verdicts.back().verdict != "good" && verdicts.back().verdict != "incomplete")
      problem_when_doubted = static_cast<std::int64_t>(i);
  }
  EXPECT_GT(problem_when_doubted, 350);
  EXPECT_LT(problem_when_doubted, 500);
}

TEST(JudgedAnswer, IsComparedInTheDirectionsThatWereObservable) {
  JudgedAnswer judged;
  judged.observability.observable = {true, true, false, true, true, true};
  judged.observability.stddev = {0.01, 0.02, std::numeric_limits<double>::infinity(), 0.001, 0.001, 0.001};
  const Pose moved{rotation_exp({0.002, 0, 0}), {0.03, 0.02, 5}};
  EXPECT_NEAR(deviations_from(judged, to_dual_quaternion(moved)), 3, 1e-9);
  judged.observability.observable = {};
  EXPECT_EQ(deviations_from(judged, to_dual_quaternion(moved)), 0);
}

TEST(UnseenMotions, AreNotCalledGoodUntilTheyAreFew) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::good;
  diagnosis.reason = "The motions agree.";
  limit_to_what_was_seen({0.19, 40, 500}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::good);
  limit_to_what_was_seen({0.3, 40, 500}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::incomplete);
  EXPECT_THAT(diagnosis.reason, ::testing::HasSubstr("The first 40 s are not judged"));
  diagnosis.verdict = Verdict::good;
  limit_to_what_was_seen({0, 0, 29}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::incomplete);
  EXPECT_THAT(diagnosis.reason, ::testing::HasSubstr("has 29 poses of each sensor at common times"));
  diagnosis.verdict = Verdict::contradictory;
  limit_to_what_was_seen({0.9, 40, 500}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::contradictory);
}

TEST_F(DiagnosisService, AResetToldToItAloneIsRefused) {
  start();
  pass(1s);
  command_t command{};
  command.to = "egocal-diagnosis";
  command.verb = "reset";
  observer.publish(bus::command_channel, command);
  pass(2s);
  EXPECT_TRUE(std::any_of(status.counters.begin(), status.counters.end(), [](const counter_t& counter) {
    return counter.name == "rejected: " + not_understood && counter.value == 1;
  }));
}

TEST_F(DiagnosisService, TellsTheGoalFromWhatIsMissing) {
  rig.pairs[0].goal = GoalOptions{1e-6, 1e-6, std::nullopt};
  start();
  play(drive(200), 0, 200);
  ASSERT_FALSE(verdicts.empty());
  const verdict_t& last = verdicts.back();
  EXPECT_EQ(last.verdict, "incomplete") << last.reason;
  EXPECT_TRUE(last.has_goal);
  EXPECT_FALSE(last.goal_reached);
  EXPECT_THAT(last.goal_missing, ::testing::HasSubstr("yaw"));
  EXPECT_GT(last.goal_seconds_left, 0);
  EXPECT_FALSE(last.next.empty());
}

TEST_F(DiagnosisService, NeverMixesTwoSessions) {
  start();
  testing::Streams streams = drive(600);
  // after the reset the mount is another one: both parts are good, the whole would not be
  const Pose bump{rotation_exp({0, 0, 20 * std::numbers::pi / 180}), {0.5, 0, 0}};
  streams.b = testing::knocked(streams.b, 0.5, bump);
  play(streams, 0, 300);
  const std::size_t of_first = verdicts.size();
  play(streams, 300, 600);
  ASSERT_GT(of_first, 0u);
  ASSERT_GT(verdicts.size(), of_first);
  const std::int64_t second = streams.a[300].time_us;
  bool begun = false;
  for (const verdict_t& verdict : verdicts) {
    EXPECT_TRUE(verdict.session == streams.a[0].time_us || verdict.session == second);
    begun = begun || verdict.session == second;
    if (begun) {
      EXPECT_EQ(verdict.session, second) << "no verdict of the old session after one of the new";
      EXPECT_GE(verdict.utime_begin, second);
    }
  }
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
}

TEST_F(DiagnosisService, LooksAwayWhileThePairIsPaused) {
  start();
  testing::Streams streams = drive(500);
  // a sensor is taken off and put back while the calibration is paused
  for (std::size_t i = 200; i < 300; ++i)
    streams.b[i].pose = streams.b[i].pose * to_dual_quaternion(Pose{rotation_exp({0, 1, 0}), {1, 0, 0}});
  play(streams, 0, 200);
  tell("pause");
  EXPECT_EQ(status.state, "paused");
  for (std::size_t i = 200; i < 300; ++i) {
    observer.publish("ODO_LEFT", bus::to_message(streams.a[i], ++seq[1]));
    observer.publish("ODO_RIGHT", bus::to_message(streams.b[i], ++seq[0]));
    pass(100ms);
  }
  tell("resume");
  const std::int64_t poses_before = verdicts.back().fit.poses;
  EXPECT_EQ(poses_before, 200);
}

TEST_F(DiagnosisService, WithoutPosesItJudgesByTheProblemAlone) {
  const testing::Streams streams = drive(400);
  play(streams, 0, 395);  // no process listens yet
  start();
  play(streams, 390, 400);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().fit.poses, 0);
}

TEST_F(DiagnosisService, RepeatsTheVerdictForLateListeners) {
  start();
  play(drive(200), 0, 200);
  const std::size_t before = verdicts.size();
  const std::int64_t seq_before = verdicts.back().seq;
  pass(5s);
  EXPECT_GE(verdicts.size(), before + 4);
  EXPECT_EQ(verdicts.back().seq, seq_before);
}

TEST_F(DiagnosisService, OutlivesMessagesOfEveryWrongKind) {
  start();
  const std::vector<std::byte> rubbish(100, std::byte{7});
  observer.publish_bytes("ODO_LEFT", rubbish);
  observer.publish_bytes(bus::problem_channel("left", "right"), rubbish);
  odometry_t odometry = bus::to_message(StampedPose{1'600'000'000'000'000, {}}, 1);
  odometry.pos[0] = std::nan("");
  observer.publish("ODO_LEFT", odometry);
  problem_t problem{};
  observer.publish(bus::problem_channel("left", "right"), problem);
  pass(3s);
  play(drive(200), 0, 200);
  ASSERT_FALSE(verdicts.empty());
  std::int64_t rejected = 0;
  for (const counter_t& counter : status.counters)
    if (counter.name.starts_with("rejected")) rejected += counter.value;
  EXPECT_EQ(rejected, 4);
}

}  // namespace
}  // namespace egocal::services::test_diagnosing
