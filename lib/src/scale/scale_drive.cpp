// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/scale_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"
#include "scale/kept_motions.hpp"
#include "scale/unjudged_motions.hpp"

namespace egocal {

namespace {

PairingOptions of_single_steps(const ScaleDriveOptions& options) {
  PairingOptions pairing = detail::unjudged(options.pairing, 1);
  // the height of the scaled sensor's plane is in metres already
  (options.scale.side == Side::a ? pairing.plane_a : pairing.plane_b).distance = 0;
  return pairing;
}

ScaleDriveOptions completed(ScaleDriveOptions options) {
  options.scale.mode = options.pairing.mode;
  options.starts = std::max<std::size_t>(1, options.starts);
  options.interpolation.motion = options.motion;
  options.interpolation.starts = options.starts;
  options.interpolation.cut_alike = options.pairing.synchroniser.cut_alike;
  options.least_block = std::max<std::size_t>(1, options.least_block);
  return options;
}

/// Scaled, with sign as the solvers take it.
MotionPair at_scale(MotionPair pair, double scale, Side side) {
  DualQuaternion& motion = side == Side::a ? pair.a : pair.b;
  motion = scaled(motion, scale);
  return pair;
}

}  // namespace

ScaleDrive::ScaleDrive(const ScaleDriveOptions& options)
    : options_(completed(options)),
      pairing_(of_single_steps(options_)),
      interpolation_(options_.interpolation) {
  state_.next_solution = options_.first_solution;
  state_.balance = options_.pairing.balance;
}

ScaleDrive::ScaleDrive(const ScaleDriveOptions& options, ScaleDriveState state)
    : options_(completed(options)),
      pairing_(of_single_steps(options_), std::exchange(state.pairing, PairingState())),
      interpolation_(options_.interpolation, std::exchange(state.interpolation, InterpolationLossState())),
      state_(std::move(state)) {}

ScaleDriveState ScaleDrive::state() const {
  ScaleDriveState state = state_;
  state.pairing = pairing_.state();
  state.interpolation = interpolation_.state();
  return state;
}

std::vector<MotionPair> ScaleDrive::push(Side side, const StampedPose& pose) {
  if (!options_.pairing.track_time_offset && plausible_relative_time(pose.time_us))
    interpolation_.stamp(side, on_clock_of_a(side, pose.time_us));
  return taken(pairing_.push(side, pose));
}

std::vector<MotionPair> ScaleDrive::taken(const std::vector<MotionPair>& steps) {
  std::vector<MotionPair> completed;
  for (const MotionPair& step : steps) {
    interpolation_.step(step, pairing_.state().synchroniser.keys.value_or(Side::b));
    const std::size_t before = completed.size();
    grow(step, completed);
    // one step after the other, so that a solution does not depend on how many steps came at once
    for (std::size_t i = before; i < completed.size(); ++i) {
      state_.recent.push_back(completed[i]);
      ++state_.motions;
      if (state_.recent.size() > options_.most_recent) commit_old();
      if (state_.motions >= state_.next_solution) solve();
    }
  }
  if (known())
    for (MotionPair& motion : completed) motion = at_scale(motion, state_.solution.scale, this->side());
  return completed;
}

std::int64_t ScaleDrive::on_clock_of_a(Side side, std::int64_t time_us) const {
  return side == Side::b ? time_us + to_microseconds(options_.pairing.time_offset) : time_us;
}

/// Builds motions of the wanted length from single steps. A gap ends all that have begun.
void ScaleDrive::grow(const MotionPair& step, std::vector<MotionPair>& completed) {
  std::vector<MotionPair>& open = state_.open;
  state_.step_us = step.end_us - step.begin_us;
  if (!open.empty() && open.back().end_us != step.begin_us) open.clear();
  const double distance = options_.motion / static_cast<double>(options_.starts);
  for (MotionPair& motion : open) {
    motion.a = motion.a * step.a;
    motion.b = motion.b * step.b;
    motion.end_us = step.end_us;
  }
  if (open.empty() || to_seconds(step.begin_us - open.back().begin_us) >= distance) open.push_back(step);
  // rounded down, streams with jitter would take one step more every other time
  const double length = options_.motion - 0.5 * to_seconds(state_.step_us);
  const double least_real = std::cos(0.5 * options_.pairing.accumulator.most_rotation);
  while (!open.empty() && to_seconds(open.front().end_us - open.front().begin_us) >= length) {
    const MotionPair& motion = open.front();
    if (std::abs(motion.a.real[0]) > least_real && std::abs(motion.b.real[0]) > least_real) {
      completed.push_back(motion);
      completed.back().a = canonical_sign(motion.a);
      completed.back().b = canonical_sign(motion.b);
    }
    open.erase(open.begin());
  }
}

/// Judges the older half of the newest motions for the last time, and adds it to the sums.
void ScaleDrive::commit_old() {
  const std::size_t count = state_.recent.size() / 2;
  if (state_.old_block == 0)
    state_.old_block =
        std::max<std::uint64_t>(options_.least_block, options_.most_recent / options_.most_recent_blocks);
  for (std::size_t i = 0; i < count; ++i) {
    const MotionPair& pair = state_.recent[i];
    if (state_.limit > 0 && detail::scale_residual(pair, state_.solution, side()) > state_.limit) {
      ++state_.left_out;
      continue;
    }
    if (state_.old.empty() || state_.old.back().count >= state_.old_block) {
      if (state_.old.size() >= options_.most_old_blocks) join_old_blocks();
      state_.old.emplace_back();
    }
    state_.old.back().add(pair);
  }
  state_.recent.erase(state_.recent.begin(), state_.recent.begin() + static_cast<std::ptrdiff_t>(count));
}

void ScaleDrive::join_old_blocks() {
  std::vector<ScaleStatistics> joined;
  for (std::size_t i = 0; i < state_.old.size(); i += 2) {
    joined.push_back(state_.old[i]);
    if (i + 1 < state_.old.size()) joined.back() += state_.old[i + 1];
  }
  state_.old = std::move(joined);
  state_.old_block *= 2;
}

std::vector<ScaleStatistics> ScaleDrive::blocks_with(std::span<const MotionPair> recent) const {
  std::vector<ScaleStatistics> blocks = state_.old;
  const std::size_t least =
      blocks.empty() ? options_.least_block : static_cast<std::size_t>(state_.old_block);
  for (const ScaleStatistics& block : scale_blocks(recent, options_.most_recent_blocks, least))
    blocks.push_back(block);
  return blocks;
}

/// The newest motions without those that do not fit.
std::vector<MotionPair> ScaleDrive::kept() const {
  if (!(state_.limit > 0)) return detail::of_plausible_length(state_.recent);
  std::vector<MotionPair> pairs;
  for (const MotionPair& pair : state_.recent)
    if (detail::scale_residual(pair, state_.solution, side()) <= state_.limit) pairs.push_back(pair);
  return pairs;
}

void ScaleDrive::solve() {
  const double more = options_.growth * static_cast<double>(state_.motions);
  state_.next_solution =
      state_.motions + std::clamp<std::uint64_t>(static_cast<std::uint64_t>(more), 4,
                                                 std::max<std::size_t>(4, options_.longest_wait));
  std::vector<MotionPair> pairs = kept();
  ScaleProblem problem;
  problem.options = options_.scale;
  problem.options.doubt = interpolation_.part();
  for (int pass = 0; pass < options_.passes; ++pass) {
    problem.blocks = blocks_with(pairs);
    problem.options.balance = state_.balance ? *state_.balance : detail::even_balance(problem.blocks, side());
    state_.solution = solve_scale(problem.blocks, problem.options);
    if (pass + 1 == options_.passes) break;
    std::vector<double> residuals;
    for (const MotionPair& pair : state_.recent)
      residuals.push_back(detail::scale_residual(pair, state_.solution, side()));
    state_.limit = options_.most_residual * detail::median(std::move(residuals));
    if (!std::isfinite(state_.limit)) state_.limit = 0;
    std::vector<MotionPair> again = kept();
    const bool same = again.size() == pairs.size();
    if (same && pass > 0) break;
    pairs = std::move(again);
    if (!options_.pairing.balance)
      if (const std::optional<Balance> better = detail::noise_balance(pairs, state_.solution, side()))
        state_.balance = better;
  }
  state_.solved_motions = state_.motions;
  state_.solved_left_out = state_.left_out + state_.recent.size() - pairs.size();
  state_.solved_us = state_.recent.empty() ? 0 : state_.recent.back().end_us;
  state_.problem = std::move(problem);
}

bool ScaleDrive::known() const {
  return state_.problem && state_.solution.certified && state_.solution.observable &&
         std::isfinite(state_.solution.stddev);
}

std::optional<Problem> ScaleDrive::problem() const {
  if (!known()) return std::nullopt;
  Problem problem;
  problem.mode = options_.pairing.mode;
  problem.plane_a = pairing_.options().plane_a;
  problem.plane_b = pairing_.options().plane_b;
  // the planes as the user gave them, as their distances place the extrinsic along the normal
  problem.plane_a.distance = options_.pairing.plane_a.distance;
  problem.plane_b.distance = options_.pairing.plane_b.distance;
  problem.balance = state_.solution.balance;
  problem.prior = options_.pairing.prior;
  for (const ScaleStatistics& block : state_.problem->blocks)
    problem.blocks.push_back(
        egocal::at_scale(side() == Side::a ? block : with_scale_on_b(block), state_.solution.scale));
  return problem;
}

PairingCounts ScaleDrive::counts() const {
  PairingCounts counts = pairing_.running_counts();  // of what is not replaced here
  counts.outliers = state_.solved_left_out;
  counts.matched = state_.solved_motions - std::min(state_.solved_motions, state_.solved_left_out);
  return counts;
}

Choice ScaleDrive::choice() const {
  Choice choice;
  if (state_.step_us > 0)
    choice.stride =
        static_cast<int>(std::clamp(std::round(options_.motion / to_seconds(state_.step_us)), 1.0, 1e4));
  choice.balance = state_.solution.balance;
  choice.reason = "motions of one second, with the scale that they show";
  return choice;
}

}  // namespace egocal
