// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is in a log, and how damaged it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "egocal/bus/log_file.hpp"

namespace egocal::tools {

struct LogChannel {
  std::uint64_t events = 0, bytes = 0;
  std::int64_t first_us = 0, last_us = 0;
  std::string type;  ///< of its first message; empty: unknown
};

/// A limit on memory: a damaged or hostile log may hold a million channels.
inline constexpr std::size_t most_channels = 1000;

struct LogContent {
  std::map<std::string, LogChannel> channels;
  LogChannel others;  ///< events of channels beyond most_channels
  bool more_channels = false;
  bus::LogDamage damage;
  std::uint64_t size = 0;  ///< of the file [bytes]
};

/// Reads all of a log. Throws Error where it cannot be opened or read.
LogContent content_of_log(const std::string& file);

/// Writes all events of a log that can be read to a new one, whole or not at all; out may be the log itself.
struct RepairedLog {
  std::uint64_t events = 0;
  bus::LogDamage damage;  ///< of the log as it was
};
RepairedLog repair_log(const std::string& file, const std::string& out);

/// "no damage", or what is lost, of what people read.
std::string damage_text(const bus::LogDamage& damage);

}  // namespace egocal::tools
