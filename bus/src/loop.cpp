// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/loop.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "egocal/bus/check.hpp"
#include "egocal/bus/work_thread.hpp"
#include "egocal/error.hpp"
#include "ending_signals.hpp"
#include "message_queue.hpp"

namespace egocal::bus {

namespace {

using namespace std::chrono_literals;

}  // namespace

struct Loop::Impl {
  struct Timer {
    TimerId id;
    std::int64_t due_ns;
    Duration period;  // zero: once
    Callback callback;
  };
  struct Watch {
    int fd;
    Callback callback;
  };

  Impl(std::unique_ptr<Transport> bus, const Clock& time, const LoopOptions& given)
      : options(given),
        signals(options.handle_signals),
        transport(std::move(bus)),
        clock(time),
        host(options.host.empty() ? host_name() : options.host) {
    network_error = transport->network_error();
    if (options.require_network && !network_error.empty()) throw Error(network_error);
  }

  void watch_network() {
    std::string now = transport->network_error();
    if (now == network_error) return;
    network_error = std::move(now);
    if (on_network) on_network(network_error);
  }

  void handle_messages() {
    const std::int64_t end = clock.mono_ns() + options.longest_batch.count();
    std::int64_t next_drain = 0;
    int handled = 0;
    for (std::int64_t now = clock.mono_ns(); !stopped; now = clock.mono_ns()) {
      if (queue.empty() || now >= next_drain) {
        queue.fill(*transport);
        next_drain = now + options.drain_period.count();
      }
      if (queue.empty() || now >= end || handled++ == options.most_in_batch) break;
      queue.handle_one();
    }
    // a callback may add another one, which is called after the next batch
    for (std::size_t i = 0, all = batch_callbacks.size(); i < all; ++i) batch_callbacks[i](queue.empty());
  }

  void wait(std::span<pollfd> fds, Duration timeout) const {
    if (clock.wait(fds, timeout) < 0 && errno != EINTR)
      throw Error(std::string("poll: ") + std::strerror(errno));
  }

  void run_timers() {
    const std::int64_t now = clock.mono_ns();
    EGOCAL_CHECK(now >= timers_run_ns, "the monotonic clock never goes back");
    timers_run_ns = now;
    std::vector<TimerId> due;
    for (const Timer& timer : timers)
      if (timer.due_ns <= now) due.push_back(timer.id);
    for (const TimerId id : due) {
      const auto timer =
          std::find_if(timers.begin(), timers.end(), [id](const Timer& t) { return t.id == id; });
      if (timer == timers.end()) continue;  // cancelled by another one's callback
      Callback callback = timer->callback;
      if (timer->period.count() > 0)
        timer->due_ns = std::max(timer->due_ns + timer->period.count(), now);
      else
        timers.erase(timer);
      callback();
    }
  }

  void run_watches(std::span<const pollfd> fds) {
    for (const pollfd& ready : fds) {
      if (!ready.revents || stopped) continue;
      const auto watch =
          std::find_if(watches.begin(), watches.end(), [&](const Watch& w) { return w.fd == ready.fd; });
      if (watch == watches.end()) continue;  // unwatched by another one's callback
      const Callback callback = watch->callback;
      callback();
    }
  }

  TimerId add_timer(Duration delay, Duration period, Callback callback) {
    EGOCAL_CHECK(callback != nullptr && period.count() >= 0, "a timer has something to do");
    timers.push_back({next_timer, clock.mono_ns() + delay.count(), period, std::move(callback)});
    return next_timer++;
  }

  LoopOptions options;
  EndingSignals signals;
  std::unique_ptr<Transport> transport;
  const Clock& clock;
  std::string host;
  MessageQueue queue;
  std::string network_error, send_error;
  std::function<void(const std::string&)> on_network;
  std::int64_t not_sent = 0;
  std::deque<std::function<void(bool)>> batch_callbacks;  // one that runs stays where it is
  std::vector<Timer> timers;
  std::vector<Watch> watches;
  TimerId next_timer = 1;
  std::int64_t timers_run_ns = std::numeric_limits<std::int64_t>::min();
  bool stopped = false;
  int ended_by = 0;
};

Loop::Loop(const std::string& url, const LoopOptions& options)
    : Loop(open_transport(parse_lcm_url(url), system_clock()), system_clock(), options) {}

Loop::Loop(std::unique_ptr<Transport> transport, const Clock& clock, const LoopOptions& options)
    : impl_(std::make_unique<Impl>(std::move(transport), clock, options)) {
  every(options.network_period, [this] {
    impl_->transport->check_network();
    impl_->watch_network();
  });
}

Loop::~Loop() = default;

const Clock& Loop::clock() const {
  return impl_->clock;
}

const std::string& Loop::host() const {
  return impl_->host;
}

void Loop::subscribe_bytes(const std::string& channel, Handler handler, int queue_capacity) {
  impl_->queue.subscribe(channel, false, std::move(handler), queue_capacity);
}

void Loop::subscribe_prefix(const std::string& prefix, Handler handler, int queue_capacity) {
  impl_->queue.subscribe(prefix, true, std::move(handler), queue_capacity);
}

void Loop::subscribe_others(Handler handler, std::function<bool()> wanted, int queue_capacity) {
  impl_->queue.subscribe_others(std::move(handler), std::move(wanted), queue_capacity);
}

void Loop::count_undecodable(const std::string& channel) {
  const bool known = undecodable_.size() < impl_->options.most_undecodable || undecodable_.contains(channel);
  ++undecodable_[known ? channel : "other"];
}

bool Loop::publish_bytes(const std::string& channel, Bytes bytes) {
  const SendStatus status = impl_->transport->send(channel, bytes);
  if (status == SendStatus::sent) {
    impl_->send_error.clear();
    if (!impl_->network_error.empty()) impl_->watch_network();
    return true;
  }
  ++impl_->not_sent;
  if (status == SendStatus::no_network) {
    impl_->watch_network();
    impl_->send_error = impl_->network_error;
  } else {
    impl_->send_error = "cannot send " + std::to_string(bytes.size()) + " bytes on channel '" + channel +
                        "': more than LCM's messages can hold";
  }
  return false;
}

const std::string& Loop::send_error() const {
  return impl_->send_error;
}

const std::string& Loop::network_error() const {
  return impl_->network_error;
}

void Loop::on_network(std::function<void(const std::string&)> callback) {
  impl_->on_network = std::move(callback);
}

LoopCounts Loop::counts() const {
  return {impl_->not_sent, impl_->queue.dropped(), impl_->transport->counts()};
}

void Loop::after_batch(std::function<void(bool)> callback) {
  impl_->batch_callbacks.push_back(std::move(callback));
}

Loop::TimerId Loop::every(Duration period, Callback callback) {
  return impl_->add_timer(period, period, std::move(callback));
}

Loop::TimerId Loop::after(Duration delay, Callback callback) {
  return impl_->add_timer(delay, Duration{0}, std::move(callback));
}

void Loop::cancel(TimerId timer) {
  std::erase_if(impl_->timers, [timer](const Impl::Timer& t) { return t.id == timer; });
}

std::optional<std::int64_t> Loop::next_timer_ns() const {
  std::optional<std::int64_t> next;
  for (const Impl::Timer& timer : impl_->timers) next = std::min(next.value_or(timer.due_ns), timer.due_ns);
  return next;
}

void Loop::receive_while(const Callback& work) {
  Impl& impl = *impl_;
  if (impl.transport->fd() < 0) return work();
  WorkThread thread(work);
  while (!thread.ended()) {
    std::array fds{pollfd{impl.transport->fd(), POLLIN, 0}, pollfd{thread.fd(), POLLIN, 0}};
    impl.wait(fds, impl.transport->ready() ? Duration{0} : Duration{1h});
    if (fds[0].revents || impl.transport->ready()) impl.queue.fill(*impl.transport);
  }
  thread.finish();
}

void Loop::watch(int fd, Callback callback) {
  impl_->watches.push_back({fd, std::move(callback)});
}

void Loop::unwatch(int fd) {
  std::erase_if(impl_->watches, [fd](const Impl::Watch& w) { return w.fd == fd; });
}

bool Loop::run_once(Duration timeout) {
  Impl& impl = *impl_;
  if (impl.stopped) return false;
  const auto waiting = [&] { return !impl.queue.empty() || impl.transport->ready(); };
  if (const std::optional<std::int64_t> due = next_timer_ns())
    timeout = std::min<Duration>(timeout, Duration(*due - impl.clock.mono_ns()));
  if (waiting()) timeout = Duration{0};
  std::vector<pollfd> fds{{impl.transport->fd(), POLLIN, 0}, {impl.signals.fd(), POLLIN, 0}};
  for (const Impl::Watch& watch : impl.watches) fds.push_back({watch.fd, POLLIN, 0});
  impl.wait(fds, std::max(timeout, Duration{0}));
  if (fds[1].revents) {
    impl.ended_by = impl.signals.read_one();
    impl.stopped = impl.stopped || impl.ended_by != 0;
  }
  if ((fds[0].revents || waiting()) && !impl.stopped) impl.handle_messages();
  impl.run_watches(std::span(fds).subspan(2));
  if (!impl.stopped) impl.run_timers();
  return !impl.stopped;
}

void Loop::run() {
  while (run_once(1h)) {
  }
}

void Loop::stop() {
  impl_->stopped = true;
}

int Loop::signal() const {
  return impl_->ended_by;
}

std::string host_name() {
  char name[256] = "";
  if (gethostname(name, sizeof name - 1) != 0) return "unknown";
  return name;
}

}  // namespace egocal::bus
