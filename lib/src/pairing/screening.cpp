// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/screening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motions/motions_between.hpp"

namespace egocal {

namespace {

/// Whether one sensor repeats its pose to the last digit while the other one moves (at rest both may).
/// Rounding of the interpolation is no motion.
bool one_repeats(const Instant& before, const Instant& now, double repeated) {
  const auto repeats = [repeated](const DualQuaternion& x, const DualQuaternion& y) {
    const double most = repeated * std::max(1.0, y.dual.norm());
    return (x.real - y.real).cwiseAbs().maxCoeff() <= most && (x.dual - y.dual).cwiseAbs().maxCoeff() <= most;
  };
  return repeats(before.a, now.a) != repeats(before.b, now.b);
}

/// Time between two instants in periods, at least one.
double steps(const Instant& from, const Instant& to, double period_us) {
  return std::max(1.0, static_cast<double>(to.time_us - from.time_us) / period_us);
}

/// How the sensors differ in the motion.
MotionDifference difference(const Instant& from, const Instant& to, const CongruenceOptions& options) {
  const detail::MotionsOfBoth motions = detail::motions_between(from, to);
  return difference_of(motions.a, motions.b, options);
}

/// How far the motion is from congruent, in standard deviations. Noise grows with the root of the steps.
double sigmas(const MotionDifference& difference, double steps, const CongruenceScale& scale,
              const CongruenceOptions& options) {
  return incongruence(difference, steps, scale, options) / std::sqrt(steps);
}

}  // namespace

Screening::Screening(const ScreeningOptions& options) : Screening(options, ScreeningState{}) {}

Screening::Screening(const ScreeningOptions& options, ScreeningState state)
    : options_(options), state_(std::move(state)) {}

Screened Screening::push(const Instant& instant, std::int64_t period_us) {
  const std::optional<Instant> before = std::exchange(state_.newest, instant);
  if (before && before->chain == instant.chain && one_repeats(*before, instant, options_.repeated)) {
    state_.rejections.add(Rejection::frozen);
    return {};
  }
  if (before && before->chain != instant.chain) begin_chain();
  const auto period = static_cast<double>(period_us);
  const bool known = knows_typical(state_.congruence, options_.congruence);
  if (!known) state_.first.push_back(instant);
  Screened result;
  screen(instant, period, result.accepted);
  if (!known && knows_typical(state_.congruence, options_.congruence)) {
    result.replaces = true;
    result.accepted = screen_first_ones_again(period);
  }
  return result;
}

/// On another clock: what waits for a confirmation gets none, and new instants are not compared with earlier
/// ones.
void Screening::begin_chain() {
  finish();
  ++state_.chain;
  state_.accepted.reset();
}

void Screening::finish() {
  state_.rejections.add(Rejection::screw_congruence, state_.doubtful.size());
  state_.doubtful.clear();
}

/// Screens the first instants again. Their motions are remembered already and are not added a second time.
std::vector<Instant> Screening::screen_first_ones_again(double period_us) {
  const std::vector<Instant> first = std::exchange(state_.first, {});
  const CongruenceScale estimated = state_.congruence;
  state_.accepted.reset();
  std::vector<Instant> accepted;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (i > 0 && first[i].chain != first[i - 1].chain) begin_chain();
    screen(first[i], period_us, accepted);
  }
  state_.congruence = estimated;
  return accepted;
}

void Screening::screen(const Instant& instant, double period_us, std::vector<Instant>& accepted) {
  auto& doubtful = state_.doubtful;
  if (!state_.accepted) return accept(instant, instant.number, accepted);
  const CongruenceOptions& options = options_.congruence;
  const auto agrees = [&](const MotionDifference& motion, const Instant& from, const Instant& to) {
    return sigmas(motion, steps(from, to, period_us), state_.congruence, options) <= options_.doubtful;
  };
  const auto agree = [&](const Instant& from, const Instant& to) {
    return agrees(difference(from, to, options), from, to);
  };
  const Instant newest = *state_.accepted;
  const MotionDifference from_newest = difference(newest, instant, options);
  if (agrees(from_newest, newest, instant)) {
    if (doubtful.empty()) update_congruence(from_newest, false, state_.congruence, options);
    return confirm({}, instant, accepted);
  }
  for (std::size_t i = 0; i < doubtful.size(); ++i) {
    if (!agree(doubtful[i], instant)) continue;
    const MotionDifference before = difference(newest, doubtful[i], options);
    const double count = steps(newest, doubtful[i], period_us);
    const bool one_chain = sigmas(before, count, state_.congruence, options) <= options_.break_chain &&
                           !grossly_incongruent(before, count, state_.congruence, options);
    if (one_chain) return confirm({doubtful[i]}, instant, accepted);
    for (std::size_t k = 0; k < i; ++k) {
      if (!agree(doubtful[k], doubtful[i])) continue;
      ++state_.chain;
      state_.rejections.add(Rejection::screw_congruence);
      return confirm({doubtful[k], doubtful[i]}, instant, accepted);
    }
  }
  update_congruence(doubtful.empty() ? from_newest : difference(doubtful.back(), instant, options), true,
                    state_.congruence, options);
  doubtful.push_back(instant);
  if (doubtful.size() > options_.most_doubtful) {
    doubtful.pop_front();
    state_.rejections.add(Rejection::screw_congruence);
  }
}

/// Accepts the instant and the doubtful ones that it confirms; rejects the other doubtful ones.
void Screening::confirm(const std::vector<Instant>& confirmed, const Instant& instant,
                        std::vector<Instant>& accepted) {
  state_.rejections.add(Rejection::screw_congruence, state_.doubtful.size() - confirmed.size());
  state_.doubtful.clear();
  for (const Instant& one : confirmed) accept(one, instant.number, accepted);
  accept(instant, instant.number, accepted);
}

void Screening::accept(Instant instant, std::uint64_t number, std::vector<Instant>& accepted) {
  instant.chain = state_.chain;
  instant.number = number;
  state_.accepted = instant;
  accepted.push_back(instant);
}

}  // namespace egocal
