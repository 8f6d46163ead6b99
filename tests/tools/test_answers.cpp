// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which answer is exported: verified by the listener, of the right session and pair.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "pair_messages.hpp"
#include "support/paths.hpp"
#include "support/scale_problem.hpp"

namespace egocal::tools::test_answers {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(AnswersTest, TheCertifiedOneCountsInWhateverOrderTheyAreHeard) {
  const problem_t to = problem(10);
  const calibration_t good = answer(to), poor = poor_answer(to, 3);
  for (const bool poor_first : {true, false})
    for (const bool problem_first : {true, false}) {
      Answers answers;
      if (problem_first) answers.hear(to);
      answers.hear(poor_first ? poor : good);
      if (!problem_first) answers.hear(to);
      answers.hear(poor_first ? good : poor);
      const Answers::Best* best = answers.best(pair_name);
      ASSERT_NE(best, nullptr);
      EXPECT_TRUE(best->certified());
      EXPECT_EQ(best->message.solver, "egocal-global");
    }
}

TEST_F(AnswersTest, OneHeardBeforeItsProblemIsVerifiedWhenThatComes) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(answer(to));
  ASSERT_NE(answers.best(pair_name), nullptr);
  EXPECT_FALSE(answers.best(pair_name)->certified()) << "the sender's word is no proof";
  answers.hear(to);
  EXPECT_TRUE(answers.best(pair_name)->certified());
}

/// A second pairing process took over for a while, or the disk had no room for the newest session.
TEST_F(AnswersTest, FollowProblemsWhoseNumbersGoBackForGood) {
  Answers answers;
  const auto come = [&](std::int64_t seq, std::int64_t session) {
    const problem_t to = problem(seq, session);
    answers.hear(to);
    answers.hear(answer(to));
    return answers.best(pair_name)->message.session;
  };
  EXPECT_EQ(come(50, begin_us + 1'000'000), begin_us + 1'000'000);
  EXPECT_EQ(come(10, begin_us), begin_us + 1'000'000) << "one that is late";
  EXPECT_EQ(come(51, begin_us + 1'000'000), begin_us + 1'000'000);
  for (std::int64_t seq = 11; seq <= 13; ++seq) come(seq, begin_us);
  EXPECT_EQ(answers.best(pair_name)->message.session, begin_us);
  EXPECT_EQ(answers.best(pair_name)->message.seq, 13);
}

TEST_F(AnswersTest, ForgedOnesCountForNothing) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(to);
  answers.hear(answer(to));
  calibration_t forged = answer(to);
  forged.solver = "forger";
  forged.pos[0] = forged.pos[1] = forged.pos[2] = 9;
  forged.cost = forged.lower_bound = forged.gap = forged.scaled_gap = 0;
  answers.hear(forged);  // a lower cost for the same problem
  for (const std::int64_t session : {begin_us, begin_us + 1'000'000'000}) {
    forged.session = session;
    forged.seq = 1'000'000;
    answers.hear(forged);  // of a problem to come
  }
  const Answers::Best* best = answers.best(pair_name);
  ASSERT_NE(best, nullptr);
  EXPECT_TRUE(best->certified());
  EXPECT_EQ(best->message.solver, "egocal-global");
  EXPECT_EQ(answers.refused().size(), 1u);
}

/// The scale of the right sensor, to be found from a short drive.
scale_problem_t scale_problem(std::int64_t session) {
  scale_problem_t message = bus::to_message(testing::scale_problem_of_b(0.37));
  message.utime = message.session = session;
  message.seq = 1;
  message.sensor_a = pair_name.first;
  message.sensor_b = pair_name.second;
  message.scale = 0.37;
  return message;
}

scale_t scale_answer(const scale_problem_t& to) {
  const ScaleProblem problem = *bus::to_scale_problem(to).value;
  scale_t message = bus::to_message(solve_scale(problem.blocks, problem.options), to);
  message.solver = "egocal-global";
  return message;
}

TEST_F(AnswersTest, WithoutItsScaleNoneIsCertified) {
  const problem_t to = problem(1);
  const scale_problem_t scale_to = scale_problem(begin_us), later = scale_problem(begin_us + 1'000'000);
  bus::Rig rig;
  rig.sensors = {{"left", "L"}, {"right", "R"}};
  rig.pairs.emplace_back().a = "left";
  rig.pairs[0].b = "right";
  for (const bool by_rig : {true, false}) {
    Answers answers;
    rig.sensors[1].find_scale = by_rig;
    answers.expect_scales(rig);
    answers.hear(to);
    answers.hear(answer(to));
    ASSERT_TRUE(answers.best(pair_name)->certified());
    EXPECT_EQ(answers.certified(pair_name), !by_rig);
    answers.hear(later);
    answers.hear(scale_answer(later));
    EXPECT_FALSE(answers.certified(pair_name)) << "the scale of another session";
    EXPECT_TRUE(answers.lacks_scale(pair_name));
    answers.hear(scale_answer(scale_to));
    EXPECT_FALSE(answers.certified(pair_name)) << "the sender's word is no proof";
    answers.hear(scale_to);
    EXPECT_TRUE(answers.certified(pair_name));
    EXPECT_FALSE(answers.lacks_scale(pair_name));
  }
}

TEST_F(AnswersTest, TheExportWarnsOfAScaleThatItDoesNotKnow) {
  const std::string log = folder / "session.log", out = folder / "out.yaml", said = folder / "said.txt";
  const auto exported = [&](bool with_scale) {
    {
      bus::LogWriter writer(log);
      const auto write = [&](const std::string& channel, const auto& message) {
        writer.write(message.utime, channel, bus::encode(message));
      };
      const problem_t to = problem(1);
      const scale_problem_t scale_to = scale_problem(begin_us);
      write(bus::scale_problem_channel("left", "right"), scale_to);
      if (with_scale) write(bus::scale_channel("left", "right"), scale_answer(scale_to));
      write(bus::problem_channel("left", "right"), to);
      write(bus::calibration_channel("left", "right"), answer(to));
      writer.close();
    }
    const std::string command =
        paths::bin_dir() + "/egocal export --log " + log + " --out " + out + " 2>" + said;
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
    const auto content = [](const std::string& file) {
      std::ifstream stream(file);
      return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    return content(out) + content(said);
  };
  EXPECT_THAT(exported(true), AllOf(HasSubstr("certified: true"), Not(HasSubstr("warning"))));
  EXPECT_THAT(exported(false), AllOf(HasSubstr("certified: false"), HasSubstr("the scale of this answer")));
}

TEST_F(AnswersTest, OfALogIsTheSessionThatRanAtItsEnd) {
  const std::string log = folder / "session.log";
  {
    bus::LogWriter writer(log);
    const auto write = [&](const problem_t& to) {
      writer.write(to.utime, bus::problem_channel("left", "right"), bus::encode(to));
      writer.write(to.utime, bus::calibration_channel("left", "right"), bus::encode(answer(to)));
    };
    for (int i = 1; i <= 5; ++i) write(problem(i, begin_us, static_cast<std::uint64_t>(100 + i)));
    // a second pairing process sent for a moment, under a higher session
    for (int i = 1; i <= 3; ++i) write(problem(i, begin_us + 12'000'000, static_cast<std::uint64_t>(20 + i)));
    for (int i = 6; i <= 9; ++i) write(problem(i, begin_us, static_cast<std::uint64_t>(100 + i)));
    writer.close();
  }
  const Answers answers = recorded_answers(log);
  const Answers::Best* best = answers.best(pair_name);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->message.session, begin_us);
  EXPECT_EQ(best->message.seq, 9);
  EXPECT_EQ(best->message.pairs, 109);
  EXPECT_TRUE(best->certified());
}

TEST_F(AnswersTest, WhatIsKnownOfADirectionIsTheVerdictsToSay) {
  const problem_t to = problem(10);
  Answers answers;
  answers.hear(to);
  answers.hear(answer(to));
  const Observability stated = answers.observability(pair_name);
  ASSERT_TRUE(stated.observable[3]);
  EXPECT_EQ(stated.stddev, answers.best(pair_name)->checked.answer.observability.stddev);
  verdict_t judged = verdict(Verdict::incomplete, begin_us, 9);
  judged.stddev_added[0] = 0.2;
  judged.stddev_added[3] = std::numeric_limits<double>::infinity();
  answers.hear(judged);
  const Observability shown = answers.observability(pair_name);
  EXPECT_DOUBLE_EQ(shown.stddev[0], std::hypot(stated.stddev[0], 0.2));
  EXPECT_FALSE(shown.observable[3]);
  EXPECT_TRUE(std::isinf(shown.stddev[3]));
  EXPECT_EQ(shown.stddev[5], stated.stddev[5]);

  const problem_t next = problem(1, begin_us + 1'000'000);
  answers.hear(next);
  answers.hear(answer(next));
  EXPECT_TRUE(answers.observability(pair_name).observable[3]) << "of another session";
}

// A mount may have moved since then.
TEST_F(AnswersTest, AVerdictOfAnEarlierPartOfTheDriveIsKnownToBeThat) {
  Answers answers;
  const auto drive_to = [&](std::int64_t seq) {
    const problem_t to = problem(seq);
    answers.hear(to);
    answers.hear(answer(to));
  };
  drive_to(10);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_FALSE(answers.seconds_not_judged(pair_name).has_value());
  answers.hear(verdict(Verdict::doubtful, begin_us, 10));
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
  EXPECT_EQ(answers.seconds_not_judged(pair_name), 0);
  drive_to(30);
  EXPECT_NE(answers.diagnosis(pair_name), nullptr);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_judged(pair_name).value_or(-1), 2, 1e-9);
  answers.hear(verdict(Verdict::contradictory, begin_us, 30));
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
}

// A busy diagnosis has the newest problem before the poses that it was made of: such a verdict was the last
// word of `egocal up` on a drive whose mount had moved.
TEST_F(AnswersTest, AVerdictByOldPosesIsNotOneOfTheEnd) {
  Answers answers;
  const problem_t newest = problem(100);
  answers.hear(newest);
  answers.hear(answer(newest));
  const DualQuaternion T_a_b = solve(*bus::to_problem(newest).value, Method::dual).T_a_b;
  verdict_t late = verdict(Verdict::incomplete, begin_us, 100, T_a_b);
  late.fit.poses = 60;
  late.utime_end = newest.utime - 4'000'000;
  answers.hear(late);
  EXPECT_FALSE(answers.judged_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_judged(pair_name).value_or(-1), 4, 1e-9);
  late.utime_end = newest.utime - 1'000'000;
  answers.hear(late);
  EXPECT_TRUE(answers.judged_to_the_end(pair_name));
}

// The solvers hang, or were started with another rig.
TEST_F(AnswersTest, OneOfAnEarlierPartOfTheDriveIsKnownToBeThat) {
  Answers answers;
  EXPECT_TRUE(answers.answered_to_the_end(pair_name)) << "there is nothing to answer";
  const problem_t first = problem(10);
  answers.hear(first);
  EXPECT_FALSE(answers.answered_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 1, 1e-9);
  answers.hear(answer(first));
  EXPECT_TRUE(answers.answered_to_the_end(pair_name));
  EXPECT_EQ(answers.seconds_not_answered(pair_name), 0);
  answers.hear(problem(40));
  EXPECT_FALSE(answers.answered_to_the_end(pair_name));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 3, 1e-9);
  answers.hear(problem(20, begin_us + 60'000'000));
  EXPECT_NEAR(answers.seconds_not_answered(pair_name), 2, 1e-9) << "all of the new session";
}

// egocal solve prints the cure of what is possible as well.
TEST(VerdictLine, NamesWhatIsPossibleWithItsCure) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::doubtful;
  diagnosis.reason = "The mounting changed.";
  diagnosis.findings.push_back({"mount_moved", false, diagnosis.reason, "Reset the pair.", 2, {}, {}, {}});
  diagnosis.findings.push_back(
      {"inverted_both", false, "Both may be inverted.", "Look at them.", 1, {}, {}, {}});
  EXPECT_EQ(verdict_line(diagnosis), "doubtful: The mounting changed. Cure: Reset the pair.");
  EXPECT_THAT(possible_lines(diagnosis), ::testing::ElementsAre("Both may be inverted. Cure: Look at them."));
  diagnosis.verdict = Verdict::good;
  EXPECT_EQ(verdict_line(diagnosis), "good: The mounting changed.");
  EXPECT_EQ(possible_lines(diagnosis).size(), 2u);
  diagnosis.findings[0].certain = true;
  EXPECT_EQ(verdict_line(diagnosis), "good: The mounting changed. Cure: Reset the pair.");
}

// A `good` beside an answer that nobody has judged was exported as good.
TEST_F(AnswersTest, AGoodVerdictIsNotThatOfAnAnswerThatHasMoved) {
  const std::string log = folder / "moved.log";
  const problem_t first = problem(5);
  const DualQuaternion judged = *bus::to_dual_quaternion(answer(first).pos, answer(first).quat).value;
  Pose moved = to_pose(T);
  moved.rotation = moved.rotation * rotation_exp({0, 0, 0.09});  // 5 degrees
  T = to_dual_quaternion(moved);
  const problem_t last = problem(6);
  {
    bus::LogWriter writer(log);
    const auto write = [&](const std::string& channel, const auto& message) {
      writer.write(message.utime, channel, bus::encode(message));
    };
    write(bus::problem_channel("left", "right"), first);
    write(bus::verdict_channel("left", "right"), verdict(Verdict::good, first.session, 5, judged));
    write(bus::problem_channel("left", "right"), last);
    write(bus::calibration_channel("left", "right"), answer(last));
    writer.close();
  }
  const std::string out = folder / "moved.yaml", said = folder / "moved.err";
  const int status = std::system(
      (paths::bin_dir() + "/egocal export --log " + log + " --out " + out + " 2>" + said).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
  const auto text_of = [](const std::string& file) {
    std::ifstream stream(file);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  EXPECT_THAT(text_of(out), HasSubstr("usable: false"));
  EXPECT_THAT(text_of(out), HasSubstr("DO NOT USE; not judged: the answer has moved by "));
  EXPECT_THAT(text_of(out), Not(HasSubstr("verdict: good")));
  EXPECT_THAT(text_of(said), HasSubstr("since it was judged. Before: good: "));
}

TEST_F(AnswersTest, TheVerdictOfTheSessionGoesWithTheAnswer) {
  const std::string log = folder / "session.log";
  const problem_t last = problem(5);
  {
    bus::LogWriter writer(log);
    const auto write = [&](const std::string& channel, const auto& message) {
      writer.write(message.utime, channel, bus::encode(message));
    };
    write(bus::problem_channel("left", "right"), last);
    write(bus::calibration_channel("left", "right"), answer(last));
    write(bus::verdict_channel("left", "right"), verdict(Verdict::good, last.session, 2));
    write(bus::verdict_channel("left", "right"), verdict(Verdict::contradictory, last.session, 5));
    write(bus::verdict_channel("left", "right"), verdict(Verdict::good, last.session, 3));
    write(bus::verdict_channel("left", "right"), verdict(Verdict::good, last.session + 1, 9));
    writer.close();
  }
  const Answers answers = recorded_answers(log);
  ASSERT_NE(answers.diagnosis(pair_name), nullptr);
  EXPECT_EQ(answers.diagnosis(pair_name)->verdict, Verdict::contradictory);
  const std::string out = folder / "out.yaml";
  const int status = std::system(
      (paths::bin_dir() + "/egocal export --log " + log + " --out " + out + " 2>/dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3) << "written, but not to be used";
  std::ifstream stream(out);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(text, HasSubstr("usable: false"));
  EXPECT_THAT(text, HasSubstr("verdict: contradictory"));
}

// They had the time of the day on which the drive was played
TEST_F(AnswersTest, ALogForRosHasAnswersAtTheTimeOfTheDrive) {
  const std::string log = folder / "session.log", mcap = folder / "session.mcap";
  const problem_t first = problem(1), second = problem(2);
  {
    bus::LogWriter writer(log);
    std::int64_t played_us = begin_us + 1'000'000'000'000;
    const auto write = [&](const calibration_t& message) {
      writer.write(played_us += 1'000'000, bus::calibration_channel("left", "right"), bus::encode(message));
    };
    for (int i = 0; i < 3; ++i) write(answer(first));  // sent again once a second
    for (int i = 0; i < 2; ++i) write(answer(second));
    writer.close();
  }
  const std::string command = paths::bin_dir() + "/egocal log export " + log + " --mcap " + mcap;
  ASSERT_EQ(std::system((command + " >" + (folder / "said").string()).c_str()), 0);
  std::ifstream said(folder / "said");
  EXPECT_THAT((std::string{std::istreambuf_iterator<char>(said), {}}), HasSubstr("0 poses, 2 calibrations"));
  const Trajectory answers = read_trajectory(mcap + ":/tf:left/right");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].time_us, first.utime);
  EXPECT_EQ(answers[1].time_us, second.utime);
}

// A pair that nothing shows the height of was a frame like any other
TEST_F(AnswersTest, AnExportStatesTheReasonAndWhatIsNotObservable) {
  const std::string log = folder / "session.log", out = folder / "out.urdf", said = folder / "said";
  const problem_t last = problem(5);
  {
    bus::LogWriter writer(log);
    calibration_t flat = answer(last);
    flat.observable[2] = 0;
    flat.stddev[2] = std::numeric_limits<double>::infinity();
    writer.write(last.utime, bus::calibration_channel("left", "right"), bus::encode(flat));
    writer.write(last.utime, bus::verdict_channel("left", "right"),
                 bus::encode(verdict(Verdict::incomplete, last.session, 5)));
    writer.close();
  }
  const std::string command =
      paths::bin_dir() + "/egocal export --log " + log + " --format urdf --out " + out + " 2>" + said;
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto content = [](const std::string& file) {
    std::ifstream stream(file);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  EXPECT_THAT(content(out), HasSubstr("<!-- verdict incomplete: the lengths differ; NOT OBSERVABLE, not a "
                                      "measurement: z; "));
  EXPECT_THAT(content(said), HasSubstr("egocal: left,right: NOT OBSERVABLE, not a measurement: z\n"));
}

TEST_F(AnswersTest, AllOfThemAreOneTree) {
  const std::string log = folder / "session.log";
  {
    bus::LogWriter writer(log);
    for (const char* b : {"right", "rear"}) {
      problem_t to = problem(1);
      to.sensor_b = b;
      writer.write(to.utime, bus::problem_channel("left", b), bus::encode(to));
      writer.write(to.utime, bus::calibration_channel("left", b), bus::encode(answer(to)));
    }
    writer.close();
  }
  const std::string out = folder / "robot.urdf";
  const auto run = [&](const std::string& options) {
    const int status = std::system(
        (paths::bin_dir() + "/egocal export --log " + log + " " + options + " --out " + out + " 2>/dev/null")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(run("--all --format matrix"), 1);
  EXPECT_EQ(run("--all --pair left,right"), 2);
  EXPECT_FALSE(std::filesystem::exists(out));
  ASSERT_EQ(run("--all --format urdf"), 0);
  std::ifstream stream(out);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const char* part : {"<robot", "left_to_right", "left_to_rear", "</robot>"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(AnswersTest, SeveralPairsWithoutAChoiceAreWrongUsage) {
  std::ofstream(folder / "rig.toml") << R"(
[[sensor]]
name = "lidar"
channel = "L"
[[sensor]]
name = "camera"
channel = "C"
[[sensor]]
name = "radar"
channel = "R"
[[pair]]
a = "lidar"
b = "camera"
[[pair]]
a = "lidar"
b = "radar"
)";
  const std::string command = paths::bin_dir() + "/egocal export --rig " + (folder / "rig.toml").string() +
                              " 2>" + (folder / "said").string();
  for (const std::string more : {"", " --pair lidar,sonar"}) {
    const int status = std::system((command + more).c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 2);
    std::ifstream stream(folder / "said");
    const std::string said{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_THAT(said, HasSubstr("lidar,camera lidar,radar"));
  }
}

}  // namespace
}  // namespace egocal::tools::test_answers
