// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages in, plain data out: the answer that counts, and its lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/model.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_answer {
namespace {

using test::PairDrive;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST(ModelAnswer, TheOneThatCountsIsTheLibrarysChoice) {
  PairDrive drive;
  drive.global = true;
  drive.change_answer = [](calibration_t& answer) {
    if (answer.solver == "egocal-fast") answer.status = 1;
  };
  drive.run(3);
  EXPECT_EQ(drive.pair().counted_solver()->name, "egocal-global") << "certified before uncertified";
  drive.global = false;
  drive.run(1);
  EXPECT_EQ(drive.pair().counted_solver()->name, "egocal-fast") << "the newest problem first";
}

TEST(ModelAnswer, FollowsACalibrationThatContinuesFromAnOlderState) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  const std::int64_t newest = drive.pair().answer()->seq;
  const auto older = [](problem_t& message) {
    message.seq -= 20;
    message.utime -= 2'000'000;
  };
  drive.change_problem = older;
  drive.run(2);  // two problems may be late
  EXPECT_EQ(drive.pair().answer()->seq, newest);
  drive.run(3);
  ASSERT_NE(drive.pair().answer(), nullptr);
  EXPECT_EQ(drive.pair().answer()->seq, drive.pair().problem.seq);
  EXPECT_LT(drive.pair().answer()->seq, newest);
  EXPECT_THAT(drive.fresh(), ::testing::Contains(::testing::HasSubstr("continues from an older state")));
}

TEST(ModelAnswer, WhatIsNoTransformIsNeverCertified) {
  const std::function<void(calibration_t&)> lies[] = {[](calibration_t& c) { c.pos[1] = not_a_number; },
                                                      [](calibration_t& c) { c.quat[0] = infinity; },
                                                      [](calibration_t& c) { c.scaled_gap = not_a_number; },
                                                      [](calibration_t& c) {
                                                        for (double& q : c.quat) q = 0;
                                                      }};
  for (const auto& lie : lies) {
    PairDrive drive;
    drive.change_answer = [&](calibration_t& answer) {
      answer.status = 0;
      lie(answer);
    };
    drive.run(40);
    EXPECT_NE(drive.pair().answer()->status, 0);
    EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("proven"))));
    EXPECT_THAT(json_line(drive.model), Not(HasSubstr("\"certified\":true")));
    EXPECT_FALSE(drive.pair().only_fast_since);
    // beside an honest one it does not count
    drive.global = true;
    drive.change_answer = [&](calibration_t& answer) {
      if (answer.solver == "egocal-fast") lie(answer);
    };
    drive.run(1);
    EXPECT_EQ(drive.pair().counted_solver()->name, "egocal-global");
  }
}

TEST(ModelAnswer, ErrorsAgainstTruthOrNominalOrSpreads) {
  PairDrive drive;
  drive.run(20);
  EXPECT_EQ(drive.pair().shown.reference, ReferenceKind::truth);
  EXPECT_GT(drive.pair().shown.error_translation, 0);
  drive.change_problem = [](problem_t& p) { p.has_truth = 0; };
  drive.run(1);
  EXPECT_EQ(drive.pair().shown.reference, ReferenceKind::nominal);
  drive.change_problem = [](problem_t& p) { p.has_truth = p.has_prior = 0; };
  drive.run(1);
  EXPECT_EQ(drive.pair().shown.reference, ReferenceKind::none);
  EXPECT_TRUE(std::isnan(drive.pair().shown.error_translation));
  drive.change_problem = [](problem_t& p) { p.truth_quat[2] = not_a_number; };
  drive.run(1);
  EXPECT_EQ(drive.pair().shown.reference, ReferenceKind::nominal) << "a broken truth is none";
}

TEST(Lines, SayWhatTheScreenSays) {
  PairDrive drive;
  drive.change_problem = [](problem_t& p) {
    p.rejected = 17;
    p.left_out = 3;
    p.time_offset = 0.012;
    p.time_offset_stddev = -1;
  };
  drive.run(40);
  const std::string line = pair_lines(drive.model, Charset::ascii);
  for (const char* part :
       {"lidar -> camera: not judged yet; optimal (proven) by egocal-fast (sqp), 40 motions, 3 outliers, 17 "
        "rejected, x y z ",
        "+-", " cm, roll pitch yaw ", ", error ", ", gap ", " of 1, solve 5.2 us verify 1.9 us"})
    EXPECT_THAT(line, HasSubstr(part));
  const std::string json = json_line(drive.model);
  for (const char* part :
       {"\"rejected\":17", "\"left_out\":3", "\"time_offset\":0.012", "\"time_offset_stddev\":null",
        "\"paused\":false", "\"only_fast_since\":0.7", "\"reference\":\"truth\"", "\"method\":\"sqp\"",
        "\"observable\":[true,true,true,true,true,true]"})
    EXPECT_THAT(json, HasSubstr(part));
}

TEST(Lines, AnswersOfAPairingThatIsSilentAreShown) {
  PairDrive drive;
  drive.run(40);
  EXPECT_THAT(pair_lines(drive.model, Charset::ascii), Not(HasSubstr("silent")));
  const calibration_t answer = *drive.pair().answer();
  Now now = drive.now();
  now.mono_us += 3'000'000;
  drive.model.tick(now);
  EXPECT_THAT(pair_lines(drive.model, Charset::ascii), HasSubstr("pairing is silent"));
  // a monitor that was started since then has the answers alone
  Model late;
  late.expect_pair("lidar", "camera");
  late.on_calibration(answer, now, false);
  const std::string line = pair_lines(late, Charset::ascii);
  EXPECT_THAT(line, HasSubstr("x y z "));
  EXPECT_THAT(line, HasSubstr("pairing is silent: not verified"));
  EXPECT_THAT(json_line(late), HasSubstr("\"pairing_silent\":true"));
  late.on_problem(drive.pair().problem, now);
  EXPECT_THAT(pair_lines(late, Charset::ascii), Not(HasSubstr("silent")));
}

}  // namespace egocal::monitor::test_answer
