// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::services {

/// A pose as it came from the bus.
struct Sample {
  StampedPose pose;
  std::int64_t seq = -1;     ///< -1: not counted
  std::int64_t mono_us = 0;  ///< arrival, CLOCK_MONOTONIC [us]
  bool begins_anew = false;  ///< set by Stream: the first one of a new timeline
};

struct StreamCounts {
  std::int64_t lost = 0;  ///< numbers that never came
  std::int64_t duplicate = 0;
  std::int64_t out_of_order = 0;  ///< too late to be used
  std::int64_t jump = 0;          ///< time or number far off, and nothing followed there
};

/// Everything that a Stream remembers.
struct StreamState {
  std::optional<std::int64_t> newest_us;
  std::int64_t period_us = 0;
  std::optional<std::int64_t> next_seq;
  std::set<std::int64_t> lost;            ///< the newest numbers that were given up
  std::map<std::int64_t, Sample> early;   ///< by number, behind a gap
  std::vector<Sample> candidates;         ///< for a jump
  std::array<std::int64_t, 64> recent{};  ///< times released last
  std::uint64_t recent_next = 0;          ///< in recent
  bool patient = false;                   ///< see be_patient()
  std::int64_t gap = -1;                  ///< the number last missed by a sender that went back,
  std::int32_t gap_repeats = 0;           ///< and how often
  bool settling = false;                  ///< see settle()
  std::map<std::int64_t, Sample> held;    ///< by time, while settling
  StreamCounts counts;
};

/// Puts the messages of one odometry channel in order. Its clock is the time inside the messages.
///
/// - A gap in the numbers is waited for until reorder_window of measured time has gone by, or for as long as
///   it is patient.
/// - Time or number far off (more than a second and four periods; 1000 numbers): kept back until three
///   messages in a row go on from there, for one damaged message must not end a session. If time then turns
///   out to run backwards (a log that was started again, a clock that was set), a new timeline begins;
///   nothing of it is lost.
class Stream {
 public:
  explicit Stream(double reorder_window_s);

  /// The samples that are now in order, oldest first.
  std::vector<Sample> push(Sample sample);
  /// Gives up waiting: nothing has come for long.
  std::vector<Sample> flush();
  /// Something is missing before what is held back.
  bool waiting() const { return !state_.early.empty() || !state_.held.empty(); }
  std::size_t held_back() const { return state_.early.size() + state_.held.size(); }
  /// The number that it waits for or expects next; -1: none.
  std::int64_t expected() const { return state_.next_seq.value_or(-1); }
  std::optional<std::int64_t> newest_us() const { return state_.newest_us; }
  const StreamCounts& counts() const { return state_.counts; }

  /// While the sender sends again what is missing, however long that takes in measured time, it is waited
  /// for: until flush(), or until the first message behind the gap has come twice again, for then the sender
  /// has been there twice and had nothing for the gap.
  void be_patient(bool patient) { state_.patient = patient; }
  bool settling() const { return state_.settling; }
  /// After an interruption: the messages of a stream without numbers, or of one not heard before, are
  /// collected, and put in order when one of them comes a second time, or by flush().
  void settle();

  const StreamState& state() const { return state_; }
  void restore(StreamState state) { state_ = std::move(state); }

 private:
  bool plausible(const Sample& sample) const;
  bool known(std::int64_t time_us) const;
  std::vector<Sample> put_in_order(Sample sample);
  std::vector<Sample> hold(Sample sample);
  std::vector<Sample> settled();
  void release(Sample sample, std::vector<Sample>& out);
  void give_up_until(std::int64_t number);
  void release_early(std::vector<Sample>& out, bool give_up);
  void give_up_first_gap(std::vector<Sample>& out);
  std::vector<Sample> take_candidates();

  std::int64_t reorder_window_us_;
  StreamState state_;
};

}  // namespace egocal::services
