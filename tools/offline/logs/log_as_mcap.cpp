// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/logs/log_as_mcap.hpp"

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/error.hpp"
#include "egocal/io/mcap_writer.hpp"
#include "egocal/printable.hpp"
#include "offline/reading/lcm_pose.hpp"
#include "progress.hpp"

namespace egocal::tools {

namespace {

/// Solvers send their answer again once a second: the pair's last one is written once.
class NewAnswers {
 public:
  bool is_new(const calibration_t& answer) {
    const Sent sent{answer.session,
                    answer.seq,
                    answer.utime,
                    {answer.pos, answer.pos + 3},
                    {answer.quat, answer.quat + 4}};
    const auto [last, first] = last_.try_emplace({answer.sensor_a, answer.sensor_b, answer.solver}, sent);
    if (first) return true;
    return std::exchange(last->second, sent) != sent;
  }

 private:
  using Sent = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::vector<double>, std::vector<double>>;
  std::map<std::array<std::string, 3>, Sent> last_;
};

}  // namespace

McapOfLog log_as_mcap(const std::string& file, const std::string& out) {
  bus::LogReader log(file);
  McapWriter mcap(out);
  Progress progress("writing");
  McapOfLog written;
  NewAnswers answers;
  while (const auto event = log.next()) {
    const std::string name = bus::printable(event->channel, 63);
    calibration_t calibration{};
    if (const LcmPose message = decode_lcm_pose(event->data, event->time_us); !message.type.empty()) {
      if (!message.pose) {
        ++written.refused;
        continue;
      }
      mcap.write_pose("/" + name, name + "_start", *message.pose.value);
      mcap.write_transform(name + "_start", name, *message.pose.value);
      ++written.poses;
    } else if (bus::decode(event->data, calibration)) {
      const bus::Checked<Answer> answer = bus::to_answer(calibration);
      if (!answer) {
        ++written.refused;
        continue;
      }
      if (!answers.is_new(calibration)) continue;
      mcap.write_transform(bus::printable(calibration.sensor_a, 63), bus::printable(calibration.sensor_b, 63),
                           {calibration.utime, answer.value->T_a_b});
      ++written.transforms;
    }
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  if (written.poses + written.transforms == 0)
    throw error_at(file, 0, "", "holds neither poses nor calibrations");
  mcap.close();
  written.damage = log.damage();
  return written;
}

}  // namespace egocal::tools
