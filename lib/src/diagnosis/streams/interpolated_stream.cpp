// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/interpolated_stream.hpp"

#include <algorithm>
#include <string>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::detail {

namespace {

struct Lines {
  std::size_t moving = 0, straight = 0, corners = 0;  ///< poses
  double seconds = 0;                                 ///< that they take

  double part() const { return moving > 0 ? static_cast<double>(straight) / static_cast<double>(moving) : 0; }
  /// Lines have ends. What moves evenly is nearly straight everywhere, and no more elsewhere.
  bool end() const { return 2 * corners > moving - straight; }
  double rate() const { return seconds > 0 ? static_cast<double>(moving - straight) / seconds : 0; }
};

/// Lines of whole poses, of positions alone and of rotations alone.
struct Kinds {
  Lines poses, positions, rotations;
};

Kinds lines_of(const Trajectory& poses, const InterpolatedStreamOptions& options) {
  Kinds kinds;
  const std::size_t n = poses.size(), count = std::min(n, options.most), first = (n - count) / 2;
  for (std::size_t i = first + 1; i + 1 < first + count; ++i) {
    const std::optional<Bends> bends = bends_at(poses, i, options);
    if (!bends) continue;
    const auto count_in = [&](Lines& lines, const Bend& bend) {
      if (bend.rests) return;
      lines.seconds += bends->seconds;
      ++lines.moving;
      lines.straight += bend.bent < 1 ? 1 : 0;
      lines.corners += bend.bent > options.corner ? 1 : 0;
    };
    count_in(kinds.poses, bends->pose);
    count_in(kinds.positions, bends->position);
    count_in(kinds.rotations, bends->rotation);
  }
  return kinds;
}

}  // namespace

std::optional<Bends> bends_at(const Trajectory& poses, std::size_t i,
                              const InterpolatedStreamOptions& options) {
  const double before = to_seconds(poses[i].time_us - poses[i - 1].time_us),
               after = to_seconds(poses[i + 1].time_us - poses[i].time_us);
  if (!(before > 0 && after > 0)) return std::nullopt;
  const Pose x = to_pose(poses[i - 1].pose), y = to_pose(poses[i].pose), z = to_pose(poses[i + 1].pose);
  const double ratio = before / after;
  const Eigen::Vector3d moved = y.translation - x.translation, moves = z.translation - y.translation;
  const Eigen::Vector3d turned = rotation_log(x.rotation.conjugate() * y.rotation),
                        turns = rotation_log(y.rotation.conjugate() * z.rotation);
  // digits of the three poses, and of coordinates of a map
  const double digits = options.digits * std::max(1.0, ratio) + options.rounding * y.translation.norm();
  const auto bend = [&](const Eigen::Vector3d& here, const Eigen::Vector3d& next) {
    return (ratio * next - here).norm() / (options.straight * here.norm() + digits);
  };
  const auto rests = [&](double motion) { return motion < 10 * digits; };
  const double moved_on = bend(moved, moves), turned_on = bend(turned, turns);
  // position and rotation by themselves, or along a screw
  const double along_screw = bend(x.rotation.conjugate() * moved, y.rotation.conjugate() * moves);
  return Bends{
      {std::max(turned_on, std::min(moved_on, along_screw)), rests(std::max(moved.norm(), turned.norm()))},
      {moved_on, rests(moved.norm())},
      {turned_on, rests(turned.norm())},
      before};
}

std::vector<Finding> interpolated_streams(const Trajectory& a, const Trajectory& b,
                                          const InterpolatedStreamOptions& options) {
  if (std::min(a.size(), b.size()) < options.least) return {};
  const Kinds of_a = lines_of(a, options), of_b = lines_of(b, options);
  struct Kind {
    Lines Kinds::*lines;
    const char* name;
  };
  for (const auto& [kind, name] : {Kind{&Kinds::poses, "poses"}, Kind{&Kinds::positions, "positions"},
                                   Kind{&Kinds::rotations, "rotations"}})
    for (const char which : {'a', 'b'}) {
      const Lines &lines = (which == 'a' ? of_a : of_b).*kind, &other = (which == 'a' ? of_b : of_a).*kind;
      if (lines.moving < options.least || lines.part() < options.part || !lines.end() ||
          other.part() > options.other_part)
        continue;
      Finding finding;
      finding.code = std::string("undersampled_") + which;
      finding.certain = true;
      say(finding,
          format("Of the %s of %s %.0f %% lie on straight lines between about %.1f %s a second: they were "
                 "interpolated before, and what its sensor did between those is lost.",
                 name, mark(which), 100 * lines.part(), lines.rate(), name),
          format("Give the %s of %s as they were measured, at their own times.", name, mark(which)));
      return {finding};
    }
  return {};
}

}  // namespace egocal::detail
