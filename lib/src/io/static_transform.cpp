// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/static_transform.hpp"

#include <cstdio>

#include "egocal/degrees.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/printable.hpp"

namespace egocal::detail {

namespace {

/// "57.296 deg and 1.0000 m"; empty: the two are equal up to the six digits that launch files hold.
std::string difference(const DualQuaternion& one, const DualQuaternion& other) {
  constexpr double rounding = 1e-5;  // [m, rad]
  const Pose change = to_pose(conjugate(one) * other);
  const double turn = rotation_log(change.rotation).norm(), way = change.translation.norm();
  if (turn < rounding && way < rounding) return {};
  char text[64];
  std::snprintf(text, sizeof text, "%.3f deg and %.4f m", turn * degrees_per_radian, way);
  return text;
}

}  // namespace

void StaticTransform::add(const RecordedStream& stream, const StampedPose& value) {
  if (!stream.fixed) return;
  const bool reversed = stream.parent == stream_.child && stream.child == stream_.parent;
  if (stream.name != stream_.name) {
    if (!reversed && (stream.parent != stream_.parent || stream.child != stream_.child)) return;
    elsewhere_ = {{value.time_us, reversed ? conjugate(value.pose) : value.pose}};
    other_topic_ = stream.topic;
    return;
  }
  const std::string changed = newest_.empty() ? std::string() : difference(newest_.front().pose, value.pose);
  if (!changed.empty() && changes_++ == 0) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f s", to_seconds(value.time_us));
    first_change_ = std::string("at ") + text + " by " + changed;
  }
  newest_ = {value};
}

std::string StaticTransform::contradiction() const {
  const std::string name =
      "the static transform " + printable(stream_.parent) + " to " + printable(stream_.child);
  if (changes_ > 0)
    return name + " changes " + (changes_ == 1 ? "" : std::to_string(changes_) + " times, first ") +
           first_change_ + ": its last value is used for the whole drive";
  if (newest_.empty() || elsewhere_.empty()) return {};
  const std::string other = difference(newest_.front().pose, elsewhere_.front().pose);
  if (other.empty()) return {};
  return name + " is another one on " + printable(other_topic_) + ", by " + other + ": that of " +
         printable(stream_.topic) + " is used";
}

}  // namespace egocal::detail
