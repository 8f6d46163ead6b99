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
  /// Names of channels that are remembered: a status can be forged. Four times the sensors of a large rig.
  std::size_t most_channels = 256;
  /// Attempts to fill a gap, each as soon as what was sent before has arrived. Later ones wait for
  /// PaceOptions::stall_us. Only after these attempts does the player state what its log holds next: the log
  /// may hold messages in another order than that of their numbers.
  int most_tries = 2;
};

/// The messages that pairing has not acknowledged yet, of the channels that it acknowledges. What is lost on
/// the way, or was sent to a pairing process that ended, is still here to be sent again. Pure: no clock, no
/// LCM.
class InFlight {
 public:
  explicit InFlight(const InFlightOptions& options = {}) : options_(options) {}

  /// Takes note of a message that was sent. Of channels that pairing does not listen to nothing is kept.
  void sent(const bus::LogEvent& event);
  struct Progress {
    bool any = false;  ///< something new was acknowledged, or it is a new process
    /// all(): a new process has them not, or one before what it has is missing, or it has the first only
    bool send_again = false;
  };
  /// A status of pairing. Its acknowledgements name the newest message before which nothing is missing; the
  /// counter "held back: <channel>" says that something came behind a gap.
  Progress acknowledged(const status_t& pairing);

  /// Of each channel on which something came behind a gap and most_tries have not filled it: the time of the
  /// next message of the log after the acknowledged one. Where that is what came, the log holds nothing for
  /// the gap.
  std::vector<acknowledgement_t> following() const;

  /// A message of the channel has been sent, and pairing has none. Where more were sent now and the first
  /// were lost, pairing would take what it receives for the beginning.
  bool begins(const std::string& channel) const;

  bool heard() const { return run_.has_value(); }            ///< any pairing process, ever
  std::size_t count() const;                                 ///< messages on the way
  std::size_t channels() const { return channels_.size(); }  ///< that are remembered
  /// What is to be sent again, in the order in which it was sent: all of them, and of a channel that begins()
  /// the first.
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
