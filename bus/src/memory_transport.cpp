// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "memory_transport.hpp"

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/datagrams.hpp"

namespace egocal::bus {

namespace {

class MemoryTransport final : public Transport {
 public:
  explicit MemoryTransport(const Clock& clock) : clock_(clock) {}

  SendStatus send(std::string_view channel, Bytes bytes) override {
    if (!fits_datagrams(channel, bytes)) return SendStatus::too_large;
    waiting_.push_back({std::string(channel), {bytes.begin(), bytes.end()}, clock_.mono_us()});
    return SendStatus::sent;
  }

  bool receive(const Wanted& wanted, Received& message) override {
    while (!waiting_.empty()) {
      current_ = std::move(waiting_.front());
      waiting_.pop_front();
      if (!wanted(current_.channel)) continue;
      message = {current_.channel, current_.bytes, current_.mono_us};
      return true;
    }
    return false;
  }

  int fd() const override { return -1; }
  bool ready() const override { return !waiting_.empty(); }
  void check_network() override {}
  std::string network_error() const override { return {}; }
  TransportCounts counts() const override { return {}; }

 private:
  struct Waiting {
    std::string channel;
    std::vector<std::byte> bytes;
    std::int64_t mono_us = 0;
  };
  const Clock& clock_;
  std::deque<Waiting> waiting_;
  Waiting current_;
};

}  // namespace

std::unique_ptr<Transport> open_memory_transport(const Clock& clock) {
  return std::make_unique<MemoryTransport>(clock);
}

}  // namespace egocal::bus
