// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The fields of the library structs in a state file: all of them. The structured bindings do not compile when
// a struct gains or loses a field, so no field is forgotten. Raise state_layout with each change.
#pragma once

#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/stream.hpp"
#include "egocal/scale/scale_drive.hpp"
#include "state/archive.hpp"

namespace egocal {

void fields(auto& archive, services::Is<DualQuaternion> auto& value) {
  auto& [real, dual] = value;
  archive(real, dual);
}

void fields(auto& archive, services::Is<StampedPose> auto& value) {
  auto& [time_us, pose] = value;
  archive(time_us, pose);
}

void fields(auto& archive, services::Is<Balance> auto& value) {
  auto& [rotation, translation] = value;
  archive(rotation, translation);
}

void fields(auto& archive, services::Is<Statistics> auto& value) {
  auto& [dual_rows, weight, count] = value;
  archive(dual_rows, weight, count);
}

void fields(auto& archive, services::Is<GroundPlane> auto& value) {
  auto& [normal, distance] = value;
  archive(normal, distance);
}

void fields(auto& archive, services::Is<SynchroniserOptions> auto& value) {
  auto& [poses_to_decide, most_waiting, slower_by, cut_alike, most_cut, most_bent, typical_steps,
         smooth_poses, correlation_length, most_rough, most_uneven_here, most_uneven] = value;
  archive(poses_to_decide, most_waiting, slower_by, cut_alike, most_cut, most_bent, typical_steps,
          smooth_poses, correlation_length, most_rough, most_uneven_here, most_uneven);
}

void fields(auto& archive, services::Is<ClockOptions> auto& value) {
  auto& [first, every, delay, window, longest, most_held, least_correlation, least_inliers, largest_stddev,
         least_change, change_sigmas, work_per_pose, phase] = value;
  archive(first, every, delay, window, longest, most_held, least_correlation, least_inliers, largest_stddev,
          least_change, change_sigmas, work_per_pose, phase);
}

void fields(auto& archive, services::Is<CongruenceOptions> auto& value) {
  auto& [least_turn, angle_floor, length_floor, memory, first_estimate, estimate_every,
         estimate_every_when_full, doubtful_remembered, most_growing, still, beyond, unknown_noise,
         gross_angle, gross_lengths, longest_lever_arm, noise_of_turns, turns_more] = value;
  archive(least_turn, angle_floor, length_floor, memory, first_estimate, estimate_every,
          estimate_every_when_full, doubtful_remembered, most_growing, still, beyond, unknown_noise,
          gross_angle, gross_lengths, longest_lever_arm, noise_of_turns, turns_more);
}

void fields(auto& archive, services::Is<ScreeningOptions> auto& value) {
  auto& [doubtful, break_chain, most_doubtful, repeated, congruence] = value;
  archive(doubtful, break_chain, most_doubtful, repeated, congruence);
}

void fields(auto& archive, services::Is<AccumulatorOptions> auto& value) {
  auto& [longest_motion, stretch, most_rotation, balances, first_choice, early_choice, choice_phase] = value;
  archive(longest_motion, stretch, most_rotation, balances, first_choice, early_choice, choice_phase);
}

void fields(auto& archive, services::Is<PairingOptions> auto& value) {
  auto& [mode, plane_a, plane_b, stride, balance, time_offset, track_time_offset, max_gap, robust, prior,
         clock, synchroniser, screening, accumulator] = value;
  archive(mode, plane_a, plane_b, stride, balance, time_offset, track_time_offset, max_gap, robust, prior,
          clock, synchroniser, screening, accumulator);
}

void fields(auto& archive, services::Is<MotionPair> auto& value) {
  auto& [a, b, begin_us, end_us, eta] = value;
  archive(a, b, begin_us, end_us, eta);
}

void fields(auto& archive, services::Is<BlockStatistics::Block> auto& value) {
  auto& [statistics, outlier] = value;
  archive(statistics, outlier);
}

void fields(auto& archive, services::Is<BlockStatistics::State> auto& value) {
  auto& [blocks, pairs_per_block] = value;
  archive(blocks, pairs_per_block);
}

void fields(auto& archive, services::Is<ResidualScale> auto& value) {
  auto& [absolute, relative] = value;
  archive(absolute, relative);
}

void fields(auto& archive, services::Is<Agreement> auto& value) {
  auto& [q, scale] = value;
  archive(q, scale);
}

void fields(auto& archive, services::Is<RobustStatistics::State> auto& value) {
  auto& [blocks, waiting, agreement, in_a_row, doublings, next_look, given] = value;
  archive(blocks, waiting, agreement, in_a_row, doublings, next_look, given);
}

/// Classes whose whole state is a struct.
template <class T>
concept Stateful = std::same_as<T, BlockStatistics> || std::same_as<T, RobustStatistics> ||
    std::same_as<T, StrideBlocks> || std::same_as<T, WeightedBlocks>;
inline void fields(services::Writer& archive, const Stateful auto& value) {
  archive(value.state());
}
template <Stateful T>
void fields(services::Reader& archive, T& value) {
  typename T::State state;
  archive(state);
  value = T(std::move(state));
}

void fields(auto& archive, services::Is<TypicalDifference::Seen> auto& value) {
  auto& [size, difference] = value;
  archive(size, difference);
}

void fields(auto& archive, services::Is<TypicalDifference> auto& value) {
  auto& [newest, constant, growing, large, moving] = value;
  archive(newest, constant, growing, large, moving);
}

void fields(auto& archive, services::Is<CongruenceScale> auto& value) {
  auto& [angle, slide, length, lever, arm, remembered, doubtful] = value;
  archive(angle, slide, length, lever, arm, remembered, doubtful);
}

void fields(auto& archive, services::Is<Rejections> auto& value) {
  auto& [by_reason] = value;
  archive(by_reason);
}

void fields(auto& archive, services::Is<Choice> auto& value) {
  auto& [stride, balance, mean_stride, reason] = value;
  archive(stride, balance, mean_stride, reason);
}

void fields(auto& archive, services::Is<TimeOffset> auto& value) {
  auto& [seconds, stddev, correlation, rate, rate_stddev, at_us, drifts, inliers, rival] = value;
  archive(seconds, stddev, correlation, rate, rate_stddev, at_us, drifts, inliers, rival);
}

void fields(auto& archive, services::Is<ClockState::Stream> auto& value) {
  auto& [window, held, begin_us, newest_us, stray] = value;
  archive(window, held, begin_us, newest_us, stray);
}

void fields(auto& archive, services::Is<ClockState> auto& value) {
  auto& [streams, next_us, newest, in_force, near, given_up, changes] = value;
  archive(streams, next_us, newest, in_force, near, given_up, changes);
}

void fields(auto& archive, services::Is<Instant> auto& value) {
  auto& [time_us, a, b, chain, number] = value;
  archive(time_us, a, b, chain, number);
}

void fields(auto& archive, services::Is<KeyStep> auto& value) {
  auto& [length, angle] = value;
  archive(length, angle);
}

void fields(auto& archive, services::Is<SynchroniserState> auto& value) {
  auto& [newest_us, waiting, keys, period_us, last_key_us, previous_key, key_steps, synchronised, chain,
         rejections] = value;
  archive(newest_us, waiting, keys, period_us, last_key_us, previous_key, key_steps, synchronised, chain,
          rejections);
}

void fields(auto& archive, services::Is<ScreeningState> auto& value) {
  auto& [chain, congruence, newest, accepted, first, doubtful, rejections] = value;
  archive(chain, congruence, newest, accepted, first, doubtful, rejections);
}

void fields(auto& archive, services::Is<AccumulatorState::PerStride> auto& value) {
  auto& [stride, statistics] = value;
  archive(stride, statistics);
}

/// Most cells hold no motions across a jump, and many hold none at all. Empty statistics take 8 bytes instead
/// of 528.
void fields(auto& archive, services::Is<StrideCell> auto& value) {
  auto& [motions, rotations] = value;
  const auto unless_empty = [&archive](auto& statistics) {
    auto& [dual_rows, weight, count] = statistics;
    archive(count);
    if (count > 0) archive(dual_rows, weight);
  };
  unless_empty(motions);
  unless_empty(rotations);
}

void fields(auto& archive, services::Is<StrideSum> auto& value) {
  auto& [stride, near, far] = value;
  archive(stride, near, far);
}

void fields(auto& archive, services::Is<StrideBlocks::State> auto& value) {
  auto& [block_length, instants, outlier, strides] = value;
  archive(block_length, instants, outlier, strides);
}

void fields(auto& archive, services::Is<WeightedBlocks::State> auto& value) {
  auto& [block_length, blocks, left_out, shared] = value;
  archive(block_length, blocks, left_out, shared);
}

void fields(auto& archive, services::Is<StrideWeights> auto& value) {
  auto& [rotation, translation] = value;
  archive(rotation, translation);
}

void fields(auto& archive, services::Is<WeightChoice> auto& value) {
  auto& [weights, q, memory, mean_stride, ratio, beats_single, reason] = value;
  archive(weights, q, memory, mean_stride, ratio, beats_single, reason);
}

void fields(auto& archive, services::Is<JudgedInstant> auto& value) {
  auto& [instant, index, jump, rotation_chain, translation_chain, doubtful, step_variance, total_variance] =
      value;
  archive(instant, index, jump, rotation_chain, translation_chain, doubtful, step_variance, total_variance);
}

void fields(auto& archive, services::Is<StrideSumsState> auto& value) {
  auto& [committed, instants, first_open, next_index, next_look, next_choice, period_us, outlier,
         outlier_length, choice, weighted, jumps] = value;
  archive(committed, instants, first_open, next_index, next_look, next_choice, period_us, outlier,
          outlier_length, choice, weighted, jumps);
}

void fields(auto& archive, services::Is<Attenuation> auto& value) {
  auto& [r, taken_off, pull] = value;
  archive(r, taken_off, pull);
}

void fields(auto& archive, services::Is<AccumulatorState> auto& value) {
  auto& [choice, period_us, instants, strides, next_choice, sums, attenuation, rejections] = value;
  archive(choice, period_us, instants, strides, next_choice, sums, attenuation, rejections);
}

void fields(auto& archive, services::Is<PairingState> auto& value) {
  auto& [poses_a, poses_b, rejections, segment, clock, synchroniser, screening, accumulator] = value;
  archive(poses_a, poses_b, rejections, segment, clock, synchroniser, screening, accumulator);
}

void fields(auto& archive, services::Is<NumberedPose> auto& value) {
  auto& [pose, seq, mono_us, begins_anew] = value;
  archive(pose, seq, mono_us, begins_anew);
}

void fields(auto& archive, services::Is<StreamCounts> auto& value) {
  auto& [lost, duplicate, out_of_order, jump] = value;
  archive(lost, duplicate, out_of_order, jump);
}

void fields(auto& archive, services::Is<StreamState> auto& value) {
  auto& [newest_us, period_us, next_seq, lost, early, candidates, ahead, checked_us, recent, recent_next,
         patient, gap, gap_repeats, settling, held, held_last_us, held_before, going_over, counts] = value;
  archive(newest_us, period_us, next_seq, lost, early, candidates, ahead, checked_us, recent, recent_next,
          patient, gap, gap_repeats, settling, held, held_last_us, held_before, going_over, counts);
}

void fields(auto& archive, services::Is<ScaleStatistics> auto& value) {
  auto& [rotation, coupling_a, coupling_b, cross, square_a, square_b, weight, count] = value;
  archive(rotation, coupling_a, coupling_b, cross, square_a, square_b, weight, count);
}

void fields(auto& archive, services::Is<ScaleOptions> auto& value) {
  auto& [side, least, most, noise, mode, balance, tolerance, most_solves, most_noise_share, farthest,
         given_away, weak_bound, least_blocks, doubt] = value;
  archive(side, least, most, noise, mode, balance, tolerance, most_solves, most_noise_share, farthest,
          given_away, weak_bound, least_blocks, doubt);
}

void fields(auto& archive, services::Is<ScaleProblem> auto& value) {
  auto& [blocks, options] = value;
  archive(blocks, options);
}

void fields(auto& archive, services::Is<ScaleSolution> auto& value) {
  auto& [scale, q, cost, balance, lower_bound, gap, rounding, least_scale, most_scale, certified, at_limit,
         stddev, sensitivity, attenuation, observability, observable, solves] = value;
  archive(scale, q, cost, balance, lower_bound, gap, rounding, least_scale, most_scale, certified, at_limit,
          stddev, sensitivity, attenuation, observability, observable, solves);
}

void fields(auto& archive, services::Is<InterpolationLossState::Open> auto& value) {
  auto& [motion, miss, begin_us] = value;
  archive(motion, miss, begin_us);
}

void fields(auto& archive, services::Is<InterpolationLossState> auto& value) {
  auto& [stamps, previous, open, lost, energy, steps, together, passed] = value;
  archive(stamps, previous, open, lost, energy, steps, together, passed);
}

void fields(auto& archive, services::Is<ScaleDriveState> auto& value) {
  auto& [pairing, open, recent, old, old_block, motions, left_out, next_solution, solved_motions,
         solved_left_out, solved_us, step_us, limit, balance, interpolation, problem, solution] = value;
  archive(pairing, open, recent, old, old_block, motions, left_out, next_solution, solved_motions,
          solved_left_out, solved_us, step_us, limit, balance, interpolation, problem, solution);
}

namespace services {

/// Number of the layout of the fields in this file.
constexpr int state_layout = 24;

}  // namespace services

}  // namespace egocal
