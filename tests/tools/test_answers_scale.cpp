// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// An answer of a pair whose scale is to be found counts with its scale alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "pair_messages.hpp"
#include "support/paths.hpp"
#include "support/scale_problem.hpp"

namespace egocal::tools::test_answers_scale {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

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

}  // namespace
}  // namespace egocal::tools::test_answers_scale
