// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "delivery.hpp"

#include <string_view>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/bus/pair_messages.hpp"
#include "egocal/bus/verdict.hpp"

namespace egocal::monitor {

void Delivery::deliver(const std::string& channel, std::span<const std::byte> bytes, Now now) {
  const auto decoded = [&](auto& message) {
    if (bus::decode(bytes, message)) return true;
    model_.note(Severity::warning, channel, "a message that could not be decoded: another version?", now);
    return false;
  };
  // names that are damaged or sent by another program must not appear as another pair
  const auto of_channel = [&](const auto& message) {
    if (channel == bus::channel_of(message)) return true;
    model_.note(Severity::warning, channel, "a message of another pair is refused", now);
    return false;
  };
  if (channel.starts_with(bus::problem_prefix)) {
    problem_t message{};
    if (decoded(message) && of_channel(message)) problem(message, now);
  } else if (channel.starts_with(bus::calibration_prefix)) {
    calibration_t message{};
    if (decoded(message) && of_channel(message)) calibration(message, now);
  } else if (channel.starts_with(bus::verdict_prefix)) {
    verdict_t message{};
    if (decoded(message) && of_channel(message)) verdict(message, now);
  } else if (channel.starts_with(bus::scale_problem_prefix)) {
    scale_problem_t message{};
    if (decoded(message) && of_channel(message)) scale_problem(message, now);
  } else if (channel.starts_with(bus::scale_prefix)) {
    scale_t message{};
    if (decoded(message) && of_channel(message)) scale(message, now);
  } else if (channel == bus::status_channel) {
    status_t message{};
    if (decoded(message)) model_.on_status(message, now);
  } else if (channel == bus::command_channel) {
    command_t message{};
    if (decoded(message)) model_.on_command(message, now);
  }
}

void Delivery::problem(const problem_t& message, Now now) {
  const std::string refused = answers_.take(message);
  if (refused.empty())
    model_.on_problem(message, now);
  else
    model_.note(Severity::warning, pair_name(message.sensor_a, message.sensor_b),
                "a problem is refused: " + refused, now);
}

void Delivery::calibration(calibration_t& message, Now now) {
  const bus::CheckedAnswer checked = answers_.check(message);
  if (checked.standing == bus::Standing::refused) {
    model_.note(Severity::bad, pair_name(message.sensor_a, message.sensor_b),
                "an answer of " + message.solver + " is refused: " + checked.reason, now);
    return;
  }
  bus::set_certificate(checked, message);
  model_.on_calibration(message, now, checked.standing == bus::Standing::verified);
}

void Delivery::verdict(const verdict_t& message, Now now) {
  const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
  const std::string refused = received ? answers_.refusal(message, *received.value) : received.reason;
  if (refused.empty())
    model_.on_verdict(message, *received.value, now);
  else
    model_.note(Severity::warning, pair_name(message.sensor_a, message.sensor_b),
                "a verdict of " + message.sender + " is refused: " + refused, now);
}

void Delivery::scale_problem(const scale_problem_t& message, Now now) {
  if (const std::string refused = scales_.take(message); !refused.empty())
    model_.note(Severity::warning, pair_name(message.sensor_a, message.sensor_b),
                "a scale problem is refused: " + refused, now);
}

void Delivery::scale(const scale_t& message, Now now) {
  const std::string refused = scales_.take(message);
  if (!refused.empty())
    model_.note(Severity::warning, pair_name(message.sensor_a, message.sensor_b),
                "a scale of " + message.solver + " is refused: " + refused, now);
  else if (const bus::CheckedScale* checked =
               scales_.find(message.sensor_a, message.sensor_b, message.session))
    model_.on_scale(message, *checked, now);
}

}  // namespace egocal::monitor
