// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/joint.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"
#include "offline/common/backing_of.hpp"

namespace egocal::tools {

namespace {

/// A loop has its own motions where its sensors share this many times the time that all sensors share.
constexpr double longer_than_common = 1.25;
/// The joint answer takes the place of the pairs' where it states at most this many times what they do: it
/// knows no errors in variables (docs/method.md), and has only instants that all sensors share.
constexpr double most_spread = 1.5;
/// The joint answer takes that place only where both agree, in every direction, to this many standard
/// deviations and what loops may be open by (RigOptions::least_rotation).
constexpr double agreeing_sigmas = 3;

/// The time from the begin to the end of what all these sensors recorded [s]; below 0: they share none.
double common_span(const std::vector<Trajectory>& trajectories, const std::vector<std::size_t>& sensors) {
  std::int64_t begin = trajectories[sensors.front()].front().time_us,
               end = trajectories[sensors.front()].back().time_us;
  for (const std::size_t s : sensors) {
    begin = std::max(begin, trajectories[s].front().time_us);
    end = std::min(end, trajectories[s].back().time_us);
  }
  return to_seconds(end - begin);
}

/// The choice of the pair whose motions are the longest, for the motions of all sensors: what is common keeps
/// the errors of the pairs dependent, and the loops closed.
Choice longest_choice(const RigReport& report) {
  Choice common;
  common.stride = 0;
  for (const Calibration& calibration : report.pairs)
    if (calibration.choice.stride > common.stride) common = calibration.choice;
  return common;
}

/// Index of the pair in the report; empty: it has no answer.
std::optional<std::size_t> index_of(const RigReport& report, std::size_t a, std::size_t b) {
  for (std::size_t i = 0; i < report.solution.pairs.size(); ++i)
    if (report.solution.pairs[i].a == a && report.solution.pairs[i].b == b) return i;
  return std::nullopt;
}

/// What the answer of a pair states, infinite where a direction is not known; that of the planes is.
std::array<double, 6> stated_of(const Calibration& calibration) {
  std::array<double, 6> stddev = calibration.observability.stddev;
  const std::array<Backing, 6> backing = backing_of(calibration);
  for (std::size_t i = 0; i < 6; ++i) {
    if (backing[i] == Backing::planes) stddev[i] = 0;
    if (backing[i] == Backing::none || backing[i] == Backing::nominal) stddev[i] = INFINITY;
  }
  return stddev;
}

/// The motions that these sensors have in common; empty where they have none or a pair has no answer.
std::vector<RigPair> motions_of(const std::vector<Trajectory>& trajectories,
                                const std::vector<std::size_t>& sensors, const RigMotionsOptions& options,
                                const RigReport& report) {
  std::vector<Trajectory> chosen;
  chosen.reserve(sensors.size());
  for (const std::size_t s : sensors) chosen.push_back(trajectories[s]);
  RigMotionsOptions of_chosen = options;
  of_chosen.planes.clear();
  if (!options.planes.empty())
    for (const std::size_t s : sensors) of_chosen.planes.push_back(options.planes[s]);
  std::vector<RigPair> pairs = rig_motions(chosen, of_chosen);
  for (RigPair& pair : pairs) {
    const auto index = index_of(report, sensors[pair.a], sensors[pair.b]);
    if (!index || pair.pairs.empty()) return {};
    pair.T_a_b = to_dual_quaternion(report.pairs[*index].T_a_b);
    pair.stated = stated_of(report.pairs[*index]);
  }
  return pairs;
}

std::vector<std::size_t> all_of(std::size_t sensors) {
  std::vector<std::size_t> all;
  for (std::size_t s = 0; s < sensors; ++s) all.push_back(s);
  return all;
}

/// Each loop from the motions of its own three sensors where they share much more time than all sensors do,
/// otherwise from those of all.
void judge_loops(const std::vector<Trajectory>& trajectories, const RigMotionsOptions& options,
                 double span_of_all, RigReport& report) {
  const std::size_t n = trajectories.size();
  std::vector<Loop> of_all = std::move(report.solution.loops);
  report.solution.loops.clear();
  RigOptions judging;
  judging.false_alarms /= std::max(1.0, static_cast<double>(n * (n - 1) * (n - 2)) / 6);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b)
      for (std::size_t c = b + 1; c < n; ++c) {
        const std::vector<std::size_t> sensors{a, b, c};
        const auto known = std::find_if(of_all.begin(), of_all.end(), [&](const Loop& loop) {
          return std::equal(sensors.begin(), sensors.end(), loop.sensors.begin());
        });
        if (known != of_all.end() &&
            !(common_span(trajectories, sensors) > longer_than_common * span_of_all)) {
          report.solution.loops.push_back(*known);
          continue;
        }
        const std::vector<RigPair> pairs = motions_of(trajectories, sensors, options, report);
        if (pairs.empty()) continue;
        for (Loop loop : solve_rig(3, pairs, judging).loops) {
          loop.sensors = {a, b, c};
          report.solution.loops.push_back(loop);
        }
      }
}

/// Why the joint pose does not take the place of a pair's: it states much more than the pair does, or
/// contradicts it. Empty: neither.
std::string why_not(const RigReport& report, std::size_t pair) {
  const ConsistentSet& set = report.solution.set;
  const std::size_t sensor = report.solution.pairs[pair].b;
  const std::array<double, 6>&joint = set.stddev[sensor], of_pair = stated_of(report.pairs[pair]);
  const Pose T = to_pose(set.poses[sensor]), &own = report.pairs[pair].T_a_b;
  std::array<double, 6> difference{};
  Eigen::Map<Eigen::Vector3d>(difference.data()) = T.translation - own.translation;
  Eigen::Map<Eigen::Vector3d>(difference.data() + 3) = rotation_log(T.rotation * own.rotation.conjugate());
  const RigOptions options;
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const auto size = [first](const std::array<double, 6>& x) {
      return Eigen::Map<const Eigen::Vector3d>(x.data() + first).norm();
    };
    if (!(size(joint) <= most_spread * size(of_pair)))
      return "the joint answer knows " + report.names[sensor] + " less well than the pairs alone do";
    const double least = first == 0 ? options.least_translation : options.least_rotation;
    for (std::size_t i = first; i < first + 3; ++i)
      if (std::abs(difference[i]) > least + agreeing_sigmas * std::hypot(joint[i], of_pair[i]))
        return "the joint answer contradicts the pair " + report.names[0] + " -> " + report.names[sensor];
  }
  return {};
}

}  // namespace

CommonMotions solve_jointly(const std::vector<Trajectory>& trajectories, const RigSettings& settings,
                            RigReport& report) {
  const Choice common = longest_choice(report);
  RigMotionsOptions options;
  options.stride = common.stride;
  options.balance = common.balance;
  options.max_gap = settings.pairs.front().calibration.pairing.max_gap;
  options.planes = settings.planes;
  options.screening = settings.pairs.front().calibration.pairing.screening;
  const std::vector<std::size_t> all = all_of(trajectories.size());
  CommonMotions motions;
  const double span = common_span(trajectories, all);
  if (span > 0) motions.pairs = motions_of(trajectories, all, options, report);
  if (!motions.pairs.empty()) {
    RigSolution solution = solve_rig(trajectories.size(), motions.pairs);
    report.solution.loops = std::move(solution.loops);
    report.solution.noise = std::move(solution.noise);
    report.solution.blamed = solution.blamed;
    report.solution.set = std::move(solution.set);
    motions.begin =
        to_seconds(motions.pairs.front().pairs.front().begin_us - trajectories.front().front().time_us);
  }
  judge_loops(trajectories, options, motions.pairs.empty() ? 0 : span, report);
  if (!motions.pairs.empty() && common.stride > 1) {
    options.stride = 1;
    motions.single_steps = motions_of(trajectories, all, options, report);
  }
  return motions;
}

void choose_tree(RigReport& report) {
  const ConsistentSet& set = report.solution.set;
  report.joint = false;
  const auto bad = std::find_if(report.unusable.begin(), report.unusable.end(),
                                [](const std::string& why) { return !why.empty(); });
  const auto is_planar = [](const Calibration& calibration) {
    return calibration.problem.mode == Mode::planar;
  };
  if (report.names.size() == 2)
    report.why_not_joint = "there is one pair only";
  else if (std::any_of(report.pairs.begin(), report.pairs.end(), is_planar))
    report.why_not_joint = "there is no joint answer in planar mode";
  else if (!report.unsolved.empty())
    report.why_not_joint = "not all pairs have an answer";
  else if (bad != report.unusable.end()) {
    const RigPairAnswer& pair =
        report.solution.pairs[static_cast<std::size_t>(bad - report.unusable.begin())];
    report.why_not_joint =
        fmt::format("the pair {} -> {} should not be used", report.names[pair.a], report.names[pair.b]);
  } else if (!set.solved || set.stddev.size() != report.names.size())
    report.why_not_joint = "there are no instants that all sensors were seen at";
  else
    for (std::size_t i = 0; i < report.pairs.size() && report.why_not_joint.empty(); ++i) {
      const std::array<bool, 6>& known = report.pairs[i].observability.observable;
      const RigPairAnswer& pair = report.solution.pairs[i];
      if (std::find(known.begin(), known.end(), false) != known.end())
        report.why_not_joint = fmt::format("the pair {} -> {} does not show every direction",
                                           report.names[pair.a], report.names[pair.b]);
      else if (pair.a == 0)
        report.why_not_joint = why_not(report, i);
    }
  report.joint = report.why_not_joint.empty();
}

}  // namespace egocal::tools
