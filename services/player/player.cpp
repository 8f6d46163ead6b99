// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/player.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "egocal/bus/channels.hpp"
#include "egocal/error.hpp"

namespace egocal::services {

namespace {

using namespace std::chrono_literals;

/// liblcm's receive queue and the kernel's buffer hold this many poses many times over.
constexpr std::size_t most_in_flight = 64;
/// At full speed one turn of the loop sends no more than this before it listens.
constexpr int most_at_once = 64;
constexpr std::int64_t wait_for_pairing_us = 3'000'000;
constexpr std::int64_t stall_us = 500'000;
constexpr std::int64_t announced_gap_us = 5'000'000;

std::regex compiled(const std::string& expression) {
  try {
    return std::regex(expression);
  } catch (const std::regex_error& error) {
    throw Error("--channel: '" + expression + "' is not a regular expression: " + error.what());
  }
}

}  // namespace

Player::Player(bus::Loop& loop, bus::Heartbeat& heartbeat, const PlayerOptions& options)
    : loop_(loop), heartbeat_(heartbeat), options_(options), log_(options.log), paused_(options.paused) {
  if (!options.channel.empty()) channel_ = compiled(options.channel);
  terminal_ = isatty(STDERR_FILENO) != 0;
  begin_us_ = log_.next()->time_us;
  log_.rewind();
  if (!load())
    throw error_at(options.log, 0, "", "nothing to play: no event of the channels and times asked for");
  started_mono_us_ = progress_mono_us_ = bus::mono_us();
  anchor();
  heartbeat_.on_status([this](const status_t& status) { hear(status); });
  heartbeat_.before_publish([this] {
    heartbeat_.counter("out") = static_cast<std::int64_t>(out_);
    heartbeat_.counter("lost: damaged bytes of the log") = static_cast<std::int64_t>(log_.damage().bytes);
    heartbeat_.counter("lost: damaged regions of the log") = static_cast<std::int64_t>(log_.damage().regions);
  });
  heartbeat_.set_state(paused_ ? "paused" : "running");
  heartbeat_.publish();
  loop_.subscribe<command_t>(bus::command_channel,
                             [this](const command_t& command, const bus::Arrival&) { hear(command); });
  loop_.every(100ms, [this] { watch_over(); });
  if (isatty(STDIN_FILENO)) loop_.watch(STDIN_FILENO, [this] { take_line(); });
  play();
}

void Player::hear(const status_t& status) {
  if (status.role != "pairing" || status.state == "waiting" || status.state == "ended") return;
  const std::int64_t now = bus::mono_us();
  const bool first = !in_flight_.heard();
  const InFlight::Progress progress = in_flight_.acknowledged(status);
  if (progress.any) {
    progress_mono_us_ = now;
    alone_ = false;
    if (first) anchor();
  }
  if (progress.send_again) send_again();
  if (progress.any) play();
}

void Player::hear(const command_t& command) {
  if (command.to != "*" && command.to != heartbeat_.identity().name) return;
  if (command.verb != "pause" && command.verb != "resume") return;
  paused_ = command.verb == "pause";
  heartbeat_.set_state(paused_ ? "paused" : "running");
  anchor();
  play();
}

/// On a terminal: pause, resume, step, speed S, seek S, quit.
void Player::take_line() {
  char buffer[256];
  const ssize_t got = read(STDIN_FILENO, buffer, sizeof buffer - 1);
  if (got <= 0) {
    loop_.unwatch(STDIN_FILENO);
    return;
  }
  std::istringstream line(std::string(buffer, static_cast<std::size_t>(got)));
  std::string verb;
  double value = -1;
  line >> verb >> value;
  if (verb == "quit" || verb == "q") {
    loop_.stop();
  } else if (verb == "pause" || verb == "p") {
    paused_ = !paused_ || verb == "pause";
  } else if (verb == "resume" || verb == "r") {
    paused_ = false;
  } else if (verb == "step" || verb == "s") {
    step_ = paused_ = true;
  } else if (verb == "speed" && value >= 0) {
    options_.speed = value;
  } else if (verb == "seek" && value >= 0) {
    seek(value);
  } else {
    std::fprintf(stderr, "egocal-player: expected pause, resume, step, speed S, seek S or quit\n");
  }
  heartbeat_.set_state(paused_ ? "paused" : "running");
  anchor();
  play();
}

/// The next event that is to be played.
bool Player::load() {
  while ((next_ = log_.next())) {
    const double into = 1e-6 * static_cast<double>(next_->time_us - begin_us_);
    if (options_.end && into > *options_.end) {
      next_.reset();
      return false;
    }
    if (into < options_.start || (channel_ && !std::regex_match(next_->channel, *channel_))) continue;
    return true;
  }
  return false;
}

void Player::seek(double seconds) {
  const double start = options_.start;
  options_.start = seconds;
  log_.rewind();
  if (!load()) std::fprintf(stderr, "egocal-player: nothing at %.1f s and later\n", seconds);
  options_.start = start;
  in_flight_.clear();
}

/// Recorded and real time run together from here.
void Player::anchor() {
  anchor_us_ = next_ ? next_->time_us : 0;
  anchor_mono_us_ = bus::mono_us();
}

void Player::send(const bus::LogEvent& event) {
  loop_.publish_bytes(event.channel, event.data);
  ++out_;
}

void Player::send_again() {
  for (const bus::LogEvent& event : in_flight_.all()) {
    send(event);
    ++heartbeat_.counter("sent again");
  }
}

void Player::play() {
  if (timer_) loop_.cancel(*timer_);
  timer_.reset();
  // at any speed but that of the recording it is worth waiting for somebody to keep in step with
  const bool waits_for_pairing = !in_flight_.heard() && !alone_ && options_.speed != 1;
  for (int sent = 0; next_ && (!paused_ || step_) && !waits_for_pairing; ++sent) {
    if (in_flight_.count() >= most_in_flight) return;  // goes on with the next acknowledgement
    const double speed = options_.speed == 0 && alone_ ? 1 : options_.speed;
    if (speed > 0 && !step_) {
      const auto due =
          anchor_mono_us_ + std::llround(static_cast<double>(next_->time_us - anchor_us_) / speed);
      const std::int64_t wait = due - bus::mono_us();
      if (wait > 0) {
        if (wait > announced_gap_us)
          std::fprintf(stderr, "egocal-player: gap of %.1f s in the log, %.1f s to wait\n",
                       1e-6 * speed * static_cast<double>(wait), 1e-6 * static_cast<double>(wait));
        timer_ = loop_.after(std::chrono::microseconds(wait), [this] {
          timer_.reset();
          play();
        });
        return;
      }
    } else if (sent == most_at_once) {
      timer_ = loop_.after(0ns, [this] {
        timer_.reset();
        play();
      });
      return;
    }
    if (in_flight_.count() == 0) progress_mono_us_ = bus::mono_us();
    send(*next_);
    in_flight_.sent(*next_);
    step_ = false;
    if (!load() && options_.loop) {
      log_.rewind();
      load();
      anchor();
    }
  }
  if (!next_ && !ended_) {
    ended_ = true;
    progress_mono_us_ = bus::mono_us();
  }
  if (ended_ && in_flight_.count() == 0) finish();
}

/// Ten times a second: nobody there, something lost, the end.
void Player::watch_over() {
  const std::int64_t now = bus::mono_us();
  show_progress(false);
  if (!in_flight_.heard() && !alone_ && now - started_mono_us_ > wait_for_pairing_us) {
    alone_ = true;
    if (options_.speed != 1)
      std::fprintf(
          stderr,
          "egocal-player: no pairing process acknowledges anything; going on without keeping in step%s\n",
          options_.speed == 0 ? ", at the recorded speed" : "");
    anchor();
    play();
  }
  if (in_flight_.count() > 0 && now - progress_mono_us_ > stall_us && heartbeat_.alive("pairing")) {
    send_again();
    progress_mono_us_ = now;
  }
  // whoever is gone for long at the end of the log will not be waited for
  if (ended_ && now - progress_mono_us_ > 10'000'000) {
    std::fprintf(stderr, "egocal-player: %zu messages were never acknowledged\n", in_flight_.count());
    in_flight_.clear();
    finish();
  }
}

void Player::finish() {
  show_progress(true);
  const bus::LogDamage& damage = log_.damage();
  if (damage.regions > 0)
    std::fprintf(
        stderr,
        "egocal-player: %s: %llu damaged regions skipped, %llu bytes and at least %llu events lost%s\n",
        options_.log.c_str(), static_cast<unsigned long long>(damage.regions),
        static_cast<unsigned long long>(damage.bytes), static_cast<unsigned long long>(damage.lost_events),
        damage.truncated ? "; the log is cut off" : "");
  loop_.stop();
}

void Player::show_progress(bool last) {
  if (!terminal_) return;
  const std::int64_t now = bus::mono_us();
  if (!last && now - shown_mono_us_ < 200'000) return;
  shown_mono_us_ = now;
  const double part =
      static_cast<double>(log_.position()) / static_cast<double>(std::max<std::uint64_t>(1, log_.size()));
  const std::int64_t at = next_ ? next_->time_us : anchor_us_;
  std::fprintf(stderr, "\r%s %3.0f %%  %8.1f s  %llu messages%s", paused_ ? "paused " : "playing", 100 * part,
               1e-6 * static_cast<double>(at - begin_us_), static_cast<unsigned long long>(out_),
               last ? "\n" : "  ");
  std::fflush(stderr);
}

}  // namespace egocal::services
