// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/player.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "egocal/bus/channels.hpp"
#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"
#include "player/printed_text.hpp"

namespace egocal::services {

namespace {

using namespace std::chrono_literals;

/// A longer wait does not fit into a timer [us].
constexpr double longest_wait_us = 1e15;

}  // namespace

Player::Player(bus::Loop& loop, bus::Heartbeat& heartbeat, const PlayerOptions& options)
    : loop_(loop),
      heartbeat_(heartbeat),
      options_(options),
      tape_(options.log, options.range),
      paused_(options.paused) {
  load();
  started_mono_us_ = progress_mono_us_ = loop_.mono_us();
  anchor(next_->time_us);
  heartbeat_.on_status([this](const status_t& status) { hear(status); });
  heartbeat_.before_publish([this] {
    heartbeat_.acknowledgements() = in_flight_.following();
    heartbeat_.counter("out") = static_cast<std::int64_t>(out_);
    heartbeat_.counter("lost: damaged bytes of the log") = static_cast<std::int64_t>(tape_.damage().bytes);
    heartbeat_.counter("lost: damaged regions of the log") =
        static_cast<std::int64_t>(tape_.damage().regions);
    heartbeat_.counter("lost: events of the log") = static_cast<std::int64_t>(tape_.damage().lost_events);
  });
  // subscribes before the first status, because a command may follow that at once
  loop_.subscribe<command_t>(bus::command_channel,
                             [this](const command_t& command, const bus::Arrival&) { hear(command); });
  heartbeat_.set_state(paused_ ? bus::State::paused : bus::State::running);
  heartbeat_.publish();
  loop_.every(100ms, [this] { watch_over(); });
  if (terminal_keys_.there()) {
    console_.say(std::string("keys: ") + keys_help);
    loop_.watch(STDIN_FILENO, [this] { take_keys(); });
  }
  play();
}

void Player::hear(const status_t& status) {
  if (status.role != "pairing" || status.state == "waiting" || status.state == "ended") return;
  const std::int64_t now = loop_.mono_us();
  const bool first = !in_flight_.heard();
  const InFlight::Progress progress = in_flight_.acknowledged(status);
  pairing_mono_us_ = now;
  if (progress.any) {
    progress_mono_us_ = now;
    alone_ = false;
    if (first && next_) anchor(next_->time_us);
  }
  if (progress.send_again) send_again();
  if (progress.any) play();
}

void Player::hear(const command_t& command) {
  if (command.to != "*" && command.to != heartbeat_.identity().name) return;
  // a command to one pair: the other pairs continue, and so does the log
  if (command.to == "*" && !(command.sensor_a.empty() && command.sensor_b.empty())) return;
  if (const std::optional<Control> control = control_from_text(command.verb))
    obey(*control);
  else if (command.to != "*")
    heartbeat_.reject("command not understood");
}

void Player::take_keys() {
  const std::string typed = terminal_keys_.read();
  if (typed.empty() && terminal_keys_.ended()) loop_.unwatch(STDIN_FILENO);
  for (const char byte : typed)
    if (const std::optional<Control> control = keys_.feed(byte)) obey(*control);
  show_progress(false);
}

void Player::obey(const Control& control) {
  // the clock of the recording stops where it is now, or continues from there
  std::int64_t now = recorded_now();
  switch (control.verb) {
    case Control::Verb::pause:
      paused_ = true;
      break;
    case Control::Verb::resume:
      paused_ = false;
      break;
    case Control::Verb::toggle:
      paused_ = !paused_;
      break;
    case Control::Verb::step:
      step_ = paused_ = true;
      break;
    case Control::Verb::speed:
      options_.speed = control.value;
      break;
    case Control::Verb::faster:
      options_.speed = std::clamp(control.value * options_.speed, 0.0, 1e6);
      break;
    case Control::Verb::seek:
      seek(control.value);
      now = next_ ? next_->time_us : now;
      break;
    case Control::Verb::skip:
      seek(std::max(0.0, into_log(now) + control.value));
      now = next_ ? next_->time_us : now;
      break;
    case Control::Verb::quit:
      loop_.stop();
      return;
  }
  heartbeat_.set_state(paused_ ? bus::State::paused : bus::State::running);
  anchor(now);
  play();
}

/// Goes to this place in the log [s]. The player stays where it is if there is nothing so far into the log.
void Player::seek(double seconds) {
  // a copy: the log may have been moved, or its name given to another one
  Tape there = tape_;
  there.rewind(std::max(seconds, options_.range.start));
  std::optional<bus::LogEvent> event = there.next();
  if (!event) {
    console_.say(printed_text("nothing to play at %.1f s and later", seconds));
    return;
  }
  tape_ = std::move(there);
  next_ = std::move(event);
  console_.take_as_reported(tape_.damage());
  in_flight_.clear();
  ended_ = false;
  say_it_jumps();
}

/// Announces the jump before the first message from the new place. Listeners then take what they miss, or
/// hear twice, for no fault.
void Player::say_it_jumps() {
  ++heartbeat_.counter("seeks");
  heartbeat_.publish();
}

void Player::load() {
  next_ = tape_.next();
  console_.say_damage(tape_.damage(), options_.pace.most_reported);
}

/// Starts again from the start of what is to be played. False: the options do not ask for it, or nothing is
/// there.
bool Player::begin_again() {
  if (!options_.loop) return false;
  report();
  console_.take_as_reported({});
  tape_.rewind(options_.range.start);
  load();
  if (!next_) return false;
  anchor(next_->time_us);
  say_it_jumps();
  return true;
}

/// Time of the recording that is played now; at most that of the next event, which has not been sent yet.
std::int64_t Player::recorded_now() const {
  if (!next_) return played_us_;
  if (paused_ || options_.speed == 0) return anchor_us_;
  const double passed = static_cast<double>(loop_.mono_us() - anchor_mono_us_) * options_.speed;
  const double now = static_cast<double>(anchor_us_) + passed;
  return now < static_cast<double>(next_->time_us) ? std::llround(now) : next_->time_us;
}

/// Recorded and real time run together from here.
void Player::anchor(std::int64_t recorded_us) {
  anchor_us_ = recorded_us;
  anchor_mono_us_ = loop_.mono_us();
}

double Player::into_log(std::int64_t recorded_us) const {
  return seconds_between(tape_.begin_us(), recorded_us);
}

bool Player::send(const bus::LogEvent& event) {
  if (!loop_.publish_bytes(event.channel, event.data)) return false;
  ++out_;
  refused_mono_us_.reset();
  return true;
}

/// After a message that could not be sent: true while the network is away, and the log waits. False: the
/// network is there, and this message is lost.
bool Player::network_may_return() {
  const std::int64_t now = loop_.mono_us();
  if (!refused_mono_us_) {
    refused_mono_us_ = now;
    console_.say(loop_.send_error());
  }
  const bool away = !loop_.network_error().empty();
  if (!away && now - *refused_mono_us_ > options_.pace.refused_us) {
    refused_mono_us_.reset();
    ++heartbeat_.counter("lost: could not be sent");
    return false;
  }
  anchor(next_->time_us);
  wait_until(now + options_.pace.retry_us);
  return true;
}

void Player::send_again() {
  for (const bus::LogEvent& event : in_flight_.all()) {
    send(event);
    ++heartbeat_.counter("sent again");
  }
  if (!in_flight_.following().empty()) heartbeat_.publish();
}

void Player::wait_until(std::int64_t mono_us) {
  timer_ =
      loop_.after(std::chrono::microseconds(std::max<std::int64_t>(0, mono_us - loop_.mono_us())), [this] {
        timer_.reset();
        play();
      });
}

void Player::play() {
  if (timer_) loop_.cancel(*timer_);
  timer_.reset();
  // what is sent before any pairing process is alive could not be sent again if that process ends
  const bool waits_for_pairing = !in_flight_.heard() && !alone_ && !step_;
  for (int sent = 0; next_ && (!paused_ || step_) && !waits_for_pairing; ++sent) {
    // continues with the next acknowledgement
    const bool begins = in_flight_.begins(next_->channel) && !alone_ && !step_;
    if (begins || in_flight_.count() >= options_.pace.most_in_flight) return;
    const double speed = options_.speed == 0 && alone_ ? 1 : options_.speed;
    if (speed > 0 && !step_) {
      const double ahead_us = (static_cast<double>(next_->time_us) - static_cast<double>(anchor_us_)) / speed;
      const std::int64_t due =
          anchor_mono_us_ + std::llround(std::clamp(ahead_us, -longest_wait_us, longest_wait_us));
      const std::int64_t wait = due - loop_.mono_us();
      if (wait > 0) {
        if (wait > options_.pace.announced_wait_us && announced_gap_us_ != next_->time_us) {
          announced_gap_us_ = next_->time_us;
          const std::string gap = printed_text("gap in the log, nothing until %.1f s into it: %.1f s to wait",
                                               into_log(next_->time_us), to_seconds(wait));
          console_.say(gap);
          heartbeat_.set_error(gap);
        }
        wait_until(due);
        return;
      }
    } else if (sent == options_.pace.most_at_once) {
      wait_until(0);
      return;
    }
    if (announced_gap_us_) {
      announced_gap_us_.reset();
      heartbeat_.set_error("");
    }
    if (in_flight_.count() == 0) progress_mono_us_ = loop_.mono_us();
    if (!send(*next_) && network_may_return()) return;
    in_flight_.sent(*next_);
    played_us_ = next_->time_us;
    if (step_ || options_.speed == 0) anchor(played_us_);
    step_ = false;
    load();
    if (!next_ && begin_again()) continue;
  }
  if (!next_ && !ended_) {
    ended_ = true;
    progress_mono_us_ = loop_.mono_us();
  }
  // paused at the end by a step: the user may want to go back
  if (ended_ && in_flight_.count() == 0 && !paused_) finish();
}

/// Ten times a second: no pairing, something lost, the end.
void Player::watch_over() {
  const std::int64_t now = loop_.mono_us();
  show_progress(false);
  // without a network no message arrives, so the waiting times start when it is back
  if (!loop_.network_error().empty()) started_mono_us_ = progress_mono_us_ = now;
  say_that_it_waits(now);
  if (!in_flight_.heard() && !alone_ && now - started_mono_us_ > options_.pace.wait_for_pairing_us) {
    alone_ = true;
    console_.say(std::string("no pairing process acknowledges anything; going on without keeping in step") +
                 (options_.speed == 0 ? ", at the recorded speed" : ""));
    if (next_) anchor(paused_ ? anchor_us_ : next_->time_us);
    play();
  }
  // a stopped process has the messages in its socket and needs no second copy; when it works again, its next
  // status, one a second, asks for what it lacks
  const bool heard_since = pairing_mono_us_ > progress_mono_us_;
  const std::int64_t wait = heard_since ? options_.pace.stall_us : options_.pace.unheard_us;
  if (in_flight_.count() > 0 && now - progress_mono_us_ > wait && heartbeat_.alive(bus::Role::pairing)) {
    send_again();
    progress_mono_us_ = now;
  }
  // at the end of the log, a pairing process that has been gone for long is not waited for
  if (ended_ && in_flight_.count() > 0 && now - progress_mono_us_ > options_.pace.end_wait_us) {
    console_.say(printed_text("%zu messages were never acknowledged", in_flight_.count()));
    in_flight_.clear();
    play();
  }
}

/// Reports that the player waits for a pairing process, if that takes long and the network is there.
void Player::say_that_it_waits(std::int64_t now) {
  const bool waits =
      !in_flight_.heard() && !alone_ && !paused_ && now - started_mono_us_ > options_.pace.announced_wait_us;
  if (waits == waits_announced_) return;
  waits_announced_ = waits;
  constexpr const char* waiting = "waiting for a pairing process";
  if (waits) console_.say(waiting);
  heartbeat_.set_error(waits ? waiting : "");
}

void Player::finish() {
  loop_.stop();
}

void Player::report() {
  show_progress(true);
  console_.report(options_.log, tape_);
}

void Player::show_progress(bool last) {
  const Progress progress{paused_, options_.speed, tape_.part(), into_log(recorded_now()),
                          out_,    keys_.number()};
  console_.show(progress, loop_.mono_us(), options_.pace.progress_period_us, last);
}

}  // namespace egocal::services
