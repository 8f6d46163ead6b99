// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/accumulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "egocal/degrees.hpp"
#include "egocal/microseconds.hpp"
#include "motions/motions_between.hpp"
#include "motions/motions_to_one.hpp"
#include "pairing/choice_schedule.hpp"
#include "robust/disagreements.hpp"

namespace egocal {

Accumulator::Accumulator(const PairingOptions& options, const EstimationOptions& tuning)
    : Accumulator(options, AccumulatorState{}, tuning) {
  state_.choice.stride = options_.stride.value_or(1);
  state_.choice.balance = options_.balance.value_or(Balance{});
  state_.choice.reason = options_.stride && options_.balance ? "fixed" : "too few motions to choose yet";
  state_.next_choice = options_.accumulator.first_choice;
  if (options_.robust && !options_.stride && !options_.balance) sums_.emplace(options_, tuning_.sums);
}

Accumulator::Accumulator(const PairingOptions& options, AccumulatorState state,
                         const EstimationOptions& tuning)
    : options_(options),
      tuning_(tuning),
      least_scalar_(std::cos(0.5 * options.accumulator.most_rotation)),
      state_(std::move(state)) {
  if (state_.sums) sums_.emplace(options_, tuning_.sums, *std::exchange(state_.sums, std::nullopt));
  if (options_.mode == Mode::planar) {
    G_a_ = plane_frame(options_.plane_a);
    G_b_ = plane_frame(options_.plane_b);
  }
}

void Accumulator::begin(std::int64_t period_us) {
  state_.period_us = period_us;
  if (defers_)
    deferred_.push_back({SumsStep::Kind::begin, {}, period_us, false, false, nullptr});
  else if (sums_)
    sums_->begin(period_us);
  state_.strides.clear();
  if (options_.stride) {
    state_.strides.push_back({*options_.stride, {}});
    return;
  }
  const double longest_us = second_us * options_.accumulator.longest_motion;
  for (int stride = 1; stride == 1 || stride * static_cast<double>(period_us) <= longest_us; stride *= 2)
    state_.strides.push_back({stride, {}});
}

void Accumulator::settle() {
  if (sums_) sums_->settle();
}

void Accumulator::restart() {
  for (AccumulatorState::PerStride& entry : state_.strides) entry.statistics = {};
  state_.instants.clear();
  state_.rejections = {};
  if (defers_) {
    deferred_.push_back({SumsStep::Kind::restart, {}, state_.period_us, false, false, nullptr});
    deferred_instants_ = 0;
    deferred_choice_ = options_.accumulator.first_choice;
    return;
  }
  state_.attenuation.reset();
  if (!sums_) return;
  sums_.emplace(options_, tuning_.sums);
  sums_->begin(state_.period_us);
}

std::vector<MotionPair> Accumulator::add(const Instant& instant) {
  const std::uint64_t before = state_.instants.empty() ? 0 : state_.instants.back().number;
  state_.instants.push_back(instant);
  const auto longest = static_cast<std::size_t>(state_.strides.back().stride);
  while (state_.instants.size() > longest + 1) state_.instants.pop_front();

  const Problem problem = empty_problem();
  bool doubtful = false;
  std::vector<MotionPair> pairs = add_motions(instant, problem, doubtful);
  if (options_.robust && !(options_.stride && options_.balance)) {
    // A search for outliers costs as much as a hundred poses, so those that a choice needs are spread over
    // the poses before it, one stride each.
    const std::uint64_t choice = state_.next_choice + choice_delay();
    const auto newest_look = choice > 0 ? choice - 1 : 0;
    for (std::size_t i = 0; i < state_.strides.size(); ++i) {
      const std::uint64_t due = newest_look - std::min<std::uint64_t>(newest_look, i);
      if (before < due && due <= instant.number)
        state_.strides[i].statistics.look(problem, state_.strides[i].stride, tuning_.robust);
    }
  }
  bool chosen_anew = false;
  if (instant.number >= state_.next_choice + choice_delay()) {
    choose();
    const std::uint64_t without_delay = instant.number - choice_delay();
    state_.next_choice = without_delay + without_delay / tuning_.choice_part;
    chosen_anew = true;
  }
  if (defers_) {
    defer(instant, doubtful, chosen_anew);
  } else if (sums_) {
    sums_->add(instant, doubtful);
    // both choices in one step would take 0.7 ms (docs/benchmarks.md)
    if (sums_->choice_is_due() && !chosen_anew) {
      sums_->choose(SingleStride{state_.choice.stride, state_.choice.balance, single_stride_problem()});
      chosen_anew = true;
    }
    if (chosen_anew) state_.attenuation = find_attenuation(plain_problem());
  }
  return pairs;
}

void Accumulator::defer_sums() {
  defers_ = sums_.has_value();
  deferred_instants_ = 0;
  deferred_choice_ = options_.accumulator.first_choice;
}

/// Defers a step of the sums. The best single stride is stored with it, as later steps may change it.
void Accumulator::defer(const Instant& instant, bool doubtful, bool chosen_anew) {
  SumsStep step{SumsStep::Kind::instant, instant, 0, doubtful, false, nullptr};
  const detail::SumsSchedule schedule(tuning_.sums, options_.accumulator);
  ++deferred_instants_;
  if (schedule.is_due(deferred_instants_, deferred_choice_) && !chosen_anew) {
    step.choose = true;
    deferred_choice_ = schedule.after_choice(deferred_instants_, deferred_choice_);
  }
  if (step.choose || chosen_anew)
    step.single = std::make_shared<SingleStride>(
        SingleStride{state_.choice.stride, state_.choice.balance, single_stride_problem()});
  deferred_.push_back(std::move(step));
}

void Accumulator::add_to_sums(const std::vector<SumsStep>& steps) {
  for (const SumsStep& step : steps) {
    if (step.kind != SumsStep::Kind::instant) {
      if (step.kind == SumsStep::Kind::restart) {
        sums_.emplace(options_, tuning_.sums);
        state_.attenuation.reset();
      }
      sums_->begin(step.period_us);
      continue;
    }
    sums_->add(step.instant, step.doubtful);
    if (step.choose) sums_->choose(*step.single);
    if (!step.single) continue;
    Problem problem = step.single->problem;
    if (sums_->in_force()) sums_->fill(problem);
    state_.attenuation = find_attenuation(problem);
  }
}

/// Adds the motions of all strides that end at the newest instant. Returns that of the chosen stride.
/// doubtful: it contradicts the others.
std::vector<MotionPair> Accumulator::add_motions(const Instant& instant, const Problem& problem,
                                                 bool& doubtful) {
  std::vector<MotionPair> pairs;
  const auto is_chosen = [&](const AccumulatorState::PerStride& entry) {
    return entry.stride == state_.choice.stride;
  };
  const auto look_at_chosen = [&](AccumulatorState::PerStride& entry, const MotionPair& pair) {
    pairs.push_back(pair);
    doubtful = entry.statistics.disagreed();
    if (options_.robust && entry.statistics.look_is_due())
      entry.statistics.look(problem, entry.stride, tuning_.robust);
  };
  Rejections not_counted;
  const auto rejections = [&](const AccumulatorState::PerStride& entry) -> Rejections& {
    return is_chosen(entry) ? state_.rejections : not_counted;
  };
  const auto add_one = [&](AccumulatorState::PerStride& entry, const Instant& from) {
    const std::optional<MotionPair> pair = motion(from, instant, entry.stride, rejections(entry));
    if (!pair) return;
    if (options_.robust)
      entry.statistics.add(*pair, problem, entry.stride, tuning_.robust);
    else
      entry.statistics.add_unjudged(*pair);
    if (is_chosen(entry)) look_at_chosen(entry, *pair);
  };
  // several at a time: most motions agree with the others, and only their squares are needed
  constexpr std::size_t at_once = detail::MotionsToOne::count;
  const Agreement none;
  std::array<AccumulatorState::PerStride*, at_once> entries;
  std::array<const Instant*, at_once> begins;
  std::array<const Agreement*, at_once> agreements;
  detail::MotionsToOne motions;
  std::size_t waiting = 0;
  const auto add_waiting = [&] {
    if (waiting == 0) return;
    for (std::size_t k = 0; k < at_once; ++k) {
      if (k >= waiting) begins[k] = begins[0];
      const bool is_judged = k < waiting && entries[k]->statistics.agreement();
      agreements[k] = is_judged ? &*entries[k]->statistics.agreement() : &none;
    }
    detail::set_motions_to_one(begins, instant, motions);
    const auto disagreements =
        detail::disagreements(motions, agreements, problem.balance, tuning_.robust.consensus);
    for (std::size_t k = 0; k < waiting; ++k) {
      AccumulatorState::PerStride& entry = *entries[k];
      const bool disagrees = agreements[k] != &none && disagreements[k] > 1;
      if (!motions.plain[k] || disagrees || motions.least_scalar[k] < least_scalar_) {
        add_one(entry, *begins[k]);
        continue;
      }
      entry.statistics.add_agreeing(motions.squares[k]);
      if (!is_chosen(entry)) continue;
      const detail::MotionsOfBoth both = detail::motions_between(*begins[k], instant);
      look_at_chosen(entry, {both.a, both.b, begins[k]->time_us, instant.time_us, 1});
    }
    waiting = 0;
  };
  const bool several = options_.robust && options_.mode == Mode::spatial && state_.strides.size() > 2;
  for (AccumulatorState::PerStride& entry : state_.strides) {
    const auto steps = static_cast<std::size_t>(entry.stride);
    if (state_.instants.size() <= steps) continue;
    const Instant& from = state_.instants[state_.instants.size() - 1 - steps];
    if (!several) {
      add_one(entry, from);
    } else if (joined(from, instant, entry.stride, rejections(entry))) {
      entries[waiting] = &entry;
      begins[waiting] = &from;
      if (++waiting == at_once) add_waiting();
    }
  }
  add_waiting();
  return pairs;
}

/// Whether there is a motion between the two.
bool Accumulator::joined(const Instant& from, const Instant& to, int stride, Rejections& rejections) const {
  if (from.chain != to.chain) return false;
  const double longest_us = options_.accumulator.stretch * stride * static_cast<double>(state_.period_us);
  if (static_cast<double>(to.time_us - from.time_us) <= longest_us) return true;
  rejections.add(Rejection::gap);
  return false;
}

std::optional<MotionPair> Accumulator::motion(const Instant& from, const Instant& to, int stride,
                                              Rejections& rejections) {
  if (!joined(from, to, stride, rejections)) return std::nullopt;
  const detail::MotionsOfBoth motions = detail::motions_between(from, to);
  MotionPair pair{motions.a, motions.b, from.time_us, to.time_us, 1};
  if (std::min(pair.a.real[0], pair.b.real[0]) < least_scalar_) {
    rejections.add(Rejection::too_much_rotation);
    return std::nullopt;
  }
  if (options_.mode == Mode::planar) {
    pair.a = planar_motion(pair.a, G_a_);
    pair.b = planar_motion(pair.b, G_b_);
  }
  return pair;
}

std::uint64_t Accumulator::choice_delay() const {
  return detail::choice_delay(state_.next_choice, tuning_.choice_part, options_.accumulator.choice_phase);
}

void Accumulator::choose() {
  if (options_.stride && options_.balance) return;
  std::vector<MotionsOfStride> strides;
  strides.reserve(state_.strides.size());
  for (const AccumulatorState::PerStride& entry : state_.strides)
    strides.push_back({entry.stride, entry.statistics.inliers()});
  const std::optional<SelectedSetting> selected =
      select_setting(empty_problem(), strides, options_.accumulator.balances, options_.balance,
                     Setting{state_.choice.stride, state_.choice.balance}, tuning_.selection);
  if (!selected) return;
  state_.choice.stride = selected->setting.stride;
  state_.choice.balance = selected->setting.balance;
  char text[160];
  std::snprintf(text, sizeof text, "smallest jack-knife spread of %zu settings: %.3f deg, %.2f cm",
                selected->tried, selected->spread.rotation * degrees_per_radian,
                100 * selected->spread.translation);
  state_.choice.reason = text;
}

/// What add() spreads over several instants.
void Accumulator::choose_all() {
  if (options_.robust) {
    const Problem problem = empty_problem();
    for (AccumulatorState::PerStride& entry : state_.strides)
      entry.statistics.look(problem, entry.stride, tuning_.robust);
  }
  choose();
  if (sums_)
    sums_->choose(SingleStride{state_.choice.stride, state_.choice.balance, single_stride_problem()});
  state_.attenuation = find_attenuation(plain_problem());
}

bool Accumulator::chooses_early() const {
  const std::uint64_t instants = state_.instants.empty() ? 0 : state_.instants.back().number;
  const bool has_chosen = state_.next_choice != options_.accumulator.first_choice;
  return !(options_.stride && options_.balance) && !has_chosen &&
         instants >= options_.accumulator.early_choice;
}

std::optional<Accumulator> Accumulator::with_early_choice() const {
  if (!chooses_early()) return std::nullopt;
  Accumulator early(*this);
  early.choose_all();
  return early;
}

Problem Accumulator::empty_problem() const {
  Problem problem;
  problem.mode = options_.mode;
  problem.plane_a = options_.plane_a;
  problem.plane_b = options_.plane_b;
  problem.balance = state_.choice.balance;
  problem.prior = options_.prior;
  return problem;
}

const AccumulatorState::PerStride* Accumulator::chosen() const {
  for (const AccumulatorState::PerStride& entry : state_.strides)
    if (entry.stride == state_.choice.stride) return &entry;
  return nullptr;
}

Choice Accumulator::choice() const {
  Choice choice = state_.choice;
  if (sums_ && sums_->in_force()) {
    choice.mean_stride = sums_->choice()->mean_stride;
    choice.reason = sums_->choice()->reason;
  }
  if (state_.attenuation) choice.reason += ", rotation noise taken off";
  return choice;
}

AccumulatorState Accumulator::state() const {
  AccumulatorState state = state_;
  if (sums_) state.sums = sums_->state();
  return state;
}

Problem Accumulator::problem() const {
  Problem problem = plain_problem();
  if (!state_.attenuation) return problem;
  std::optional<Problem> corrected = without_attenuation(problem, *state_.attenuation);
  return corrected ? *std::move(corrected) : problem;
}

/// The problem before rotation noise is taken off.
Problem Accumulator::plain_problem() const {
  if (!sums_ || !sums_->in_force()) return single_stride_problem();
  Problem problem = empty_problem();
  sums_->fill(problem);
  return problem;
}

Problem Accumulator::single_stride_problem() const {
  Problem problem = empty_problem();
  if (const auto* entry = chosen())
    problem.blocks = independent_blocks(entry->statistics.inliers(), entry->stride);
  return problem;
}

std::uint64_t Accumulator::inlier_pairs() const {
  const auto* entry = chosen();
  return entry ? entry->statistics.inlier_pairs() : 0;
}

std::uint64_t Accumulator::outlier_pairs() const {
  const auto* entry = chosen();
  return entry ? entry->statistics.outlier_pairs() : 0;
}

std::uint64_t Accumulator::jumps() const {
  return sums_ && sums_->in_force() ? sums_->jumps() : 0;
}

std::optional<std::int64_t> Accumulator::newest_us() const {
  if (state_.instants.empty()) return std::nullopt;
  return state_.instants.back().time_us;
}

}  // namespace egocal
