// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pairing.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/check.hpp"
#include "egocal/bus/convert.hpp"

namespace egocal::services {

using namespace std::chrono_literals;

Pairing::Pairing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig,
                 std::unique_ptr<SavedState> saved, const PairingServiceOptions& options)
    : options_(options),
      loop_(loop),
      heartbeat_(heartbeat),
      saved_(std::move(saved)),
      accumulation_(saved_ ? saved_->restore() : Accumulation(rig)),
      arrivals_(rig.sensors.size()),
      published_mono_us_(rig.pairs.size()),
      listening_clock_(options.watch_period, loop.mono_us()) {
  for (std::size_t i = 0; i < rig.sensors.size(); ++i)
    loop_.subscribe_bytes(
        rig.sensors[i].channel,
        [this, i](const bus::Arrival& arrival) { take(static_cast<std::uint16_t>(i), arrival); },
        options_.queue_capacity);
  for (const bus::PairConfig& pair : rig.pairs)
    channels_.push_back({bus::problem_channel(pair.a, pair.b), bus::motion_channel(pair.a, pair.b),
                         bus::scale_problem_channel(pair.a, pair.b)});
  hear_commands(loop_, heartbeat_, [this](Verb verb, const command_t& command) { obey(verb, command); });
  heartbeat_.on_status([this](const status_t& status) { hear(status); });
  heartbeat_.before_publish([this] { acknowledge(); });
  loop_.after_batch([this](bool caught_up) {
    caught_up_ = caught_up;
    after_batch(caught_up);
  });
  loop_.every(options_.watch_period, [this] { watch_gaps(); });
  loop_.every(1s, [this] { every_second(); });
  if (saved_ && !saved_->not_saved().empty()) not_saved(saved_->not_saved());
  const bool restored = saved_ && saved_->restored();
  if (restored) {
    patient_ = true;
    settle_until_us_ = listened_us() + options_.patience_us;
    heartbeat_.counter("restored") = 1;
  }
  show_state();
  heartbeat_.publish();  // a namesake answers this
  loop_.after(restored ? options_.listen_restored : options_.listen, [this] { begin_to_send(); });
}

Pairing::~Pairing() {
  // the saved state is what others know; the state in memory may have just been found wrong
  if (!saved_ || std::uncaught_exceptions() > 0) return;
  try {
    saved_->snapshot(accumulation_);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal-pairing: %s\n", error.what());
  }
}

void Pairing::feed(const Input& input) {
  if (saved_) saved_->note(input);
  accumulation_.apply(input);
}

void Pairing::save() {
  if (!saved_ || (!save_error_.empty() && loop_.mono_us() < save_again_mono_us_)) return;
  try {
    saved_->save(accumulation_);
    save_error_.clear();
  } catch (const Error& error) {
    not_saved(error.what());
  }
}

/// Continues without a saved state. From now on each attempt to save writes a whole snapshot.
void Pairing::not_saved(const std::string& why) {
  if (save_error_.empty()) std::fprintf(stderr, "egocal-pairing: %s\n", why.c_str());
  save_error_ = why;
  save_again_mono_us_ = loop_.mono_us() + options_.save_retry_us;
}

void Pairing::take(std::uint16_t channel, const bus::Arrival& arrival) {
  Arrivals& arrivals = arrivals_[channel];
  const std::int64_t repeated = accumulation_.stream(channel).repeated();
  ++arrivals.count;
  arrivals.heard_at_us = listened_us();
  ++unacknowledged_;
  feed({Input::Kind::message, channel, arrival.bytes, arrival.mono_us});
  if (accumulation_.stream(channel).repeated() != repeated) arrivals.repeated_at_us = listened_us();
  if (unacknowledged_ >= options_.acknowledge_every && acknowledges_early()) heartbeat_.publish();
}

/// Within a batch the next save waits until handling messages has taken as long as the last save did. A flood
/// on a slow disk would otherwise be saved sixteen messages at a time.
bool Pairing::acknowledges_early() const {
  return leads() && loop_.mono_us() - acknowledged_mono_us_ >= acknowledging_us_;
}

void Pairing::after_batch(bool caught_up) {
  save();
  if (listening_) return;
  if (!leads()) {
    accumulation_.take_motions();
    return;
  }
  publish_new_problems();
  publish_motions();
  // a sender may be waiting for it: a player that keeps in step
  if (caught_up && unacknowledged_ > 0 && !acknowledge_timer_ && heartbeat_.alive(bus::Role::player))
    acknowledge_timer_ = loop_.after(options_.acknowledge_delay, [this] {
      acknowledge_timer_.reset();
      if (unacknowledged_ > 0 && leads()) heartbeat_.publish();
    });
}

/// A player sends again what is missing.
void Pairing::be_patient_if_it_helps() {
  const std::int64_t now = listened_us();
  const bool patient =
      now < settle_until_us_ || heartbeat_.alive(bus::Role::player) || (patient_ && now < heard_again_us_);
  if (patient != patient_) feed({patient ? Input::Kind::patient : Input::Kind::impatient});
  patient_ = patient;
}

/// Ten times a second: gives up gaps that nothing fills. After a stop the messages that wait in the socket
/// are read first.
void Pairing::watch_gaps() {
  if (listening_clock_.look(loop_.mono_us(), caught_up_))
    heard_again_us_ = listened_us() + options_.heard_again_us;
  if (listening_clock_.catching_up()) return;
  be_patient_if_it_helps();
  const std::int64_t now = listened_us();
  bool waits = false;
  for (std::size_t channel = 0; channel < arrivals_.size(); ++channel) {
    const auto i = static_cast<std::uint16_t>(channel);
    Arrivals& arrivals = arrivals_[i];
    const Stream& stream = accumulation_.stream(i);
    if (!stream.gone_over())
      arrivals.gone_over_at_us = 0;
    else if (arrivals.gone_over_at_us == 0)
      arrivals.gone_over_at_us = now;
    else if (now - arrivals.gone_over_at_us >= options_.latest_us)
      feed({Input::Kind::settled, i});
    // a restarted player reaches the missing messages at the speed of the recording
    const bool comes =
        patient_ && arrivals.repeated_at_us > 0 && now - arrivals.repeated_at_us <= options_.patience_us;
    if (!stream.waiting()) {
      arrivals.gap_at_us = 0;
      if (stream.settling() && now > settle_until_us_) feed({Input::Kind::give_up, i});
    } else if (comes || arrivals.gap_at_us == 0 || arrivals.expected != stream.expected()) {
      arrivals.gap_at_us = now;
      arrivals.expected = stream.expected();
    } else if (patient_ || stream.settling() ? now - arrivals.gap_at_us > options_.patience_us
                                             : now - arrivals.heard_at_us > options_.silence_us) {
      feed({Input::Kind::give_up, i});
    }
    waits = waits || stream.waiting();
  }
  release_what_silence_holds(now);
  after_batch(true);
  // a player repeats what a status reports as missing, and a status may be lost
  if (waits && patient_ && leads() && loop_.mono_us() - acknowledged_mono_us_ >= options_.ask_again_us)
    heartbeat_.publish();
}

/// While the clocks are compared poses are held back, and each pose that comes then releases a few. Where
/// none comes, at the end of a log, they would wait for ever. A drive that ends before they are compared is
/// reported at once: `egocal up` ends soon after its log.
void Pairing::release_what_silence_holds(std::int64_t now_us) {
  const std::vector<PairSession>& pairs = std::as_const(accumulation_).pairs();
  const auto silent = [&](const std::string& sensor) {
    for (std::size_t k = 0; k < arrivals_.size(); ++k)
      if (accumulation_.sensor(k).name == sensor)
        return now_us - arrivals_[k].heard_at_us > options_.silence_us;
    return true;
  };
  std::string without_clock;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!silent(pairs[i].config().a) || !silent(pairs[i].config().b)) continue;
    if (pairs[i].can_release()) feed({Input::Kind::silent, static_cast<std::uint16_t>(i)});
    if (without_clock.empty()) without_clock = pairs[i].without_clock();
  }
  if (without_clock == without_clock_) return;
  without_clock_ = without_clock;
  show_state();
  if (leads()) heartbeat_.publish();
}

/// Puts the state of this process into its status: waiting, paused or running, and its error.
void Pairing::show_state() {
  const std::optional<bus::Peer> senior = heartbeat_.senior_namesake();
  waits_for_senior_ = senior.has_value();
  const auto& pairs = accumulation_.pairs();
  const bool paused =
      std::all_of(pairs.begin(), pairs.end(), [](const PairSession& pair) { return pair.paused(); });
  heartbeat_.set_state(!leads() ? bus::State::waiting : paused ? bus::State::paused : bus::State::running);
  heartbeat_.set_error(senior ? "another process has this name and continues: pid " +
                                    std::to_string(senior->pid) + " on " + senior->host
                              : error());
}

/// All that is wrong: a pair without motions may be so because the state with its clocks was refused.
std::string Pairing::error() const {
  std::string text;
  for (const std::string& one : {save_error_, without_clock_, saved_ ? saved_->refused() : ""})
    if (!one.empty()) text += (text.empty() ? "" : "; ") + one;
  return text;
}

void Pairing::every_second() {
  show_state();
  if (leads()) publish_all_problems();
}

/// Another process of this name would have answered by now.
void Pairing::begin_to_send() {
  listening_ = false;
  every_second();
  if (leads()) heartbeat_.publish();  // from where senders have to continue
}

/// A player states the message of its log that follows the acknowledged one. If that is the first message
/// behind a gap, the log holds nothing for the gap, and no repetition will fill it.
void Pairing::give_up_what_was_not_sent(const status_t& player) {
  for (const acknowledgement_t& next : player.acknowledgements)
    for (std::size_t i = 0; i < arrivals_.size(); ++i)
      if (accumulation_.sensor(i).channel == next.channel &&
          accumulation_.stream(i).behind_gap_us() == next.utime)
        feed({Input::Kind::nothing_sent, static_cast<std::uint16_t>(i)});
}

/// A process that starts gets its answer at once instead of after up to a second. A namesake that precedes
/// this process silences it at once.
void Pairing::hear(const status_t& status) {
  if (status.name == heartbeat_.identity().name) show_state();
  const bool player = status.role == "player";
  if (player) give_up_what_was_not_sent(status);
  if ((status.role != "fast" && status.role != "global" && !player) || status.state == "ended" ||
      known_runs_.contains(status.run) || known_runs_.size() >= options_.most_known_runs)
    return;  // bounds the work that a flood of forged statuses can cause
  known_runs_.insert(status.run);
  if (player) be_patient_if_it_helps();
  if (!leads()) return;
  if (player)
    heartbeat_.publish();
  else
    publish_all_problems();
}

void Pairing::obey(Verb verb, const command_t& command) {
  bool any = false;
  for (std::size_t number = 0; number < channels_.size(); ++number) {
    const auto i = static_cast<std::uint16_t>(number);
    const PairSession& pair = accumulation_.pairs()[i];
    if (!means(command, verb, pair.config().a, pair.config().b, pair.session())) continue;
    any = true;
    feed({verb == Verb::reset   ? Input::Kind::new_session
          : verb == Verb::pause ? Input::Kind::pause
                                : Input::Kind::resume,
          i});
  }
  if (!any) {
    heartbeat_.reject(not_meant);
    return;
  }
  ++heartbeat_.counter("commands");
  show_state();
}

void Pairing::acknowledge() {
  const std::int64_t begin_mono_us = loop_.mono_us();
  save();
  acknowledged_mono_us_ = loop_.mono_us();
  acknowledging_us_ = acknowledged_mono_us_ - begin_mono_us;
  std::map<std::string, std::int64_t> counters;
  accumulation_.count(counters);
  counters["out"] = sent_;
  for (const auto& [name, value] : counters) heartbeat_.counter(name) = value;

  std::vector<acknowledgement_t>& acknowledgements = heartbeat_.acknowledgements();
  acknowledgements.clear();
  if (!leads()) return;
  EGOCAL_CHECK(saved_or_known_not_to_be(), "a message is saved before it is acknowledged");
  for (std::size_t i = 0; i < arrivals_.size(); ++i) {
    acknowledgement_t& entry = acknowledgements.emplace_back();
    entry.channel = accumulation_.sensor(i).channel;
    entry.utime = accumulation_.complete_until(i);
    entry.count = arrivals_[i].count;
  }
  unacknowledged_ = 0;
}

}  // namespace egocal::services
