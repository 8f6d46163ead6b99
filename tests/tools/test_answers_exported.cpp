// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What egocal export writes of the answers of a log, and states beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "pair_messages.hpp"
#include "support/paths.hpp"

namespace egocal::tools::test_answers_exported {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The verdict `good` was exported with a newer answer that had not been judged.
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
}  // namespace egocal::tools::test_answers_exported
