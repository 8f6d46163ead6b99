// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <random>

#include "egocal/bus/answer_check.hpp"
#include "egocal/bus/backing.hpp"

namespace egocal::bus::test_answer_check {
namespace {

const DualQuaternion truth = to_dual_quaternion(Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}});

Problem noisy_problem(unsigned seed, Mode mode = Mode::spatial) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    return to_dual_quaternion(
        Pose{rotation_exp({size * normal(random), size * normal(random), size * normal(random)}),
             {size * normal(random), size * normal(random), size * normal(random)}});
  };
  Problem problem;
  problem.mode = mode;
  problem.plane_b.distance = -0.3;
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion planar_truth = to_dual_quaternion(Pose{rotation_exp({0, 0, 0.7}), {0.4, -0.8, 0}});
  const DualQuaternion T = mode == Mode::planar ? extrinsic_from_planar(planar_truth, G_a, G_b) : truth;
  for (int block = 0; block < 4; ++block) {
    Statistics statistics;
    for (int i = 0; i < 20; ++i) {
      DualQuaternion a = noise(0.5);
      if (mode == Mode::planar) {
        const Pose pose = to_pose(a);
        a = to_dual_quaternion(Pose{rotation_exp({0, 0, pose.translation.z()}),
                                    {pose.translation.x(), pose.translation.y(), 0}});
      }
      const DualQuaternion b = conjugate(T) * a * T * noise(0.01);
      if (mode == Mode::planar)
        statistics.add(planar_motion(a, G_a), planar_motion(b, G_b));
      else
        statistics.add(a, b);
    }
    problem.blocks.push_back(statistics);
  }
  return problem;
}

problem_t problem_message(const Problem& problem, std::int64_t seq = 80) {
  problem_t message = to_message(problem);
  message.session = 1'600'000'000'000'000;
  message.utime = message.session + 100'000 * seq;
  message.seq = seq;
  message.sensor_a = "left";
  message.sensor_b = "right";
  return message;
}

calibration_t answer_message(const Problem& problem, const problem_t& message, Method method = Method::dual) {
  calibration_t answer = to_message(solve(problem, method), message);
  answer.solver = "egocal-global";
  return answer;
}

TEST(AnswerCheck, TrueAnswersAreVerifiedInBothModes) {
  for (const Mode mode : {Mode::spatial, Mode::planar})
    for (unsigned seed = 1; seed <= 200; ++seed) {
      const Problem problem = noisy_problem(seed, mode);
      const problem_t message = problem_message(problem);
      AnswerCheck check;
      ASSERT_EQ(check.take(message), "");
      const CheckedAnswer checked = check.check(answer_message(problem, message));
      EXPECT_EQ(checked.standing, Standing::verified) << checked.reason << ", seed " << seed;
      EXPECT_EQ(checked.answer.certificate.optimality, Optimality::certified) << "seed " << seed;
    }
}

TEST(AnswerCheck, WhatAnAnswerRestsOnFollowsItsProblemWhateverMethodAnswered) {
  const Problem problem = noisy_problem(1, Mode::planar);
  const problem_t message = problem_message(problem);
  constexpr std::array all{Method::dual, Method::sdp, Method::sqp, Method::slsqp};
  for (const Method method : all) {
    const calibration_t answer = answer_message(problem, message, method);
    AnswerCheck check;
    const CheckedAnswer unknown = check.check(answer);
    ASSERT_EQ(unknown.standing, Standing::unverified);
    EXPECT_FALSE(unknown.problem);
    // a nominal pose of the rig gives nothing in the plane
    const auto of_method = backing_of(unknown, answer.method, false);
    EXPECT_EQ(of_method[2], answer.method == "planar" ? Backing::planes : Backing::none) << answer.method;
    ASSERT_EQ(check.take(message), "");
    const auto backing = backing_of(check.check(answer), answer.method, true);
    EXPECT_THAT(backing, testing::ElementsAre(Backing::motions, Backing::motions, Backing::planes,
                                              Backing::planes, Backing::planes, Backing::motions))
        << answer.method;
  }
}

/// Of motions on flat ground, which do not show the height, with a prior for it.
Problem flat_problem_with_prior(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto pose = [&](double turn, double noise) {
    return to_dual_quaternion(
        Pose{rotation_exp({noise * normal(random), noise * normal(random), turn}),
             {(turn == 0 ? 0 : 1) + noise * normal(random), noise * normal(random), noise * normal(random)}});
  };
  Problem problem;
  for (int block = 0; block < 12; ++block) {
    Statistics statistics;
    for (int i = 0; i < 20; ++i) {
      const DualQuaternion a = pose(0.2 * normal(random), 0);
      statistics.add(a * pose(0, 0.005), conjugate(truth) * a * truth * pose(0, 0.005));
    }
    problem.blocks.push_back(statistics);
  }
  Pose prior = to_pose(truth);
  prior.translation.z() += 2;
  problem.prior = to_dual_quaternion(prior);
  return problem;
}

TEST(AnswerCheck, AnswersAtThePriorAreVerified) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Problem problem = flat_problem_with_prior(seed);
    const problem_t message = problem_message(problem);
    const Answer answer = solve(problem, Method::dual);
    ASSERT_FALSE(answer.observability.observable[2]) << seed;
    EXPECT_NEAR(to_pose(answer.T_a_b).translation.z(), to_pose(*problem.prior).translation.z(), 0.05) << seed;
    AnswerCheck check;
    ASSERT_EQ(check.take(message), "");
    for (const Method method : {Method::dual, Method::sdp, Method::sqp, Method::slsqp}) {
      const CheckedAnswer checked = check.check(answer_message(problem, message, method));
      EXPECT_EQ(checked.standing, Standing::verified) << checked.reason << ", seed " << seed;
      EXPECT_EQ(backing_of(checked, "", false)[2], Backing::nominal) << "as its problem says";
    }
    // the minimum that noise has elsewhere is not the answer
    Answer elsewhere = answer;
    elsewhere.T_a_b = answer.minimum;
    calibration_t forged = to_message(elsewhere, message);
    forged.solver = "egocal-global";
    EXPECT_EQ(check.check(forged).standing, Standing::refused) << seed;
  }
}

verdict_t verdict_message(Verdict verdict, const DualQuaternion& T_a_b, const problem_t& of) {
  Diagnosis diagnosis;
  diagnosis.verdict = verdict;
  verdict_t message = to_message(diagnosis, {T_a_b, of.utime, of.utime, 0});
  message.sender = "egocal-diagnosis";
  message.utime = of.utime;
  message.session = of.session;
  message.seq = of.seq;
  message.sensor_a = of.sensor_a;
  message.sensor_b = of.sensor_b;
  return message;
}

TEST(AnswerCheck, AVerdictCallsOnlyTheOptimumGood) {
  for (const Mode mode : {Mode::spatial, Mode::planar}) {
    const Problem problem = noisy_problem(1, mode);
    const problem_t message = problem_message(problem);
    AnswerCheck check;
    const auto refusal = [&](Verdict verdict, const DualQuaternion& T_a_b) {
      const verdict_t sent = verdict_message(verdict, T_a_b, message);
      const Checked<ReceivedVerdict> received = to_verdict(sent);
      EXPECT_TRUE(received) << received.reason;
      return check.refusal(sent, *received.value);
    };
    const DualQuaternion optimum = solve(problem, Method::dual).T_a_b;
    const DualQuaternion other = optimum * to_dual_quaternion(Pose{rotation_exp({0, 0, 0.05}), {0.1, 0, 0}});
    EXPECT_EQ(refusal(Verdict::good, other), "") << "its problem is not known";
    ASSERT_EQ(check.take(message), "");
    EXPECT_EQ(refusal(Verdict::good, optimum), "");
    EXPECT_NE(refusal(Verdict::good, other), "");
    EXPECT_EQ(refusal(Verdict::doubtful, other), "");
  }
}

// Each of them was exported or shown as certified.
TEST(AnswerCheck, ForgedCertificatesAreRefused) {
  const Problem problem = noisy_problem(1);
  const problem_t message = problem_message(problem);
  AnswerCheck check;
  ASSERT_EQ(check.take(message), "");
  const calibration_t honest = answer_message(problem, message);
  const std::vector<std::pair<std::string, std::function<void(calibration_t&)>>> lies{
      {"elsewhere", [](auto& m) { m.pos[0] += 9; }},
      {"elsewhere, cost zero", [](auto& m) { m.pos[0] += 9, m.cost = m.lower_bound = m.gap = 0; }},
      {"a millimetre off", [](auto& m) { m.pos[1] += 1e-3; }},
      {"another rotation", [](auto& m) { std::swap(m.quat[0], m.quat[1]); }},
      {"gap of five limits", [](auto& m) { m.scaled_gap = 5, m.reach_translation = 1; }},
      {"infinite gap", [](auto& m) { m.gap = m.scaled_gap = std::numeric_limits<double>::infinity(); }},
      {"bound above the cost",
       [](auto& m) {
         m.lower_bound = m.cost + 1;
         m.gap = 5;
       }},
      {"hugely negative cost",
       [](auto& m) {
         m.cost = -1e300;
         m.lower_bound = -1e300;
         m.gap = 0;
       }},
      {"NaN", [](auto& m) { m.cost = std::nan(""); }},
  };
  for (const auto& [name, lie] : lies) {
    calibration_t forged = honest;
    lie(forged);
    const CheckedAnswer checked = check.check(forged);
    EXPECT_EQ(checked.standing, Standing::refused) << name;
    EXPECT_NE(checked.reason, "") << name;
  }
  EXPECT_EQ(check.check(honest).standing, Standing::verified);
}

TEST(AnswerCheck, OffThePlaneIsNotCertified) {
  const Problem problem = noisy_problem(3, Mode::planar);
  const problem_t message = problem_message(problem);
  AnswerCheck check;
  ASSERT_EQ(check.take(message), "");
  calibration_t lifted = answer_message(problem, message);
  lifted.pos[2] += 0.5;
  EXPECT_EQ(check.check(lifted).standing, Standing::refused);
}

// The certificate is ours: what the sender claims of cost and bound is not looked at.
TEST(AnswerCheck, CostsAreComputedNotBelieved) {
  const Problem problem = noisy_problem(2);
  const problem_t message = problem_message(problem);
  AnswerCheck check;
  ASSERT_EQ(check.take(message), "");
  calibration_t boasting = answer_message(problem, message);
  boasting.cost = boasting.lower_bound = boasting.gap = boasting.scaled_gap = 0;
  const CheckedAnswer checked = check.check(boasting);
  EXPECT_GT(checked.answer.certificate.cost, 1e-6);
  set_certificate(checked, boasting);
  EXPECT_EQ(boasting.cost, checked.answer.certificate.cost);
}

TEST(AnswerCheck, WithoutItsProblemAnAnswerIsNeverCertifiedAndNeverOutranks) {
  const Problem problem = noisy_problem(4);
  const problem_t message = problem_message(problem, 80), later = problem_message(problem, 90);
  AnswerCheck check;
  ASSERT_EQ(check.take(message), "");
  const calibration_t honest = answer_message(problem, message);
  const calibration_t early = answer_message(problem, later);  // or forged, with a number to come
  const CheckedAnswer known = check.check(honest), unknown = check.check(early);
  EXPECT_EQ(unknown.standing, Standing::unverified);
  EXPECT_NE(unknown.answer.certificate.optimality, Optimality::certified);
  EXPECT_TRUE(outranks(rank_of(known, honest), rank_of(unknown, early)));
  EXPECT_FALSE(outranks(rank_of(unknown, early), rank_of(known, honest)));
  ASSERT_EQ(check.take(later), "");
  const CheckedAnswer now_known = check.check(early);
  EXPECT_EQ(now_known.standing, Standing::verified);
  EXPECT_TRUE(outranks(rank_of(now_known, early), rank_of(known, honest)));
}

TEST(AnswerCheck, PairsAndProblemsAreBounded) {
  const Problem problem = noisy_problem(5);
  AnswerCheck check;
  problem_t message = problem_message(problem);
  for (std::size_t i = 0; i < 3 * AnswerCheck::max_pairs; ++i) {
    message.sensor_b = "b" + std::to_string(i);
    ASSERT_EQ(check.take(message), "");
  }
  calibration_t answer = answer_message(problem, message);
  EXPECT_EQ(check.check(answer).standing, Standing::verified);
  answer.sensor_b = "b0";  // forgotten
  EXPECT_EQ(check.check(answer).standing, Standing::unverified);
}

}  // namespace
}  // namespace egocal::bus::test_answer_check
