// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// A pose with its number, as one odometry source sends or has recorded them.
struct NumberedPose {
  StampedPose pose;
  std::int64_t seq = -1;     ///< -1: not counted
  std::int64_t mono_us = 0;  ///< arrival by a clock of the caller [us]; handed on, never looked at
  bool begins_anew = false;  ///< set by Stream: the first one of a new timeline
};

struct StreamOptions {
  /// A missing number is waited for during this much measured time [s]: several periods of usual sensors, and
  /// little beside the time that a drive takes.
  double reorder_window = 0.2;
  /// Judges every time stamp by its two neighbours, which delays the poses by two: for recordings, where
  /// nothing waits. Without it a stamp that is damaged by less than largest_jump costs the poses in between.
  bool look_ahead = false;
  /// Largest jump of time [s], and in periods of the source: a time that jumps by more than both is not
  /// believed until other messages confirm it. Longer than the gaps that a busy source leaves.
  double largest_jump = 1;
  std::int64_t jump_periods = 4;
  /// Largest jump of a number that is believed without a confirmation. At most this many messages are held
  /// back or remembered as lost. 10 s at 100 Hz.
  std::int64_t most_missing = 1000;
  /// A sender that repeats the first message behind a gap this often, and sends nothing for the gap, has
  /// nothing for it: the missing message would have been lost seven times, once in 7,000 at a loss of 28 %.
  /// egocal-player states this instead, see give_up_first_gap(). Study: egocal_simulation, seeds 10007613 and
  /// 10012590.
  std::int32_t repeats_of_nothing = 6;
  /// Messages in a row that confirm a jump. One damaged message must not, two might be damaged alike.
  std::size_t confirmations = 3;
  /// Messages that confirm each other are no further apart than this [s].
  double largest_confirming_step = 60;
};

struct StreamCounts {
  std::int64_t lost = 0;  ///< numbers that never came
  std::int64_t duplicate = 0;
  std::int64_t out_of_order = 0;  ///< too late to be used
  std::int64_t jump = 0;          ///< time or number damaged or far off, and nothing followed there
};

/// Everything that a Stream remembers.
struct StreamState {
  std::optional<std::int64_t> newest_us;
  std::int64_t period_us = 0;
  std::optional<std::int64_t> next_seq;
  std::set<std::int64_t> lost;                 ///< the newest numbers that were given up
  std::map<std::int64_t, NumberedPose> early;  ///< by number, behind a gap
  std::vector<NumberedPose> candidates;        ///< for a jump
  std::vector<NumberedPose> ahead;             ///< see StreamOptions::look_ahead
  std::optional<std::int64_t> checked_us;      ///< time of the last one that left ahead
  std::array<std::int64_t, 64> recent{};       ///< times released, or late, last
  std::uint64_t recent_next = 0;               ///< in recent
  bool patient = false;                        ///< see be_patient()
  std::int64_t gap = -1;                       ///< the number last missed by a sender that went back,
  std::int32_t gap_repeats = 0;                ///< and how often
  bool settling = false;                       ///< see settle()
  std::map<std::int64_t, NumberedPose> held;   ///< by time, while settling
  std::optional<std::int64_t> held_last_us;    ///< time of the one that came last
  bool held_before = false;                    ///< held is of before the last interruption
  bool going_over = false;                     ///< the sender is among those held again
  StreamCounts counts;
};

/// Puts the poses of one odometry source in order: live, replayed or read from a log. Its clock is the time
/// inside the messages. Time and memory of a call are bounded, whatever a message claims.
///
/// - A gap in the numbers is waited for until reorder_window of measured time has gone by, or for as long as
///   it is patient.
/// - Time or number far off: kept back until three messages in a row continue from there, for one damaged
///   message must not end a session. If time then turns out to run backwards (a log that was started again, a
///   clock that was set), a new timeline begins; nothing of it is lost.
/// - Times and numbers that no source can have (limits.hpp) are counted as jumps and not used.
class Stream {
 public:
  explicit Stream(const StreamOptions& options = {});

  /// The poses that are now in order, oldest first.
  std::vector<NumberedPose> push(NumberedPose sample);
  /// Stops waiting, as nothing has come for long; returns the poses held back.
  std::vector<NumberedPose> flush();
  /// Time of the first message behind the first gap [us]; empty: there is no gap.
  std::optional<std::int64_t> behind_gap_us() const;
  /// Gives up the first gap: the sender has nothing for it.
  std::vector<NumberedPose> give_up_first_gap();
  /// Whether something is missing before what is held back.
  bool waiting() const { return !state_.early.empty() || !state_.held.empty(); }
  std::size_t held_back() const { return state_.early.size() + state_.held.size() + unconfirmed(); }
  /// Number of messages that are far off and not confirmed yet, of a sender that can send again what is
  /// missing before them. Without numbers nothing is known to be missing.
  std::size_t unconfirmed() const;
  /// The number that the stream waits for or expects next; -1: none.
  std::int64_t expected() const { return state_.next_seq.value_or(-1); }
  std::optional<std::int64_t> newest_us() const { return state_.newest_us; }
  const StreamCounts& counts() const { return state_.counts; }
  /// Number of messages that came again from before what the stream waits for. Where it grows, the sender has
  /// gone back (it was restarted) and will come to what is missing. Not part of the state.
  std::int64_t repeated() const { return repeated_; }

  /// While the sender sends again what is missing, however long that takes in measured time, it is waited
  /// for: until flush(), give_up_first_gap(), or until the first message behind the gap has come
  /// StreamOptions::repeats_of_nothing times again.
  void be_patient(bool patient) { state_.patient = patient; }
  bool settling() const { return state_.settling; }
  /// After an interruption: the messages of a stream without numbers, or of one not received before, are
  /// collected, and put in order when the sender goes over them again, or by flush(). Those without numbers
  /// one by one, as it comes to them.
  void settle();
  /// The sender goes over numbered messages again: as soon as nothing is on its way any more that it sent the
  /// first time, end_settling() puts them in order.
  bool gone_over() const {
    return state_.settling && state_.going_over && !state_.held.empty() &&
           state_.held.begin()->second.seq >= 0;
  }
  std::vector<NumberedPose> end_settling();

  const StreamState& state() const { return state_; }
  /// Throws Error where no Stream can have had this state.
  void restore(StreamState state);

 private:
  bool plausible(const NumberedPose& sample) const;
  bool follows(const NumberedPose& x, const NumberedPose& y) const;
  bool too_many(std::size_t count) const { return count > static_cast<std::size_t>(options_.most_missing); }
  std::ptrdiff_t place_among_candidates(const NumberedPose& sample) const;
  bool known(std::int64_t time_us) const;
  bool repeats_a_stamp(const NumberedPose& sample) const;
  std::int64_t newest_us_of_all() const;
  std::int64_t largest_jump_us() const;
  void drop_late_candidates(std::int64_t repeated_us);
  bool sent_again_too_late(const NumberedPose& sample) const;
  std::vector<NumberedPose> look_ahead(NumberedPose sample);
  void pass_checked(std::vector<NumberedPose>& out);
  std::vector<NumberedPose> in_order(NumberedPose sample);
  std::vector<NumberedPose> count_repeated(std::int64_t time_us);
  std::vector<NumberedPose> confirm_jump(NumberedPose sample);
  std::vector<NumberedPose> place(NumberedPose sample);
  std::vector<NumberedPose> place_before_candidates(NumberedPose sample);
  std::vector<NumberedPose> hold(NumberedPose sample);
  std::vector<NumberedPose> go_over(NumberedPose sample);
  std::vector<NumberedPose> settled();
  void remember(std::int64_t time_us);
  void reject_late(const NumberedPose& sample);
  void release(NumberedPose sample, std::vector<NumberedPose>& out);
  void give_up_until(std::int64_t number);
  void release_early(std::vector<NumberedPose>& out, bool give_up);
  std::vector<NumberedPose> take_candidates();

  StreamOptions options_;
  StreamState state_;
  std::int64_t repeated_ = 0;
};

}  // namespace egocal
