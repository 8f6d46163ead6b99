// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bot_core/pose_t.hpp"
#include "egocal/bus/bytes.hpp"
#include "egocal/calibration_t.hpp"
#include "egocal/command_t.hpp"
#include "egocal/motion_pair_t.hpp"
#include "egocal/odometry_t.hpp"
#include "egocal/problem_t.hpp"
#include "egocal/scale_problem_t.hpp"
#include "egocal/scale_t.hpp"
#include "egocal/status_t.hpp"
#include "egocal/verdict_t.hpp"

namespace egocal::bus {

/// Whether the lengths inside an encoded message add up to its size. The generated decoders trust them: a
/// damaged one would allocate gigabytes or read past the end.
bool lengths_fit(const odometry_t*, Bytes bytes);
bool lengths_fit(const bot_core::pose_t*, Bytes bytes);
bool lengths_fit(const motion_pair_t*, Bytes bytes);
bool lengths_fit(const problem_t*, Bytes bytes);
bool lengths_fit(const calibration_t*, Bytes bytes);
bool lengths_fit(const status_t*, Bytes bytes);
bool lengths_fit(const command_t*, Bytes bytes);
bool lengths_fit(const verdict_t*, Bytes bytes);
bool lengths_fit(const scale_problem_t*, Bytes bytes);
bool lengths_fit(const scale_t*, Bytes bytes);

/// Whether fingerprint and lengths are those of the type.
template <class Message>
bool is_a(Bytes bytes) {
  return lengths_fit(static_cast<const Message*>(nullptr), bytes) &&
         big_endian<std::uint64_t>(bytes) == static_cast<std::uint64_t>(Message::getHash());
}

/// Name of the type of an encoded message, as its .lcm file has it: "egocal.odometry_t", "bot_core.pose_t",
/// another one of ours, or "unknown type".
std::string type_name(Bytes bytes);

/// Decodes a message that must fill the bytes exactly. False: wrong fingerprint (another type or version),
/// truncated, trailing bytes, or a false length field. Never throws on any input except for lack of memory.
template <class Message>
bool decode(Bytes bytes, Message& message) {
  if (!lengths_fit(&message, bytes)) return false;
  const int size = static_cast<int>(bytes.size());
  return message.decode(bytes.data(), 0, size) == size;
}

template <class Message>
std::vector<std::byte> encode(const Message& message) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace egocal::bus
