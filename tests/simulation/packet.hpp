// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace egocal::simulation {

/// One datagram on its way. What all its listeners get is kept once.
struct Packet {
  std::string channel;  ///< of the message, for filters and people; the datagram has it, too
  std::vector<std::byte> datagram;
  int sender = 0;          ///< number of the process
  std::uint64_t hash = 0;  ///< of the datagram
  bool whole = true;       ///< no fault has changed it
};
using PacketPtr = std::shared_ptr<const Packet>;

/// Fast, and good enough to tell two traces apart; eight bytes at a time.
inline std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}
std::uint64_t hash_of(const std::byte* data, std::size_t size);

}  // namespace egocal::simulation
