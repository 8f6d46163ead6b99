// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "egocal/bus/clock.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/bus/transport.hpp"

namespace egocal::bus {

/// What a handler receives beside the message.
struct Arrival {
  const std::string& channel;
  Bytes bytes;
  std::int64_t mono_us;  ///< when the host received it, before it waited in any queue [us]
};

struct LoopOptions {
  /// SIGINT and SIGTERM end run(). They are blocked from construction on, in every thread started after it.
  bool handle_signals = true;
  /// The constructor throws where the network is away: right for commands that do one thing and end.
  /// Processes that run for days wait for it instead, see on_network().
  bool require_network = true;
  /// Name of this host in messages; empty: the machine's own.
  std::string host{};

  // Study of these: bench_processes and tests/bus/test_loop.cpp; docs/processes.md.
  /// Longest that messages are handled before timers, signals and the work on the newest ones get their turn.
  std::chrono::nanoseconds longest_batch{5'000'000};
  /// And most messages, where the clock does not advance meanwhile.
  int most_in_batch = 10'000;
  /// The transport's own buffer is emptied into the queue this often meanwhile: a slow handler of one channel
  /// does not cost messages of another.
  std::chrono::nanoseconds drain_period{1'000'000};
  /// The network is looked at this often: a cable that is plugged in again is noticed as fast as a person
  /// looks up.
  std::chrono::nanoseconds network_period{1'000'000'000};
  /// Channels whose undecodable messages are counted by name; a forger can invent any number of them.
  std::size_t most_undecodable = 64;
};

/// What the loop could not deliver, since it was made.
struct LoopCounts {
  std::int64_t not_sent = 0;    ///< messages
  std::int64_t queue_full = 0;  ///< messages of a channel that came faster than its handler took them
  TransportCounts transport;
};

/// The loop of a process: messages, timers, signals and other file descriptors, on one thread but for
/// receive_while(). Not thread-safe. What a handler throws leaves run(). Transport and clock can be handed
/// in: then nothing here opens a socket, waits, or looks at any other clock.
class Loop {
 public:
  using Handler = std::function<void(const Arrival&)>;
  using Callback = std::function<void()>;
  using Duration = std::chrono::nanoseconds;

  /// Connects to the URL (parse_lcm_url) on the system's clock. Throws Error with the remedy where the URL is
  /// not understood or, with require_network, the machine cannot multicast.
  explicit Loop(const std::string& url, const LoopOptions& options = {});
  /// The clock must outlive the loop.
  Loop(std::unique_ptr<Transport> transport, const Clock& clock, const LoopOptions& options = {});
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  const Clock& clock() const;
  std::int64_t mono_us() const { return clock().mono_us(); }
  std::int64_t wall_us() const { return clock().wall_us(); }
  /// Name of this host in messages.
  const std::string& host() const;

  /// Calls the handler for every message of exactly this channel. While queue_capacity of its messages wait,
  /// newer ones are dropped and counted: memory stays bounded.
  void subscribe_bytes(const std::string& channel, Handler handler, int queue_capacity = 256);
  /// The same for every channel whose name begins so. All of them share one queue.
  void subscribe_prefix(const std::string& prefix, Handler handler, int queue_capacity = 256);

  /// Calls the handler for every message of a channel that nothing else here subscribes to, while wanted()
  /// states it; it is asked before anything of a message is kept. Once.
  void subscribe_others(Handler handler, std::function<bool()> wanted, int queue_capacity = 256);

  /// subscribe_bytes, decoded. What cannot be decoded is counted in undecodable() and not handed on.
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
            count_undecodable(arrival.channel);
        },
        queue_capacity);
  }

  /// Messages that were not what their channel promises, by channel; beyond LoopOptions::most_undecodable
  /// under "other".
  const std::map<std::string, std::int64_t>& undecodable() const { return undecodable_; }
  void count_undecodable(const std::string& channel);

  /// Sends a message. False: it was not sent, see send_error(). That is counted, and no reason to end: the
  /// next message may go.
  bool publish_bytes(const std::string& channel, Bytes bytes);
  template <class Message>
  bool publish(const std::string& channel, const Message& message) {
    return publish_bytes(channel, encode(message));
  }
  /// Why the last message could not be sent, one line; empty: it was sent.
  const std::string& send_error() const;

  /// The problem of the network, with its remedy; empty: there is none. Checked once a second.
  const std::string& network_error() const;
  /// Sets a callback that receives network_error() whenever it changes.
  void on_network(std::function<void(const std::string& error)> callback);

  LoopCounts counts() const;

  /// Sets a callback for work that needs only the newest message. It is called when all waiting messages have
  /// been handled, and under a flood at least every 5 ms. caught_up: no more messages are waiting.
  void after_batch(std::function<void(bool caught_up)> callback);

  using TimerId = std::uint64_t;
  TimerId every(Duration period, Callback callback);
  TimerId after(Duration delay, Callback callback);
  void cancel(TimerId timer);
  /// When the next timer is due, of clock().mono_ns(); empty: there is none.
  std::optional<std::int64_t> next_timer_ns() const;

  /// Runs work, and receives messages into their queues until it has ended: a computation of seconds costs no
  /// message that its queue has room for. Calls no handler, timer or watch meanwhile. Work runs on a thread
  /// of its own and must not use the loop. Where the transport has no fd(), or the system gives no thread,
  /// work runs alone. Rethrows what work throws.
  void receive_while(const Callback& work);

  /// Calls back while the file descriptor is readable (or hung up).
  void watch(int fd, Callback callback);
  void unwatch(int fd);

  /// Runs until stop() or a signal. Rethrows what a handler threw.
  void run();
  /// One turn: waits at most this long for anything to happen and handles it. False once the loop was
  /// stopped.
  bool run_once(Duration timeout);
  void stop();
  /// The signal that ended run(); 0: none.
  int signal() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::map<std::string, std::int64_t> undecodable_;
};

/// The machine's own name.
std::string host_name();

}  // namespace egocal::bus
