// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/undersampling.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/motions/answer_change.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/directions.hpp"

namespace egocal::detail {

namespace {

bool interpolates(const Instants& instants, std::size_t samples) {
  const std::size_t each = std::max<std::size_t>(1, instants.size() / samples);
  for (std::size_t i = 0; i < instants.size(); i += each)
    if (instants.between_poses(i)) return true;
  return false;
}

}  // namespace

std::array<double, 6> interpolation_stddev(const Instants& instants, const DualQuaternion& T_a_b,
                                           const DiagnosisOptions& options) {
  const UndersamplingOptions& tuning = options.undersampling;
  std::array<double, 6> stddev{};
  if (!interpolates(instants, options.change.motions)) return stddev;
  const std::optional<AnswerChange> change =
      answer_change(instants, instants.through(tuning.poses), T_a_b, options.change);
  if (!change) return stddev;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double by_chance = tuning.significant * tuning.significant * change->variance[k];
    const double more = change->size[k] * change->size[k] - by_chance;
    if (more > 0) stddev[i] = tuning.share * std::sqrt(more);
  }
  return stddev;
}

std::optional<Finding> undersampled(const Instants& instants, const Answered& answered,
                                    const std::array<double, 6>& interpolation_stddev,
                                    const UndersamplingOptions& options) {
  std::size_t worst = 6;
  double most = options.matters;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!answered.observability.observable[i]) continue;
    const double ratio = interpolation_stddev[i] / answered.observability.stddev[i];
    if (!(ratio > most)) continue;
    most = ratio;
    worst = i;
  }
  if (worst == 6) return std::nullopt;
  const bool length = worst < 3;
  const double unit = length ? 100 : degrees_per_radian;
  const char interpolated = instants.b_slower() ? 'a' : 'b', other = instants.b_slower() ? 'b' : 'a';
  Finding finding;
  finding.code = std::string("undersampled_") + interpolated;
  finding.certain = true;
  say(finding,
      format("The motion is too fast for the rate of %s: what is lost between its poses, at the times of %s, "
             "makes %s uncertain by %.2g %s (one standard deviation) rather than by %.2g.",
             mark(interpolated), mark(other), direction_names[worst], unit * interpolation_stddev[worst],
             length ? "cm" : "deg", unit * answered.observability.stddev[worst]),
      format("Measure with %s at a higher rate, or with both sensors at the same times.",
             mark(interpolated)));
  return finding;
}

}  // namespace egocal::detail
