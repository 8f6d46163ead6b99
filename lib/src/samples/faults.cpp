// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/faults.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/in_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

Finding too_few_poses(std::size_t units) {
  Finding finding;
  finding.code = "too_little_motion";
  finding.certain = true;
  finding.message =
      format("Only %s, where samples that share a pose of a, or one of b, count as one: an answer needs %zu.",
             counted(units, "different pose").c_str(), least_units);
  finding.remedy =
      "Move the arm: 10 poses and more, with turns of 20 degrees and more in different directions.";
  return finding;
}

std::optional<Finding> turns_too_small(std::span<const PoseSample> samples, const SampleNoise& noise,
                                       const SmallTurnOptions& options) {
  const std::size_t n = samples.size();
  std::vector<double> turns_a, turns_b, ways, unlike;
  for (const std::size_t step : {n / 2, n / 3})  // neighbours may be alike: samples are in an order
    for (std::size_t i = 0; i < n; ++i) {
      const PoseSample &from = samples[i], &to = samples[(i + step) % n];
      const DualQuaternion a = conjugate(from.a) * to.a, b = conjugate(from.b) * to.b;
      turns_a.push_back(rotation_angle(a.real));
      turns_b.push_back(rotation_angle(b.real));
      const double way_a = to_pose(a).translation.norm(), way_b = to_pose(b).translation.norm();
      ways.push_back(std::max(way_a, way_b));
      unlike.push_back(std::abs(way_a - way_b));
    }
  const auto most_of = [](std::vector<double>& turns) {
    return order_statistic_in_place(turns, 3 * turns.size() / 4);
  };
  const double turn = std::max(most_of(turns_a), most_of(turns_b));
  constexpr double of_motion = 2.449489742783178;  // mathematics: three axes of two samples, squares added
  const bool noisy_turns = of_motion * std::sqrt(noise.rotation) > options.much_noise * turn;
  // without turns both go equally far, whatever X is
  const bool noisy_ways = median(std::move(unlike)) > options.alike * median(std::move(ways));
  if (!(turn < options.least_turn) || !noisy_turns || noisy_ways) return std::nullopt;
  Finding finding;
  finding.code = "too_little_motion";
  finding.certain = true;
  finding.message = format("The samples turn by %.2g deg from one to another, which is no more than noise.",
                           turn * degrees_per_radian);
  finding.remedy =
      "Turn the hand, too: 10 poses and more, with turns of 20 degrees and more in different directions.";
  return finding;
}

bool agree_by_chance(const SampleSet& set, const SampleNoise& noise, const ChanceOptions& options) {
  return set.units() < options.few && largest_noise(set, noise) > options.much_noise;
}

bool agree_badly(const SampleSet& set, const SampleNoise& noise, const ChanceOptions& options) {
  return largest_noise(set, noise) > options.too_much_noise;
}

bool given_twice(const SampleSet& set, std::span<const PoseSample> samples) {
  constexpr double digits = 1e-9;  // of lengths; quaternions of files have nine digits, too
  const auto all_alike = [&](bool inverse_of_b) {
    return std::all_of(samples.begin(), samples.end(), [&](const PoseSample& sample) {
      const Pose a = to_pose(sample.a), given = to_pose(sample.b), b = inverse_of_b ? inverse(given) : given;
      return a.rotation.angularDistance(b.rotation) < digits &&
             (a.translation - b.translation).norm() < digits * (set.length() + a.translation.norm());
    });
  };
  return all_alike(false) || all_alike(true);
}

Finding wrong_samples(const std::vector<SampleResidual>& residuals, const SampleNames& names) {
  Finding finding;
  finding.code = "wrong_samples";
  finding.certain = true;
  std::string named;
  constexpr std::size_t longest = 200;  // limit of what people read
  std::size_t count = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!residuals[i].wrong) continue;
    ++count;
    if (named.size() < longest) named += (named.empty() ? "" : ", ") + name_of(names, i);
  }
  const std::string kind = names.kind.empty() ? "" : names.kind + (count == 1 ? " " : "s ");
  finding.message = format("%zu of %zu samples contradict the others and do not count: %s%s.", count,
                           residuals.size(), kind.c_str(), named.c_str());
  finding.remedy = "Check these poses: a target detected wrongly, or a robot pose of another moment.";
  return finding;
}

}  // namespace egocal::detail
