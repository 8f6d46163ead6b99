// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/judgement.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "diagnosis/remedies.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/diagnosis/as_judged.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/scale/scale_statistics.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal::services {

namespace {

/// The number of poses of the slower stream at common times. 0 if the clock of one sensor was set meanwhile.
std::size_t at_common_times(const Trajectory& a, const Trajectory& b, double time_offset) {
  if (a.empty() || b.empty()) return 0;
  const std::int64_t offset = to_microseconds(time_offset);
  const std::int64_t begin = std::max(a.front().time_us, b.front().time_us + offset);
  const std::int64_t end = std::min(a.back().time_us, b.back().time_us + offset);
  const auto between = [](const Trajectory& poses, std::int64_t first, std::int64_t last) {
    return static_cast<std::size_t>(std::count_if(poses.begin(), poses.end(), [&](const StampedPose& pose) {
      return pose.time_us >= first && pose.time_us <= last;
    }));
  };
  return std::min(between(a, begin, end), between(b, begin - offset, end - offset));
}

DiagnosisOptions diagnosis_options(const bus::PairConfig& pair, const DiagnosingOptions& options) {
  DiagnosisOptions result;
  result.goal = pair.goal;
  result.platform = pair.platform;
  result.mount.false_alarms = options.false_alarms;
  result.mount.shown_before = options.shown_before;
  return result;
}

Answered answered_of(DiagnosedPair& pair, const Answer& answer) {
  const problem_t& message = pair.newest->message;
  const Problem& problem = pair.newest->problem;
  Answered answered;
  answered.T_a_b = answer.minimum;
  answered.observability = answer.observability;
  answered.problem = problem;
  answered.stride = message.stride;
  answered.seconds = to_seconds(message.utime - message.session);
  if (pair.unscaled)
    if (const ScaleSolution* solution = pair.scale.solution(pair.config.a, pair.config.b, message.session))
      answered.scale_stddev = spread_by_scale(answer.observability, problem, *solution);
  return answered;
}

verdict_t verdict_of(const DiagnosedPair& pair, const Diagnosis& diagnosis, const bus::Judged& judged) {
  const problem_t& message = pair.newest->message;
  verdict_t verdict = bus::to_message(diagnosis, judged);
  verdict.utime = message.utime;
  verdict.session = message.session;
  verdict.seq = message.seq;
  for (const statistics_t& block : message.blocks) verdict.pairs += block.count;
  verdict.sensor_a = pair.config.a;
  verdict.sensor_b = pair.config.b;
  return verdict;
}

bool moved_for_certain(const Diagnosis& diagnosis) {
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [](const Finding& finding) { return finding.code == "mount_moved" && finding.certain; });
}

}  // namespace

Judgement judge(DiagnosedPair& pair, double scale, const bus::Rig& rig, const DiagnosingOptions& options) {
  const problem_t& message = pair.newest->message;
  PairingOptions pairing = bus::drive_options(rig, pair.config);
  pairing.time_offset = message.time_offset;
  const auto poses_of = [&](Side side) {
    return pair.unscaled == side ? scaled(pair.sample.poses(side), scale) : pair.sample.poses(side);
  };
  const Trajectory a = poses_of(Side::a), b = pair.clock.at_newest_offset(poses_of(Side::b));
  const std::size_t poses = at_common_times(a, b, message.time_offset);

  const Answer answer = solve(pair.newest->problem, Method::dual);
  const Answered answered = answered_of(pair, answer);
  const DiagnosisOptions diagnosing = diagnosis_options(pair.config, options);
  bus::Judged judged{answer.T_a_b, message.utime, message.utime, 0, {}};
  Diagnosis diagnosis;
  if (poses < options.unseen.least_poses) {
    diagnosis = diagnose(answered, diagnosing);
  } else {
    diagnosis = options.diagnose(a, b, pairing, answered, diagnosing);
    judged = {answer.T_a_b, a.front().time_us, a.back().time_us, static_cast<std::int64_t>(poses), {}};
  }
  judged.observability = as_judged(answer.observability, diagnosis);
  limit_to_what_was_seen(pair.unseen(poses), diagnosis, options.unseen);
  word_remedies(rig, pair.config, diagnosis.findings);

  Judgement judgement{verdict_of(pair, diagnosis, judged), {}, moved_for_certain(diagnosis)};
  if (diagnosis.verdict < Verdict::doubtful)
    judgement.judged = JudgedAnswer{to_pose(answer.T_a_b), judged.observability};
  return judgement;
}

}  // namespace egocal::services
