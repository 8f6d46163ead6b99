// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "egocal/bus/heartbeat.hpp"

namespace egocal::services {

enum class Verb { reset, pause, resume };

/// Hands on the commands that are meant for this process: its name or "*", a known verb, names that make
/// sense. What is not understood is counted as rejected.
void hear_commands(bus::Loop& loop, bus::Heartbeat& heartbeat,
                   std::function<void(Verb, const command_t&)> callback);

/// Whether a command means this pair: both names, or none for all pairs; and of a reset, whether it means
/// this session.
bool means(const command_t& command, Verb verb, const std::string& sensor_a, const std::string& sensor_b,
           std::int64_t session);

/// Why a command that this process does not know is rejected.
inline const std::string not_understood = "command not understood";

/// Why a command that means no pair at all is rejected.
inline const std::string not_meant = "command for another session or pair";

}  // namespace egocal::services
