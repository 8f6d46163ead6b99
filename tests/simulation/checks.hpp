// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/scale.hpp"
#include "egocal/problem_t.hpp"
#include "egocal/status_t.hpp"
#include "simulation/certificates.hpp"
#include "simulation/commands.hpp"
#include "simulation/process.hpp"

namespace egocal::simulation {

/// A broken promise of docs/processes.md. check: the letter of docs/simulation.md.
struct Violation {
  char check = '?';
  std::int64_t at_us = 0;
  std::string text;
};

/// Observes a life from outside: what is sent, what arrives, which processes live.
class Checks {
 public:
  Checks(const Surroundings& surroundings, const std::vector<std::unique_ptr<Process>>& processes)
      : surroundings_(surroundings), processes_(processes) {}

  void sent(const Address& from, const std::string& channel, bus::Bytes message);
  void received(const Address& by, std::string_view channel, bus::Bytes message);
  void started(const Process& process);
  void ended(const Process& process, const Process::Ending& ending);
  /// A person's wish; no names: for all pairs.
  void commanded(const std::string& to, const std::string& verb, const std::string& a, const std::string& b);
  /// After each turn of a process.
  void look_at_memory(const Process& process);
  /// Ten times a second, once the faults are over.
  void look_at_answers();
  /// Nothing more will happen.
  void finish();

  const std::optional<Violation>& violation() const { return violation_; }
  void fail(char check, const std::string& text);
  /// What was compared with an undisturbed run, for the share of lives in which it could be.
  int compared() const { return compared_; }
  /// Certificates that were compared with arithmetic of 113 bits.
  std::int64_t certificates() const { return certificates_.checked(); }
  /// Verdicts `good` that were compared with the truth.
  std::int64_t judged_good() const { return judged_good_; }
  /// Scales that were compared with that of the drive.
  std::int64_t scales() const { return scales_; }
  /// Of any process at any time [bytes].
  std::size_t most_memory() const { return most_memory_; }

 private:
  struct Sensor {                    // as one life of pairing received it
    std::set<std::int64_t> numbers;  // distinct
    std::int64_t received = 0, first = 0;
  };
  struct Lineage {  // a name of pairing: what one life has promised the next one keeps
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> problems;  // by channel: session, seq
    std::map<std::string, std::int64_t> acknowledged;                       // by channel: time
    std::map<std::string, std::int64_t> counters;                           // of the newest life
    std::map<std::size_t, Sensor> sensors;                                  // of the newest life
    std::map<std::size_t, std::set<std::int64_t>> all;                      // of all lives
    std::map<std::string, std::set<std::int64_t>> again;  // by channel: what came more than once
    std::int64_t lives = 0;
  };
  const Process& process(const Address& address) const {
    return *processes_[static_cast<std::size_t>(address.process)];
  }
  bool keeps_state(const Process& process) const;
  bool peaceful() const;
  bool keeps_order() const;
  bool in_an_order_of_its_own() const;
  bool forgets() const;
  bool is_foreign(bus::Bytes message) const;
  bool corrupts() const;
  void check_wishes(const Process& from, const std::string& channel, std::int64_t session, std::int64_t seq);
  void check_leader(const Process& from);
  bool dates_differ() const;
  void problem_sent(const Process& from, const std::string& channel, bus::Bytes message);
  void status_sent(const Process& from, const status_t& status);
  void answer_sent(const Process& from, const std::string& channel, bus::Bytes message);
  void scale_problem_sent(const std::string& channel, bus::Bytes message);
  void scale_sent(const Process& from, bus::Bytes message);
  bool is_scale_to_be_found(const std::string& a, const std::string& b) const;
  void check_scale(const std::string& whose, const ScaleSolution& solution);
  void check_scales();
  void verdict_sent(const Process& from, bus::Bytes message);
  std::string missing_answer() const;
  bool may_lack_a_problem(bool scaled) const;
  bool no_longer_sent(const std::string& a, const std::string& b) const;
  void compare_with_undisturbed();
  void check_counts();
  void check_losses();
  void check_certificates();
  void check_bounds();

  const Surroundings& surroundings_;
  const std::vector<std::unique_ptr<Process>>& processes_;
  std::optional<Violation> violation_;
  std::map<std::string, Lineage> lineages_;
  std::uint64_t sender_of_problems_ = 0;
  std::int64_t sender_changed_us_ = 0;  // another pairing process may continue an older session
  std::map<std::string, std::int64_t> problem_sent_us_;           // by channel
  std::map<std::string, std::vector<std::byte>> newest_problem_;  // by channel, of the leading pairing
  Commands commands_;
  Certificates certificates_;
  std::map<std::uint64_t, std::map<std::string, std::int64_t>> counters_;  // newest of each life, by its port
  std::size_t most_memory_ = 0;
  std::int64_t judged_good_ = 0, scales_ = 0;
  std::map<std::string, std::set<std::pair<std::int64_t, std::int64_t>>>
      scale_problems_;                            ///< by channel: session, number
  std::map<std::string, std::int64_t> sessions_;  // newest by channel
  std::int64_t player_starts_ = 0;
  std::map<std::string, std::int64_t>
      begun_before_;  // sessions, where the log began again behind all that is known
  std::int64_t answered_until_us_ = -1, answers_missing_since_us_ = -1;
  std::int64_t last_start_us_ = 0;
  std::map<std::string, std::uint64_t> leaders_;  ///< by name of pairing: port of the one that sent last
  int compared_ = 0;
};

/// The statistics of a whole drive without any faults, one problem a pair of the rig.
std::vector<problem_t> undisturbed(const Drive& drive,
                                   const std::map<std::size_t, std::set<std::int64_t>>* numbers);

}  // namespace egocal::simulation
