// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Problems, answers and verdicts of one pair, as its processes send them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "answers/answers.hpp"
#include "egocal/certificate/certificate.hpp"
#include "support/random_motion.hpp"

namespace egocal::tools {

inline const PairName pair_name{"left", "right"};
inline constexpr std::int64_t begin_us = 1'700'000'000'000'000;

class AnswersTest : public ::testing::Test {
 protected:
  AnswersTest() : random(5), T(testing::random_extrinsic(random)) {
    folder = std::filesystem::temp_directory_path() / ("egocal_answers_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
  }
  ~AnswersTest() override { std::filesystem::remove_all(folder); }

  problem_t problem(std::int64_t seq, std::int64_t session = begin_us, std::uint64_t pairs = 60) {
    Problem problem;
    Statistics statistics;
    for (const MotionPair& pair : testing::random_pairs(T, {.pairs = pairs, .noise = 0.01}, random))
      statistics.add(pair.a, pair.b);
    problem.blocks = {statistics};
    problem_t message = bus::to_message(problem);
    message.utime = session + 100'000 * seq;
    message.session = session;
    message.seq = seq;
    message.sensor_a = pair_name.first;
    message.sensor_b = pair_name.second;
    return message;
  }
  static calibration_t answer(const problem_t& to) {
    calibration_t message = bus::to_message(solve(*bus::to_problem(to).value, Method::dual), to);
    message.solver = "egocal-global";
    return message;
  }
  /// Moved by this much, and honest about it.
  static calibration_t poor_answer(const problem_t& to, double metres) {
    const Problem problem = *bus::to_problem(to).value;
    Answer poor = solve(problem, Method::dual);
    Pose pose = to_pose(poor.T_a_b);
    pose.translation.x() += metres;
    poor.T_a_b = to_dual_quaternion(pose);
    poor.certificate = verify(certified_cost(problem), poor.T_a_b);
    calibration_t message = bus::to_message(poor, to);
    message.solver = "egocal-fast";
    return message;
  }

  testing::Random random;
  DualQuaternion T;
  std::filesystem::path folder;
};

/// T: the transform that is judged; a good one is refused where that is not the optimum.
inline verdict_t verdict(Verdict what, std::int64_t session, std::int64_t seq, const DualQuaternion& T = {}) {
  Diagnosis diagnosis;
  diagnosis.verdict = what;
  diagnosis.reason = "the lengths differ";
  verdict_t message = bus::to_message(diagnosis, {T, begin_us, begin_us, 0});
  message.utime = session + 100'000 * seq;
  message.session = session;
  message.seq = seq;
  message.sensor_a = pair_name.first;
  message.sensor_b = pair_name.second;
  message.sender = "egocal-diagnosis";
  return message;
}

}  // namespace egocal::tools
