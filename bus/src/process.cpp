// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/process.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace egocal::bus {

namespace {

constexpr std::array<std::string_view, 6> roles{"player", "pairing",   "global",
                                                "fast",   "diagnosis", "monitor"};
constexpr std::array<std::string_view, 5> states{"waiting", "standby", "running", "paused", "ended"};

/// The verbs of each role, in the order of Role. The diagnosis has no verb reset: it follows the session of
/// the problems by itself.
constexpr std::array<std::string_view, 6> verbs{"pause, resume, step, seek, speed",
                                                "pause, resume, reset",
                                                "pause, resume",
                                                "pause, resume, reset",
                                                "pause, resume",
                                                ""};

template <class Enum, std::size_t n>
std::optional<Enum> from_name(const std::array<std::string_view, n>& names, std::string_view name) {
  for (std::size_t i = 0; i < n; ++i)
    if (names[i] == name) return static_cast<Enum>(i);
  return std::nullopt;
}

}  // namespace

std::string_view role_name(Role role) {
  return roles[static_cast<std::size_t>(role)];
}

std::string_view state_name(State state) {
  return states[static_cast<std::size_t>(state)];
}

std::optional<Role> role_from_name(std::string_view name) {
  return from_name<Role>(roles, name);
}

std::optional<State> state_from_name(std::string_view name) {
  return from_name<State>(states, name);
}

std::chrono::seconds announced_silence(const status_t& status) {
  const auto found =
      std::find_if(status.counters.begin(), status.counters.end(),
                   [](const counter_t& counter) { return counter.name == announced_silence_counter; });
  if (found == status.counters.end()) return std::chrono::seconds{0};
  return std::chrono::seconds{std::clamp<std::int64_t>(found->value, 0, longest_announced_silence.count())};
}

bool knows_verb(Role role, std::string_view verb) {
  const std::string known = ", " + verbs_of(role) + ",";
  return !verb.empty() && known.find(", " + std::string(verb) + ",") != std::string::npos;
}

std::string verbs_of(Role role) {
  return std::string(verbs[static_cast<std::size_t>(role)]);
}

}  // namespace egocal::bus
