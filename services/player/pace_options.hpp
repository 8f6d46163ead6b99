// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace egocal::services {

/// How egocal-player keeps in step with pairing. Study: bench_processes and tests/e2e/test_lossy_network.cpp;
/// docs/benchmarks.md has the rates.
struct PaceOptions {
  /// Messages in flight, not acknowledged by pairing. The buffer of the kernel holds many times as many
  /// poses, and a larger number would not be faster, as pairing acknowledges every sixteenth.
  std::size_t most_in_flight = 64;
  /// At full speed one turn of the loop sends at most this before it listens.
  int most_at_once = 64;
  /// If no pairing process is alive after this time, the log is played to any listener [us]. A process starts
  /// within a second, and nothing is sent before one is alive.
  std::int64_t wait_for_pairing_us = 3'000'000;
  /// A message that was not acknowledged is sent again after this time [us]. Pairing acknowledges within
  /// milliseconds, unless the message was lost.
  std::int64_t stall_us = 500'000;
  /// The same if pairing was not heard meanwhile [us]. It sends a status every second, so three were lost, or
  /// it is stopped and has the messages in its socket.
  std::int64_t unheard_us = 3'500'000;
  /// A message that could not be sent is tried again this often [us]. Study: tests/e2e/test_network.cpp.
  std::int64_t retry_us = 100'000;
  /// A message is given up if it cannot be sent for this time although the network is there [us]. The loop
  /// looks at the network once a second, so by then it knows whether the network is away.
  std::int64_t refused_us = 2'500'000;
  /// Waits that are longer are announced [us].
  std::int64_t announced_wait_us = 5'000'000;
  /// After the last message the player waits this long for its acknowledgement [us].
  std::int64_t end_wait_us = 10'000'000;
  /// The line of progress is drawn this often [us].
  std::int64_t progress_period_us = 200'000;
  /// Damage of a log that is reported when it is met, this many times; later damage is only counted.
  std::uint64_t most_reported = 5;
};

}  // namespace egocal::services
