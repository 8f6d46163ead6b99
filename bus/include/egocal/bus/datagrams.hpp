// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// LCM's wire format over UDP (docs/wire.md): messages to datagrams and back. No sockets here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/bus/bytes.hpp"

namespace egocal::bus {

/// LCM_MAX_CHANNEL_NAME_LENGTH, without the final zero.
inline constexpr std::size_t max_channel_length = 63;

/// One datagram to send: its header and its part of the message.
struct Datagram {
  std::array<std::byte, 20 + max_channel_length + 1> header_storage;
  std::size_t header_size = 0;
  Bytes payload;

  Bytes header() const { return Bytes(header_storage).first(header_size); }
};

/// Whether LCM's format can carry the message at all.
bool fits_datagrams(std::string_view channel, Bytes bytes);

/// Calls send for each datagram of the message, in order, until it returns false. Returns false then, and if
/// the message does not fit. number: counts the messages of this sender; receivers use it to tell which
/// fragments belong together.
bool for_each_datagram(std::string_view channel, Bytes bytes, std::uint32_t number,
                       const std::function<bool(const Datagram&)>& send);

struct ReassemblyOptions {
  /// Larger messages are dropped [bytes]. Our largest one, problem_t with 128 blocks, has 40 kB.
  std::size_t max_message = std::size_t{4} << 20;
  /// Size of all incomplete messages [bytes]; beyond it the oldest are dropped. Four of the largest.
  std::size_t max_total = std::size_t{16} << 20;
  /// Senders with an incomplete message. A bus has a few dozen processes, and a flood of forged senders costs
  /// at most this.
  std::size_t max_senders = 64;
};

/// Datagrams in, whole messages out. Every number of a datagram is checked against its size before it is
/// used, and memory stays below ReassemblyOptions whatever arrives.
class Reassembly {
 public:
  using Wanted = std::function<bool(std::string_view channel)>;
  struct Message {
    std::string_view channel;  ///< both are valid until the next call of take(), and as long as its datagram
    Bytes bytes;
  };

  explicit Reassembly(const ReassemblyOptions& options = {}) : options_(options) {}

  /// sender: address and port, or any other number that distinguishes senders.
  std::optional<Message> take(Bytes datagram, std::uint64_t sender, const Wanted& wanted);

  std::int64_t malformed() const { return malformed_; }
  std::int64_t incomplete() const { return incomplete_; }
  /// Bytes held for messages that are not complete yet.
  std::size_t held() const { return held_; }

 private:
  struct Part {
    std::uint32_t offset = 0, size = 0;  ///< [bytes]
    bool there = false;
  };
  struct Partial {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;
    std::string channel;
    std::vector<std::byte> bytes;
    std::vector<Part> parts;  ///< by fragment
    std::size_t missing = 0;

    std::size_t memory() const { return bytes.size() + sizeof(Part) * parts.size(); }
    /// Whether the fragments neither overlap nor leave gaps.
    bool without_holes() const;
  };
  using Place = std::list<Partial>::iterator;

  std::optional<Message> refuse();
  std::optional<Message> take_whole(Bytes rest, const Wanted& wanted);
  std::optional<Message> take_fragment(Bytes datagram, std::uint64_t sender, const Wanted& wanted);
  Place begin_message(std::uint64_t sender, std::uint32_t number, std::string_view channel, std::size_t size,
                      std::size_t fragments);
  void drop(Place partial);
  Place find(std::uint64_t sender);

  ReassemblyOptions options_;
  std::list<Partial> partials_;  ///< oldest first
  Partial complete_;
  std::size_t held_ = 0;
  std::int64_t malformed_ = 0, incomplete_ = 0;
};

}  // namespace egocal::bus
