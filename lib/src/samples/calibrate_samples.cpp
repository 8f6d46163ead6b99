// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/samples/calibrate_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "diagnosis/motions/fit.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/streams/stream_check.hpp"
#include "diagnosis/verdict/judge.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "samples/agreeing.hpp"
#include "samples/leave_one_out.hpp"
#include "samples/readings.hpp"
#include "statistics/median.hpp"

namespace egocal {

namespace {

using namespace detail;

std::array<double, 16> numbers_of(const PoseSample& sample) {
  std::array<double, 16> numbers;
  const Vector8d a = sample.a.vec(), b = sample.b.vec();
  std::copy(a.data(), a.data() + 8, numbers.begin());
  std::copy(b.data(), b.data() + 8, numbers.begin() + 8);
  return numbers;
}

/// Samples in an order that depends on them alone, so that the same sums are made whatever order they come
/// in; those that repeat another one exactly are omitted.
struct DistinctSamples {
  std::vector<PoseSample> samples;
  std::vector<std::size_t> places;  ///< of each given sample among these
};

DistinctSamples distinct(const std::vector<PoseSample>& given) {
  std::vector<std::size_t> order(given.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::array<double, 16>> numbers;
  numbers.reserve(given.size());
  for (const PoseSample& sample : given) numbers.push_back(numbers_of(sample));
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return numbers[i] < numbers[j]; });
  DistinctSamples result;
  result.samples.reserve(given.size());
  result.places.resize(given.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || numbers[order[k]] != numbers[order[k - 1]]) result.samples.push_back(given[order[k]]);
    result.places[order[k]] = result.samples.size() - 1;
  }
  return result;
}

void require_usable(std::span<const PoseSample> samples) {
  if (samples.size() < 3) throw Error("samples: expected at least 3, got " + std::to_string(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (const DualQuaternion& pose : {samples[i].a, samples[i].b})
      if (!pose.vec().allFinite() || !(std::abs(pose.real.norm() - 1) < 1e-3))
        throw Error("sample " + std::to_string(i + 1) + ": expected finite poses with unit quaternions");
}

/// Motions between samples, nearest neighbours of the order first.
std::vector<MotionPair> motions_between(const std::vector<PoseSample>& samples, std::size_t most) {
  std::vector<MotionPair> pairs;
  for (std::size_t step = 1; step < samples.size(); ++step)
    for (std::size_t i = 0; i + step < samples.size(); ++i) {
      if (pairs.size() == most) return pairs;
      const PoseSample& from = samples[i];
      const PoseSample& to = samples[i + step];
      MotionPair pair;
      pair.a = canonical_sign(conjugate(from.a) * to.a);
      pair.b = canonical_sign(conjugate(from.b) * to.b);
      pairs.push_back(pair);
    }
  return pairs;
}

Problem problem_of(const SampleFit& fit, const SampleOptions& options) {
  Problem problem;
  problem.balance = balance_of(fit.noise);
  problem.blocks = {fit.statistics};
  problem.prior = options.prior;
  return problem;
}

/// Residuals of all samples, and the spread of the target over those that count.
void measure_spread(const SampleSet& set, const AgreeingSamples& agreeing,
                    const std::vector<std::size_t>& places, SampleCalibration& result) {
  std::vector<SampleResidual> residuals;
  std::vector<double> distances;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const SquaredResidual squares = squared_residual(set, i, agreeing.fit);
    const bool counts = std::binary_search(agreeing.chosen.begin(), agreeing.chosen.end(), i);
    residuals.push_back({std::sqrt(squares.rotation), std::sqrt(squares.translation), !counts});
    if (!counts) continue;
    distances.push_back(std::sqrt(squares.translation));
    result.spread_rms += squares.translation / static_cast<double>(agreeing.chosen.size());
  }
  for (const std::size_t place : places) result.residuals.push_back(residuals[place]);
  result.spread_rms = std::sqrt(result.spread_rms);
  result.spread_largest = *std::max_element(distances.begin(), distances.end());
  result.spread_median = detail::median(std::move(distances));
}

Finding wrong_samples(const std::vector<SampleResidual>& residuals) {
  Finding finding;
  finding.code = "wrong_samples";
  finding.certain = true;
  std::string rows;
  std::size_t count = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!residuals[i].wrong) continue;
    ++count;
    if (rows.size() < 200) rows += (rows.empty() ? "" : ", ") + std::to_string(i + 1);
  }
  finding.message = format("%zu of %zu samples contradict the others and do not count: %s.", count,
                           residuals.size(), rows.c_str());
  finding.remedy = "Check these poses: a target detected wrongly, or a robot pose of another moment.";
  return finding;
}

/// Two motions: fewer show no hand-eye pose.
constexpr std::size_t least_units = 3;

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

/// Whether the poses of both lists are the same to the digits that files keep, read alike or one as the
/// inverse.
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

bool another_reading(const Finding& finding) {
  return finding.code.starts_with("inverted_") || finding.code.starts_with("quaternion_order_");
}

void judge_samples(const std::vector<PoseSample>& samples, const SampleSet& set,
                   const AgreeingSamples& agreeing, const SampleOptions& options, Calibration& calibration) {
  DiagnosisOptions tolerances = options.diagnosis;
  tolerances.tolerance_translation =
      std::min(tolerances.tolerance_translation, options.tolerance_of_distance * set.length());
  const Answered answered{to_dual_quaternion(calibration.T_a_b),
                          calibration.observability,
                          calibration.counts,
                          calibration.problem,
                          1,
                          0,
                          Platform::arm};
  const Motions motions = motions_of(motions_between(samples, options.most_motions), tolerances.motions);
  Diagnosis diagnosis;
  diagnosis.fit = fit_at(motions, calibration.T_a_b, 0, tolerances.motions);
  diagnosis.fit.tenths.clear();  // samples have no order in time
  Misfit misfit;
  misfit.at_answer = misfit.best = detail::misfit(motions, evaluated(motions, answered.T_a_b));
  if (set.units() < least_units) {
    diagnosis.findings = {too_few_poses(set.units())};
    misfit = {};  // noise contradicts every answer
  } else if (given_twice(set, samples)) {
    diagnosis.findings = {same_stream()};
  } else if (options.diagnosis.enabled) {
    diagnosis.findings = find_other_readings(samples, agreeing, options);
  }
  judge(diagnosis, answered, misfit, tolerances);
  // The poses as given are refuted, also where they show no direction in which the answers could differ.
  for (const Finding& finding : diagnosis.findings)
    if (another_reading(finding) && diagnosis.verdict != Verdict::contradictory) {
      diagnosis.verdict = Verdict::contradictory;
      diagnosis.reason = finding.message;
    }
  calibration.verdict = diagnosis.verdict;
  calibration.reason = std::move(diagnosis.reason);
  calibration.fit = std::move(diagnosis.fit);
  calibration.findings = std::move(diagnosis.findings);
  calibration.goal = std::move(diagnosis.goal);
}

}  // namespace

SampleCalibration calibrate_samples(std::span<const PoseSample> given, const SampleOptions& options) {
  require_usable(given);
  const auto [samples, places] = distinct(detail::reread(given, options.read_a, options.read_b));
  const SampleSet set(samples);
  AgreeingSamples agreeing = find_agreeing(set, options);
  if (set.units() < least_units) agreeing.fit.statistics = Statistics();  // what is there is noise

  SampleCalibration result;
  Calibration& calibration = result.calibration;
  calibration.problem = problem_of(agreeing.fit, options);
  const Answer answer = solve(calibration.problem, Method::dual);
  calibration.certificate = answer.certificate;
  calibration.observability = answer.observability;
  calibration.status = answer.status;
  calibration.T_a_b = to_pose(answer.T_a_b);
  calibration.T_b_a = inverse(calibration.T_a_b);
  calibration.minimum = to_pose(answer.minimum);
  calibration.choice.stride = 1;
  calibration.choice.balance = calibration.problem.balance;
  calibration.choice.reason = "inverse variances of the residuals";
  calibration.counts.synchronised = given.size();

  // where the samples do not show a direction the answer is the one closest to the prior: so is the target
  agreeing.fit.Y = target_at(set, agreeing.chosen, agreeing.fit, answer.T_a_b);
  agreeing.fit.X = answer.T_a_b;
  calibration.observability.stddev =
      spread_without_each(set, agreeing.chosen, agreeing.fit, options.most_solved);
  for (std::size_t i = 0; i < 6; ++i)
    if (!calibration.observability.observable[i])
      calibration.observability.stddev[i] = std::numeric_limits<double>::infinity();
  const Pose Y = to_pose(agreeing.fit.Y);
  result.T_world_a_world_b = {Y.rotation, Y.translation + set.middle()};
  result.noise_rotation = std::sqrt(agreeing.fit.noise.rotation);
  result.noise_translation = std::sqrt(agreeing.fit.noise.translation);
  result.repeated = given.size() - samples.size();
  result.different = set.units();
  measure_spread(set, agreeing, places, result);
  for (const SampleResidual& residual : result.residuals)
    ++(residual.wrong ? calibration.counts.outliers : calibration.counts.matched);
  judge_samples(samples, set, agreeing, options, calibration);
  const bool misread = calibration.verdict == Verdict::contradictory && !calibration.findings.empty();
  if (calibration.counts.outliers > 0 && !misread)
    calibration.findings.push_back(wrong_samples(result.residuals));
  return result;
}

}  // namespace egocal
