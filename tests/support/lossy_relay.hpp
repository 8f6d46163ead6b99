// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/decode.hpp"
#include "support/random_motion.hpp"

namespace egocal::test {

/// Faults of a bad network, each with its own probability.
struct Losses {
  double dropped = 0.2, doubled = 0.05, reordered = 0.05, flipped = 0.001;
};

struct RelayCounts {
  std::int64_t in = 0, out = 0;
  std::int64_t dropped = 0, doubled = 0, reordered = 0, flipped = 0;
  std::int64_t flipped_fingerprint_or_length = 0;  ///< of odometry_t: cannot be decoded any more
};

/// Relays messages with faults, which are drawn from the seed and counted. A reordered message goes out after
/// the next one of its channel; a flipped one has a single wrong bit.
class LossyRelay {
 public:
  using Send = std::function<void(const std::string& channel, bus::Bytes bytes)>;

  LossyRelay(const Losses& losses, std::uint64_t seed, Send send)
      : losses_(losses), random_(seed), send_(std::move(send)) {}

  void take(const std::string& channel, bus::Bytes bytes) {
    ++counts_.in;
    // all faults are drawn for every message, so that one probability does not change the draws of the others
    const bool drop = random_.uniform() < losses_.dropped;
    const bool twice = random_.uniform() < losses_.doubled;
    const bool late = random_.uniform() < losses_.reordered;
    const bool flip = random_.uniform() < losses_.flipped;
    const std::uint64_t bit = random_.bits();
    std::optional<Waiting>& waiting = waiting_[channel];
    std::optional<Waiting> now_due = std::exchange(waiting, std::nullopt);
    if (drop) {
      ++counts_.dropped;
    } else {
      Waiting message{{bytes.begin(), bytes.end()}, twice};
      counts_.doubled += twice;
      if (flip) flip_bit(message.bytes, bit % (8 * bytes.size()));
      if (late) {
        ++counts_.reordered;
        waiting = std::move(message);
      } else {
        pass(channel, message);
      }
    }
    if (now_due) pass(channel, *now_due);
  }
  /// Sends what was kept for later.
  void flush() {
    for (auto& [channel, waiting] : waiting_)
      if (waiting) pass(channel, *std::exchange(waiting, std::nullopt));
  }
  void set(const Losses& losses) { losses_ = losses; }

  const RelayCounts& counts() const { return counts_; }

 private:
  struct Waiting {
    std::vector<std::byte> bytes;
    bool twice;
  };

  void flip_bit(std::vector<std::byte>& bytes, std::uint64_t bit) {
    ++counts_.flipped;
    const std::size_t byte = bit / 8;
    if (byte < 8 || (byte >= 80 && byte < 84)) ++counts_.flipped_fingerprint_or_length;
    bytes[byte] ^= std::byte{1} << (bit % 8);
  }
  void pass(const std::string& channel, const Waiting& message) {
    for (int i = 0; i < (message.twice ? 2 : 1); ++i) {
      send_(channel, message.bytes);
      ++counts_.out;
    }
  }

  Losses losses_;
  testing::Random random_;
  Send send_;
  std::map<std::string, std::optional<Waiting>> waiting_;
  RelayCounts counts_;
};

}  // namespace egocal::test
