// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/motion_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/pairing/selection.hpp"

namespace egocal {

namespace {

/// So many poses of each stream show which one is slower.
constexpr std::size_t poses_to_decide = 8;
/// A stream whose partner is silent does not grow without bound.
constexpr std::size_t most_waiting = 4096;
/// Motions longer than this in time are not considered when the stride is chosen [us].
constexpr std::int64_t longest_motion_us = 8'000'000;
/// A motion may take this many times as long as its stride says: lost poses make longer motions, standing
/// still for minutes does not make one.
constexpr std::int64_t stretch = 4;
/// Above this the sign of a quaternion is a guess [rad].
constexpr double most_rotation = 170 * std::numbers::pi / 180;
constexpr double balances[] = {1, 0.1, 0.01, 0.001};
/// The first choice is made after so many instants, each further one after a quarter more.
constexpr std::uint64_t first_choice = 64;
/// A pose whose motion is doubtful waits for the next ones to speak for it; real odometry has heavy tails
/// that belong to it, so between poses that others speak for only what is further off ends a chain [sigmas].
constexpr double break_chain = 40;
/// Poses that wait for others to speak for them.
constexpr std::size_t most_doubtful = 5;

std::int64_t median_period(const std::deque<StampedPose>& poses) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < poses.size(); ++i) periods.push_back(poses[i].time_us - poses[i - 1].time_us);
  if (periods.empty()) return 0;
  std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2),
                   periods.end());
  return periods[periods.size() / 2];
}

DualQuaternion motion_between(const DualQuaternion& from, const DualQuaternion& to) {
  return canonical_sign(normalized(conjugate(from) * to));
}

/// One sensor says exactly what it said before while the other one moves. (Both do at rest.) Rounding of the
/// interpolation is no motion.
bool one_repeats(const Instant& before, const Instant& now) {
  const auto repeats = [](const DualQuaternion& x, const DualQuaternion& y) {
    return (x.vec() - y.vec()).cwiseAbs().maxCoeff() <= 1e-14 * std::max(1.0, y.dual.norm());
  };
  return repeats(before.a, now.a) != repeats(before.b, now.b);
}

std::size_t index(Side side) {
  return side == Side::a ? 0 : 1;
}

}  // namespace

std::string_view name(Rejection reason) {
  switch (reason) {
    case Rejection::not_finite:
      return "not finite";
    case Rejection::out_of_order:
      return "out of order";
    case Rejection::no_partner:
      return "no partner";
    case Rejection::gap:
      return "gap";
    case Rejection::frozen:
      return "frozen";
    case Rejection::screw_congruence:
      return "screw congruence";
    case Rejection::too_much_rotation:
      return "too much rotation";
    case Rejection::count_:
      break;
  }
  return "unknown";
}

MotionPairing::MotionPairing(PairingOptions options) : MotionPairing(std::move(options), PairingState{}) {
  state_.choice.stride = options_.stride.value_or(1);
  state_.choice.balance = options_.balance.value_or(Balance{});
  state_.choice.reason = options_.stride && options_.balance ? "fixed" : "too few motions to choose yet";
  state_.next_choice = first_choice;
}

MotionPairing::MotionPairing(PairingOptions options, PairingState state)
    : options_(std::move(options)), state_(std::move(state)) {
  if (options_.stride && *options_.stride < 1) throw Error("stride: expected at least 1");
  if (options_.mode == Mode::planar) {
    options_.plane_a = checked(options_.plane_a);
    options_.plane_b = checked(options_.plane_b);
    G_a_ = plane_frame(options_.plane_a);
    G_b_ = plane_frame(options_.plane_b);
  }
}

std::vector<MotionPair> MotionPairing::push(Side side, const StampedPose& given) {
  ++(side == Side::a ? state_.counts.poses_a : state_.counts.poses_b);
  StampedPose pose = given;
  const double norm = pose.pose.real.norm();
  if (!pose.pose.vec().allFinite() || !(std::abs(norm - 1) < 0.01)) {
    reject(Rejection::not_finite);
    return {};
  }
  pose.pose = normalized(pose.pose);
  if (!options_.track_time_offset) {
    if (side == Side::b) pose.time_us += std::llround(options_.time_offset * 1e6);
    return take(side, pose);
  }
  const std::uint64_t changes = state_.clock.changes, given_up = state_.clock.given_up;
  const std::vector<ReleasedPose> released = follow_clock(state_.clock, side, pose, options_.max_gap);
  for (std::uint64_t n = state_.clock.given_up - given_up; n > 0; --n) reject(Rejection::no_partner);
  std::vector<MotionPair> pairs;
  for (const ReleasedPose& one : released) {
    const std::vector<MotionPair> more = take(one.side, one.pose);
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  // no motion spans a change of the clock
  if (state_.clock.changes != changes) ++state_.chain;
  return pairs;
}

std::vector<MotionPair> MotionPairing::take(Side side, const StampedPose& pose) {
  auto& newest = state_.newest_us[index(side)];
  auto& waiting = state_.waiting[index(side)];
  // a late pose still has its place while nothing after it has been paired
  auto place = waiting.end();
  if (newest && pose.time_us <= *newest) {
    while (place != waiting.begin() && std::prev(place)->time_us > pose.time_us) --place;
    const bool known = place != waiting.begin() && std::prev(place)->time_us == pose.time_us;
    if (known || (state_.last_key_us && pose.time_us <= *state_.last_key_us)) {
      reject(Rejection::out_of_order);
      return {};
    }
  }
  newest = std::max(newest.value_or(pose.time_us), pose.time_us);
  waiting.insert(place, pose);
  if (waiting.size() > most_waiting) {
    waiting.pop_front();
    reject(Rejection::no_partner);
  }
  if (!state_.keys && state_.waiting[0].size() >= poses_to_decide &&
      state_.waiting[1].size() >= poses_to_decide)
    decide_keys();
  return state_.keys ? synchronise() : std::vector<MotionPair>{};
}

std::vector<MotionPair> MotionPairing::finish() {
  if (!state_.keys && !state_.waiting[0].empty() && !state_.waiting[1].empty()) decide_keys();
  std::vector<MotionPair> pairs = state_.keys ? synchronise() : std::vector<MotionPair>{};
  for (; !state_.doubtful.empty(); state_.doubtful.pop_front()) reject(Rejection::screw_congruence);
  if (state_.keys) {
    auto& keys = state_.waiting[index(*state_.keys)];
    while (!keys.empty()) {
      keys.pop_front();
      reject(Rejection::no_partner);
    }
  }
  return pairs;
}

void MotionPairing::decide_keys() {
  // only the first poses decide, however many have come of one stream before the other spoke
  const auto first = [](const std::deque<StampedPose>& poses) {
    return std::deque<StampedPose>(
        poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(std::min(poses.size(), poses_to_decide)));
  };
  const std::int64_t period_a = median_period(first(state_.waiting[0]));
  const std::int64_t period_b = median_period(first(state_.waiting[1]));
  state_.keys = 10 * period_b >= 9 * period_a ? Side::b : Side::a;
  state_.period_us = std::max<std::int64_t>(1, std::max(period_a, period_b));
  if (options_.stride) {
    state_.strides.push_back({*options_.stride, {}});
  } else {
    for (int stride = 1; stride == 1 || stride * state_.period_us <= longest_motion_us; stride *= 2)
      state_.strides.push_back({stride, {}});
  }
}

std::vector<MotionPair> MotionPairing::synchronise() {
  std::vector<MotionPair> pairs;
  auto& keys = state_.waiting[index(*state_.keys)];
  auto& others = state_.waiting[1 - index(*state_.keys)];
  const auto max_gap_us = static_cast<std::int64_t>(options_.max_gap * 1e6);
  while (!keys.empty() && !others.empty()) {
    const StampedPose& key = keys.front();
    if (key.time_us < others.front().time_us) {
      state_.last_key_us = key.time_us;
      reject(Rejection::no_partner);
      keys.pop_front();
      continue;
    }
    while (others.size() > 1 && others[1].time_us <= key.time_us) others.pop_front();
    const bool exact = others.front().time_us == key.time_us;
    if (!exact && others.size() < 2) break;
    state_.last_key_us = key.time_us;
    if (!exact && others[1].time_us - others[0].time_us > max_gap_us) {
      reject(Rejection::gap);
      keys.pop_front();
      continue;
    }
    DualQuaternion other = others[0].pose;
    if (!exact)
      other = interpolate(others[0].pose, others[1].pose,
                          static_cast<double>(key.time_us - others[0].time_us) /
                              static_cast<double>(others[1].time_us - others[0].time_us));
    Instant instant{key.time_us, key.pose, other, 0};
    if (*state_.keys == Side::b) std::swap(instant.a, instant.b);
    keys.pop_front();
    ++state_.counts.synchronised;
    if (!options_.robust) {
      accept(instant, pairs);
      continue;
    }
    const std::optional<Instant> before = std::exchange(state_.newest, instant);
    if (before && one_repeats(*before, instant)) {
      reject(Rejection::frozen);
      continue;
    }
    const bool known = knows_typical(state_.congruence);
    if (!known) state_.unjudged.push_back({instant.time_us, instant.a, instant.b, state_.chain});
    judge(instant, pairs);
    if (!known && knows_typical(state_.congruence)) judge_first_ones();
  }
  return pairs;
}

/// What was taken in before it was known what is typical is taken in anew: one wrong pose among the first
/// would stay in every long motion across it. The motions handed out already cannot be taken back; what they
/// taught is not learnt twice, and their rejections are not counted twice.
void MotionPairing::judge_first_ones() {
  const std::vector<Instant> first = std::exchange(state_.unjudged, {});
  const CongruenceScale learnt = state_.congruence;
  const auto rejected = state_.counts.rejected;
  for (PairingState::PerStride& entry : state_.strides) entry.statistics = {};
  state_.instants.clear();
  std::vector<MotionPair> handed_out;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (i > 0 && first[i].chain != first[i - 1].chain) ++state_.chain;
    judge(first[i], handed_out);
  }
  state_.congruence = learnt;
  for (const Rejection reason : {Rejection::gap, Rejection::too_much_rotation})
    state_.counts.rejected[static_cast<std::size_t>(reason)] = rejected[static_cast<std::size_t>(reason)];
}

/// A pose that jumped, froze or was tracked wrongly makes incongruent motions with its neighbours, while
/// those are congruent with each other: it alone is left out. Three poses that agree with each other and not
/// with those before (tracking lost and found again elsewhere) begin a new chain; two might be a glitch that
/// passes.
void MotionPairing::judge(const Instant& instant, std::vector<MotionPair>& pairs) {
  auto& doubtful = state_.doubtful;
  if (state_.instants.empty()) return accept(instant, pairs);
  const auto steps = [&](const Instant& from, const Instant& to) {
    return std::max(1.0,
                    static_cast<double>(to.time_us - from.time_us) / static_cast<double>(state_.period_us));
  };
  const auto difference = [&](const Instant& from, const Instant& to) {
    return incongruence(motion_between(from.a, to.a), motion_between(from.b, to.b), state_.congruence) /
           std::sqrt(steps(from, to));
  };
  const auto one_chain = [&](const Instant& from, const Instant& to) {
    return difference(from, to) <= break_chain &&
           !grossly_incongruent(motion_between(from.a, to.a), motion_between(from.b, to.b), steps(from, to),
                                state_.congruence);
  };
  const auto teach = [&](const Instant& from, bool doubted) {
    learn(motion_between(from.a, instant.a), motion_between(from.b, instant.b), doubted, state_.congruence);
  };
  const Instant newest = state_.instants.back();
  if (difference(newest, instant) <= doubtful_incongruence) {
    if (doubtful.empty()) teach(newest, false);
    return speak_for({}, instant, pairs);
  }
  for (std::size_t i = 0; i < doubtful.size(); ++i) {
    if (difference(doubtful[i], instant) > doubtful_incongruence) continue;
    if (one_chain(newest, doubtful[i])) return speak_for({doubtful[i]}, instant, pairs);
    for (std::size_t k = 0; k < i; ++k) {
      if (difference(doubtful[k], doubtful[i]) > doubtful_incongruence) continue;
      ++state_.chain;
      reject(Rejection::screw_congruence);
      return speak_for({doubtful[k], doubtful[i]}, instant, pairs);
    }
  }
  teach(doubtful.empty() ? newest : doubtful.back(), true);
  doubtful.push_back(instant);
  if (doubtful.size() > most_doubtful) {
    doubtful.pop_front();
    reject(Rejection::screw_congruence);
  }
}

/// The instant and the doubtful ones that it agrees with are good; the other doubtful ones are not.
void MotionPairing::speak_for(const std::vector<Instant>& witnesses, const Instant& instant,
                              std::vector<MotionPair>& pairs) {
  for (std::size_t wrong = state_.doubtful.size() - witnesses.size(); wrong > 0; --wrong)
    reject(Rejection::screw_congruence);
  state_.doubtful.clear();
  for (const Instant& witness : witnesses) accept(witness, pairs);
  accept(instant, pairs);
}

void MotionPairing::accept(Instant instant, std::vector<MotionPair>& pairs) {
  instant.chain = state_.chain;
  state_.instants.push_back(instant);
  const auto longest = static_cast<std::size_t>(state_.strides.back().stride);
  while (state_.instants.size() > longest + 1) state_.instants.pop_front();

  const Problem problem = empty_problem();
  for (PairingState::PerStride& entry : state_.strides) {
    const auto steps = static_cast<std::size_t>(entry.stride);
    if (state_.instants.size() <= steps) continue;
    const bool chosen = entry.stride == state_.choice.stride;
    const std::optional<MotionPair> pair =
        motion(state_.instants[state_.instants.size() - 1 - steps], instant, entry.stride, chosen);
    if (!pair) continue;
    if (options_.robust)
      entry.statistics.add(*pair, problem, entry.stride);
    else
      entry.statistics.add_unjudged(*pair);
    if (!chosen) continue;
    pairs.push_back(*pair);
    if (options_.robust && entry.statistics.look_is_due()) entry.statistics.look(problem, entry.stride);
  }
  if (state_.counts.synchronised >= state_.next_choice) {
    choose();
    state_.next_choice = state_.counts.synchronised + state_.counts.synchronised / 4;
  }
  for (const auto& entry : state_.strides) {
    if (entry.stride != state_.choice.stride) continue;
    state_.counts.matched = entry.statistics.inlier_pairs();
    state_.counts.outliers = entry.statistics.outlier_pairs();
  }
}

std::optional<MotionPair> MotionPairing::motion(const Instant& from, const Instant& to, int stride,
                                                bool count_rejections) {
  if (from.chain != to.chain) return std::nullopt;
  if (to.time_us - from.time_us > stretch * stride * state_.period_us) {
    if (count_rejections) reject(Rejection::gap);
    return std::nullopt;
  }
  MotionPair pair{motion_between(from.a, to.a), motion_between(from.b, to.b), from.time_us, to.time_us, 1};
  if (std::max(screw_of(pair.a).angle, screw_of(pair.b).angle) > most_rotation) {
    if (count_rejections) reject(Rejection::too_much_rotation);
    return std::nullopt;
  }
  if (options_.mode == Mode::planar) {
    pair.a = planar_motion(pair.a, G_a_);
    pair.b = planar_motion(pair.b, G_b_);
  }
  return pair;
}

void MotionPairing::choose() {
  if (options_.stride && options_.balance) return;
  const Problem problem = empty_problem();
  std::vector<Candidate> candidates;
  std::optional<std::size_t> current;
  for (PairingState::PerStride& entry : state_.strides) {
    if (options_.robust) entry.statistics.look(problem, entry.stride);
    for (const double translation : balances) {
      const Balance balance = options_.balance.value_or(Balance{1, translation});
      if (entry.stride == state_.choice.stride && balance.rotation == state_.choice.balance.rotation &&
          balance.translation == state_.choice.balance.translation)
        current = candidates.size();
      candidates.push_back({entry.stride, balance, entry.statistics.inliers()});
      if (options_.balance) break;
    }
  }
  const std::optional<Selection> selection = select(problem, candidates, current);
  if (!selection) return;
  const Candidate& chosen = candidates[selection->index];
  state_.choice.stride = chosen.stride;
  state_.choice.balance = chosen.balance;
  char text[160];
  std::snprintf(text, sizeof text, "smallest jack-knife spread of %zu settings: %.3f deg, %.2f cm",
                candidates.size(), selection->spread.rotation * 180 / std::numbers::pi,
                100 * selection->spread.translation);
  state_.choice.reason = text;
}

Problem MotionPairing::empty_problem() const {
  Problem problem;
  problem.mode = options_.mode;
  problem.plane_a = options_.plane_a;
  problem.plane_b = options_.plane_b;
  problem.balance = state_.choice.balance;
  problem.prior = options_.prior;
  return problem;
}

Problem MotionPairing::problem() const {
  Problem problem = empty_problem();
  for (const auto& [stride, statistics] : state_.strides)
    if (stride == state_.choice.stride) problem.blocks = independent_blocks(statistics.inliers(), stride);
  return problem;
}

std::optional<double> MotionPairing::time_offset() const {
  return options_.track_time_offset ? state_.clock.in_force : options_.time_offset;
}

std::optional<std::int64_t> MotionPairing::newest_us() const {
  if (state_.instants.empty()) return std::nullopt;
  return state_.instants.back().time_us;
}

PairingResult pair_motions(const PairingOptions& options, const Trajectory& a, const Trajectory& b) {
  PairingResult result{MotionPairing(options), {}};
  const auto take = [&result](std::vector<MotionPair> pairs) {
    result.pairs.insert(result.pairs.end(), pairs.begin(), pairs.end());
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool from_a = j == b.size() || (i < a.size() && a[i].time_us <= b[j].time_us);
    take(from_a ? result.drive.push(Side::a, a[i++]) : result.drive.push(Side::b, b[j++]));
  }
  take(result.drive.finish());
  return result;
}

}  // namespace egocal
