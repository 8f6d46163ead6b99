// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What arrives while a process computes: over a network of the test's own, with a small buffer of the kernel.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "egocal/bus/datagrams.hpp"
#include "egocal/bus/loop.hpp"

namespace egocal::bus::test_receive_while {
namespace {

using namespace std::chrono_literals;

/// Bytes that wait in the kernel for the receiver, which alone listens on the port.
long waiting_bytes() {
  std::ifstream table("/proc/net/udp");
  long bytes = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream fields(line);
    std::string number, local, remote, state, queues;
    fields >> number >> local >> remote >> state >> queues;
    // port 7668
    if (local.ends_with(":1DF4")) bytes += std::stol(queues.substr(queues.find(':') + 1), nullptr, 16);
  }
  return bytes;
}

/// A socket that listens to nothing.
class Sender {
 public:
  Sender() {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(7668);
    inet_pton(AF_INET, "239.255.76.68", &to_.sin_addr);
  }
  ~Sender() { close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Sends messages, and waits after each twentieth until the receiver has taken them. False: it leaves them
  /// in the kernel.
  bool send(int messages) {
    const std::vector<std::byte> bytes(200);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(messages); ++i) {
      for_each_datagram("DATA", bytes, i, [this](const Datagram& datagram) {
        std::vector<std::byte> all(datagram.header().begin(), datagram.header().end());
        all.insert(all.end(), datagram.payload.begin(), datagram.payload.end());
        return sendto(fd_, all.data(), all.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_) >=
               0;
      });
      for (int wait = 0; i % 20 == 19 && waiting_bytes() > 0; ++wait) {
        if (wait == 10'000) return false;
        std::this_thread::sleep_for(1ms);
      }
    }
    return true;
  }

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to_{};
};

struct Receiver {
  explicit Receiver(int capacity = 10'000) {
    loop.subscribe_bytes(
        "DATA", [this](const Arrival&) { ++handled; }, capacity);
  }
  void handle_all() {
    for (int before = -1; before != handled;) {
      before = handled;
      loop.run_once(50ms);
    }
  }
  Loop loop{"udpm://239.255.76.68:7668?ttl=0&recv_buf_size=65536", {.handle_signals = false}};
  int handled = 0;
};

// 2000 messages are ten times what the buffer of the kernel holds.
TEST(ReceiveWhile, AComputationCostsNoMessage) {
  Receiver receiver;
  Sender sender;
  bool received = false;
  int handled_meanwhile = -1;
  receiver.loop.receive_while([&] {
    received = sender.send(2000);
    handled_meanwhile = receiver.handled;
  });
  EXPECT_TRUE(received);
  EXPECT_EQ(handled_meanwhile, 0);
  receiver.handle_all();
  EXPECT_EQ(receiver.handled, 2000);
  EXPECT_EQ(receiver.loop.counts().transport.buffer_overflow, 0);
  EXPECT_EQ(receiver.loop.counts().queue_full, 0);
}

TEST(ReceiveWhile, WhatTheQueueHasNoRoomForIsCounted) {
  Receiver receiver(500);
  Sender sender;
  receiver.loop.receive_while([&] { EXPECT_TRUE(sender.send(2000)); });
  receiver.handle_all();
  EXPECT_EQ(receiver.handled, 500);
  EXPECT_EQ(receiver.loop.counts().queue_full, 1500);
}

TEST(ReceiveWhile, WhatTheWorkThrowsIsThrown) {
  Receiver receiver;
  const auto fails = [] { throw std::runtime_error("the work's"); };
  EXPECT_THROW(receiver.loop.receive_while(fails), std::runtime_error);
  Loop alone("memq://", {.handle_signals = false});
  EXPECT_THROW(alone.receive_while(fails), std::runtime_error);
}

// A simulation has a network without file descriptor, and one thread.
TEST(ReceiveWhile, WithoutAFileDescriptorTheWorkRunsHere) {
  Loop loop("memq://", {.handle_signals = false});
  std::thread::id id;
  loop.receive_while([&] { id = std::this_thread::get_id(); });
  EXPECT_EQ(id, std::this_thread::get_id());
}

}  // namespace
}  // namespace egocal::bus::test_receive_while
