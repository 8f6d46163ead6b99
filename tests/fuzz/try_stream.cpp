// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "egocal/pairing/stream.hpp"
#include "fuzz/input_bytes.hpp"
#include "fuzz/require.hpp"
#include "fuzz/try_sequence.hpp"

namespace egocal::fuzz {

namespace {

/// What came out: in order, except for messages without numbers and where a new timeline begins.
class Received {
 public:
  void take(const std::vector<NumberedPose>& poses) {
    for (const NumberedPose& pose : poses) {
      const std::int64_t time_us = pose.pose.time_us;
      require(pose.begins_anew || count_ == 0 || pose.seq < 0 || time_us > newest_us_,
              "numbered poses come in order");
      newest_us_ = pose.begins_anew || count_ == 0 ? time_us : std::max(newest_us_, time_us);
      ++count_;
    }
  }
  std::int64_t count() const { return count_; }

 private:
  std::int64_t count_ = 0, newest_us_ = 0;
};

void check(const Stream& stream, std::int64_t pushed, std::int64_t received) {
  const StreamState& state = stream.state();
  const StreamCounts& counts = stream.counts();
  const std::size_t most = static_cast<std::size_t>(StreamOptions{}.most_missing) + 1;
  require(state.early.size() + state.held.size() <= 2 * most && state.lost.size() <= most &&
              state.candidates.size() <= 3 && state.ahead.size() <= 3,
          "memory is bounded");
  const auto waiting = static_cast<std::int64_t>(state.early.size() + state.held.size() +
                                                 state.candidates.size() + state.ahead.size());
  require(pushed == received + counts.duplicate + counts.out_of_order + counts.jump + waiting,
          "every pose is handed on, counted or held back");
  require(counts.lost >= 0, "no less than nothing is lost");
}

}  // namespace

void try_stream(const std::uint8_t* data, std::size_t size) {
  InputBytes input(data, size);
  StreamOptions options;
  options.look_ahead = (input.byte() & 1) != 0;
  Stream stream(options);
  Received received;
  std::int64_t pushed = 0, time_us = 1'700'000'000'000'000, seq = 0;
  while (!input.done()) {
    const std::uint8_t choice = input.byte();
    if (choice < 240) {
      NumberedPose pose;
      time_us = pose.pose.time_us = input.near(time_us, 100'000);
      if (choice < 200) seq = pose.seq = input.near(seq, 1);
      ++pushed;
      received.take(stream.push(pose));
    } else if (choice < 242) {
      received.take(stream.flush());
    } else if (choice < 244) {
      received.take(choice == 242 ? stream.give_up_first_gap() : stream.end_settling());
    } else if (choice < 248) {
      stream.be_patient((choice & 1) != 0);
    } else if (choice < 252) {
      stream.settle();  // what was held back is counted, and is sent again
    } else {
      Stream other(options);
      other.restore(stream.state());
      stream = std::move(other);
    }
    check(stream, pushed, received.count());
  }
  received.take(stream.flush());
  check(stream, pushed, received.count());
  require(!stream.waiting(), "nothing is held back after a flush");
}

}  // namespace egocal::fuzz
