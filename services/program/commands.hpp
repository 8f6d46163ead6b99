// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "egocal/bus/heartbeat.hpp"

namespace egocal::services {

enum class Verb { reset, pause, resume };

/// Hands on the commands for this process: addressed to its name or "*", with a known verb and plausible
/// names. Other commands are counted as rejected.
void hear_commands(bus::Loop& loop, bus::Heartbeat& heartbeat,
                   std::function<void(Verb, const command_t&)> callback);

/// Whether a command concerns this pair: it names both sensors, or no pair, which means all pairs. A reset
/// must also name this session, or none.
bool means(const command_t& command, Verb verb, const std::string& sensor_a, const std::string& sensor_b,
           std::int64_t session);

/// Why a command that this process does not know is rejected.
inline const std::string not_understood = "command not understood";

/// Why a command that means no pair at all is rejected.
inline const std::string not_meant = "command for another session or pair";

}  // namespace egocal::services
