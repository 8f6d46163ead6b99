// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "egocal/error.hpp"
#include "state/archive.hpp"

namespace egocal::services {

namespace {

/// How a state of this process begins, whatever its version.
std::string beginning(const std::string& process) {
  return process + " state ";
}

/// The last character states the byte order of the machine.
std::string magic(const std::string& process) {
  const std::uint16_t one = 1;
  std::uint8_t low = 0;
  std::memcpy(&low, &one, 1);
  return beginning(process) + "4" + (low ? "l" : "b") + "\n";
}

/// Up to version 3 all processes began their state like this, and only the identity in it names the process.
const std::string shared_beginning = "egocal-pairing state 3";

/// Before each part: identity, snapshot, additions.
struct PartHeader {
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;         ///< of the part
  std::int64_t boot_us = 0;           ///< when it was written, see BootTime
  std::uint64_t header_checksum = 0;  ///< of those above
};

std::uint64_t own_checksum(const PartHeader& header) {
  return checksum(std::as_bytes(std::span(&header, 1)).first(sizeof header - sizeof header.header_checksum));
}

PartHeader header_of(std::span<const std::byte> bytes, std::int64_t boot_us) {
  PartHeader header{bytes.size(), checksum(bytes), boot_us, 0};
  header.header_checksum = own_checksum(header);
  return header;
}

std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

void append_part(std::vector<std::byte>& out, std::span<const std::byte> part, std::int64_t boot_us) {
  const PartHeader header = header_of(part, boot_us);
  const auto header_bytes = std::as_bytes(std::span(&header, 1));
  out.insert(out.end(), header_bytes.begin(), header_bytes.end());
  out.insert(out.end(), part.begin(), part.end());
}

/// The next part; empty where the bytes end before it does.
std::optional<std::span<const std::byte>> next_part(std::span<const std::byte>& rest, std::int64_t& boot_us) {
  PartHeader header;
  if (rest.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, rest.data(), sizeof header);
  if (own_checksum(header) != header.header_checksum) throw Error("is damaged");
  const std::span<const std::byte> behind = rest.subspan(sizeof header);
  if (header.size > behind.size()) return std::nullopt;
  const auto part = behind.first(header.size);
  if (checksum(part) != header.checksum) throw Error("is damaged");
  rest = behind.subspan(header.size);
  boot_us = header.boot_us;
  return part;
}

/// The first line in which the two differ.
std::string difference(const std::string& found, const std::string& expected) {
  std::istringstream x(found), y(expected);
  std::string line_x, line_y;
  for (;;) {
    const bool more_x = static_cast<bool>(std::getline(x, line_x));
    const bool more_y = static_cast<bool>(std::getline(y, line_y));
    if (!more_x) line_x = "nothing";
    if (!more_y) line_y = "nothing";
    if (line_x != line_y)
      return "it has '" + std::string(line_x).append("', expected '").append(line_y) + "'";
    if (!more_x && !more_y) return "no difference";
  }
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Whether a file that begins like a state may be one of this process. If its identity cannot be read, the
/// process named at its beginning decides.
bool is_of(const std::string& process, std::span<const std::byte> bytes) {
  const std::string begin = text_of(bytes.first(std::min(bytes.size(), shared_beginning.size())));
  if (begin == shared_beginning) {
    try {
      const std::size_t magic_size = shared_beginning.size() + 2;
      std::span<const std::byte> rest = bytes.subspan(std::min(bytes.size(), magic_size));
      std::int64_t written_us = 0;
      if (const auto whose = next_part(rest, written_us)) return text_of(*whose).starts_with(process + " ");
    } catch (const Error&) {
      // damaged
    }
  }
  const std::string own = beginning(process);
  return begin.starts_with(own) || own.starts_with(begin);
}

struct Parsed {
  StateFile::Content content;
  BootTime written;  ///< the last part
};

Parsed parsed(std::span<const std::byte> bytes, const StateIdentity& identity) {
  const std::string begin = magic(identity.process);
  if (text_of(bytes.first(std::min(bytes.size(), begin.size()))) != begin)
    throw Error("is that of another version or machine, or cut off");
  std::span<const std::byte> rest = bytes.subspan(begin.size());
  Parsed result;
  const auto whose = next_part(rest, result.written.us);
  if (!whose) throw Error("is cut off");
  const std::string found = text_of(*whose);
  if (found != identity.text)
    throw Error("is that of another rig or version: " + difference(found, identity.text));
  const auto boot = next_part(rest, result.written.us);
  if (!boot) throw Error("is cut off");
  result.written.boot = text_of(*boot);
  const auto snapshot = next_part(rest, result.written.us);
  if (!snapshot) throw Error("is cut off");
  result.content.snapshot.assign(snapshot->begin(), snapshot->end());
  while (const auto addition = next_part(rest, result.written.us))
    result.content.additions.emplace_back(addition->begin(), addition->end());
  return result;
}

}  // namespace

StateFile::StateFile(std::unique_ptr<StateMedium> medium, StateIdentity identity, Clock clock,
                     const StateOptions& options)
    : medium_(std::move(medium)),
      identity_(std::move(identity)),
      clock_(std::move(clock)),
      options_(options) {}

std::optional<StateFile::Content> StateFile::read() {
  const std::string& process = identity_.process;
  const std::optional<StateMedium::Found> found =
      medium_->read({process, {beginning(process), shared_beginning}});
  if (!found || found->bytes.empty()) return std::nullopt;
  if (!is_of(process, found->bytes)) throw not_a_state(medium_->name(), process);
  try {
    Parsed state = parsed(found->bytes, identity_);
    const std::int64_t age = age_s(state.written, clock_(), found->written_s, found->now_s);
    if (std::abs(age) > options_.most_age_s)
      throw Error("is stale: written " + std::to_string(age) + " s ago, expected at most " +
                  std::to_string(options_.most_age_s));
    return std::move(state.content);
  } catch (const Error& error) {
    refuse(error.what());
    return std::nullopt;
  }
}

void StateFile::refuse(const std::string& why) {
  const std::string begin = medium_->name() + ": " + why + "; starting from nothing, ";
  try {
    refused_ = begin + "it is kept as " + medium_->keep_aside();
    in_the_way_.clear();
  } catch (const Error& error) {
    in_the_way_ = why;
    refused_ = begin + "it stays there: " + error.what();
  }
}

void StateFile::snapshot(std::span<const std::byte> bytes) {
  if (!in_the_way_.empty()) refuse(in_the_way_);
  if (!in_the_way_.empty()) throw Error(refused_);
  const std::string begin_text = magic(identity_.process);
  const auto begin = as_bytes(begin_text);
  std::vector<std::byte> parts(begin.begin(), begin.end());
  const BootTime now = clock_();
  append_part(parts, as_bytes(identity_.text), now.us);
  append_part(parts, as_bytes(now.boot), now.us);
  append_part(parts, bytes, now.us);
  medium_->replace(parts);
  added_ = 0;
}

void StateFile::add(std::span<const std::byte> bytes) {
  std::vector<std::byte> part;
  part.reserve(sizeof(PartHeader) + bytes.size());
  append_part(part, bytes, clock_().us);
  medium_->add(part);
  added_ += part.size();
}

}  // namespace egocal::services
