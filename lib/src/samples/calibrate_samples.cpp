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
#include "egocal/samples/named_samples.hpp"
#include "egocal/statistics/median.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "samples/agreeing.hpp"
#include "samples/both_lists.hpp"
#include "samples/faults.hpp"
#include "samples/large_slip.hpp"
#include "samples/leave_one_out.hpp"
#include "samples/readings.hpp"
#include "samples/slip.hpp"

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

/// Directions that the samples do not show.
DirectionBasis hidden_from(const Calibration& calibration) {
  const std::array<bool, 6>& seen = calibration.observability.observable;
  if (std::all_of(seen.begin(), seen.end(), [](bool one) { return one; })) return {};
  return hidden_directions(calibration.problem, cost_matrix(calibration.problem),
                           to_dual_quaternion(calibration.T_a_b));
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

bool another_reading(const Finding& finding) {
  return finding.code == "inverted_a" || finding.code == "inverted_b" || finding.code.starts_with("axes_") ||
         finding.code.starts_with("quaternion_order_");
}

/// The samples as they are judged: distinct ones, and which given ones they are.
struct Judged {
  const std::vector<PoseSample>& samples;
  const SampleSet& set;
  const AgreeingSamples& agreeing;
  std::vector<std::size_t> order, given;  ///< in the order given, the first of those that repeat each other
  const SampleNames& names;
};

Judged judged(const DistinctSamples& distinct, const SampleSet& set, const AgreeingSamples& agreeing,
              const SampleNames& names) {
  Judged result{distinct.samples, set, agreeing, {}, {}, names};
  std::vector<bool> met(distinct.samples.size(), false);
  for (std::size_t row = 0; row < distinct.places.size(); ++row) {
    const std::size_t i = distinct.places[row];
    if (met[i]) continue;
    met[i] = true;
    result.order.push_back(i);
    result.given.push_back(row);
  }
  return result;
}

/// Other explanations of samples that move enough.
std::vector<Finding> explanations(const Judged& judged, bool agree, const SampleOptions& options) {
  std::vector<Finding> findings = find_other_readings(judged.samples, judged.agreeing, options);
  const auto add = [&](std::optional<Finding> finding) {
    if (finding) findings.push_back(*std::move(finding));
  };
  const bool may_slip = std::all_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.code == "scale" && !finding.certain;
  });
  if (may_slip) {
    std::optional<Finding> slip = find_slip(judged.set, judged.agreeing, judged.order, judged.given,
                                            judged.names, options.diagnosis.unit == LengthUnit::metres);
    // a linear test gives the answer after a large slip to centimetres only
    const bool large = largest_noise(judged.set, judged.agreeing.fit.noise) > LargeSlipOptions().least_noise;
    if (!slip || large)
      if (std::optional<Finding> found =
              find_large_slip(judged.set, judged.agreeing, judged.order, judged.given, judged.names, options))
        slip = std::move(found);
    add(std::move(slip));
  }
  if (findings.empty() && agree) add(both_inverted(judged.samples, judged.set, judged.agreeing, options));
  add(not_in_metres(judged.set, judged.agreeing.fit, options));
  return findings;
}

void judge_samples(const Judged& judged, const SampleOptions& options, Calibration& calibration) {
  DiagnosisOptions tolerances = options.diagnosis;
  tolerances.tolerance_translation =
      std::min(tolerances.tolerance_translation, options.tolerance_of_distance * judged.set.length());
  const Answered answered{to_dual_quaternion(calibration.T_a_b),
                          calibration.observability,
                          calibration.counts,
                          calibration.problem,
                          1,
                          0,
                          Platform::arm};
  const Motions motions =
      motions_of(motions_between(judged.samples, options.most_motions), tolerances.motions);
  Diagnosis diagnosis;
  diagnosis.fit = fit_at(motions, calibration.T_a_b, 0, tolerances.motions);
  diagnosis.fit.tenths.clear();  // samples have no order in time
  Misfit misfit;
  misfit.at_answer = misfit.best = detail::misfit(motions, evaluated(motions, answered.T_a_b));
  if (judged.set.units() < least_units)
    diagnosis.findings = {too_few_poses(judged.set.units())};
  else if (given_twice(judged.set, judged.samples))
    diagnosis.findings = {same_stream()};
  else if (const std::optional<Finding> small = turns_too_small(judged.samples, judged.agreeing.fit.noise))
    diagnosis.findings = {*small};
  else if (options.diagnosis.enabled)
    diagnosis.findings = explanations(judged, misfit.at_answer < tolerances.doubtful_misfit, options);
  const bool little = !diagnosis.findings.empty() && diagnosis.findings.front().code == "too_little_motion";
  if (little) misfit = {};  // noise contradicts every answer
  judge(diagnosis, answered, misfit, tolerances);
  // The poses as given are refuted, also where they show no direction in which the answers could differ.
  for (const Finding& finding : diagnosis.findings)
    if (another_reading(finding) && diagnosis.verdict != Verdict::contradictory) {
      diagnosis.verdict = Verdict::contradictory;
      diagnosis.reason = finding.message;
    }
  if (diagnosis.verdict < Verdict::doubtful && !little &&
      agree_by_chance(judged.set, judged.agreeing.fit.noise)) {
    diagnosis.verdict = Verdict::doubtful;
    diagnosis.reason = "So few samples may agree as badly by chance: take ten and more.";
  }
  if (diagnosis.verdict < Verdict::doubtful && !little &&
      agree_badly(judged.set, judged.agreeing.fit.noise)) {
    diagnosis.verdict = Verdict::doubtful;
    diagnosis.reason =
        "These samples agree badly: what one of them leaves unexplained is larger than errors of an arm or "
        "of a detector are. Make sure that the rows belong together and that nothing moved meanwhile.";
  }
  calibration.verdict = diagnosis.verdict;
  calibration.reason = std::move(diagnosis.reason);
  calibration.fit = std::move(diagnosis.fit);
  calibration.findings = std::move(diagnosis.findings);
  calibration.goal = std::move(diagnosis.goal);
}

}  // namespace

SampleCalibration calibrate_named_samples(std::span<const PoseSample> given, const SampleOptions& options,
                                          const SampleNames& names) {
  require_usable(given);
  const DistinctSamples distinct_samples = distinct(detail::reread(given, options.read_a, options.read_b));
  const auto& [samples, places] = distinct_samples;
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
      spread_without_each(set, agreeing.chosen, agreeing.fit, hidden_from(calibration), options.most_solved);
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
  judge_samples(judged(distinct_samples, set, agreeing, names), options, calibration);
  // under another reading other samples are wrong; a slip leaves them what they are
  const auto& findings = calibration.findings;
  const bool misread = calibration.verdict == Verdict::contradictory &&
                       std::any_of(findings.begin(), findings.end(),
                                   [](const Finding& one) { return one.code != "mount_moved"; });
  if (calibration.counts.outliers > 0 && !misread)
    calibration.findings.push_back(wrong_samples(result.residuals, names));
  return result;
}

SampleCalibration calibrate_samples(std::span<const PoseSample> samples, const SampleOptions& options) {
  return calibrate_named_samples(samples, options, {});
}

std::string name_of(const SampleNames& names, std::size_t sample) {
  return sample < names.of.size() ? names.of[sample] : std::to_string(sample + 1);
}

std::string full_name_of(const SampleNames& names, std::size_t sample) {
  return (names.kind.empty() ? "sample" : names.kind) + " " + name_of(names, sample);
}

}  // namespace egocal
