// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/spread_motions.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "scale/kept_motions.hpp"

namespace egocal::detail {

namespace {

/// Over a fixed number of instants, none across a gap.
std::vector<MotionPair> motions_over(const Instants& instants, std::int64_t origin_us, std::size_t steps,
                                     std::size_t most, const MotionSampleOptions& motions) {
  std::vector<MotionPair> pairs;
  const std::size_t n = instants.size(), each = (n + most - 1) / most;
  const double longest = motions.most_stretched * static_cast<double>(steps) * instants.period;
  MotionEnds ends(instants, {}, {}, steps, each);
  for (std::size_t i = 0; i + steps < n; i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k) - instants.time(i) > longest) continue;
    ends.fetch_next(i, k);
    const PosePair from = ends.at(i), to = ends.at(k);
    pairs.push_back({canonical_sign(normalized(conjugate(from.a) * to.a)),
                     canonical_sign(normalized(conjugate(from.b) * to.b)),
                     origin_us + to_microseconds(instants.time(i)),
                     origin_us + to_microseconds(instants.time(k)), 1});
  }
  return pairs;
}

}  // namespace

bool is_long(const Instants& instants, const LongDriveOptions& options) {
  return instants.size() > options.most;
}

std::vector<MotionPair> spread_motions(const Instants& instants, std::int64_t origin_us,
                                       const PairingOptions& pairing, const MotionSampleOptions& motions,
                                       const LongDriveOptions& options) {
  constexpr double most_steps = 64;  // as where all motions are looked at
  const auto steps = static_cast<std::size_t>(
      std::clamp(std::round(options.motion / std::max(instants.period, 1e-6)), 1.0, most_steps));
  std::vector<MotionPair> pairs = motions_over(instants, origin_us, steps, options.most, motions);
  if (pairing.mode != Mode::planar) return pairs;
  GroundPlane through_b = pairing.plane_b;
  through_b.distance = 0;  // the height of the scaled sensor is not to be scaled
  const DualQuaternion G_a = plane_frame(pairing.plane_a), G_b = plane_frame(through_b);
  for (MotionPair& pair : pairs) {
    pair.a = planar_motion(pair.a, G_a);
    pair.b = planar_motion(pair.b, G_b);
  }
  return pairs;
}

std::optional<ScaleSolution> scale_of_b(std::span<const MotionPair> motions, Mode mode) {
  if (motions.empty()) return std::nullopt;
  DriveScaleOptions options;
  options.scale.side = Side::b;
  options.scale.mode = mode;
  options.scale.balance = even_balance(scale_blocks(motions), Side::b);
  ScaleSolution solution = estimate_scale(motions, options);
  if (const std::optional<Balance> better = noise_balance(motions, solution, Side::b)) {
    options.scale.balance = *better;
    solution = estimate_scale(motions, options);
  }
  return solution;
}

}  // namespace egocal::detail
