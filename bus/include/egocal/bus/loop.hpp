// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "egocal/bus/decode.hpp"

namespace egocal::bus {

/// What a handler learns beside the message.
struct Arrival {
  const std::string& channel;
  Bytes bytes;
  std::int64_t mono_us;  ///< CLOCK_MONOTONIC when the handler was called [us]
};

struct LoopOptions {
  /// SIGINT and SIGTERM end run(). They are blocked from construction on, in every thread started after it.
  bool handle_signals = true;
};

/// The one thread of a process: LCM, timers, signals and other file descriptors in one poll(). Exceptions of
/// handlers never cross liblcm's C frames: they leave run() instead.
class Loop {
 public:
  using Handler = std::function<void(const Arrival&)>;
  using Callback = std::function<void()>;
  using Duration = std::chrono::nanoseconds;

  /// Connects and runs LCM's multicast self-test at once. Throws Error, naming the remedy, where the URL is
  /// not understood or the machine cannot multicast. Also: memq:// (tests of handlers, one process).
  explicit Loop(const std::string& url, const LoopOptions& options = {});
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Calls the handler for every message of exactly this channel. While queue_capacity messages wait, liblcm
  /// drops newer ones: memory stays bounded.
  void subscribe_bytes(const std::string& channel, Handler handler, int queue_capacity = 256);

  /// The same, decoded. What cannot be decoded is counted in undecodable() and not handed on.
  template <class Message>
  void subscribe(const std::string& channel, std::function<void(const Message&, const Arrival&)> handler,
                 int queue_capacity = 256) {
    subscribe_bytes(
        channel,
        [this, handler = std::move(handler)](const Arrival& arrival) {
          Message message{};
          if (decode(arrival.bytes, message))
            handler(message, arrival);
          else
            ++undecodable_[arrival.channel];
        },
        queue_capacity);
  }

  /// Messages that were not what their channel promises, by channel.
  const std::map<std::string, std::int64_t>& undecodable() const { return undecodable_; }
  void count_undecodable(const std::string& channel) { ++undecodable_[channel]; }

  /// Throws Error where LCM cannot send.
  void publish_bytes(const std::string& channel, Bytes bytes);
  template <class Message>
  void publish(const std::string& channel, const Message& message) {
    publish_bytes(channel, encode(message));
  }

  /// Called when all messages that were waiting have been handled, and under a flood at least every 5 ms: the
  /// place for work that only the newest message needs. caught_up: nothing more is waiting.
  void after_batch(std::function<void(bool caught_up)> callback);

  using TimerId = std::uint64_t;
  TimerId every(Duration period, Callback callback);
  TimerId after(Duration delay, Callback callback);
  void cancel(TimerId timer);

  /// Calls back while the file descriptor is readable (or hung up).
  void watch(int fd, Callback callback);
  void unwatch(int fd);

  /// Until stop() or a signal. Rethrows what a handler threw.
  void run();
  /// One turn: waits at most this long for anything to happen and handles it. False once the loop has been
  /// told to stop.
  bool run_once(Duration timeout);
  void stop();
  /// The signal that ended run(); 0: none.
  int signal() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::map<std::string, std::int64_t> undecodable_;
};

/// CLOCK_MONOTONIC, the same for every process of a host [us].
std::int64_t mono_us();
/// Wall clock [us].
std::int64_t wall_us();
std::string host_name();

}  // namespace egocal::bus
