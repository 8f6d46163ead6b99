// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "recording.hpp"

#include <chrono>
#include <optional>

#include "delivery.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/timed_log.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::monitor {

namespace {

constexpr double tick_s = 0.5;  // of the log, between two looks at what is overdue

}  // namespace

struct Recording::State {
  State(Model& shown, const std::string& file) : model(shown), delivery(shown), log(file) {}
  Model& model;
  Delivery delivery;
  bus::TimedLog log;
  std::optional<bus::LogEvent> next;
  std::uint64_t damaged_regions = 0;  ///< already reported
  double speed = 0;
  std::int64_t first_us = 0, time_us = 0, ticked_us = 0;
  std::optional<std::int64_t> started_mono_us;
};

Recording::Recording(Model& model, const std::string& file, double speed)
    : state_(std::make_unique<State>(model, file)) {
  State& s = *state_;
  s.next = s.log.next();
  s.speed = speed;
  s.first_us = s.time_us = s.ticked_us = s.next->time_us;
}

Recording::~Recording() = default;

bool Recording::at_end() const {
  return !state_->next;
}

Now Recording::advance(std::int64_t mono_us) {
  State& s = *state_;
  Model& model = s.model;
  if (!s.started_mono_us) s.started_mono_us = mono_us;
  const double due_s = to_seconds(mono_us - *s.started_mono_us) * s.speed;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  while (s.next) {
    // a log made of two may step back in time; the session then continues at its time
    const std::int64_t stamp = std::max(s.next->time_us, s.time_us);
    if (s.speed > 0 && seconds_between(s.first_us, stamp) > due_s) break;
    s.time_us = stamp;
    const Now now{s.time_us, s.time_us};
    if (seconds_between(s.ticked_us, s.time_us) >= tick_s) {
      s.ticked_us = s.time_us;
      model.tick(now);
    }
    s.delivery.deliver(s.next->channel, s.next->data, now);
    s.next = s.log.next();
    const bus::LogDamage& damage = s.log.damage();
    if (damage.regions > s.damaged_regions) {
      s.damaged_regions = damage.regions;
      model.note(Severity::warning, "log",
                 "damaged here: " + std::to_string(damage.bytes) + " bytes lost so far" +
                     (damage.truncated ? ", and cut off" : ""),
                 now);
    }
    if (std::chrono::steady_clock::now() > until) break;
  }
  return {s.time_us, s.time_us};
}

}  // namespace egocal::monitor
