// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Code of a simulated process: the services themselves, and the few lines of their main().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "answers/answers.hpp"
#include "delivery.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/monitor/model.hpp"
#include "simulation/drive.hpp"
#include "simulation/schedule.hpp"

namespace egocal::simulation {

/// What egocal-monitor knows, without its terminal.
class Watcher {
 public:
  Watcher(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig);
  const monitor::Model& model() const { return model_; }

 private:
  monitor::Model model_;
  monitor::Delivery delivery_{model_};
};

/// `egocal export`: what it receives, and the answer that it would choose.
class Exporter {
 public:
  Exporter(bus::Loop& loop, const bus::Rig& rig);
  const tools::Answers& answers() const { return answers_; }

 private:
  tools::Answers answers_;
};

/// Live odometry of one sensor: sends each message once, when it is measured. A process that starts late or
/// again continues with the current measurement.
class Odometry {
 public:
  Odometry(bus::Loop& loop, const Schedule& schedule, const Drive& drive, std::size_t channel);

 private:
  void send_next();
  bus::Loop& loop_;
  const Schedule& schedule_;
  const Drive& drive_;
  std::size_t channel_;
  std::size_t next_ = 0;
};

}  // namespace egocal::simulation
