// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A file through the reader of logs; what it read makes a log without damage.
#include <vector>

#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"
#include "require.hpp"
#include "support/in_memory_file.hpp"

namespace {

using namespace egocal;
using fuzz::require;

constexpr std::size_t header_size = 28;

void put(std::vector<unsigned char>& out, std::uint64_t value, int count) {
  for (int i = count; i > 0; --i) out.push_back(static_cast<unsigned char>(value >> (8 * (i - 1))));
}

std::vector<bus::LogEvent> events_of(bus::LogReader& log) {
  std::vector<bus::LogEvent> events;
  std::uint64_t bytes = 0, position = 0;
  while (auto event = log.next()) {
    bytes += header_size + event->channel.size() + event->data.size();
    require(log.position() > position && log.position() <= log.size(), "the reader goes on");
    position = log.position();
    events.push_back(std::move(*event));
  }
  require(bytes + log.damage().bytes == log.size(), "every byte is read or counted as lost");
  require(log.position() == log.size(), "the end is the end of the file");
  require((log.damage().bytes == 0) == (log.damage().regions == 0), "what is lost is lost somewhere");
  return events;
}

bool equal(const std::vector<bus::LogEvent>& x, const std::vector<bus::LogEvent>& y) {
  if (x.size() != y.size()) return false;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i].time_us != y[i].time_us || x[i].channel != y[i].channel || x[i].data != y[i].data) return false;
  return true;
}

/// Whether the log could just as well continue inside of its last event, which would then have a damaged
/// length: there is an event with the next number, and it ends with the last one or is followed by a higher
/// number. The same bytes are two logs then, and the reader takes the one that saves more events.
bool has_two_readings(const std::vector<unsigned char>& bytes, std::size_t last, std::int64_t next_number) {
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
    return value;
  };
  bool goes_on = false;
  for (std::size_t at = last + header_size; at + header_size <= bytes.size(); ++at) {
    if (number(at, 4) != 0xEDA1DA01) continue;
    const auto event = static_cast<std::int64_t>(number(at + 4, 8));
    if (goes_on && event > next_number) return true;
    if (event != next_number) continue;
    goes_on = true;
    if (at + header_size + number(at + 20, 4) + number(at + 24, 4) == bytes.size()) return true;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::InMemoryFile input, repaired;
  input.set(data, size);
  try {
    bus::LogReader log(input.name());
    const std::vector<bus::LogEvent> events = events_of(log);
    require(!events.empty(), "a log has an event");
    if (!log.damage().any()) return 0;
    log.rewind();
    require(equal(events, events_of(log)), "a log reads the same again");

    std::vector<unsigned char> bytes;
    std::int64_t number = 0;
    std::size_t last = 0;
    for (const bus::LogEvent& event : events) {
      last = bytes.size();
      put(bytes, 0xEDA1DA01, 4);
      put(bytes, static_cast<std::uint64_t>(number++), 8);
      put(bytes, static_cast<std::uint64_t>(event.time_us), 8);
      put(bytes, event.channel.size(), 4);
      put(bytes, event.data.size(), 4);
      bytes.insert(bytes.end(), event.channel.begin(), event.channel.end());
      for (const std::byte b : event.data) bytes.push_back(std::to_integer<unsigned char>(b));
    }
    if (has_two_readings(bytes, last, number)) return 0;
    repaired.set(bytes.data(), bytes.size());
    bus::LogReader again(repaired.name());
    require(equal(events, events_of(again)), "a repaired log holds the same events");
    require(!again.damage().any(), "a repaired log has no damage");
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
