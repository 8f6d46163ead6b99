// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Why messages are not used, and what cures it, in words.
#include <cmath>
#include <cstdio>
#include <map>

#include "egocal/bus/decode.hpp"
#include "egocal/bus/stream_watch.hpp"
#include "egocal/limits.hpp"

namespace egocal::bus {

namespace {

std::string rig_name(OdometryType type) {
  return type == OdometryType::pose ? "bot_core.pose_t" : "egocal.odometry_t";
}

std::string text(const char* format, double value) {
  char line[200];
  std::snprintf(line, sizeof line, format, value);
  return line;
}

/// The values of a message that are refused most often.
struct Values {
  double utime = 0;
  double pos[3]{}, quat[4]{};
};

Values values_of(OdometryType type, Bytes bytes) {
  Values values;
  const auto take = [&](std::int64_t utime, const double(&pos)[3], const double(&quat)[4]) {
    values.utime = static_cast<double>(utime);
    for (int i = 0; i < 3; ++i) values.pos[i] = pos[i];
    for (int i = 0; i < 4; ++i) values.quat[i] = quat[i];
  };
  if (odometry_t message{}; type == OdometryType::odometry && decode(bytes, message))
    take(message.utime, message.pos, message.quat);
  if (bot_core::pose_t message{}; type == OdometryType::pose && decode(bytes, message))
    take(message.utime, message.pos, message.orientation);
  return values;
}

std::string cure_of_time(double utime) {
  // a date of this century in nanoseconds
  if (utime > 1e17 && utime < 4.2e18)
    return text("times %.3g us: nanoseconds? Send microseconds, divide by 1000.", utime);
  if (utime < 0) return text("times %.3g us: before 1970. Is the clock of the sensor set?", utime);
  return text("times %.3g us: after 2100. Send microseconds since 1970, or since the start.", utime);
}

std::string cure_of_quaternion(const double (&quat)[4]) {
  const double norm =
      std::sqrt(quat[0] * quat[0] + quat[1] * quat[1] + quat[2] * quat[2] + quat[3] * quat[3]);
  if (norm == 0) return "the quaternion is 0 0 0 0: the field is not filled. Send w x y z of unit length.";
  return text("the quaternion (w x y z) has length %.3g: send it of unit length.", norm);
}

}  // namespace

std::string cure_of(const std::string& reason, OdometryType type, Bytes bytes) {
  const Values values = values_of(type, bytes);
  if (reason == "not decodable") {
    const std::string heard = type_name(bytes);
    if (heard == "unknown type")
      return "neither " + rig_name(type) +
             " nor any type of ours: another version of the .lcm file, or damaged.";
    if (heard == rig_name(type)) return "damaged on the way.";
    return "it carries " + heard + ", the rig file says " + rig_name(type) +
           (is_a<odometry_t>(bytes) || is_a<bot_core::pose_t>(bytes)
                ? ": set type = \"" + heard + "\" for this sensor."
                : ": is it the channel of another program?");
  }
  if (reason == "time out of range") return cure_of_time(values.utime);
  if (reason == "position not finite" || reason == "quaternion not finite")
    return "the odometry sends NaN or infinity: it has lost track, or is not initialised.";
  if (reason == "position out of range")
    return text("a position of %.3g m: check the unit, and whether the field is initialised.", values.pos[0]);
  if (reason == "quaternion not of unit length") return cure_of_quaternion(values.quat);
  if (reason == "sequence number out of range")
    return "seq counts up by one per message; -1 where the source does not count.";
  if (reason == "covariance of the wrong size")
    return "covariance_size is 36, or 0 where the odometry knows none.";
  if (reason == "covariance not finite") return "send covariance_size = 0 where the covariance is not known.";
  return "see docs/wire.md.";
}

std::string cure_of_rejection(const std::string& reason) {
  static const std::map<std::string, std::string> cures{
      {"duplicate",
       "a message or its time came twice: a player sent it again, two senders, a network loop, or stamps "
       "that repeat."},
      {"too late",
       "it came after newer ones had been used: two senders on one channel, or messages that are late by "
       "more "
       "than reorder_window in the rig file."},
      {"time or number jumps", "stamps or sequence numbers leap: check the clock of the sender."},
      {std::string(to_string(Rejection::not_finite)), "the odometry sends values that are no poses."},
      {std::string(to_string(Rejection::out_of_order)),
       "poses come out of order: send them in order of time."},
      {std::string(to_string(Rejection::no_partner)),
       "the other sensor has no pose at that time: it is silent, or the clocks differ (time_offset = "
       "\"auto\")."},
      {std::string(to_string(Rejection::gap)),
       "poses are further apart than max_gap in the rig file: a slow or interrupted stream."},
      {std::string(to_string(Rejection::frozen)),
       "one odometry repeats the same pose while the other one moves: it has stopped working, or is sent "
       "more often than it is computed (send each pose once)."},
      {std::string(to_string(Rejection::screw_congruence)),
       "motions of the two sensors differ by more than noise: outliers, clocks apart, or a loose mount."},
      {std::string(to_string(Rejection::too_much_rotation)),
       "half a turn within one motion: send poses more often, or set a smaller stride."},
      {"status out of range", "a heartbeat that no process of ours sends."},
      {"command not understood", "a command with an unknown verb: another version of egocal?"}};
  const auto cure = cures.find(reason);
  return cure == cures.end() ? std::string() : cure->second;
}

}  // namespace egocal::bus
