// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/chord_copy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/streams/timed_poses.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// A pose of one stream, and the other one at its time: on the line between its neighbours there, and on the
/// line from the pose before to the one after these.
struct RowOnLines {
  DualQuaternion own, near, far;
};

/// Position and rotation interpolated by themselves, as a tree of frames does.
DualQuaternion on_line(const TimedPoses& stream, std::size_t from, std::size_t to, double time) {
  const Pose x = to_pose(stream.poses[from].pose), y = to_pose(stream.poses[to].pose);
  const double part = (time - stream.times[from]) / (stream.times[to] - stream.times[from]);
  return to_dual_quaternion(
      Pose{x.rotation.slerp(part, y.rotation), (1 - part) * x.translation + part * y.translation});
}

std::vector<RowOnLines> rows_on_lines(const TimedPoses& rows, const TimedPoses& others, double max_gap,
                                      const ChordCopyOptions& options) {
  std::vector<RowOnLines> result;
  const std::size_t each = (rows.poses.size() + options.looked_at - 1) / options.looked_at;
  std::size_t next = 0;  // the first of the others that is later than the row
  for (std::size_t i = 0; i < rows.poses.size(); ++i) {
    const double time = rows.times[i];
    while (next < others.poses.size() && others.times[next] <= time) ++next;
    if (i % each != 0 || next < 2 || next + 1 >= others.poses.size()) continue;
    const double before = others.times[next - 1], gap = others.times[next] - before;
    if (!(gap > 0) || gap > max_gap || time < before + options.from_ends * gap ||
        time > before + (1 - options.from_ends) * gap || !(others.times[next - 2] < before) ||
        !(others.times[next] < others.times[next + 1]))
      continue;
    result.push_back({rows.poses[i].pose, on_line(others, next - 1, next, time),
                      on_line(others, next - 2, next + 1, time)});
  }
  return result;
}

/// Whether the lines between neighbours leave far less of the motions than the longer lines do. Only the half
/// of the motions of which the longer lines leave more counts: of a sensor that stands nothing is left on
/// either. size: of the motions.
bool far_less(std::vector<std::pair<double, double>> far_and_near, double size,
              const ChordCopyOptions& options) {
  const std::size_t half = far_and_near.size() / 2;
  std::nth_element(far_and_near.begin(), far_and_near.begin() + static_cast<std::ptrdiff_t>(half),
                   far_and_near.end());
  std::vector<double> near, far;
  for (std::size_t i = half; i < far_and_near.size(); ++i) {
    far.push_back(far_and_near[i].first);
    near.push_back(far_and_near[i].second);
  }
  const double of_far = median(std::move(far)), of_near = median(std::move(near));
  return of_far > options.least * size && of_near <= options.digits * size &&
         of_near <= options.most * of_far;
}

/// Whether the rows of one stream lie on the lines between the poses of the other one.
bool lies_on_lines(const TimedPoses& rows, const TimedPoses& others, double max_gap,
                   const ChordCopyOptions& options) {
  const std::vector<RowOnLines> poses = rows_on_lines(rows, others, max_gap, options);
  if (poses.size() <= options.fewest) return false;
  std::vector<MotionPair> near, far;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    MotionPair motion;
    motion.b = conjugate(poses[i].own) * poses[i + 1].own;
    motion.a = conjugate(poses[i].near) * poses[i + 1].near;
    near.push_back(motion);
    motion.a = conjugate(poses[i].far) * poses[i + 1].far;
    far.push_back(motion);
  }
  const Motions on_near = motions_of(near), on_far = motions_of(far);
  const Pose T = to_pose(robust_fit(on_near).T);
  std::vector<std::pair<double, double>> rotations, translations;
  for (std::size_t i = 0; i < on_near.all.size(); ++i) {
    const Residual of_near = residual_at(on_near.all[i], T), of_far = residual_at(on_far.all[i], T);
    rotations.emplace_back(of_far.rotation, of_near.rotation);
    translations.emplace_back(of_far.translation, of_near.translation);
  }
  return far_less(std::move(rotations), 1, options) &&
         far_less(std::move(translations), on_near.translation, options);
}

}  // namespace

std::optional<Finding> chord_copy(const Trajectory& a, const Trajectory& b, const ClockModel& clock,
                                  double max_gap, const ChordCopyOptions& options) {
  if (a.empty() || b.empty()) return std::nullopt;
  const TimedPoses of_a{a, Times(a, a.front().time_us, ClockModel{})},
      of_b{b, Times(b, a.front().time_us, clock)};
  const bool b_on_a = lies_on_lines(of_b, of_a, max_gap, options);
  if (!b_on_a && !lies_on_lines(of_a, of_b, max_gap, options)) return std::nullopt;
  const char copy = b_on_a ? 'b' : 'a', original = b_on_a ? 'a' : 'b';
  Finding finding;
  finding.code = "same_stream";
  finding.certain = true;
  say(finding,
      format("The poses of %s lie on the straight lines between those of %s, moved by one transform",
             mark(copy), mark(original)),
      format("Give what the sensor of %s measured by itself.", mark(copy)),
      ": they were looked up in a tree of frames, and the answer is the transform that was put in there.");
  return finding;
}

}  // namespace egocal::detail
