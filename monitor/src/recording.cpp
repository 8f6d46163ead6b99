// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "recording.hpp"

#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <optional>

#include "egocal/error.hpp"
#include "feed.hpp"

namespace egocal::monitor {

struct Recording::State {
  explicit State(const std::string& file) : log(file, "r") {}
  lcm::LogFile log;
  const lcm::LogEvent* next = nullptr;
  double speed = 0;
  std::int64_t first_us = 0, time_us = 0, ticked_us = 0;
  std::optional<std::int64_t> started_mono_us;
};

Recording::Recording(const std::string& file, double speed) : state_(std::make_unique<State>(file)) {
  State& s = *state_;
  s.next = s.log.good() ? s.log.readNextEvent() : nullptr;
  if (s.next == nullptr) throw Error(file + ": holds no LCM log event");
  s.speed = speed;
  s.first_us = s.time_us = s.ticked_us = s.next->timestamp;
}

Recording::~Recording() = default;

bool Recording::at_end() const {
  return state_->next == nullptr;
}

Now Recording::advance(Model& model, std::int64_t mono_us) {
  State& s = *state_;
  if (!s.started_mono_us) s.started_mono_us = mono_us;
  const double due_us = static_cast<double>(mono_us - *s.started_mono_us) * s.speed;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  while (s.next != nullptr) {
    // a log stitched together from two may step back in time; the session goes on where it was
    const std::int64_t stamp = std::max(s.next->timestamp, s.time_us);
    if (s.speed > 0 && static_cast<double>(stamp - s.first_us) > due_us) break;
    s.time_us = stamp;
    const Now now{s.time_us, s.time_us};
    if (s.time_us - s.ticked_us >= 500000) {
      s.ticked_us = s.time_us;
      model.tick(now);
    }
    const std::span<const std::byte> bytes(static_cast<const std::byte*>(s.next->data),
                                           static_cast<std::size_t>(s.next->datalen));
    if (!deliver(model, s.next->channel, bytes, now))
      model.note(Severity::warning, s.next->channel, "a message that could not be decoded: another version?",
                 now);
    s.next = s.log.readNextEvent();
    if (std::chrono::steady_clock::now() > until) break;
  }
  return {s.time_us, s.time_us};
}

}  // namespace egocal::monitor
