// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/synchroniser.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/cut_alike.hpp"
#include "pairing/smooth_interpolation.hpp"

namespace egocal {

namespace {

std::size_t index(Side side) {
  return side == Side::a ? 0 : 1;
}

/// Median period of the first `count` poses; 0: fewer than two.
std::int64_t median_period(const std::deque<StampedPose>& poses, std::size_t count) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < std::min(poses.size(), count); ++i)
    periods.push_back(poses[i].time_us - poses[i - 1].time_us);
  return detail::median(std::move(periods));
}

}  // namespace

Synchroniser::Synchroniser(const PairingOptions& options) : Synchroniser(options, SynchroniserState{}) {}

Synchroniser::Synchroniser(const PairingOptions& options, SynchroniserState state)
    : options_(options.synchroniser),
      max_gap_us_(to_microseconds(options.max_gap)),
      state_(std::move(state)) {}

std::vector<Instant> Synchroniser::push(Side side, const StampedPose& pose) {
  auto& newest = state_.newest_us[index(side)];
  auto& waiting = state_.waiting[index(side)];
  // a late pose can still be inserted while nothing after it has been paired
  auto place = waiting.end();
  if (newest && pose.time_us <= *newest) {
    while (place != waiting.begin() && std::prev(place)->time_us > pose.time_us) --place;
    const bool known = place != waiting.begin() && std::prev(place)->time_us == pose.time_us;
    if (known || (state_.last_key_us && pose.time_us <= *state_.last_key_us)) {
      state_.rejections.add(Rejection::out_of_order);
      return {};
    }
  }
  newest = std::max(newest.value_or(pose.time_us), pose.time_us);
  waiting.insert(place, pose);
  if (waiting.size() > options_.most_waiting) {
    waiting.pop_front();
    state_.rejections.add(Rejection::no_partner);
  }
  if (!state_.keys && state_.waiting[0].size() >= options_.poses_to_decide &&
      state_.waiting[1].size() >= options_.poses_to_decide)
    decide_keys();
  return state_.keys ? synchronise() : std::vector<Instant>{};
}

std::vector<Instant> Synchroniser::finish() {
  if (!state_.keys && !state_.waiting[0].empty() && !state_.waiting[1].empty()) decide_keys();
  if (!state_.keys) return {};
  std::vector<Instant> instants = synchronise();
  auto& keys = state_.waiting[index(*state_.keys)];
  state_.rejections.add(Rejection::no_partner, keys.size());
  keys.clear();
  return instants;
}

std::vector<Instant> Synchroniser::begin_chain() {
  std::vector<Instant> instants = finish();
  ++state_.chain;
  state_.previous_key.reset();
  state_.key_steps.clear();
  for (auto& waiting : state_.waiting) waiting.clear();
  return instants;
}

void Synchroniser::decide_keys() {
  // the first poses decide which stream is slower, however many of one stream came before the other began
  const std::int64_t period_a = median_period(state_.waiting[0], options_.poses_to_decide);
  const std::int64_t period_b = median_period(state_.waiting[1], options_.poses_to_decide);
  const bool a_is_slower = static_cast<double>(period_a) > options_.slower_by * static_cast<double>(period_b);
  state_.keys = a_is_slower ? Side::a : Side::b;
  state_.period_us = std::max<std::int64_t>(1, std::max(period_a, period_b));
}

void Synchroniser::remember_step(const StampedPose& key) {
  if (!state_.previous_key || key.time_us - state_.previous_key->time_us > max_gap_us_) return;
  state_.key_steps.push_back(detail::step_of(conjugate(state_.previous_key->pose) * key.pose));
  if (state_.key_steps.size() > options_.typical_steps) state_.key_steps.pop_front();
}

std::vector<Instant> Synchroniser::synchronise() {
  std::vector<Instant> instants;
  auto& keys = state_.waiting[index(*state_.keys)];
  auto& others = state_.waiting[1 - index(*state_.keys)];
  const auto pass_key = [&] {
    state_.last_key_us = keys.front().time_us;
    state_.previous_key = keys.front();
    keys.pop_front();
  };
  // an instant is interpolated when this many poses on each side are there
  const std::size_t side = std::max<std::size_t>(1, options_.smooth_poses / 2);
  while (!keys.empty() && !others.empty()) {
    const StampedPose key = keys.front();
    if (key.time_us < others.front().time_us) {
      state_.rejections.add(Rejection::no_partner);
      pass_key();
      continue;
    }
    std::size_t at = 0;
    while (at + 1 < others.size() && others[at + 1].time_us <= key.time_us) ++at;
    for (; at >= side; --at) others.pop_front();
    Instant instant{key.time_us, key.pose, others[at].pose, state_.chain, 0};
    if (others[at].time_us != key.time_us) {
      if (at + 1 >= others.size()) break;
      const std::int64_t period_us = others[at + 1].time_us - others[at].time_us;
      if (period_us > max_gap_us_) {
        state_.rejections.add(Rejection::gap);
        pass_key();
        continue;
      }
      if (at + side >= others.size()) break;
      const double part =
          static_cast<double>(key.time_us - others[at].time_us) / static_cast<double>(period_us);
      std::optional<DualQuaternion> smooth;
      if (options_.smooth_poses > 0 && at + 1 == side) {
        std::array<StampedPose, SynchroniserOptions::most_smooth_poses> around;
        std::copy_n(others.begin(), 2 * side, around.begin());
        smooth = detail::interpolate_smoothly(std::span(around).first(2 * side), part, options_);
      }
      if (!smooth && options_.cut_alike && keys.size() < 2) break;
      remember_step(key);
      instant.b = smooth ? *smooth : interpolate(others[at].pose, others[at + 1].pose, part);
      if (!smooth && options_.cut_alike && state_.previous_key)
        instant.a = detail::cut_alike({*state_.previous_key, key, keys[1]},
                                      {part, static_cast<double>(period_us), max_gap_us_},
                                      detail::typical(state_.key_steps), options_);
    }
    instant.number = ++state_.synchronised;
    if (*state_.keys == Side::b) std::swap(instant.a, instant.b);
    pass_key();
    instants.push_back(instant);
  }
  return instants;
}

}  // namespace egocal
