// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/stride_sums.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/robust/consensus.hpp"

namespace egocal {

namespace {

/// Strides of the motions [steps]: each about 1.4 times the one before. The longest bounds the memory;
/// motions of 128 steps are longer than the memory of any odometry on record (docs/accuracy.md).
const std::vector<int>& ladder() {
  static const std::vector<int> strides{1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 90, 128};
  return strides;
}
/// Instants whose verdicts may still change, at least and at most.
constexpr std::uint64_t least_open = 128, most_open = 256;
/// Instants after which the open ones are judged anew, between choices.
constexpr std::uint64_t look_every = 64;
/// Rounds of verdicts and weights that depend on each other.
constexpr int most_rounds = 3;

}  // namespace

StrideSums::StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning)
    : StrideSums(options, tuning, StrideSumsState{}) {
  state_.committed = StrideBlocks(ladder());
  sums_ = state_.committed;
}

StrideSums::StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning, StrideSumsState state)
    : options_(options), tuning_(tuning), state_(std::move(state)) {
  if (options_.mode == Mode::planar) {
    G_a_ = plane_frame(options_.plane_a);
    G_b_ = plane_frame(options_.plane_b);
  }
  if (!state_.committed.strides().empty()) rebuild();
}

Step StrideSums::step(const JudgedInstant& from, const JudgedInstant& to) const {
  Step result{motion_between(from.instant.a, to.instant.a), motion_between(from.instant.b, to.instant.b),
              from.instant.chain == to.instant.chain};
  const double longest_us = options_.accumulator.stretch * static_cast<double>(to.index - from.index) *
                            static_cast<double>(state_.period_us);
  if (static_cast<double>(to.instant.time_us - from.instant.time_us) > longest_us) result.usable = false;
  // scalar parts are cosines of half the angle
  if (std::min(result.a.real[0], result.b.real[0]) < std::cos(0.5 * options_.accumulator.most_rotation))
    result.usable = false;
  if (options_.mode == Mode::planar) {
    result.a = planar_motion(result.a, G_a_);
    result.b = planar_motion(result.b, G_b_);
  }
  return result;
}

/// Sets the verdict and the chains that follow from it.
void StrideSums::append(JudgedInstant& judged, const JudgedInstant* before, Jump jump) const {
  judged.jump = jump;
  judged.rotation_chain = before ? before->rotation_chain + (jump == Jump::all ? 1 : 0) : 0;
  judged.translation_chain = before ? before->translation_chain + (jump != Jump::none ? 1 : 0) : 0;
}

/// The motions that end at the instant at this position.
void StrideSums::add_motions(StrideBlocks& blocks, std::size_t position) const {
  const JudgedInstant& to = state_.instants[position];
  blocks.add_instant(to.index);
  for (std::size_t i = 0; i < ladder().size(); ++i) {
    const auto steps = static_cast<std::size_t>(ladder()[i]);
    if (steps > position) break;
    const JudgedInstant& from = state_.instants[position - steps];
    if (from.rotation_chain != to.rotation_chain || from.instant.chain != to.instant.chain) continue;
    const Step motion = step(from, to);
    if (motion.usable)
      blocks.add(i, from.index, motion.a, motion.b, from.translation_chain != to.translation_chain);
  }
}

void StrideSums::add(const Instant& instant) {
  const JudgedInstant* before = state_.instants.empty() ? nullptr : &state_.instants.back();
  JudgedInstant judged{instant, state_.next_index++, Jump::none, 0, 0};
  append(judged, before, Jump::none);
  state_.instants.push_back(judged);
  add_motions(sums_, state_.instants.size() - 1);
  if (state_.choice && state_.next_index % look_every == 0 && rejudge(state_.choice->q)) {
    // what looks like a jump may be the first motion that shows a new direction
    rejudge(std::nullopt);
    rebuild();
  }
  if (state_.next_index - state_.first_open < most_open) return;
  commit();
  rebuild();
}

/// Verdicts on the steps to all open instants. Returns whether one changed.
bool StrideSums::rejudge(const std::optional<DualQuaternion>& q) {
  std::vector<Step> steps;
  std::size_t first = 0;
  while (first < state_.instants.size() && state_.instants[first].index < state_.first_open) ++first;
  first = std::max<std::size_t>(first, 1);
  for (std::size_t i = first; i < state_.instants.size(); ++i)
    steps.push_back(step(state_.instants[i - 1], state_.instants[i]));
  if (steps.empty()) return false;
  const std::vector<Jump> verdicts =
      find_jumps(steps, state_.committed.total(0).motions, options_.mode, q, tuning_.jumps);
  bool changed = false;
  for (std::size_t i = first; i < state_.instants.size(); ++i) {
    const Jump jump = verdicts[i - first];
    changed = changed || jump != state_.instants[i].jump;
    append(state_.instants[i], &state_.instants[i - 1], jump);
  }
  return changed;
}

/// All but the newest instants keep their verdicts for good.
void StrideSums::commit() {
  const std::uint64_t open = state_.next_index - state_.first_open;
  if (open <= least_open) return;
  const std::uint64_t first_open = state_.next_index - least_open;
  for (std::size_t i = 0; i < state_.instants.size(); ++i) {
    const JudgedInstant& judged = state_.instants[i];
    if (judged.index < state_.first_open || judged.index >= first_open) continue;
    add_motions(state_.committed, i);
    if (judged.jump != Jump::none) ++state_.jumps;
  }
  state_.first_open = first_open;
  const auto longest = static_cast<std::uint64_t>(ladder().back());
  while (state_.instants.front().index + longest < first_open) state_.instants.pop_front();
}

/// The sums anew, from the committed ones and the open instants.
void StrideSums::rebuild() {
  StrideBlocks sums = state_.committed;
  for (std::size_t i = 0; i < state_.instants.size(); ++i)
    if (state_.instants[i].index >= state_.first_open) add_motions(sums, i);
  sums_ = std::move(sums);
  std::vector<std::uint8_t> outlier(sums_.blocks(), 0);
  const std::uint64_t length = sums_.state().block_length;
  for (std::size_t i = 0; i < state_.outlier.size(); ++i)
    if (state_.outlier[i] != 0) outlier.at(static_cast<std::size_t>(i * state_.outlier_length / length)) = 1;
  sums_.leave_out(std::move(outlier));
}

void StrideSums::choose() {
  judge_open();
  leave_out_blocks();
  const std::optional<double> current = state_.choice ? std::optional(state_.choice->memory) : std::nullopt;
  if (std::optional<WeightChoice> choice = choose_weights(sums_, empty_problem(), current, tuning_.weighting))
    state_.choice = std::move(choice);
}

/// Verdicts on the open instants and the weights depend on each other. Mostly there is no jump, and none by
/// the weights without any: that is the end of it.
void StrideSums::judge_open() {
  const auto suggested = [&] { return residual_weights(sums_, options_.mode); };
  const std::optional<WeightChoice> first = suggested();
  const bool before = std::any_of(state_.instants.begin(), state_.instants.end(), [&](const auto& judged) {
    return judged.index >= state_.first_open && judged.jump != Jump::none;
  });
  if (first && !before && !rejudge(first->q)) return;
  rejudge(std::nullopt);
  rebuild();
  for (int round = 0; round < most_rounds; ++round) {
    const std::optional<WeightChoice> next = suggested();
    if (!next || !rejudge(next->q)) break;
    rebuild();
  }
}

/// Blocks that contradict the others, by their motions within.
void StrideSums::leave_out_blocks() {
  sums_.leave_out(std::vector<std::uint8_t>(sums_.blocks(), 0));
  const std::optional<WeightChoice> suggested = residual_weights(sums_, options_.mode);
  if (!suggested) return;
  Problem problem = empty_problem();
  problem.balance = {0, 1};
  const std::vector<Statistics> parts = sums_.within(suggested->weights);
  // Motions of a block share their ends: no block is long enough to have an extrinsic of its own.
  const auto overlap = static_cast<int>(sums_.state().block_length);
  if (const std::optional<Consensus> consensus = find_consensus(problem, parts, overlap))
    sums_.leave_out({consensus->outlier.begin(), consensus->outlier.end()});
  state_.outlier = sums_.state().outlier;
  state_.outlier_length = sums_.state().block_length;
}

Problem StrideSums::empty_problem() const {
  Problem problem;
  problem.mode = options_.mode;
  problem.plane_a = options_.plane_a;
  problem.plane_b = options_.plane_b;
  problem.prior = options_.prior;
  return problem;
}

Problem StrideSums::problem() const {
  Problem problem = empty_problem();
  if (state_.choice) TouchingSums(sums_).fill(state_.choice->weights, problem);
  return problem;
}

std::uint64_t StrideSums::inlier_steps() const {
  return sums_.strides().empty() ? 0 : sums_.total(0).motions.count;
}

std::uint64_t StrideSums::outlier_steps() const {
  std::uint64_t jumps = state_.jumps;
  for (const JudgedInstant& judged : state_.instants)
    if (judged.index >= state_.first_open && judged.jump != Jump::none) ++jumps;
  return jumps + sums_.instants_left_out();
}

}  // namespace egocal
