// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/stride_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "egocal/robust/consensus.hpp"
#include "motions/motions_between.hpp"
#include "motions/motions_to_one.hpp"
#include "pairing/choice_schedule.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

namespace {

/// Whether two variances of a step, in typical ones, give weights that differ by more than this part.
bool differ(double x, double y, double part) {
  return std::abs(x - y) > part * (1 + std::min(x, y));
}

}  // namespace

StrideSums::StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning)
    : StrideSums(options, tuning, StrideSumsState{}) {
  state_.committed = StrideBlocks(tuning_.strides);
  state_.next_choice = options_.accumulator.first_choice;
}

StrideSums::StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning, StrideSumsState state)
    : options_(options),
      tuning_(tuning),
      least_scalar_(std::cos(0.5 * options.accumulator.most_rotation)),
      state_(std::move(state)),
      first_pending_(state_.next_index) {
  if (options_.mode == Mode::planar) {
    G_a_ = plane_frame(options_.plane_a);
    G_b_ = plane_frame(options_.plane_b);
  }
}

/// Whether there is a gap between the two.
bool StrideSums::too_long(const JudgedInstant& from, const JudgedInstant& to) const {
  const double longest_us = options_.accumulator.stretch * static_cast<double>(to.index - from.index) *
                            static_cast<double>(state_.period_us);
  return static_cast<double>(to.instant.time_us - from.instant.time_us) > longest_us;
}

Step StrideSums::step(const JudgedInstant& from, const JudgedInstant& to) const {
  const detail::MotionsOfBoth motions = detail::motions_between(from.instant, to.instant);
  Step result{motions.a, motions.b, from.instant.chain == to.instant.chain};
  if (too_long(from, to)) result.usable = false;
  if (std::min(result.a.real[0], result.b.real[0]) < least_scalar_) result.usable = false;
  if (options_.mode == Mode::planar) {
    result.a = planar_motion(result.a, G_a_);
    result.b = planar_motion(result.b, G_b_);
  }
  return result;
}

/// Sets the verdict and the chains that follow from it.
void StrideSums::append(JudgedInstant& judged, const JudgedInstant* before,
                        const StepVerdict& verdict) const {
  judged.jump = verdict.jump;
  judged.rotation_chain = before ? before->rotation_chain + (verdict.jump == Jump::all ? 1 : 0) : 0;
  judged.translation_chain = before ? before->translation_chain + (verdict.jump != Jump::none ? 1 : 0) : 0;
  judged.step_variance = verdict.extra_variance;
  judged.total_variance = before ? before->total_variance + verdict.extra_variance : 0;
}

/// Certainty of a motion among those of its stride: the variances of its steps add up. One if all steps are
/// typical.
double StrideSums::certainty(const JudgedInstant& from, const JudgedInstant& to) const {
  const double extra = to.total_variance - from.total_variance;
  return extra > tuning_.least_extra_variance ? 1 / (1 + extra) : 1;
}

/// Adds the motions that end at this instant to each sum that is given, weighted by the choice in force.
void StrideSums::add_motions(std::uint64_t index, StrideBlocks* sums, WeightedBlocks* weighted) const {
  const auto position = static_cast<std::size_t>(index - state_.instants.front().index);
  const JudgedInstant& to = state_.instants[position];
  if (sums) sums->add_instant(index);
  if (weighted) weighted->add_instant(index);
  if (to.doubtful) return;
  const auto add = [&](std::size_t stride, const JudgedInstant& from, const detail::MotionSquare& square) {
    const bool rotation_only = from.translation_chain != to.translation_chain;
    const double weight = certainty(from, to);
    if (sums) sums->add(stride, from.index, square, rotation_only, weight);
    if (!weighted) return;
    const StrideWeights& weights = state_.choice->weights;
    weighted->add(from.index, index, square, {weights.rotation[stride], weights.translation[stride], weight},
                  rotation_only);
  };
  const auto add_step = [&](std::size_t stride, const JudgedInstant& from) {
    const Step motion = step(from, to);
    if (motion.usable) add(stride, from, detail::MotionSquare(motion.a, motion.b));
  };
  // a few at a time, in the order of the strides
  constexpr std::size_t at_once = detail::MotionsToOne::count;
  std::array<std::size_t, at_once> strides;
  std::array<const JudgedInstant*, at_once> begins;
  std::array<const Instant*, at_once> instants;
  detail::MotionsToOne motions;
  std::size_t waiting = 0;
  const auto add_waiting = [&] {
    if (waiting == 0) return;
    for (std::size_t k = waiting; k < at_once; ++k) instants[k] = instants[0];
    detail::set_motions_to_one(instants, to.instant, motions);
    for (std::size_t k = 0; k < waiting; ++k) {
      if (!motions.plain[k])
        add_step(strides[k], *begins[k]);
      else if (!(motions.least_scalar[k] < least_scalar_))
        add(strides[k], *begins[k], motions.squares[k]);
    }
    waiting = 0;
  };
  for (std::size_t i = 0; i < tuning_.strides.size(); ++i) {
    const auto steps = static_cast<std::size_t>(tuning_.strides[i]);
    if (steps > position) break;
    const JudgedInstant& from = state_.instants[position - steps];
    if (from.doubtful || from.rotation_chain != to.rotation_chain || from.instant.chain != to.instant.chain ||
        too_long(from, to))
      continue;
    if (options_.mode == Mode::planar) {
      add_step(i, from);
      continue;
    }
    strides[waiting] = i;
    begins[waiting] = &from;
    instants[waiting] = &from.instant;
    if (++waiting == at_once) add_waiting();
  }
  add_waiting();
}

/// Whether `all_` agrees with the current verdicts; motions that end later may be missing in it.
bool StrideSums::all_is_valid() const {
  return !all_stale_ && all_until_ >= state_.first_open;
}

void StrideSums::complete_all() {
  if (!all_is_valid()) {
    all_ = state_.committed;
    all_until_ = state_.first_open;
    all_stale_ = false;
  }
  for (; all_until_ < state_.next_index; ++all_until_) add_motions(all_until_, &all_, nullptr);
}

/// Sums over all motions, including those of the open instants.
StrideBlocks& StrideSums::sums() {
  complete_all();
  std::vector<std::uint8_t> outlier(all_.blocks(), 0);
  const std::uint64_t length = all_.state().block_length;
  for (std::size_t i = 0; i < state_.outlier.size(); ++i)
    if (state_.outlier[i] != 0) outlier.at(static_cast<std::size_t>(i * state_.outlier_length / length)) = 1;
  all_.leave_out(std::move(outlier));
  return all_;
}

void StrideSums::weigh_pending(WeightedBlocks& weighted) const {
  for (std::uint64_t index = first_pending_; index < state_.next_index; ++index)
    add_motions(index, nullptr, &weighted);
}

void StrideSums::settle() {
  const bool has_all = all_is_valid();
  for (std::uint64_t index = has_all ? std::min(all_until_, first_pending_) : first_pending_;
       index < state_.next_index; ++index)
    add_motions(index, has_all && index >= all_until_ ? &all_ : nullptr,
                index >= first_pending_ ? &state_.weighted : nullptr);
  if (has_all) all_until_ = state_.next_index;
  first_pending_ = state_.next_index;
}

void StrideSums::fill(Problem& problem) const {
  if (first_pending_ == state_.next_index) return state_.weighted.fill(problem);
  WeightedBlocks weighted = state_.weighted;
  weigh_pending(weighted);
  weighted.fill(problem);
}

StrideSumsState StrideSums::state() const {
  StrideSumsState state = state_;
  weigh_pending(state.weighted);
  return state;
}

void StrideSums::weigh_all(const TouchingSums& sums) {
  state_.weighted = in_force() ? sums.weighted(state_.choice->weights) : WeightedBlocks();
  first_pending_ = state_.next_index;
}

void StrideSums::add(const Instant& instant, bool doubtful) {
  const JudgedInstant* before = state_.instants.empty() ? nullptr : &state_.instants.back();
  JudgedInstant judged{instant, state_.next_index++, Jump::none, 0, 0, doubtful, 0, 0};
  append(judged, before, {});
  state_.instants.push_back(judged);
  if (!state_.choice) complete_all();  // else the first choice would add up all motions at once
  if (!in_force())
    first_pending_ = state_.next_index;
  else if (!state_.weighted.has_room(judged.index))
    weigh_all(TouchingSums(sums()));
  if (in_force() && state_.next_index >= state_.next_look) {
    state_.next_look = state_.next_index + std::clamp(state_.next_index / tuning_.look_part,
                                                      tuning_.least_look, tuning_.most_look);
    const Changes changes = rejudge(state_.choice->q);
    // an apparent jump may be the first motion that shows a new direction
    if (changes.jumps) rejudge(std::nullopt);
    if (changes.jumps || changes.variances) weigh_all(TouchingSums(sums()));
  }
  if (state_.next_index - state_.first_open > tuning_.most_open) commit_oldest();
}

/// The oldest of the open instants keeps its verdict for good.
void StrideSums::commit_oldest() {
  const bool pending = state_.first_open == first_pending_ && first_pending_ < state_.next_index;
  add_motions(state_.first_open, &state_.committed, pending ? &state_.weighted : nullptr);
  if (pending) ++first_pending_;
  const std::uint64_t first_kept = state_.instants.front().index;
  if (state_.instants[static_cast<std::size_t>(state_.first_open - first_kept)].jump != Jump::none)
    ++state_.jumps;
  ++state_.first_open;
  const auto longest = static_cast<std::uint64_t>(tuning_.strides.back());
  if (first_kept + longest < state_.first_open) state_.instants.pop_front();
}

/// Extends measured_ to the steps to the instants from this place on.
void StrideSums::measure_steps(std::size_t first) {
  const std::uint64_t from = state_.instants[first].index;
  const auto passed = std::min<std::uint64_t>(from - measured_from_, measured_.size());
  measured_.erase(measured_.begin(), measured_.begin() + static_cast<std::ptrdiff_t>(passed));
  measured_from_ = from;
  for (std::size_t i = first + measured_.size(); i < state_.instants.size(); ++i)
    measured_.emplace_back(step(state_.instants[i - 1], state_.instants[i]));
}

/// Judges the steps to all open instants again. Returns what changed.
StrideSums::Changes StrideSums::rejudge(const std::optional<DualQuaternion>& q) {
  std::size_t first = 0;
  while (first < state_.instants.size() && state_.instants[first].index < state_.first_open) ++first;
  first = std::max<std::size_t>(first, 1);
  Changes changes;
  if (first >= state_.instants.size()) return changes;
  measure_steps(first);
  const std::vector<StepVerdict> verdicts =
      find_jumps(measured_, state_.committed.total(0).motions, options_.mode, q, tuning_.jumps);
  for (std::size_t i = first; i < state_.instants.size(); ++i) {
    const StepVerdict& verdict = verdicts[i - first];
    const double before = state_.instants[i].step_variance;
    changes.jumps = changes.jumps || verdict.jump != state_.instants[i].jump;
    changes.variances = changes.variances || differ(verdict.extra_variance, before, tuning_.least_change);
    changes.any = changes.any || verdict.extra_variance != before;
  }
  // after a change all motions are weighted again, except if the change is too small for that
  if (changes.any && !changes.jumps && !changes.variances) settle();
  all_stale_ = all_stale_ || changes.any || changes.jumps;
  for (std::size_t i = first; i < state_.instants.size(); ++i)
    append(state_.instants[i], &state_.instants[i - 1], verdicts[i - first]);
  return changes;
}

bool StrideSums::choice_is_due() const {
  return detail::SumsSchedule(tuning_, options_.accumulator).is_due(state_.next_index, state_.next_choice);
}

void StrideSums::choose(const std::optional<SingleStride>& rival) {
  state_.next_choice =
      detail::SumsSchedule(tuning_, options_.accumulator).after_choice(state_.next_index, state_.next_choice);
  StrideBlocks& all = judge_open();
  leave_out_blocks(all);
  const TouchingSums touching(all);
  if (std::optional<WeightChoice> choice =
          choose_weights(all, touching, empty_problem(), state_.choice, rival, tuning_.weighting))
    state_.choice = std::move(choice);
  weigh_all(touching);
}

/// Judges the open instants and chooses the weights, which depend on each other. Usually there is no jump,
/// nor one by the weights made without jumps, and the first round is the last. Returns the sums.
StrideBlocks& StrideSums::judge_open() {
  StrideBlocks& all = sums();
  std::optional<WeightChoice> suggested = residual_weights(all, options_.mode, tuning_.weighting.residuals);
  const bool before = std::any_of(state_.instants.begin(), state_.instants.end(), [&](const auto& judged) {
    return judged.index >= state_.first_open && judged.jump != Jump::none;
  });
  Changes changes{true, true};
  if (suggested && !before) changes = rejudge(suggested->q);
  if (changes.jumps) rejudge(std::nullopt);
  for (int round = 0; round < tuning_.most_rounds && (changes.jumps || changes.variances); ++round) {
    sums();
    suggested = residual_weights(all, options_.mode, tuning_.weighting.residuals);
    if (!suggested) break;
    changes = rejudge(suggested->q);
  }
  return all;
}

/// Omits blocks that contradict the others, by their motions within.
void StrideSums::leave_out_blocks(StrideBlocks& all) {
  all.leave_out(std::vector<std::uint8_t>(all.blocks(), 0));
  state_.outlier = all.state().outlier;
  state_.outlier_length = all.state().block_length;
  const std::optional<WeightChoice> suggested =
      state_.choice ? state_.choice : residual_weights(all, options_.mode, tuning_.weighting.residuals);
  if (!suggested) return;
  Problem problem = empty_problem();
  problem.balance = {0, 1};
  const std::vector<Statistics> parts = all.within(suggested->weights);
  // motions of a block share their ends, so no block is long enough for an extrinsic of its own
  const auto overlap = static_cast<int>(all.state().block_length);
  if (const std::optional<Consensus> consensus = find_consensus(problem, parts, overlap, tuning_.consensus))
    state_.outlier.assign(consensus->outlier.begin(), consensus->outlier.end());
  all.leave_out(state_.outlier);
}

Problem StrideSums::empty_problem() const {
  Problem problem;
  problem.mode = options_.mode;
  problem.plane_a = options_.plane_a;
  problem.plane_b = options_.plane_b;
  problem.prior = options_.prior;
  return problem;
}

std::uint64_t StrideSums::jumps() const {
  std::uint64_t jumps = state_.jumps;
  for (const JudgedInstant& judged : state_.instants)
    if (judged.index >= state_.first_open && judged.jump != Jump::none) ++jumps;
  return jumps;
}

}  // namespace egocal
