// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "egocal/bus/bytes.hpp"
#include "egocal/bus/clock.hpp"
#include "egocal/bus/lcm_url.hpp"

namespace egocal::bus {

/// A message as it came. The views are valid until the next call of the transport.
struct Received {
  std::string_view channel;
  Bytes bytes;
  std::int64_t mono_us = 0;  ///< when the host received it, before it was queued anywhere [us]
};

enum class SendStatus {
  sent,
  no_network,  ///< the network is away; a later message may go
  too_large,   ///< no network carries it: message or channel name beyond what LCM's format can hold
};

/// What a transport dropped since it was made, counted in datagrams.
struct TransportCounts {
  std::int64_t malformed = 0;        ///< not LCM's format, or fragments that contradict themselves
  std::int64_t incomplete = 0;       ///< messages of which a fragment never came, or that were too large
  std::int64_t buffer_overflow = 0;  ///< the kernel had no room left, of any channel
};

/// How messages leave and reach a process. Not thread-safe: one loop owns it. Nothing but its own methods
/// changes it, so a simulation can put any network behind this interface.
class Transport {
 public:
  /// Channels with a subscriber; all others are dropped before anything is kept of them.
  using Wanted = std::function<bool(std::string_view channel)>;

  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  virtual SendStatus send(std::string_view channel, Bytes bytes) = 0;
  /// The next message of a wanted channel. False: nothing is waiting. Never waits.
  virtual bool receive(const Wanted& wanted, Received& message) = 0;
  /// A file descriptor that is readable while something waits; -1: there is none, and receive() is to be
  /// asked.
  virtual int fd() const = 0;
  /// Whether receive() may have something although fd() is not readable.
  virtual bool ready() const = 0;
  /// Looks whether the network is still there and connects again where it came back. To be called about once
  /// a second.
  virtual void check_network() = 0;
  /// What is wrong with the network, in one line with its remedy; empty: nothing is.
  virtual std::string network_error() const = 0;
  virtual TransportCounts counts() const = 0;
};

/// Speaks LCM's wire format (docs/wire.md) with everybody on the URL, or with itself only (memq://). A
/// network that is away is no error here, see network_error(). Throws Error where no socket can be had at
/// all.
std::unique_ptr<Transport> open_transport(const LcmUrl& url, const Clock& clock);

}  // namespace egocal::bus
