// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a process is and what it does, as its heartbeats say it.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "egocal/status_t.hpp"

namespace egocal::bus {

enum class Role { player, pairing, global, fast, diagnosis, monitor };

enum class State {
  waiting,  ///< cannot work yet, or lets another process of its name work
  standby,  ///< healthy, with nothing to do: steps in when it is needed
  running,
  paused,
  ended,
};

/// The names of roles and states, as status_t carries them.
std::string_view role_name(Role role);
std::string_view state_name(State state);
/// The role or state of a name; empty: it is one of another version.
std::optional<Role> role_from_name(std::string_view name);
std::optional<State> state_from_name(std::string_view name);

/// Counter of a status before a long computation: for so long this process may be silent [s], see
/// Heartbeat::announce_silence(). The next status does not have it.
constexpr std::string_view announced_silence_counter = "silent for up to";
/// The longest silence that is believed: a limit, a status may say anything.
constexpr std::chrono::seconds longest_announced_silence{60};
/// For how long after this status its sender may be silent because it computes; 0: it announces nothing.
std::chrono::seconds announced_silence(const status_t& status);

/// Whether a process of this role does anything on a command_t with this verb ("seek 3": seek). Listeners
/// alone (monitor, up, export) obey none.
bool knows_verb(Role role, std::string_view verb);
/// The verbs that a process of this role knows, for messages: "pause, resume, reset"; empty: none.
std::string verbs_of(Role role);

}  // namespace egocal::bus
