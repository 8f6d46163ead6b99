// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace egocal::services {

/// Every number that egocal-pairing decides by. Study: tests/e2e (chaos, lossy relay, floods) and
/// bench_processes; docs/processes.md and docs/benchmarks.md have the results.
struct PairingServiceOptions {
  /// Messages between acknowledgements. A player has four times as many in flight, so it never waits for one.
  int acknowledge_every = 16;
  /// An acknowledgement that no sender waits for yet is delayed this long: more messages may come.
  std::chrono::microseconds acknowledge_delay{300};
  /// Messages of one channel that may wait: sixteen times what a player has on the way.
  int queue_capacity = 1024;
  /// A gap in a stream is given up when nothing of that stream arrives for this time [us]. No sensor in use
  /// sends at less than 2 Hz, so its sender has ended.
  std::int64_t silence_us = 500'000;
  /// A message that a player repeats arrives within this time [us], also on the lossy network of tests/e2e.
  std::int64_t patience_us = 1'000'000;
  /// While something is missing the acknowledgements go out this often at least [us]: several times within
  /// patience_us.
  std::int64_t ask_again_us = 300'000;
  /// A delayed message arrives within this time [us]. After it, a sender that repeats its messages has no
  /// first copy in flight any more. Study: egocal_simulation, seeds 10140070 and 10571754.
  std::int64_t latest_us = 100'000;
  /// Gaps are checked at this interval. If the process did not check for twice as long, it was stopped
  /// (SIGSTOP, Ctrl-Z, a machine that slept). Senders were not silent in that time.
  std::chrono::milliseconds watch_period{100};
  /// After that a player counts as alive this long without a status [us]: it sends one a second.
  std::int64_t heard_again_us = 1'500'000;
  /// Problems of one pair are at least this far apart [us], so that a replay at full speed costs the solvers
  /// little. At 1 kHz each pose has its own answer; at higher rates one answer covers several
  /// (docs/benchmarks.md).
  std::int64_t problem_distance_us = 500;
  /// An answer before the 64th instant of a pair needs a choice of weights of its own, of 2 ms, in which all
  /// other messages wait. The choices of all pairs are this far apart at least [us], and the pair that was
  /// answered the longest ago is the next. One or two pairs at 50 Hz have an answer at each pose, nineteen at
  /// 100 Hz one each 0.2 s. Study: bench_processes latency --warm-up 0, docs/benchmarks.md.
  std::int64_t early_choice_distance_us = 10'000;
  /// A disk that is full is tried again after this time [us].
  std::int64_t save_retry_us = 1'000'000;
  /// The first status of a process is answered at once. Beyond this number of processes that is not done:
  /// statuses can be forged.
  std::size_t most_known_runs = 1024;
  /// Nothing is sent before another process of this name has had the time to answer the first status, which
  /// takes it up to 50 ms. A process that replaces a killed one (listen_restored) is most likely alone, and
  /// others wait for it.
  std::chrono::milliseconds listen{300}, listen_restored{100};
};

}  // namespace egocal::services
