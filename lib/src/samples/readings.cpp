// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/readings.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/motions/reading.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/solvers/global.hpp"
#include "samples/list_axes.hpp"
#include "samples/rotations_alone.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

namespace {

struct Alternative {
  const char* code;
  PoseReading a, b;
};

std::vector<Alternative> with_options() {
  PoseReading inverted, wxyz, xyzw;
  inverted.invert = true;
  wxyz.quaternion_order = QuaternionOrder::wxyz;
  xyzw.quaternion_order = QuaternionOrder::xyzw;
  return {{"inverted_a", inverted, {}},          {"inverted_b", {}, inverted},
          {"quaternion_order_a", wxyz, {}},      {"quaternion_order_b", {}, wxyz},
          {"quaternion_order_both", wxyz, wxyz}, {"quaternion_order_both", xyzw, xyzw}};
}

std::vector<Alternative> of_axes(std::span<const PoseSample> samples, const SampleReadingOptions& search) {
  std::vector<Alternative> result;
  for (const PoseReading& a : list_axes_readings(samples, Side::a, search.rounds_of_signs))
    result.push_back({"axes_a", a, {}});
  for (const PoseReading& b : list_axes_readings(samples, Side::b, search.rounds_of_signs))
    result.push_back({"axes_b", {}, b});
  return result;
}

/// Samples spread over the chosen ones.
std::vector<PoseSample> some(std::span<const PoseSample> samples, const std::vector<std::size_t>& chosen,
                             const SampleReadingOptions& search) {
  const std::size_t step = (chosen.size() + search.most_at_first - 1) / search.most_at_first;
  std::vector<PoseSample> result;
  for (std::size_t k = 0; k < chosen.size(); k += step) result.push_back(samples[chosen[k]]);
  return result;
}

/// Whether this reading of some samples cannot be better than the given one by least_improvement. Rotations
/// do not show quaternions of another order in both lists, which only exchanges X and Y.
bool hopeless(const std::vector<PoseSample>& few, const SampleFit& given,
              const SampleReadingOptions& search) {
  if (rotations_alone(few, search.rounds_of_signs).variance >
      search.most_worse_rotation * given.noise.rotation)
    return true;
  std::vector<std::size_t> all(few.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  FitSettings settings;
  settings.precision = FitPrecision::on_the_way;
  settings.most_rounds = 4;
  return improvement(given, fit_samples(SampleSet(few), all, settings)) < search.least_at_first;
}

/// The samples as given, which other readings have to beat. Where some of them were rejected, with all of
/// them too: the few that are left of a list that is misread may agree by chance.
class AsGiven {
 public:
  AsGiven(std::span<const PoseSample> samples, const AgreeingSamples& given, const SampleOptions& options,
          const SampleReadingOptions& search)
      : given_(given), search_(search), few_(some(samples, given.chosen, search)), size_(samples.size()) {
    if (given.chosen.size() == samples.size()) return;
    all_ = fit_of_all(SampleSet(samples), options);
    std::vector<std::size_t> every(samples.size());
    std::iota(every.begin(), every.end(), std::size_t{0});
    few_of_all_ = some(samples, every, search);
  }

  /// Whether it is sure that the other reading is no better.
  bool withstands(const Alternative& other) const {
    if (!hopeless(reread(few_, other.a, other.b), given_.fit, search_)) return false;
    return !all_ || hopeless(reread(few_of_all_, other.a, other.b), *all_, search_);
  }

  double improvement_by(const AgreeingSamples& other) const {
    if (other.chosen.size() < given_.chosen.size()) return 0;
    const double of_chosen = improvement(given_.fit, other.fit);
    // all samples without exception, about as well as some of them as given
    const bool explains_all =
        all_ && other.chosen.size() == size_ && of_chosen * search_.least_improvement > 1;
    return explains_all ? std::max(of_chosen, improvement(*all_, other.fit)) : of_chosen;
  }

 private:
  const AgreeingSamples& given_;
  const SampleReadingOptions& search_;
  std::vector<PoseSample> few_, few_of_all_;
  std::size_t size_;
  std::optional<SampleFit> all_;  ///< where not all of them agree
};

PoseReading full(const Reading& reading) {
  PoseReading result;
  static_cast<Reading&>(result) = reading;
  return result;
}

/// The options to type, as --eye-to-hand and --invert-a do the same to a.
Finding worded(Finding finding, const Alternative& other) {
  finding = worded_reading(std::move(finding), other.a, other.b);
  const bool of_a = finding.code == "inverted_a";
  if (!of_a && finding.code != "inverted_b") return finding;
  FindingWords words;
  words.claim =
      format("With the poses of %s inverted the squared residuals are %.3g times smaller: they are %s",
             of_a ? "{a}" : "{b}", finding.improvement,
             of_a ? "base-to-hand, or the camera stands beside the arm and sees the hand"
                  : "those of the target in the camera, as detectors report them");
  words.evidence = finding.certain ? "."
                   : of_a          ? ". Those of {b} inverted fit as well."
                                   : ". Those of {a} inverted fit as well.";
  if (of_a)
    words.scope = "{solve}--eye-to-hand for a camera beside the arm, --eye-in-hand for one on the hand, or ";
  words.cure = of_a ? "--invert-a" : "{solve}--invert-b";
  say(finding, std::move(words));
  return finding;
}

/// The same mistake in the other list; empty where there is none.
std::string of_other_list(const std::string& code) {
  if (!code.starts_with("inverted_") && !code.starts_with("axes_")) return {};
  return code.substr(0, code.size() - 1) + (code.ends_with('a') ? 'b' : 'a');
}

/// The reading that fits best. Whether a or b is inverted the motions cannot tell: X and Y change places, and
/// only noise is left to decide. Positions of a that are mirrored are those of b mirrored. Then both, the
/// better one first.
std::vector<Finding> best_of(const std::vector<std::pair<Finding, Alternative>>& fitting,
                             const SampleReadingOptions& search) {
  const auto better = [](const auto& x, const auto& y) { return x.first.improvement < y.first.improvement; };
  const auto best = std::max_element(fitting.begin(), fitting.end(), better);
  if (best == fitting.end()) return {};
  const std::string opposite = of_other_list(best->first.code);
  auto other = fitting.end();
  for (auto one = fitting.begin(); one != fitting.end(); ++one)
    if (one->first.code == opposite && (other == fitting.end() || better(*other, *one))) other = one;
  if (other == fitting.end() || other->first.improvement * search.least_improvement < best->first.improvement)
    return {worded(best->first, best->second)};
  std::vector<Finding> both;
  for (const auto& one : {*best, *other}) {
    Finding finding = one.first;
    finding.certain = false;
    both.push_back(worded(std::move(finding), one.second));
  }
  return both;
}

/// The factor of b's lengths that fits best, by least squares at the rotation that the rotations give.
struct FoundScale {
  double scale = 1;
  double improvement = 1;  ///< of the squared residuals of positions
  double by_chance = 1;
  double beyond_noise = 0;  ///< how far from 1 it is, less what noise in the lengths themselves pulls at most
  Pose X;
};

std::optional<FoundScale> find_scale(std::span<const PoseSample> samples, const AgreeingSamples& given,
                                     const SampleReadingOptions& search) {
  const auto n = static_cast<Eigen::Index>(given.chosen.size());
  if (n < static_cast<Eigen::Index>(search.least_samples)) return std::nullopt;
  // rotations alone: a tiny weight of the positions, in their own unit, keeps the solver's problem regular
  const Rotation R_X = to_pose(solve_dual(cost_matrix(given.fit.statistics,
                                                      {1, 1e-9 * balance_of(given.fit.noise).translation}))
                                   .q)
                           .rotation;
  Eigen::MatrixXd J(3 * n, 7);
  Eigen::VectorXd t(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PoseSample& sample = samples[given.chosen[static_cast<std::size_t>(k)]];
    const Pose a = to_pose(sample.a), c = to_pose(conjugate(sample.b));
    const Eigen::Matrix3d R_a = a.rotation.toRotationMatrix();
    // t_Y - R_a t_X - s R_a R_X t_c = t_a
    J.block<3, 3>(3 * k, 0) = -R_a;
    J.block<3, 3>(3 * k, 3).setIdentity();
    J.block<3, 1>(3 * k, 6) = -(R_a * (R_X * c.translation));
    t.segment<3>(3 * k) = a.translation;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> with(J);
  const Eigen::VectorXd x = with.solve(t);
  const Eigen::VectorXd t_at_one = t - J.col(6);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> without(J.leftCols(6));
  const Eigen::VectorXd beside =
      J.col(6) - J.leftCols(6) * without.solve(J.col(6));  // not explained by X and Y
  const double squares = (t - J * x).squaredNorm();
  const double squares_at_one = (t_at_one - J.leftCols(6) * without.solve(t_at_one)).squaredNorm();
  const double dof = static_cast<double>(3 * n - 7);
  if (!(squares > 0) || with.rank() < 7 || !(x[6] > 0)) return std::nullopt;
  const double pull = squares / (x[6] * x[6] * beside.squaredNorm());  // were all noise that of b
  const double beyond_noise = std::max(0.0, std::abs(x[6] - 1) - pull);
  const double f = beyond_noise * beyond_noise * beside.squaredNorm() / (squares / dof);
  return FoundScale{x[6], squares_at_one / squares, f_exceeded(f, 1, dof), beyond_noise, {R_X, x.head<3>()}};
}

bool is_unit(double scale, const SampleReadingOptions& search) {
  const double decades = std::log10(scale);
  return std::abs(decades) > 0.5 &&
         std::abs(scale / std::pow(10.0, std::round(decades)) - 1) < search.unit_tolerance;
}

/// Certain where the residuals as given are far larger. A target of a size other than stated leaves them
/// nearly as small, and so does a focal length: those a measurement of the target tells apart.
std::optional<Finding> finding_of(const FoundScale& scale, const SampleReadingOptions& search) {
  if (!(scale.by_chance < search.scale_by_chance)) return std::nullopt;
  Finding finding;
  finding.certain = scale.improvement > search.least_improvement;
  if (!finding.certain && !(scale.beyond_noise > search.least_scale)) return std::nullopt;
  finding.code = is_unit(scale.scale, search) ? "units" : "scale";
  finding.improvement = scale.improvement;
  finding.value = scale.scale;
  finding.T_a_b = scale.X;
  finding = worded_scale(std::move(finding));
  FindingWords words = finding.words;
  words.cure = format("{solve}--scale-b %.6g", scale.scale);
  if (!finding.certain) {
    words.evidence = format(
        ": the squared residuals of the positions are %.3g times smaller then, which noise does not explain.",
        scale.improvement);
    words.scope = "Measure the target: an edge of another length than stated changes all positions. ";
    words.cure += " undoes it";
  }
  say(finding, std::move(words));
  return finding;
}

}  // namespace

std::vector<PoseSample> reread(std::span<const PoseSample> samples, const PoseReading& read_a,
                               const PoseReading& read_b) {
  std::vector<PoseSample> result;
  for (const PoseSample& sample : samples)
    result.push_back({canonical_sign(normalized(reread(sample.a, read_a))),
                      canonical_sign(normalized(reread(sample.b, read_b)))});
  return result;
}

std::vector<PoseSample> reread(std::span<const PoseSample> samples, const Reading& read_a,
                               const Reading& read_b) {
  return reread(samples, full(read_a), full(read_b));
}

std::vector<Finding> find_other_readings(std::span<const PoseSample> samples, const AgreeingSamples& given,
                                         const SampleOptions& options, const SampleReadingOptions& search) {
  std::vector<Finding> findings;
  if (given.chosen.size() < search.least_samples) return findings;
  std::vector<std::pair<Finding, Alternative>> fitting;
  const AsGiven as_given(samples, given, options, search);
  std::vector<Alternative> alternatives = with_options();
  for (Alternative& other : of_axes(samples, search)) alternatives.push_back(std::move(other));
  for (const Alternative& other : alternatives) {
    if (as_given.withstands(other)) continue;
    const std::vector<PoseSample> read = reread(samples, other.a, other.b);
    const AgreeingSamples fit = find_agreeing(SampleSet(read), options);
    Finding finding;
    finding.code = other.code;
    finding.certain = true;
    finding.improvement = as_given.improvement_by(fit);
    if (finding.improvement < search.least_improvement) continue;
    finding.T_a_b = to_pose(fit.fit.X);
    fitting.emplace_back(std::move(finding), other);
  }
  if (!fitting.empty()) return best_of(fitting, search);
  if (const std::optional<FoundScale> scale = find_scale(samples, given, search))
    if (const std::optional<Finding> finding = finding_of(*scale, search)) findings.push_back(*finding);
  return findings;
}

}  // namespace egocal::detail
