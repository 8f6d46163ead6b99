// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/control.hpp"

#include <charconv>
#include <cmath>
#include <utility>

namespace egocal::services {

namespace {

constexpr double skip_s = 5;        // of the keys left and right, docs/processes.md [s]
constexpr double most_s = 1e9;      // [s]
constexpr double most_speed = 1e6;  // as --speed

std::optional<double> parsed(const std::string& text, double most) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= most))
    return std::nullopt;
  return value;
}

}  // namespace

std::optional<Control> control_from_text(const std::string& text) {
  using Verb = Control::Verb;
  if (text == "pause") return Control{Verb::pause};
  if (text == "resume") return Control{Verb::resume};
  if (text == "step") return Control{Verb::step};
  const auto argument = [&text](const std::string& verb, double most) {
    return text.rfind(verb, 0) == 0 ? parsed(text.substr(verb.size()), most) : std::nullopt;
  };
  if (const auto seconds = argument("seek ", most_s)) return Control{Verb::seek, *seconds};
  if (const auto speed = argument("speed ", most_speed)) return Control{Verb::speed, *speed};
  return std::nullopt;
}

std::optional<Control> Keys::feed(char byte) {
  using Verb = Control::Verb;
  if (byte == '\x1b') {
    escape_ = byte;
    return std::nullopt;
  }
  if (!escape_.empty()) {  // escape [ C, or escape O C where the keypad sends so
    escape_ += byte;
    if (escape_.size() == 2 && (byte == '[' || byte == 'O')) return std::nullopt;
    escape_.clear();
    if (byte == 'C') return Control{Verb::skip, skip_s};
    if (byte == 'D') return Control{Verb::skip, -skip_s};
    return std::nullopt;
  }
  if ((byte >= '0' && byte <= '9') || byte == '.') {
    if (byte == '.' && number_.empty()) return Control{Verb::step};
    if (number_.size() < 12) number_ += byte;
    return std::nullopt;
  }
  const std::string typed = std::exchange(number_, {});
  switch (byte) {
    case ' ':
      return Control{Verb::toggle};
    case 's':
      return Control{Verb::step};
    case '+':
      return Control{Verb::faster, 2};
    case '-':
      return Control{Verb::faster, 0.5};
    case 'g':
      if (const auto value = parsed(typed, most_s)) return Control{Verb::seek, *value};
      return std::nullopt;
    case 'x':
      if (const auto value = parsed(typed, most_speed)) return Control{Verb::speed, *value};
      return std::nullopt;
    case 'q':
      return Control{Verb::quit};
    default:
      return std::nullopt;
  }
}

}  // namespace egocal::services
