// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The verdict comes first: on every screen, in lines and in JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/loops.hpp"
#include "egocal/monitor/view.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_verdict {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Now some_time{1'000'000, 1'600'000'100'000'000};

Diagnosis clean() {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::good;
  diagnosis.reason = "The motions agree to 1.2 %, and all directions are known.";
  diagnosis.fit.rotation_median = 0.002;
  diagnosis.fit.translation_median = 0.013;
  diagnosis.fit.motion_seconds = 1.2;
  return diagnosis;
}

Diagnosis without_scale() {
  Diagnosis diagnosis = clean();
  diagnosis.verdict = Verdict::contradictory;
  diagnosis.reason = "The lengths of b are 0.37 times those of a.";
  diagnosis.findings.push_back(
      {"scale", true, diagnosis.reason, "--scale-b auto", 40, std::nullopt, std::nullopt, 2.7});
  return diagnosis;
}

class VerdictShown : public ::testing::Test {
 protected:
  VerdictShown() {
    view.charset = Charset::unicode;
    problem = test::problem_at("lidar", "camera", 100, 10);
    model.on_problem(problem, some_time);
    model.on_calibration(test::calibration_at(problem, false), some_time);
  }
  void judge(const Diagnosis& diagnosis, std::int64_t session = test::begin_utime, std::int64_t seq = 101) {
    const verdict_t message = test::verdict_at(diagnosis, test::begin_utime + 1'000'000, session, seq);
    const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
    ASSERT_TRUE(received) << received.reason;
    model.on_verdict(message, *received.value, some_time);
  }
  std::string shown(Screen screen, int w, int h) {
    view.screen = screen;
    Canvas canvas(w, h);
    draw(canvas, model, view);
    return canvas.to_text();
  }
  std::vector<std::string> events() const {
    std::vector<std::string> texts;
    for (const Event& event : model.events()) texts.push_back(event.text);
    return texts;
  }

  Model model;
  ViewState view;
  problem_t problem;
};

TEST_F(VerdictShown, ComesBeforeTheProof) {
  judge(clean());
  for (const Screen screen : {Screen::overview, Screen::detail})
    for (const auto& [w, h] : {std::pair{80, 24}, {110, 42}, {200, 60}}) {
      const std::string text = shown(screen, w, h);
      const auto verdict = text.find("✓ good"), proof = text.find("optimal (proven)");
      ASSERT_NE(verdict, std::string::npos) << w << "x" << h << "\n" << text;
      ASSERT_NE(proof, std::string::npos) << w << "x" << h << "\n" << text;
      EXPECT_LT(verdict, proof);
      EXPECT_THAT(text, HasSubstr("The motions agree to 1.2 %")) << w << "x" << h;
    }
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("1 of 1 good"));
}

TEST_F(VerdictShown, AtEverySizeThatShowsTheProof) {
  judge(without_scale());
  for (int w = 30; w <= 120; w += 10)
    for (int h = 5; h <= 40; h += 5) {
      const std::string text = shown(Screen::overview, w, h);
      EXPECT_THAT(text, HasSubstr("contradictory")) << w << "x" << h << "\n" << text;
    }
}

TEST_F(VerdictShown, ASentenceThatIsEmptyLeavesNoTrace) {
  Diagnosis diagnosis = clean();
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.reason = "Not known to 1 deg and 60 cm yet: z. ";
  judge(diagnosis);
  EXPECT_THAT(pair_lines(model, Charset::ascii), HasSubstr("yet: z; optimal (proven)"));
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("shown, not yet exact enough"));
  EXPECT_THAT(shown(Screen::detail, 110, 42), Not(HasSubstr("the motions show everything")));

  diagnosis = without_scale();
  diagnosis.findings[0].remedy.clear();
  judge(diagnosis);
  EXPECT_THAT(shown(Screen::overview, 110, 42), Not(HasSubstr("Cure:")));
  EXPECT_THAT(shown(Screen::detail, 110, 42), Not(HasSubstr("Cure:")));
}

// The solver's standard deviations were shown beside a verdict that says: neither stream measured roll and
// pitch.
TEST_F(VerdictShown, WhatIsKnownOfADirectionIsTheVerdictsToSay) {
  const auto answer = [&] { return nlohmann::json::parse(json_line(model))["pairs"][0]["answer"]; };
  const double stated = test::calibration_at(problem, false).stddev[0];
  EXPECT_TRUE(answer()["observable"][3]);
  EXPECT_EQ(answer()["stddev"][0], stated);
  Diagnosis diagnosis = clean();
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.timing_stddev[0] = 0.02;
  diagnosis.assumed = {false, false, true, true, true, false};
  judge(diagnosis);
  const auto expect_judged = [&](double x) {
    EXPECT_EQ(answer()["observable"], nlohmann::json({true, true, false, false, false, true}));
    EXPECT_EQ(answer()["stddev"][0], std::hypot(x, 0.02));
    for (const int i : {2, 3, 4}) EXPECT_TRUE(answer()["stddev"][i].is_null()) << i;
    const std::string text = shown(Screen::detail, 110, 42);
    EXPECT_THAT(text, HasSubstr("not shown"));
    EXPECT_THAT(text, HasSubstr("neither stream measures z roll pitch"));
    EXPECT_THAT(shown(Screen::overview, 110, 42), HasSubstr("not shown: z roll pitch"));
    const std::optional<NamedExtrinsic> exported = extrinsic_of(model.pairs()[0]);
    ASSERT_TRUE(exported);
    EXPECT_EQ((*exported->backing)[3], Backing::none);
    EXPECT_TRUE(std::isinf((*exported->stddev)[3]));
  };
  expect_judged(stated);

  // answers come more often than verdicts
  problem = test::problem_at("lidar", "camera", 200, 10);
  model.on_problem(problem, some_time);
  const calibration_t later = test::calibration_at(problem, false);
  model.on_calibration(later, some_time);
  expect_judged(later.stddev[0]);

  problem.session += 1;
  model.on_problem(problem, some_time);
  const nlohmann::json before = nlohmann::json::parse(json_line(model))["pairs"][0]["previous_session"];
  EXPECT_TRUE(before["stddev"][3].is_null())
      << "the verdict of the last session is gone, its answer is shown";
}

TEST_F(VerdictShown, AFindingComesWithItsCure) {
  judge(without_scale());
  for (const Screen screen : {Screen::overview, Screen::detail}) {
    const std::string text = shown(screen, 110, 42);
    EXPECT_THAT(text, HasSubstr("✗ contradictory"));
    EXPECT_THAT(text, HasSubstr("The lengths of b are 0.37 times those of a. Cure: --scale-b auto"));
    EXPECT_THAT(text, HasSubstr("optimal (proven)")) << "which it is all the same";
  }
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("0 of 1 good  1 contradictory"));
  EXPECT_THAT(shown(Screen::overview, 80, 24), HasSubstr("0 of 1 good  1 contradictory"));
}

TEST_F(VerdictShown, TheGoalSaysWhatIsMissingForHowLongAndWhatToDrive) {
  Diagnosis diagnosis = clean();
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.goal = Goal{false, {"z", "yaw"}, 75.0, "Take a ramp at an angle."};
  judge(diagnosis);
  for (const Screen screen : {Screen::overview, Screen::detail}) {
    const std::string text = shown(screen, 110, 42);
    EXPECT_THAT(text, HasSubstr("weak: z yaw, about 75 s more of this. Take a ramp at an angle.")) << text;
  }
  diagnosis.goal->missing = {"z", "yaw", "x", "y", "roll", "pitch"};
  diagnosis.goal->seconds_left.reset();
  judge(diagnosis);
  EXPECT_THAT(shown(Screen::detail, 140, 42), HasSubstr("collecting, more of this does not help"));
  diagnosis.verdict = Verdict::good;
  diagnosis.goal = Goal{true, {}, std::nullopt, ""};
  judge(diagnosis);
  EXPECT_THAT(shown(Screen::overview, 110, 42), HasSubstr("goal done"));
  EXPECT_THAT(events(), Contains("the goal is reached"));
}

TEST_F(VerdictShown, IsNotThatOfAnAnswerThatIsNotProven) {
  judge(clean());
  calibration_t answer = test::calibration_at(test::problem_at("lidar", "camera", 101, 10), false);
  answer.status = 1;
  model.on_calibration(answer, some_time);
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("? not proven"));
  EXPECT_THAT(shown(Screen::overview, 110, 30), Not(HasSubstr("✓ good")));
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("not optimal"));
}

TEST_F(VerdictShown, NeverThatOfAnotherSession) {
  judge(without_scale(), test::begin_utime - 5);
  EXPECT_FALSE(model.pairs()[0].verdict);
  judge(without_scale(), test::begin_utime + 5);
  EXPECT_FALSE(model.pairs()[0].verdict);
  judge(clean());
  ASSERT_TRUE(model.pairs()[0].verdict);
  judge(without_scale(), test::begin_utime, 50);
  EXPECT_EQ(model.pairs()[0].verdict->diagnosis.verdict, Verdict::good) << "an older one came late";
  problem.session += 7;
  model.on_problem(problem, some_time);
  EXPECT_FALSE(model.pairs()[0].verdict) << "a new session is not judged yet";
}

// The mount may have moved since, and the diagnosis hangs.
TEST_F(VerdictShown, AnOldOneIsNotCalledGood) {
  const auto at = [](double seconds) {
    const auto us = std::llround(1e6 * seconds);
    return Now{some_time.mono_us + us, some_time.wall_us + us};
  };
  const auto drive_to = [&](int step) {
    const problem_t next = test::problem_at("lidar", "camera", step, 10);
    model.on_problem(next, at(0.1 * (step - 100)));
    model.on_calibration(test::calibration_at(next, false), at(0.1 * (step - 100)));
    model.tick(at(0.1 * (step - 100)));
  };
  judge(clean());
  model.on_problem(problem, at(100));
  model.tick(at(100));
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("✓ good")) << "nothing new came since";
  for (int step = 1101; step < 1200; ++step) drive_to(step);
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("✓ good"));
  for (int step = 1200; step < 1300; ++step) drive_to(step);
  for (const Screen screen : {Screen::overview, Screen::detail}) {
    const std::string text = shown(screen, 110, 42);
    EXPECT_THAT(text, Not(HasSubstr("✓ good")));
    EXPECT_THAT(text, HasSubstr("? old verdict"));
    EXPECT_THAT(text, HasSubstr("is egocal-diagnosis running?"));
  }
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("0 of 1 good"));
  EXPECT_THAT(pair_lines(model, Charset::ascii),
              HasSubstr("lidar -> camera: ? old verdict: nothing has been judged for 20 s: is egocal-d"));
  EXPECT_EQ(nlohmann::json::parse(json_line(model))["pairs"][0]["verdict_old"], true);
  EXPECT_THAT(events(), Contains(HasSubstr("the verdict is old")).Times(1));
  judge(without_scale(), test::begin_utime, problem.seq + 1199);
  model.tick(at(120));
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("✗ contradictory"));
}

TEST_F(VerdictShown, ADoubtfulOneComesWithThePossibleCause) {
  Diagnosis diagnosis = clean();
  diagnosis.verdict = Verdict::doubtful;
  diagnosis.reason = "The mounting seems to have moved.";
  diagnosis.findings.push_back({"mount_moved", false, diagnosis.reason, "Reset the pair.", 2, std::nullopt,
                                std::nullopt, std::nullopt});
  judge(diagnosis);
  for (const Screen screen : {Screen::overview, Screen::detail})
    EXPECT_THAT(shown(screen, 110, 42), HasSubstr("The mounting seems to have moved. Cure: Reset the pair."));
}

TEST_F(VerdictShown, ItsChangesAreEvents) {
  judge(clean());
  judge(clean());
  judge(without_scale());
  EXPECT_THAT(events(), Contains(HasSubstr("verdict: good.")).Times(1));
  EXPECT_THAT(events(), Contains(HasSubstr("verdict: contradictory. The lengths")).Times(1));
  Diagnosis moved = without_scale();
  moved.findings.push_back({"mount_moved", true, "camera moved at 2:18: yaw -2.0 deg.", "reset", 3,
                            std::nullopt, 138.0, std::nullopt});
  judge(moved);
  EXPECT_THAT(events(), Contains("camera moved at 2:18: yaw -2.0 deg."));
  moved.findings.back().time = 10.05;
  judge(moved);
  model.on_calibration(test::calibration_at(test::problem_at("lidar", "camera", 102, 10), false), some_time);
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("┃")) << "a mark on the curves";
}

TEST_F(VerdictShown, InLines) {
  EXPECT_THAT(pair_lines(model, Charset::ascii),
              HasSubstr("lidar -> camera: not judged yet; optimal (proven)"));
  judge(without_scale());
  EXPECT_THAT(pair_lines(model, Charset::ascii),
              HasSubstr("lidar -> camera: ! contradictory: The lengths of b are 0.37 times those of a. Cure: "
                        "--scale-b auto; optimal (proven) by egocal-fast (sqp), 101 motions"));
}

TEST_F(VerdictShown, InJson) {
  EXPECT_EQ(nlohmann::json::parse(json_line(model))["pairs"][0]["verdict"], nullptr);
  Diagnosis diagnosis = without_scale();
  diagnosis.goal = Goal{false, {"z"}, std::nullopt, "Take a ramp."};
  judge(diagnosis);
  const nlohmann::json pair = nlohmann::json::parse(json_line(model))["pairs"][0];
  EXPECT_EQ(pair["verdict"], "contradictory");
  EXPECT_NEAR(pair["fit"]["rotation_deg_median"].get<double>(), 0.1146, 1e-3);
  EXPECT_EQ(pair["findings"][0]["code"], "scale");
  EXPECT_EQ(pair["findings"][0]["certain"], true);
  EXPECT_EQ(pair["findings"][0]["remedy"], "--scale-b auto");
  EXPECT_EQ(pair["goal"]["reached"], false);
  EXPECT_EQ(pair["goal"]["missing"][0], "z");
  EXPECT_EQ(pair["goal"]["seconds_left"], nullptr);
  EXPECT_EQ(pair["answer"]["certified"], true);
}

TEST_F(VerdictShown, AScaleThatIsLookedForIsShownWithItsProof) {
  scale_t message{};
  message.session = problem.session;
  message.seq = problem.seq;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  bus::CheckedScale scale;
  scale.sensor = "camera";
  scale.session = problem.session;
  scale.seq = problem.seq;
  scale.verified = scale.solution.certified = true;
  scale.solution.scale = 0.37;
  scale.solution.stddev = 0.00037;
  model.on_scale(message, scale, some_time);
  EXPECT_THAT(pair_lines(model, Charset::ascii), HasSubstr("scale of camera not shown by the motions yet"));
  scale.solution.observable = true;
  model.on_scale(message, scale, some_time);
  EXPECT_THAT(pair_lines(model, Charset::ascii),
              HasSubstr("scale 0.370 of camera +-0.100 %, optimal (proven)"));
  const nlohmann::json shown = nlohmann::json::parse(json_line(model))["pairs"][0]["scale"];
  EXPECT_EQ(shown["sensor"], "camera");
  EXPECT_EQ(shown["value"], 0.37);
  EXPECT_EQ(shown["certified"], true);
  message.session = scale.session = problem.session - 5;  // late, of an older session
  scale.solution.scale = 1;
  model.on_scale(message, scale, some_time);
  EXPECT_EQ(model.pairs()[0].scale->solution.scale, 0.37);
}

TEST(LoopsShown, TheSensorThatAllOpenLoopsHaveInCommonIsNamed) {
  const std::vector<std::string> names{"camera", "lidar", "radar", "tail"};
  Model model;
  const auto answer = [&](const std::string& a, const std::string& b, const Pose& T, std::int64_t step) {
    const problem_t problem = test::problem_at(a, b, step, 10);
    model.on_problem(problem, some_time);
    calibration_t message = test::calibration_at(problem, true);
    bus::set_pose(to_dual_quaternion(T), message.pos, message.quat);
    for (int i = 0; i < 6; ++i) message.stddev[i] = i < 3 ? 0.001 : 0.0001;
    model.on_calibration(message, some_time);
  };
  const auto mount = [](std::size_t i) {
    const double x = static_cast<double>(i);
    return Pose{rotation_exp({0.2 * x, -0.1 * x * x, 0.3}), {x, 0.5 - x, 0.2 * x * x}};
  };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = i + 1; k < 4; ++k) answer(names[i], names[k], inverse(mount(i)) * mount(k), 100);
  ASSERT_EQ(loops_of(model).size(), 4u);
  for (const Loop& loop : loops_of(model)) EXPECT_FALSE(loop.open());
  EXPECT_EQ(sensor_to_blame(loops_of(model)), "");
  model.tick(some_time);
  EXPECT_THAT(text_lines(model, Charset::ascii),
              HasSubstr("loop camera lidar radar: misfit 0.00 cm 0.000 deg, closed"));

  constexpr double degree = 0.0174533;
  for (std::size_t i = 0; i < 3; ++i) {
    Eigen::Vector3d off = Eigen::Vector3d::Zero();
    off[static_cast<Eigen::Index>(i)] = degree;
    answer(names[i], "tail", inverse(mount(i)) * mount(3) * Pose{rotation_exp(off), {0, 0, 0}}, 101);
  }
  model.tick(some_time);
  EXPECT_EQ(sensor_to_blame(loops_of(model)), "tail");
  const nlohmann::json shown = nlohmann::json::parse(json_line(model));
  EXPECT_EQ(shown["blamed"], "tail");
  EXPECT_EQ(shown["loops"].size(), 4u);
  EXPECT_THAT(text_lines(model, Charset::ascii), HasSubstr("every open loop has tail"));
  EXPECT_EQ(std::count_if(
                model.events().begin(), model.events().end(),
                [](const Event& event) { return event.text.find("does not close") != std::string::npos; }),
            3);
}

}  // namespace
}  // namespace egocal::monitor::test_verdict
