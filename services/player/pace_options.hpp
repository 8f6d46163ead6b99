// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace egocal::services {

/// How egocal-player keeps in step with pairing. Study: bench_processes and tests/e2e/test_lossy_network.cpp;
/// docs/benchmarks.md has the rates.
struct PaceOptions {
  /// Messages on their way that pairing has not acknowledged. The kernel's buffer holds this many poses many
  /// times over, and more would gain no speed: pairing acknowledges every sixteenth.
  std::size_t most_in_flight = 64;
  /// At full speed one turn of the loop sends at most this before it listens.
  int most_at_once = 64;
  /// Without a pairing process by then the log is played to any listener [us]: a process starts within a
  /// second, and nothing is sent before one is alive.
  std::int64_t wait_for_pairing_us = 3'000'000;
  /// What was not acknowledged is sent again after this time [us]: pairing acknowledges within
  /// milliseconds, or has lost it.
  std::int64_t stall_us = 500'000;
  /// After this time where pairing was not heard meanwhile [us]: it sends a status a second, so that three
  /// were lost, or it is stopped and has the messages in its socket.
  std::int64_t unheard_us = 3'500'000;
  /// A message that could not be sent is tried again this often [us]. Study: tests/e2e/test_network.cpp.
  std::int64_t retry_us = 100'000;
  /// A message that cannot be sent for this time while the network is there is given up [us]. The loop looks
  /// at the network once a second, so a network that is away is known by then.
  std::int64_t refused_us = 2'500'000;
  /// Waits that are longer are announced [us].
  std::int64_t announced_wait_us = 5'000'000;
  /// After the last message the player waits this long for its acknowledgement [us].
  std::int64_t end_wait_us = 10'000'000;
  /// The line of progress is drawn this often [us].
  std::int64_t progress_period_us = 200'000;
  /// Damaged places of a log that are reported one by one; the rest is summed up.
  std::uint64_t most_reported = 5;
};

}  // namespace egocal::services
