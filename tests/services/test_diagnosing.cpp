// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal-diagnosis on a virtual network in virtual time, with a pairing that is made of the library's parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "diagnosis/diagnosing.hpp"
#include "diagnosis/remedies.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "support/mistakes.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services {
namespace {

using namespace std::chrono_literals;

testing::Streams drive(int poses, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.seed = seed;
  testing::Streams streams = testing::simulated_drive(options);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  return streams;
}

class DiagnosisService : public ::testing::Test {
 protected:
  DiagnosisService() {
    rig.sensors = {{"left", "ODO_LEFT", bus::OdometryType::odometry, {}},
                   {"right", "ODO_RIGHT", bus::OdometryType::odometry, {}}};
    rig.pairs.resize(1);
    rig.pairs[0].a = "left";
    rig.pairs[0].b = "right";
    observer.subscribe<verdict_t>(bus::verdict_channel("left", "right"),
                                  [this](const verdict_t& message, const bus::Arrival&) {
                                    EXPECT_TRUE(bus::to_verdict(message)) << bus::to_verdict(message).reason;
                                    verdicts.push_back(message);
                                  });
    observer.subscribe<status_t>(bus::status_channel,
                                 [this](const status_t& message, const bus::Arrival&) { status = message; });
  }

  void start() {
    heartbeat = std::make_unique<bus::Heartbeat>(
        loop, bus::Identity{"egocal-diagnosis", bus::Role::diagnosis, "1", 1}, 3s);
    service = std::make_unique<Diagnosing>(loop, *heartbeat, rig);
  }
  void pass(std::chrono::nanoseconds time) { test::run_for(clock, {&observer, &loop}, time); }

  /// One pose of each stream, to the service and to the test's own pairing.
  void send_poses(const testing::Streams& streams, std::size_t i, MotionPairing& pairing) {
    for (const Side side : {Side::a, Side::b}) {
      const StampedPose& pose = (side == Side::a ? streams.a : streams.b)[i];
      observer.publish(side == Side::a ? "ODO_LEFT" : "ODO_RIGHT",
                       bus::to_message(pose, ++seq[side == Side::a]));
      problems += static_cast<std::int64_t>(pairing.push(side, pose).size());
    }
    pass(100ms);
  }

  /// Plays poses [begin, end) in real time, with the problem that pairing makes of them once a second.
  void play(const testing::Streams& streams, std::size_t begin, std::size_t end) {
    MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
    const std::int64_t session = streams.a[begin].time_us;
    for (std::size_t i = begin; i < end; ++i) {
      send_poses(streams, i, pairing);
      if ((i % 40 != 39 && i + 1 != end) || problems == 0) continue;
      publish(pairing, session, streams.a[i].time_us, problems);
    }
    pass(2s);
    problems = 0;
  }

  /// The problem that pairing makes of poses [begin, end).
  void send_problem(const testing::Streams& streams, std::size_t begin, std::size_t end) {
    MotionPairing pairing(bus::drive_options(rig, rig.pairs[0]));
    std::int64_t pairs = 0;
    for (std::size_t i = begin; i < end; ++i)
      for (const Side side : {Side::a, Side::b})
        pairs += static_cast<std::int64_t>(
            pairing.push(side, (side == Side::a ? streams.a : streams.b)[i]).size());
    publish(pairing, streams.a[begin].time_us, streams.a[end - 1].time_us, pairs);
  }
  void publish(const MotionPairing& pairing, std::int64_t session, std::int64_t utime, std::int64_t number) {
    problem_t message = bus::to_message(pairing.problem());
    message.session = session;
    message.utime = utime;
    message.seq = number;
    message.sensor_a = "left";
    message.sensor_b = "right";
    message.stride = pairing.choice().stride;
    message.matched = static_cast<std::int64_t>(pairing.counts().matched);
    observer.publish(bus::problem_channel("left", "right"), message);
    sent = message;
  }

  void tell(const std::string& verb) {
    command_t command{};
    command.to = "*";
    command.verb = verb;
    observer.publish(bus::command_channel, command);
    pass(200ms);
  }

  test::VirtualClock clock;
  test::VirtualNetwork network{clock};
  bus::Loop observer{network.transport(), clock, {.handle_signals = false, .host = "car"}};
  bus::Loop loop{network.transport(), clock, {.handle_signals = false, .host = "car"}};
  bus::Rig rig;
  std::unique_ptr<bus::Heartbeat> heartbeat;
  std::unique_ptr<Diagnosing> service;
  std::vector<verdict_t> verdicts;
  status_t status;
  std::int64_t problems = 0;
  problem_t sent{};  ///< the newest
  std::int64_t seq[2]{};
};

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

TEST_F(DiagnosisService, NamesAMistakeAndItsCure) {
  start();
  testing::Streams streams = drive(400);
  streams.b = testing::lengthened(streams.b, 0.37);
  play(streams, 0, 400);
  ASSERT_FALSE(verdicts.empty());
  const verdict_t& last = verdicts.back();
  EXPECT_EQ(last.verdict, "contradictory") << last.reason;
  ASSERT_GT(last.n_findings, 0);
  EXPECT_EQ(last.findings[0].code, "scale");
  EXPECT_NEAR(last.findings[0].value, 1 / 0.37, 0.05);
  EXPECT_EQ(last.findings[0].remedy.rfind("In the rig file: scale = 2.7", 0), 0u) << last.findings[0].remedy;
}

TEST_F(DiagnosisService, TheScaleOfTheRigCuresAMissingOne) {
  testing::Streams streams = drive(400);
  streams.b = testing::lengthened(streams.b, 0.37);
  rig.sensors[1].scale = 1 / 0.37;
  // the problem as pairing makes it with the same scale
  testing::Streams scaled = streams;
  scaled.b = testing::lengthened(streams.b, 1 / 0.37);
  start();
  for (std::size_t i = 0; i < 400; ++i) {
    observer.publish("ODO_LEFT", bus::to_message(streams.a[i], static_cast<std::int64_t>(i)));
    observer.publish("ODO_RIGHT", bus::to_message(streams.b[i], static_cast<std::int64_t>(i)));
    pass(1ms);
  }
  send_problem(scaled, 0, 400);
  pass(2s);
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().verdict, "good") << verdicts.back().reason;
}

class AfterAMove : public DiagnosisService {
 protected:
  AfterAMove() {
    observer.subscribe<command_t>(
        bus::command_channel,
        [this](const command_t& message, const bus::Arrival&) { commands.push_back(message); });
    const Pose bump{rotation_exp({0, 0, 5 * std::numbers::pi / 180}), {0.05, 0, 0}};
    streams.b = testing::knocked(streams.b, 0.5, bump);
  }
  /// Where the finding is that names it.
  void expect_move() const {
    ASSERT_FALSE(verdicts.empty());
    const std::vector<finding_t>& findings = verdicts.back().findings;
    const auto moved = std::find_if(findings.begin(), findings.end(),
                                    [](const finding_t& finding) { return finding.code == "mount_moved"; });
    ASSERT_NE(moved, findings.end()) << verdicts.back().reason;
    EXPECT_NEAR(static_cast<double>(moved->utime - streams.a[400].time_us), 0, 5e6);
  }

  testing::Streams streams = drive(800);
  std::vector<command_t> commands;
};

TEST_F(AfterAMove, ItIsReported) {
  start();
  play(streams, 0, 800);
  expect_move();
  EXPECT_TRUE(commands.empty());
}

TEST_F(AfterAMove, TheCalibrationStartsAgainWhereTheRigSaysSo) {
  rig.pairs[0].on_move = bus::OnMove::restart;
  start();
  play(streams, 0, 800);
  expect_move();
  ASSERT_EQ(commands.size(), 1u) << "once a session";
  EXPECT_EQ(commands[0].verb, "reset");
  EXPECT_EQ(commands[0].sensor_a, "left");
  EXPECT_EQ(commands[0].session, streams.a[0].time_us);
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

// scale = "auto" finds one scale a session (docs/scale.md): it is no cure of one that changes.
TEST_F(DiagnosisService, AScaleThatChangesIsNotCuredByTheRigFile) {
  start();
  testing::Streams streams = drive(800);
  streams.b = testing::longer_from_the_middle(streams.b, 1.3);
  play(streams, 0, 800);
  ASSERT_FALSE(verdicts.empty());
  const std::vector<finding_t>& findings = verdicts.back().findings;
  const auto changed = std::find_if(findings.begin(), findings.end(),
                                    [](const finding_t& finding) { return finding.code == "scale_change"; });
  ASSERT_NE(changed, findings.end()) << verdicts.back().reason;
  EXPECT_THAT(changed->remedy, ::testing::HasSubstr("reset the pair"));
  EXPECT_THAT(changed->remedy, ::testing::HasSubstr("egocal solve --scale-b auto"));
}

TEST(Remedies, OfAMoveNameAScaleThatIsLookedFor) {
  bus::Rig rig;
  rig.sensors = {{"left", "ODO_LEFT", bus::OdometryType::odometry, {}},
                 {"right", "ODO_RIGHT", bus::OdometryType::odometry, {}}};
  rig.pairs.resize(1);
  rig.pairs[0].a = "left";
  rig.pairs[0].b = "right";
  std::vector<Finding> findings{{"mount_moved", true, "", "", 3, {}, {}, {}}};
  word_remedies(rig, rig.pairs[0], findings);
  EXPECT_THAT(findings[0].remedy, ::testing::Not(::testing::HasSubstr("scale")));
  rig.sensors[1].find_scale = true;
  word_remedies(rig, rig.pairs[0], findings);
  EXPECT_THAT(findings[0].remedy, ::testing::HasSubstr("Or the scale of right changed"));
}

/// A reset does not end a creep: the cure is the one that egocal check names.
TEST_F(DiagnosisService, TheCureOfACreepIsThatOfARecording) {
  start();
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = 1500;
  options.relative_noise = 0.01;
  options.faults.resize(2);
  options.faults[1].mount_changes = {{0, 150, {rotation_exp({0, 0.1, 0}), {0, 0, 0}}}};
  testing::Streams streams = testing::simulated_drive(options);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  play(streams, 0, 1500);
  ASSERT_FALSE(verdicts.empty());
  const std::vector<finding_t>& findings = verdicts.back().findings;
  const auto moved = std::find_if(findings.begin(), findings.end(),
                                  [](const finding_t& finding) { return finding.code == "mount_moved"; });
  ASSERT_NE(moved, findings.end()) << verdicts.back().reason;
  EXPECT_THAT(moved->message, ::testing::HasSubstr("creeps"));
  EXPECT_THAT(moved->remedy, ::testing::HasSubstr("Fasten the mounting"));
  EXPECT_THAT(moved->remedy, ::testing::Not(::testing::HasSubstr("eset")));
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
}  // namespace egocal::services
