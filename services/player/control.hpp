// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace egocal::services {

/// A request of the user to the player, by a key or by a command on the bus.
struct Control {
  enum class Verb { pause, resume, toggle, step, seek, skip, speed, faster, quit };
  Verb verb;
  /// seek: time of the log [s]; skip: time forwards [s]; speed: times real time; faster: factor of the speed.
  double value = 0;
};

/// "pause", "resume", "step", "seek 12.5", "speed 4": the verbs of a command_t. Empty: not one of them.
std::optional<Control> control_from_text(const std::string& text);

/// Keys of a terminal, one byte at a time: space pauses and resumes, "." steps, the arrows left and right go
/// 5 s back and forth, + and - double and halve the speed, "12.5g" goes to 12.5 s, "4x" is speed 4, q quits.
class Keys {
 public:
  std::optional<Control> feed(char byte);
  /// The number typed so far.
  const std::string& number() const { return number_; }

 private:
  std::string number_, escape_;
};
constexpr const char* keys_help =
    "space pause, . step, left/right 5 s, +/- speed, 12.5g go to 12.5 s, 4x speed 4, q quit";

}  // namespace egocal::services
