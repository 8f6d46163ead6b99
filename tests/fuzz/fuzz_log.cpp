// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A file through the reader of logs; what it read makes a log without damage.
#include <algorithm>
#include <array>
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

bool holds_sync_word(const bus::LogEvent& event) {
  const std::array<std::byte, 4> word{std::byte{0xED}, std::byte{0xA1}, std::byte{0xDA}, std::byte{0x01}};
  return std::search(event.data.begin(), event.data.end(), word.begin(), word.end()) != event.data.end();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::InMemoryFile input, mended;
  input.set(data, size);
  try {
    bus::LogReader log(input.name());
    const std::vector<bus::LogEvent> events = events_of(log);
    require(!events.empty(), "a log has an event");
    if (!log.damage().any()) return 0;
    log.rewind();
    require(equal(events, events_of(log)), "a log reads the same again");

    // a message that holds a log itself cannot always be told from damage
    if (std::any_of(events.begin(), events.end(), holds_sync_word)) return 0;
    std::vector<unsigned char> bytes;
    std::uint64_t number = 0;
    for (const bus::LogEvent& event : events) {
      put(bytes, 0xEDA1DA01, 4);
      put(bytes, number++, 8);
      put(bytes, static_cast<std::uint64_t>(event.time_us), 8);
      put(bytes, event.channel.size(), 4);
      put(bytes, event.data.size(), 4);
      bytes.insert(bytes.end(), event.channel.begin(), event.channel.end());
      for (const std::byte b : event.data) bytes.push_back(std::to_integer<unsigned char>(b));
    }
    mended.set(bytes.data(), bytes.size());
    bus::LogReader again(mended.name());
    require(equal(events, events_of(again)), "a mended log holds the same events");
    require(!again.damage().any(), "a mended log has no damage");
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
