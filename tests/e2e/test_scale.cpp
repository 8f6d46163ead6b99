// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// scale = "auto" over real LCM: a camera without scale, all processes.

#include "egocal/bus/scale.hpp"
#include "egocal/bus/verdict.hpp"
#include "processes.hpp"
#include "support/mistakes.hpp"
#include "support/turning_bodies.hpp"

namespace egocal::test_scale {
namespace {

using namespace std::chrono_literals;
using test::drive;
using test::events;
using test::Processes;

constexpr double scale = 2.7;

class LiveScale : public Processes {
 protected:
  LiveScale() {
    std::ofstream(rig_file) << "[[sensor]]\nname = \"left\"\nchannel = \"ODO_LEFT\"\n"
                               "[[sensor]]\nname = \"right\"\nchannel = \"ODO_RIGHT\"\nscale = \"auto\"\n"
                               "[[pair]]\na = \"left\"\nb = \"right\"\n"
                               "[solver]\nheartbeat_timeout = 1.5\n";
    loop->subscribe<scale_problem_t>(bus::scale_problem_channel("left", "right"),
                                     [this](const scale_problem_t& message, const bus::Arrival&) {
                                       question = message;
                                       EXPECT_EQ(check.take(message), "");
                                     });
    loop->subscribe<scale_t>(bus::scale_channel("left", "right"),
                             [this](const scale_t& message, const bus::Arrival&) {
                               EXPECT_EQ(check.take(message), "");
                               answer = message;
                             });
    loop->subscribe<verdict_t>(bus::verdict_channel("left", "right"),
                               [this](const verdict_t& message, const bus::Arrival&) { verdict = message; });
  }
  bool answered() {
    return until([&] {
      return question && answer && problem && question->scale > 0 && answer->seq == question->seq &&
             problem->seq == question->seq && answers.contains("egocal-fast") &&
             answers["egocal-fast"].seq == problem->seq;
    });
  }

  bus::ScaleCheck check;
  std::optional<scale_problem_t> question;
  std::optional<scale_t> answer;
  std::optional<verdict_t> verdict;
};

TEST_F(LiveScale, IsFoundWithTheExtrinsic) {
  start("egocal-pairing");
  start("egocal-global");
  start("egocal-fast");
  start("egocal-diagnosis");
  std::vector<Trajectory> trajectories = drive(600);
  trajectories[1] = testing::lengthened(trajectories[1], 1 / scale);
  play(events(trajectories));
  ASSERT_TRUE(answered());
  const bus::CheckedScale* checked = check.find("left", "right", question->session);
  ASSERT_TRUE(checked);
  EXPECT_TRUE(checked->verified);
  EXPECT_TRUE(checked->solution.certified);
  EXPECT_TRUE(checked->solution.observable);
  EXPECT_LT(std::abs(checked->solution.scale - scale), 4 * checked->solution.stddev);
  EXPECT_LT(checked->solution.stddev, 0.005 * scale);
  EXPECT_EQ(question->scale, answer->scale) << "the solver finds what pairing uses, to the bit";
  const auto T = bus::to_dual_quaternion(answers["egocal-fast"].pos, answers["egocal-fast"].quat);
  ASSERT_TRUE(T);
  const Pose truth{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}};
  const ExtrinsicError error = extrinsic_error(to_dual_quaternion(truth), *T.value);
  EXPECT_LT(error.rotation, 0.01);
  EXPECT_LT(error.translation, 0.05);
  EXPECT_TRUE(until([&] { return verdict && verdict->seq == problem->seq; }));
  EXPECT_TRUE(verdict && verdict->verdict != "contradictory") << verdict->reason;
}

/// A head that pans and tilts about one point: each scale has a lever arm of its own. Offline the lever arm
/// is not observable (TEST Scale, WithoutItTheLeverArmIsNotObservable); live an answer would state one.
TEST_F(LiveScale, ThatNoMotionShowsHasNoAnswerBesideIt) {
  for (const char* program : {"egocal-pairing", "egocal-global", "egocal-fast", "egocal-diagnosis"})
    start(program);
  const testing::Streams streams = testing::pan_tilt(3, 0.005);
  play(events({streams.a, testing::lengthened(streams.b, 1 / scale)}));
  ASSERT_TRUE(until([&] { return question && answer && answer->seq == question->seq && answer->seq > 100; }));
  const bus::CheckedScale* checked = check.find("left", "right", question->session);
  ASSERT_TRUE(checked);
  EXPECT_TRUE(checked->verified);
  EXPECT_FALSE(checked->solution.observable);
  EXPECT_FALSE(answer->observable);
  EXPECT_EQ(question->scale, 0) << "none is in force";
  // what is sent is sent again each second
  const auto any = [&] { return problem || !answers.empty() || verdict; };
  EXPECT_FALSE(until(any, 2500ms)) << "of the lever arm at a scale that nothing shows";
}

}  // namespace
}  // namespace egocal::test_scale
