// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/loop.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/error.hpp"

namespace egocal::bus {

using Clock = std::chrono::steady_clock;

namespace {

/// Longest that messages are handled before timers, signals and the work on the newest ones get their turn.
constexpr std::chrono::milliseconds batch_time{5};

const char* const remedy =
    "; to allow it on this host: sudo ip link set lo up multicast on; sudo ip route add 224.0.0.0/4 dev lo";

/// liblcm tries for ten seconds before it gives up on a machine without a route: asking the kernel is
/// quicker.
void require_route(const std::string& url) {
  if (url.rfind("udpm://", 0) != 0) return;
  std::string address = url.substr(7, url.find_first_of(":/?", 7) - 7);
  if (address.empty()) address = "239.255.76.67";
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(7667);
  if (inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1)
    throw Error("LCM URL '" + url + "': '" + address + "' is not an IPv4 address");
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) throw Error(std::string("cannot open a UDP socket: ") + std::strerror(errno));
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  const int reason = errno;
  close(fd);
  if (result < 0) throw Error("no multicast to " + address + ": " + std::strerror(reason) + remedy);
}

/// The kernel's default buffer holds some twenty problems: asked for more it gives up to net.core.rmem_max,
/// twice the default without any setting.
std::string with_receive_buffer(const std::string& url) {
  if (url.rfind("udpm://", 0) != 0 || url.find("recv_buf_size") != std::string::npos) return url;
  return url + (url.find('?') == std::string::npos ? "?" : "&") + "recv_buf_size=4194304";
}

/// Standard error kept from the terminal while liblcm sets up; what it said goes into our own message.
class QuietStandardError {
 public:
  QuietStandardError()
      : file_(std::tmpfile()), saved_(file_ ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3) : -1) {
    if (saved_ >= 0) dup2(fileno(file_), STDERR_FILENO);
  }
  ~QuietStandardError() {
    restore();
    if (file_) std::fclose(file_);
  }
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;

  /// What was written, as one line.
  std::string said() {
    restore();
    if (!file_) return {};
    std::string text(2000, '\0');
    std::rewind(file_);
    text.resize(std::fread(text.data(), 1, text.size(), file_));
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }

 private:
  void restore() {
    if (saved_ < 0) return;
    dup2(saved_, STDERR_FILENO);
    close(saved_);
    saved_ = -1;
  }
  std::FILE* file_;
  int saved_;
};

sigset_t ending_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

/// Blocks the signals before liblcm starts its thread, and receives them as a file descriptor.
class Signals {
 public:
  explicit Signals(bool wanted) {
    if (!wanted) return;
    const sigset_t set = ending_signals();
    pthread_sigmask(SIG_BLOCK, &set, &before_);
    fd_ = signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  }
  ~Signals() {
    if (fd_ < 0) return;
    close(fd_);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  int fd() const { return fd_; }
  int read_one() const {
    signalfd_siginfo info{};
    return ::read(fd_, &info, sizeof info) == sizeof info ? static_cast<int>(info.ssi_signo) : 0;
  }

 private:
  sigset_t before_{};
  int fd_ = -1;
};

bool readable(int fd) {
  pollfd p{fd, POLLIN, 0};
  return poll(&p, 1, 0) > 0;
}

}  // namespace

struct Loop::Impl {
  struct Subscriber {
    Impl* loop;
    Handler handler;
  };
  struct Timer {
    TimerId id;
    Clock::time_point due;
    Duration period;  // zero: once
    Callback callback;
  };
  struct Watch {
    int fd;
    Callback callback;
  };

  Impl(const std::string& url, const LoopOptions& options) : signals(options.handle_signals) {
    require_route(url);
    QuietStandardError quiet;
    lcm.emplace(with_receive_buffer(url));
    if (!lcm->good()) throw Error("LCM does not understand the URL '" + url + "'; " + quiet.said());
    fd = lcm->getFileno();  // runs the multicast self-test
    if (fd < 0)
      throw Error("LCM's multicast self-test failed on '" + url + "' (routing or firewall)" + remedy);
  }

  static void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                         Subscriber* subscriber) {
    try {
      const Arrival arrival{
          channel, {static_cast<const std::byte*>(buffer->data), buffer->data_size}, mono_us()};
      subscriber->handler(arrival);
    } catch (...) {
      subscriber->loop->thrown = std::current_exception();
    }
  }

  void rethrow() {
    if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
  }

  void handle_messages() {
    const Clock::time_point end = Clock::now() + batch_time;
    bool caught_up = false;
    do {
      if (lcm->handle() < 0) throw Error("LCM has lost its connection");
      rethrow();
      caught_up = !readable(fd);
    } while (!caught_up && !stopped && Clock::now() < end);
    for (const auto& callback : batch_callbacks) callback(caught_up);
  }

  void run_timers() {
    const Clock::time_point now = Clock::now();
    std::vector<TimerId> due;
    for (const Timer& timer : timers)
      if (timer.due <= now) due.push_back(timer.id);
    for (const TimerId id : due) {
      const auto timer =
          std::find_if(timers.begin(), timers.end(), [id](const Timer& t) { return t.id == id; });
      if (timer == timers.end()) continue;  // cancelled by another one's callback
      Callback callback = timer->callback;
      if (timer->period.count() > 0)
        timer->due = std::max(timer->due + timer->period, now);
      else
        timers.erase(timer);
      callback();
    }
  }

  Signals signals;
  std::optional<lcm::LCM> lcm;
  int fd = -1;
  std::deque<Subscriber> subscribers;  // addresses stay valid
  std::vector<std::function<void(bool)>> batch_callbacks;
  std::vector<Timer> timers;
  std::vector<Watch> watches;
  TimerId next_timer = 1;
  std::exception_ptr thrown;
  bool stopped = false;
  int ended_by = 0;
};

Loop::Loop(const std::string& url, const LoopOptions& options)
    : impl_(std::make_unique<Impl>(url, options)) {}
Loop::~Loop() = default;

void Loop::subscribe_bytes(const std::string& channel, Handler handler, int queue_capacity) {
  impl_->subscribers.push_back({impl_.get(), std::move(handler)});
  lcm::Subscription* subscription =
      impl_->lcm->subscribeFunction(escaped(channel), &Impl::on_message, &impl_->subscribers.back());
  if (!subscription) throw Error("LCM cannot subscribe to channel '" + channel + "'");
  subscription->setQueueCapacity(queue_capacity);
}

void Loop::publish_bytes(const std::string& channel, Bytes bytes) {
  if (impl_->lcm->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) < 0)
    throw Error("LCM cannot send " + std::to_string(bytes.size()) + " bytes on channel '" + channel +
                "': " + std::strerror(errno));
}

void Loop::after_batch(std::function<void(bool)> callback) {
  impl_->batch_callbacks.push_back(std::move(callback));
}

Loop::TimerId Loop::every(Duration period, Callback callback) {
  impl_->timers.push_back({impl_->next_timer, Clock::now() + period, period, std::move(callback)});
  return impl_->next_timer++;
}

Loop::TimerId Loop::after(Duration delay, Callback callback) {
  impl_->timers.push_back({impl_->next_timer, Clock::now() + delay, Duration{0}, std::move(callback)});
  return impl_->next_timer++;
}

void Loop::cancel(TimerId timer) {
  std::erase_if(impl_->timers, [timer](const Impl::Timer& t) { return t.id == timer; });
}

void Loop::watch(int fd, Callback callback) {
  impl_->watches.push_back({fd, std::move(callback)});
}

void Loop::unwatch(int fd) {
  std::erase_if(impl_->watches, [fd](const Impl::Watch& w) { return w.fd == fd; });
}

bool Loop::run_once(Duration timeout) {
  if (impl_->stopped) return false;
  const Clock::time_point now = Clock::now();
  for (const Impl::Timer& timer : impl_->timers)
    timeout = std::min<Duration>(timeout, std::max<Duration>(timer.due - now, Duration{0}));
  std::vector<pollfd> fds{{impl_->fd, POLLIN, 0}, {impl_->signals.fd(), POLLIN, 0}};
  for (const Impl::Watch& watch : impl_->watches) fds.push_back({watch.fd, POLLIN, 0});
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const timespec wait{seconds.count(), (timeout - seconds).count()};
  const int ready = ppoll(fds.data(), fds.size(), &wait, nullptr);
  if (ready < 0 && errno != EINTR) throw Error(std::string("poll: ") + std::strerror(errno));
  if (ready > 0) {
    if (fds[1].revents) {
      impl_->ended_by = impl_->signals.read_one();
      impl_->stopped = impl_->stopped || impl_->ended_by != 0;
    }
    if (fds[0].revents && !impl_->stopped) impl_->handle_messages();
    for (std::size_t i = 2; i < fds.size() && !impl_->stopped; ++i) {
      if (!fds[i].revents) continue;
      const auto watch = std::find_if(impl_->watches.begin(), impl_->watches.end(),
                                      [&](const Impl::Watch& w) { return w.fd == fds[i].fd; });
      if (watch == impl_->watches.end()) continue;  // unwatched by another one's callback
      const Callback callback = watch->callback;
      callback();
    }
  }
  if (!impl_->stopped) impl_->run_timers();
  return !impl_->stopped;
}

void Loop::run() {
  while (run_once(std::chrono::hours(1))) {
  }
}

void Loop::stop() {
  impl_->stopped = true;
}

int Loop::signal() const {
  return impl_->ended_by;
}

std::int64_t mono_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

std::int64_t wall_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string host_name() {
  char name[256] = "";
  if (gethostname(name, sizeof name - 1) != 0) return "unknown";
  return name;
}

}  // namespace egocal::bus
