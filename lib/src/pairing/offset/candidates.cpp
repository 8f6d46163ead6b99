// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace egocal::detail {

namespace {

/// What is added to the stamps of b, at at_b_us [us].
double offset_us(const ClockLine& clock) {
  return static_cast<double>(clock.at_a_us - clock.at_b_us) + clock.shift_us;
}

}  // namespace

CandidateComparison::CandidateComparison(const Trajectory& a, const Trajectory& b,
                                         const TimeOffsetOptions& options, std::int64_t max_gap_us,
                                         Schedule& schedule, std::function<void()> done,
                                         const CandidateOptions& tuning)
    : a_(a),
      b_(b),
      options_(options),
      tuning_(tuning),
      max_gap_us_(max_gap_us),
      schedule_(schedule),
      done_(std::move(done)) {
  options_.most_keys = options_.candidate_motions;
}

void CandidateComparison::begin(std::vector<ClockLine> starts, double arm_us, double preferred_us) {
  starts_ = std::move(starts);
  arm_us_ = arm_us;
  preferred_us_ = preferred_us;
  fits_.emplace(a_, b_, options_, max_gap_us_, schedule_);
  schedule_.add(1, [this] { refine_next(); });
}

void CandidateComparison::refine_next() {
  if (next_ == starts_.size()) {
    add_preferred();
    return schedule_.add(1, [this] { choose(); });
  }
  refinement_.emplace(a_, b_, options_, max_gap_us_, schedule_, [this] { take_refined(); });
  refinement_->begin(starts_[next_], next_ == 0 ? 0 : arm_us_);
  ++next_;
}

void CandidateComparison::take_refined() {
  const bool found = refinement_->result().has_value();
  // without the first one nothing can be compared
  if (!found && candidates_.empty()) next_ = starts_.size();
  const ClockLine& clock = refinement_->clock();
  const bool another = std::none_of(candidates_.begin(), candidates_.end(), [&](const ClockLine& other) {
    return std::abs(offset_us(other) - offset_us(clock)) < 2 * arm_us_;
  });
  if (found && another) {
    candidates_.push_back(clock);
    extrinsics_.push_back(refinement_->extrinsic());
    fits_->add(clock, extrinsics_.back());
  }
  // the refinement that ends here is still there
  schedule_.add(1, [this] { refine_next(); });
}

/// Adds the preferred offset without refining it. If the turning is even, the noise of the poses, which
/// depends on the interpolation, moves the minimum.
void CandidateComparison::add_preferred() {
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (std::abs(offset_us(candidates_[i]) - preferred_us_) < 2 * arm_us_) twin_ = i;
  if (!twin_) return;
  ClockLine clock = candidates_[*twin_];
  clock.shift_us = preferred_us_ - static_cast<double>(clock.at_a_us - clock.at_b_us);
  fits_->add(clock, extrinsics_[*twin_]);
}

bool CandidateComparison::worse(std::size_t one, std::size_t than) const {
  const std::optional<OffsetFits::Comparison> comparison = fits_->compare(one, than);
  return comparison && comparison->gain > options_.candidate_gain &&
         comparison->chance < options_.candidate_chance;
}

void CandidateComparison::choose() {
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates_.size(); ++i)
    if (const auto comparison = fits_->compare(best, i); comparison && comparison->gain > 0) best = i;
  std::vector<std::size_t> alike;
  const std::size_t preferred = candidates_.size();
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (i == best || !worse(i, best) || (i == twin_ && !worse(preferred, best))) alike.push_back(i);
  if (alike.empty()) return done_();
  const auto from_preferred = [this](std::size_t i) {
    return std::abs(offset_us(candidates_[i]) - preferred_us_);
  };
  taken_ = *std::min_element(alike.begin(), alike.end(), [&](std::size_t i, std::size_t k) {
    return from_preferred(i) < from_preferred(k);
  });
  for (const std::size_t i : alike) {
    if (i == taken_) continue;
    const double away = offset_us(candidates_[i]) - offset_us(candidates_[taken_]);
    if (nearest_us_ == 0 || std::abs(away) < std::abs(nearest_us_)) nearest_us_ = away;
    farthest_us_ = std::max(farthest_us_, std::abs(away));
  }
  if (taken_ == twin_)
    if (const auto comparison = fits_->compare(preferred, taken_);
        comparison && comparison->sigmas < tuning_.sure)
      unsure_us_ = from_preferred(taken_);
  done_();
}

}  // namespace egocal::detail
