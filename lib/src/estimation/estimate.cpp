// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/limits.hpp"

namespace egocal {

namespace {

/// The instants of two streams, as MotionPairing makes them.
class Instants {
 public:
  explicit Instants(const PairingOptions& options)
      : offset_us_(std::llround(options.time_offset * 1e6)),
        synchroniser_(options),
        screening_(options.screening) {}

  void push(Side side, const StampedPose& given) {
    if (!given.pose.vec().allFinite() || !plausible_norm(given.pose.real.norm()) ||
        !plausible_relative_time(given.time_us) || !plausible_distance(2 * given.pose.dual.norm()))
      return;
    take(synchroniser_.push(side,
                            {given.time_us + (side == Side::b ? offset_us_ : 0), normalized(given.pose)}));
  }
  void finish() { take(synchroniser_.finish()); }

  std::vector<Instant> all;
  std::int64_t period_us() const { return synchroniser_.period_us(); }

 private:
  void take(const std::vector<Instant>& instants) {
    for (const Instant& instant : instants) {
      Screened screened = screening_.push(instant, synchroniser_.period_us());
      if (screened.replaces) all.clear();
      all.insert(all.end(), screened.accepted.begin(), screened.accepted.end());
    }
  }

  std::int64_t offset_us_;
  Synchroniser synchroniser_;
  Screening screening_;
};

}  // namespace

std::optional<StrideProblem> sum_over_strides(const PairingOptions& given, const Trajectory& a,
                                              const Trajectory& b, const StrideSumsOptions& tuning) {
  if (given.stride || given.balance || !given.robust) return std::nullopt;
  const PairingOptions options = validated(given);
  Instants instants(options);
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool from_a = j == b.size() || (i < a.size() && a[i].time_us <= b[j].time_us);
    from_a ? instants.push(Side::a, a[i++]) : instants.push(Side::b, b[j++]);
  }
  instants.finish();
  if (instants.all.size() < options.accumulator.first_choice) return std::nullopt;

  StrideSums sums(options, tuning);
  sums.begin(instants.period_us());
  std::uint64_t next_choice = options.accumulator.first_choice;
  for (const Instant& instant : instants.all) {
    sums.add(instant);
    if (sums.state().next_index < next_choice) continue;
    sums.choose();
    next_choice += next_choice / 4;
  }
  sums.choose();
  const std::optional<WeightChoice>& choice = sums.choice();
  if (!choice) return std::nullopt;
  StrideProblem result;
  result.problem = sums.problem();
  result.choice.stride = std::max(1, static_cast<int>(std::lround(choice->mean_stride)));
  result.choice.balance = {1, choice->ratio > 0 ? 1 / choice->ratio : 1};
  result.choice.reason = choice->reason;
  result.matched = sums.inlier_steps();
  result.outliers = sums.outlier_steps();
  return result;
}

}  // namespace egocal
