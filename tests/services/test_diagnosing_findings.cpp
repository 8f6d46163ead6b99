// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The mistakes and moves that egocal-diagnosis names, and their cures.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/remedies.hpp"
#include "diagnosis_service.hpp"
#include "egocal/online/answer.hpp"
#include "support/planar_drive.hpp"

namespace egocal::services::test_diagnosing_findings {
namespace {

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

// The reason said so, and every listener showed a standard deviation of 1e-6 degrees.
TEST_F(DiagnosisService, DirectionsThatBothStreamsAssumeAreNotObservable) {
  const testing::PlanarDrive planar = testing::planar_drive(1, 0.002, 0);
  testing::Streams streams;
  streams.a = planar.a;
  streams.b = planar.b;
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  diagnose_every_ten_seconds();
  start();
  play(streams, 0, 600, 100);
  ASSERT_FALSE(verdicts.empty()) << status.last_error;
  const verdict_t& last = verdicts.back();
  EXPECT_EQ(last.verdict, "incomplete") << last.reason;
  EXPECT_THAT(last.observable, ::testing::ElementsAre(1, 1, 0, 0, 0, 1));
  for (const std::size_t i : {2, 3, 4}) {
    EXPECT_TRUE(std::isinf(last.stddev[i])) << i;
    EXPECT_TRUE(std::isinf(last.stddev_added[i])) << i;
  }
  for (const std::size_t i : {0, 1, 5}) EXPECT_GE(last.stddev[i], last.stddev_added[i]) << i;
  const Answer answer = solve(*bus::to_problem(sent).value, Method::dual);
  EXPECT_TRUE(answer.observability.observable[3]) << "as the statistics have it";
}

// With the cure in force the finding stayed, and from a drift of 1 ms/s on a right answer was contradictory:
// all of the drive was judged by the newest offset.
TEST_F(DiagnosisService, AClockThatPairingFollowsIsNoMistake) {
  testing::Streams streams = drive(900);
  const std::int64_t begin_us = streams.b.front().time_us;
  for (StampedPose& pose : streams.b) pose.time_us -= (pose.time_us - begin_us) / 1000;
  rig.pairs[0].time_offset.reset();
  diagnose_every_ten_seconds();
  start();
  play(streams, 0, 900, 100);
  ASSERT_FALSE(verdicts.empty());
  const verdict_t& last = verdicts.back();
  EXPECT_NEAR(sent.time_offset, 0.09, 0.01);
  EXPECT_EQ(last.verdict, "good") << last.reason;
  for (const finding_t& finding : last.findings) EXPECT_NE(finding.code, "clock_drift") << finding.message;
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
  diagnose_every_ten_seconds();
  start();
  play(streams, 0, 800, 100);
  expect_move();
  EXPECT_TRUE(commands.empty());
}

TEST_F(AfterAMove, TheCalibrationStartsAgainWhereTheRigSaysSo) {
  rig.pairs[0].on_move = bus::OnMove::restart;
  diagnose_every_ten_seconds();
  start();
  play(streams, 0, 800, 100);
  expect_move();
  ASSERT_EQ(commands.size(), 1u) << "once a session";
  EXPECT_EQ(commands[0].verb, "reset");
  EXPECT_EQ(commands[0].sensor_a, "left");
  EXPECT_EQ(commands[0].session, streams.a[0].time_us);
}

// scale = "auto" finds one scale a session (docs/scale.md): it is no cure of one that changes.
TEST_F(DiagnosisService, AScaleThatChangesIsNotCuredByTheRigFile) {
  diagnose_every_ten_seconds();
  start();
  testing::Streams streams = drive(800);
  streams.b = testing::longer_from_the_middle(streams.b, 1.3);
  play(streams, 0, 800, 100);
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
  diagnose_every_ten_seconds();
  start();
  SimulationOptions creeping;
  creeping.terrain = Terrain::free;
  creeping.poses = 1500;
  creeping.relative_noise = 0.01;
  creeping.faults.resize(2);
  creeping.faults[1].mount_changes = {{0, 150, {rotation_exp({0, 0.1, 0}), {0, 0, 0}}}};
  testing::Streams streams = testing::simulated_drive(creeping);
  for (Trajectory* trajectory : {&streams.a, &streams.b})
    for (StampedPose& pose : *trajectory) pose.time_us += 1'600'000'000'000'000;
  play(streams, 0, 1500, 100);
  ASSERT_FALSE(verdicts.empty());
  const std::vector<finding_t>& findings = verdicts.back().findings;
  const auto moved = std::find_if(findings.begin(), findings.end(),
                                  [](const finding_t& finding) { return finding.code == "mount_moved"; });
  ASSERT_NE(moved, findings.end()) << verdicts.back().reason;
  EXPECT_THAT(moved->message, ::testing::HasSubstr("creeps"));
  EXPECT_THAT(moved->remedy, ::testing::HasSubstr("Fasten the mounting"));
  EXPECT_THAT(moved->remedy, ::testing::Not(::testing::HasSubstr("eset")));
}

}  // namespace
}  // namespace egocal::services::test_diagnosing_findings
