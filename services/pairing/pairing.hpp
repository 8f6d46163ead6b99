// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/rig.hpp"
#include "pairing/accumulation.hpp"
#include "pairing/listening_clock.hpp"
#include "pairing/saved_state.hpp"
#include "pairing/service_options.hpp"
#include "program/commands.hpp"

namespace egocal::services {

/// egocal-pairing: from the sensors' poses to problem_t. Nothing leaves the process, neither a problem nor an
/// acknowledgement, before the inputs behind it are in the state file.
class Pairing {
 public:
  /// saved: null means that the state is lost when the process ends.
  Pairing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, std::unique_ptr<SavedState> saved,
          const PairingServiceOptions& options = {});
  /// Saves a last snapshot.
  ~Pairing();
  Pairing(const Pairing&) = delete;
  Pairing& operator=(const Pairing&) = delete;

 private:
  struct Channel {
    std::string problem, motion, scale_problem;  // of a pair
  };
  struct Arrivals {                    // of a sensor; times are those of listened_us()
    std::int64_t count = 0;            // since the start of the process
    std::int64_t heard_at_us = 0;      // the last one
    std::int64_t repeated_at_us = 0;   // the last one from before what is waited for; 0: none
    std::int64_t gap_at_us = 0;        // since when something is missing; 0: nothing is
    std::int64_t expected = -1;        // its number
    std::int64_t gone_over_at_us = 0;  // since when the sender repeats messages; 0: it does not
  };

  void feed(const Input& input);
  void save();
  void not_saved(const std::string& why);
  void take(std::uint16_t channel, const bus::Arrival& arrival);
  void after_batch(bool caught_up);
  void publish_new_problems();
  void publish_problem(std::size_t pair);
  void publish_all_problems();
  void publish_motions();
  void be_patient_if_it_helps();
  void give_up_what_was_not_sent(const status_t& player);
  std::int64_t listened_us() const { return listening_clock_.now_us(loop_.mono_us()); }
  void watch_gaps();
  void release_what_silence_holds(std::int64_t now_us);
  void every_second();
  void obey(Verb verb, const command_t& command);
  void acknowledge();
  void hear(const status_t& status);
  void show_state();
  std::string error() const;
  void begin_to_send();
  bool acknowledges_early() const;
  bool saved_or_known_not_to_be() const;
  bool leads() const { return !waits_for_senior_ && !listening_; }

  PairingServiceOptions options_;
  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  std::unique_ptr<SavedState> saved_;
  Accumulation accumulation_;
  std::vector<Arrivals> arrivals_;
  std::vector<Channel> channels_;                // of the pairs
  std::vector<std::int64_t> published_mono_us_;  // each pair's problem
  std::int64_t early_choice_mono_us_ = 0;        // the end of the last one that a problem needed
  std::optional<bus::Loop::TimerId> publish_timer_, acknowledge_timer_;
  std::set<std::int64_t> known_runs_;                      // of solvers and players
  ListeningClock listening_clock_;                         // looked at by watch_gaps()
  std::int64_t settle_until_us_ = 0, heard_again_us_ = 0;  // of listened_us()
  bool caught_up_ = true;                                  // by the last batch
  std::int64_t sent_ = 0;                                  // problems
  std::string save_error_;
  std::string without_clock_;  ///< a pair that is silent and has no motion yet, see PairSession
  std::int64_t save_again_mono_us_ = 0;
  int unacknowledged_ = 0;
  std::int64_t acknowledged_mono_us_ = 0, acknowledging_us_ = 0;  // the last time, and how long it took
  bool patient_ = false;
  bool listening_ = true;  ///< see begin_to_send()
  bool waits_for_senior_ = false;
};

}  // namespace egocal::services
