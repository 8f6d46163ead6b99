// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/log_file.hpp"
#include "egocal/status_t.hpp"

namespace egocal::services {

/// Study: tests/services/player/test_in_flight.cpp, tests/e2e/test_lossy_network.cpp.
struct InFlightOptions {
  /// Channels that are remembered, because a status can be forged. Four times the sensors of a large rig.
  std::size_t most_channels = 256;
  /// Attempts to fill a gap, each as soon as the messages sent before have arrived. Later attempts wait for
  /// PaceOptions::stall_us. The player states what its log holds next only after these attempts, because a
  /// log may hold messages in another order than that of their numbers.
  int most_tries = 2;
};

/// The messages that pairing has not acknowledged yet, of the channels that it acknowledges. They are kept so
/// that they can be sent again, if they were lost or their pairing process has ended. Pure: no clock, no LCM.
class InFlight {
 public:
  explicit InFlight(const InFlightOptions& options = {}) : options_(options) {}

  /// Remembers a message that was sent. Messages of channels that pairing does not listen to are not kept.
  void sent(const bus::LogEvent& event);
  struct Progress {
    bool any = false;  ///< something new was acknowledged, or it is a new process
    /// all() must be sent again: pairing is a new process, lacks a message before what it has, or has only
    /// the first one
    bool send_again = false;
  };
  /// Takes a status of pairing. Its acknowledgements name the newest message before which nothing is missing;
  /// the counter "held back: <channel>" shows that something arrived behind a gap.
  Progress acknowledged(const status_t& pairing);

  /// For each channel with a gap that most_tries attempts have not filled: the time of the next message of
  /// the log after the acknowledged one. If pairing has that message, the log holds nothing for the gap.
  std::vector<acknowledgement_t> following() const;

  /// Whether a message of the channel was sent, and pairing has none yet. More messages must wait then: if
  /// the first one is lost, pairing would take a later one for the beginning.
  bool begins(const std::string& channel) const;

  bool heard() const { return run_.has_value(); }            ///< any pairing process, ever
  std::size_t count() const;                                 ///< messages on the way
  std::size_t channels() const { return channels_.size(); }  ///< that are remembered
  /// The messages to send again, in the order in which they were sent: all of them, but of a channel that
  /// begins() only the first.
  std::vector<bus::LogEvent> all() const;
  void clear();

 private:
  struct Message {
    std::uint64_t order;
    std::int64_t utime;
    bus::LogEvent event;
  };
  struct Channel {
    std::int64_t count = 0, utime = 0;  ///< of the last acknowledgement; time 0: pairing has nothing
    std::optional<std::int64_t> gap;    ///< utime of an acknowledgement with something held back
    bool held_back = false;             ///< with that acknowledgement
    int sent_again = 0;                 ///< because of this gap
    std::int64_t next_try = 0;          ///< count at which all that was sent again has arrived
    bool was_sent = false;              ///< anything, ever
    std::deque<Message> messages;
  };
  bool make_room_for(const std::string& channel);
  InFlightOptions options_;
  std::map<std::string, Channel> channels_;
  std::optional<std::int64_t> run_;  ///< of the pairing process
  std::uint64_t order_ = 0;
};

}  // namespace egocal::services
