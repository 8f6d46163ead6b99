// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/scale.hpp"

#include <cmath>
#include <utility>

#include "egocal/bus/plausible.hpp"
#include "egocal/limits.hpp"
#include "wire_checks.hpp"

namespace egocal::bus {

namespace {

/// Limit of the wire: twice what ScaleDriveOptions sends.
constexpr std::size_t most_blocks = 64;
/// Limits of the wire.
constexpr double least_scale = 1e-9, most_scale = 1e9;
/// Largest difference of two solutions of one problem. One program finds the same bits again; others may
/// round in another order.
constexpr double same_scale = 1e-6;

using Block = ScaleStatistics::Block;

void set_symmetric(const Block& matrix, double (&out)[10]) {
  std::size_t next = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = row; column < 4; ++column) out[next++] = matrix(row, column);
}
void set_full(const Block& matrix, double (&out)[16]) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) out[4 * row + column] = matrix(row, column);
}
Block symmetric(const double (&in)[10]) {
  Block matrix;
  std::size_t next = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = row; column < 4; ++column) matrix(row, column) = matrix(column, row) = in[next++];
  return matrix;
}
Block full(const double (&in)[16]) {
  Block matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = in[4 * row + column];
  return matrix;
}

/// Empty: no fault. At a scale common to both lengths the block must be a sum of squares, as far as its
/// diagonal and its two by two minors show.
std::string fault(const ScaleStatistics& block) {
  if (!std::isfinite(block.weight) || block.weight <= 0)
    return "statistics with a weight that is not positive";
  for (const Block* matrix : {&block.rotation, &block.coupling_a, &block.coupling_b, &block.cross})
    if (!matrix->allFinite() || matrix->cwiseAbs().maxCoeff() > largest_entry)
      return "statistics that are not finite";
  if (!(block.square_a >= 0 && block.square_a < largest_entry && block.square_b >= 0 &&
        block.square_b < largest_entry))
    return "statistics that are not a sum of squares";
  const double scale = block.square_a > 0 ? std::sqrt(block.square_b / block.square_a) : 0;
  const Matrix8d rows = at_scale(block, std::isfinite(scale) ? scale : 0).dual_rows;
  const double size = rows.diagonal().cwiseAbs().sum() + 2 * block.square_b;
  return bounded_by_diagonal(rows, 1e-9 * size) ? "" : "statistics that are not a sum of squares";
}

std::int8_t wire_noise(ScaleNoise noise) {
  return noise == ScaleNoise::both ? 0 : noise == ScaleNoise::metric ? 1 : 2;
}

bool scale_in_range(double scale) {
  return scale >= least_scale && scale <= most_scale;
}

template <class Message>
std::string fault_of_head(const Message& message) {
  if (!plausible_time(message.utime)) return "time out of range";
  if (!plausible_time(message.session)) return "session out of range";
  if (!plausible_count(message.seq)) return "count out of range";
  if (!plausible_name(message.sensor_a) || !plausible_name(message.sensor_b)) return "sensor name";
  if (message.side != 0 && message.side != 1) return "unknown side";
  return {};
}

}  // namespace

scale_problem_t to_message(const ScaleProblem& problem) {
  scale_problem_t message{};
  message.side = problem.options.side == Side::a ? 0 : 1;
  message.mode = problem.options.mode == Mode::planar ? 1 : 0;
  message.noise = wire_noise(problem.options.noise);
  message.weight_rotation = problem.options.balance.rotation;
  message.weight_translation = problem.options.balance.translation;
  message.least = problem.options.least;
  message.most = problem.options.most;
  message.doubt = problem.options.doubt;
  message.n_blocks = static_cast<std::int32_t>(problem.blocks.size());
  for (const ScaleStatistics& block : problem.blocks) {
    scale_statistics_t& out = message.blocks.emplace_back();
    out.count = static_cast<std::int64_t>(block.count);
    out.weight = block.weight;
    set_symmetric(block.rotation, out.rotation);
    set_full(block.coupling_a, out.coupling_a);
    set_full(block.coupling_b, out.coupling_b);
    set_symmetric(block.cross, out.cross);
    out.square_a = block.square_a;
    out.square_b = block.square_b;
  }
  return message;
}

Checked<ScaleProblem> to_scale_problem(const scale_problem_t& message) {
  if (std::string reason = fault_of_head(message); !reason.empty()) return {{}, std::move(reason)};
  if (message.mode != 0 && message.mode != 1) return {{}, "unknown mode"};
  if (message.noise < 0 || message.noise > 2) return {{}, "unknown noise"};
  if (!(message.weight_rotation >= 0 && message.weight_rotation < largest_entry &&
        message.weight_translation > 0 && message.weight_translation < largest_entry))
    return {{}, "balance out of range"};
  if (!scale_in_range(message.least) || !scale_in_range(message.most) || !(message.least < message.most))
    return {{}, "range of scales"};
  if (!(message.doubt >= 0 && message.doubt <= 1)) return {{}, "doubt out of range"};
  if (message.scale != 0 && !scale_in_range(message.scale)) return {{}, "scale out of range"};
  if (message.blocks.size() > most_blocks) return {{}, "too many blocks"};
  ScaleProblem problem;
  problem.options.side = message.side == 0 ? Side::a : Side::b;
  problem.options.mode = message.mode == 1 ? Mode::planar : Mode::spatial;
  for (const ScaleNoise noise : {ScaleNoise::both, ScaleNoise::metric, ScaleNoise::unscaled})
    if (wire_noise(noise) == message.noise) problem.options.noise = noise;
  problem.options.balance = {message.weight_rotation, message.weight_translation};
  problem.options.least = message.least;
  problem.options.most = message.most;
  problem.options.doubt = message.doubt;
  for (const scale_statistics_t& in : message.blocks) {
    if (!plausible_count(in.count)) return {{}, "count out of range"};
    ScaleStatistics& block = problem.blocks.emplace_back();
    block.count = static_cast<std::uint64_t>(in.count);
    block.weight = in.weight;
    block.rotation = symmetric(in.rotation);
    block.coupling_a = full(in.coupling_a);
    block.coupling_b = full(in.coupling_b);
    block.cross = symmetric(in.cross);
    block.square_a = in.square_a;
    block.square_b = in.square_b;
    if (std::string reason = fault(block); !reason.empty()) return {{}, std::move(reason)};
  }
  return {std::move(problem), {}};
}

scale_t to_message(const ScaleSolution& solution, const scale_problem_t& problem) {
  scale_t message{};
  message.utime = problem.utime;
  message.session = problem.session;
  message.seq = problem.seq;
  message.sensor_a = problem.sensor_a;
  message.sensor_b = problem.sensor_b;
  message.side = problem.side;
  message.scale = solution.scale;
  message.stddev = solution.stddev;
  message.least_scale = solution.least_scale;
  message.most_scale = solution.most_scale;
  message.cost = solution.cost;
  message.lower_bound = solution.lower_bound;
  message.gap = solution.gap;
  message.attenuation = solution.attenuation;
  message.observability = solution.observability;
  message.certified = solution.certified;
  message.observable = solution.observable;
  message.at_limit = solution.at_limit;
  return message;
}

Checked<ScaleSolution> to_scale(const scale_t& message) {
  if (std::string reason = fault_of_head(message); !reason.empty()) return {{}, std::move(reason)};
  if (!plausible_name(message.solver)) return {{}, "solver name"};
  if (!scale_in_range(message.scale)) return {{}, "scale out of range"};
  if (!not_negative({message.stddev, message.least_scale, message.most_scale, message.gap,
                     message.attenuation, message.observability}) ||
      !std::isfinite(message.cost) || !(message.lower_bound <= message.cost) || message.observability > 1 ||
      message.least_scale > message.scale || message.most_scale < message.scale ||
      (message.certified && (message.at_limit || !std::isfinite(message.gap))) ||
      (message.observable && message.at_limit))
    return {{}, "scale that contradicts itself"};
  if (message.solve_ns < 0) return {{}, "negative duration"};
  ScaleSolution solution;
  solution.scale = message.scale;
  solution.stddev = message.stddev;
  solution.least_scale = message.least_scale;
  solution.most_scale = message.most_scale;
  solution.cost = message.cost;
  solution.lower_bound = message.lower_bound;
  solution.gap = message.gap;
  solution.attenuation = message.attenuation;
  solution.observability = message.observability;
  solution.certified = message.certified != 0;
  solution.observable = message.observable != 0;
  solution.at_limit = message.at_limit != 0;
  return {std::move(solution), {}};
}

std::string ScaleCheck::take(const scale_problem_t& message) {
  Checked<ScaleProblem> problem = to_scale_problem(message);
  if (!problem) return problem.reason;
  Pair& pair = pairs_.touch(message.sensor_a, message.sensor_b);
  const bool same = pair.session == message.session && pair.seq == message.seq;
  pair.in_force = message.scale;
  if (same) return {};
  pair.session = message.session;
  pair.seq = message.seq;
  pair.problem = std::move(*problem.value);
  pair.own.reset();
  if (!pair.early) return {};
  const scale_t early = *std::exchange(pair.early, std::nullopt);
  return early.session == pair.session && early.seq == pair.seq ? take(early) : std::string();
}

std::string ScaleCheck::take(const scale_t& message) {
  Checked<ScaleSolution> solution = to_scale(message);
  if (!solution) return solution.reason;
  Pair& pair = pairs_.touch(message.sensor_a, message.sensor_b);
  CheckedScale scale{message.side == 0 ? message.sensor_a : message.sensor_b, *solution.value,
                     message.session, message.seq, false};
  if (pair.session == message.session && pair.seq == message.seq) {
    if (!pair.own) pair.own = solve_scale(pair.problem.blocks, pair.problem.options);
    const bool agrees = message.side == (pair.problem.options.side == Side::a ? 0 : 1) &&
                        std::abs(message.scale - pair.own->scale) <= same_scale * pair.own->scale;
    if (!agrees) return "its problem has another scale";
    scale.solution = *pair.own;
    scale.verified = true;
  } else {
    pair.early = message;
    scale.solution.certified = false;
    // never instead of a verified one of this session
    if (pair.scale && pair.scale->session == message.session && pair.scale->verified) return {};
  }
  pair.scale = std::move(scale);
  return {};
}

const CheckedScale* ScaleCheck::find(const std::string& a, const std::string& b, std::int64_t session) const {
  const Pair* const pair = pairs_.find(a, b);
  return pair && pair->scale && pair->scale->session == session ? &*pair->scale : nullptr;
}

const ScaleSolution* ScaleCheck::solution(const std::string& a, const std::string& b, std::int64_t session) {
  Pair* const pair = pairs_.find(a, b);
  if (!pair || pair->session != session || pair->seq < 0) return nullptr;
  if (!pair->own) pair->own = solve_scale(pair->problem.blocks, pair->problem.options);
  return &*pair->own;
}

std::optional<double> ScaleCheck::in_force(const std::string& a, const std::string& b,
                                           std::int64_t session) const {
  const Pair* const pair = pairs_.find(a, b);
  if (!pair || pair->session != session || !(pair->in_force > 0)) return std::nullopt;
  return pair->in_force;
}

}  // namespace egocal::bus
