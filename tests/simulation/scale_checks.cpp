// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is checked of scales that are to be found.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "simulation/checks.hpp"
#include "simulation/checks_common.hpp"

namespace egocal::simulation {

namespace {

/// A certified scale is that of the drive up to its own standard deviations and this part of it, which is
/// what 1 % of noise leaves in the shortest sessions. The motion changes at each pose, and interpolation in
/// between shortens lengths by percents at 4 Hz (docs/scale.md).
constexpr double most_deviations = 6, most_off = 0.02, most_off_interpolated = 0.06;

}  // namespace

bool Checks::is_scale_to_be_found(const std::string& a, const std::string& b) const {
  const bus::Rig& rig = surroundings_.drive.rig;
  return std::any_of(rig.pairs.begin(), rig.pairs.end(), [&](const bus::PairConfig& pair) {
    return pair.a == a && pair.b == b && bus::unscaled_side(rig, pair);
  });
}

void Checks::scale_problem_sent(const std::string& channel, bus::Bytes message) {
  scale_problem_t problem{};
  if (!bus::decode(message, problem)) return fail('e', "a scale problem that cannot be decoded");
  scale_problems_[channel].insert({problem.session, problem.seq});
}

void Checks::scale_sent(const Process& from, bus::Bytes message) {
  if (corrupts()) return;
  scale_t scale{};
  if (!bus::decode(message, scale)) return fail('e', "a scale that cannot be decoded");
  const auto asked = scale_problems_.find(bus::scale_problem_channel(scale.sensor_a, scale.sensor_b));
  if (asked == scale_problems_.end() || !asked->second.contains({scale.session, scale.seq}))
    return fail('e', from.spec().name + " sends a scale for what was never asked");
  const bus::Checked<ScaleSolution> solution = bus::to_scale(scale);
  if (!solution) return fail('c', from.spec().name + " sends a scale that is refused: " + solution.reason);
  check_scale(from.spec().name, *solution.value);
}

void Checks::check_scale(const std::string& whose, const ScaleSolution& solution) {
  if (!solution.certified || !solution.observable || !std::isfinite(solution.stddev)) return;
  ++scales_;
  const double truth = surroundings_.plan.scale;
  const double off = std::abs(solution.scale - truth),
               part = surroundings_.plan.measured_together() ? most_off : most_off_interpolated,
               limit = part * truth + most_deviations * solution.stddev;
  if (off <= limit) return;
  char text[120];
  std::snprintf(text, sizeof text, ": the scale is %.5g +- %.2g, that of the drive is %.5g", solution.scale,
                solution.stddev, truth);
  fail('c', whose + text);
}

/// What a person sees in the end beside an answer at a scale that was found.
void Checks::check_scales() {
  if (corrupts() || !surroundings_.plan.auto_scale) return;
  for (const auto& process : processes_)
    if (const Exporter* exporter = process->exporter())
      for (const auto& [pair, best] : exporter->answers().all()) {
        if (!exporter->answers().certified(pair) || !is_scale_to_be_found(pair.first, pair.second)) continue;
        const bus::CheckedScale* scale = exporter->answers().scale(pair);
        if (!scale)
          fail('c', "egocal-export takes an answer at a scale that it does not know");
        else
          check_scale("egocal-export", scale->solution);
      }
}

}  // namespace egocal::simulation
