// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/step_across.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "egocal/statistics/median.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// The extrinsic at instant k that the motions from instant i lead to from T_a_b, seen from T_a_b.
Vector6d led_to(const Instants& instants, const PoseReading& reading, std::size_t i, std::size_t k,
                const DualQuaternion& T_a_b) {
  const PosePair from = instants.at(i, reading, reading), to = instants.at(k, reading, reading);
  return frame_a_difference(T_a_b, conjugate(conjugate(from.a) * to.a) * T_a_b * (conjugate(from.b) * to.b));
}

/// The last instant before a move, and the first one after it.
struct Across {
  std::size_t first = 0, last = 0;
  std::size_t steps() const { return last - first; }
};

std::optional<Across> across_move(const Instants& instants, const Move& move, double begin, double margin,
                                  const MotionSampleOptions& motions) {
  const std::size_t n = instants.size();
  Across across{0, n};
  while (across.first < n && instants.time(across.first) <= begin + move.earliest - margin) ++across.first;
  while (across.last > 0 && instants.time(across.last - 1) >= begin + move.latest + margin) --across.last;
  if (across.first == 0 || across.last >= n) return std::nullopt;
  --across.first;
  if (across.last <= across.first) return std::nullopt;
  const double seconds = instants.time(across.last) - instants.time(across.first);
  if (seconds > motions.most_stretched * static_cast<double>(across.steps()) * instants.period)
    return std::nullopt;  // a gap
  return across;
}

/// What the motions across a move lead to, and variances of it.
struct LedSteps {
  double part = 1;  ///< of the change, that is to be expected
  Vector6d step = Vector6d::Zero(), noise = Vector6d::Zero();
  std::vector<Vector6d> beside{};  ///< what as long motions elsewhere lead to
};

double median_step(const std::vector<Vector6d>& steps, Eigen::Index component) {
  std::vector<double> values;
  for (const Vector6d& step : steps) values.push_back(step[component]);
  return median(std::move(values));
}

/// Variance without the tails.
double step_variance(const std::vector<Vector6d>& steps, Eigen::Index component, double mean) {
  constexpr double median_of_squares = 0.455;  // of a normal distribution
  std::vector<double> squares;
  for (const Vector6d& step : steps) squares.push_back((step[component] - mean) * (step[component] - mean));
  return median(std::move(squares)) / median_of_squares;
}

std::optional<LedSteps> steps_of_bump(const Instants& instants, const PoseReading& reading, const Move& move,
                                      double begin, double margin, const MotionSampleOptions& motions,
                                      const StepOptions& options) {
  const std::optional<Across> found = across_move(instants, move, begin, margin, motions);
  if (!found) return std::nullopt;
  const auto [first, last] = *found;
  const std::size_t n = instants.size(), steps = found->steps();
  std::vector<Vector6d> across, beside;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, steps / 4); ++k)
    if (first >= k && last + k < n)
      across.push_back(led_to(instants, reading, first - k, last + k, move.before));
  const std::size_t each = std::max({std::size_t{1}, steps / 8, n / options.most});
  for (std::size_t i = 0; i + steps < n; i += each) {
    if (i + steps <= first)
      beside.push_back(led_to(instants, reading, i, i + steps, move.before));
    else if (i >= last)
      beside.push_back(led_to(instants, reading, i, i + steps, move.after));
  }
  if (beside.size() < options.least) return std::nullopt;
  LedSteps result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    result.step[i] = median_step(across, i);
    result.noise[i] = step_variance(beside, i, 0);
  }
  result.beside = std::move(beside);
  return result;
}

/// Steps of the motions over a fourth of the time that a mount creeps.
std::optional<LedSteps> steps_of_creep(const Instants& instants, const PoseReading& reading, const Move& move,
                                       double begin, const MotionSampleOptions& motions,
                                       const StepOptions& options) {
  constexpr std::size_t windows = 4;  // of the time that it creeps: independent ones for the noise
  std::size_t from = 0, to = instants.size();
  while (from < to && instants.time(from) < begin + move.earliest) ++from;
  while (to > from && instants.time(to - 1) > begin + move.latest) --to;
  const std::size_t steps = (to - from) / windows,
                    each = std::max<std::size_t>(1, (to - from) / options.most);
  if (steps == 0) return std::nullopt;
  const double longest = motions.most_stretched * static_cast<double>(steps) * instants.period;
  std::vector<Vector6d> across;
  double seconds = 0;
  for (std::size_t i = from; i + steps < to; i += each) {
    const double here = instants.time(i + steps) - instants.time(i);
    if (here > longest) continue;
    across.push_back(led_to(instants, reading, i, i + steps, move.before));
    seconds += here;
  }
  if (across.size() < options.least || !(move.latest > move.earliest)) return std::nullopt;
  LedSteps result;
  result.part = seconds / static_cast<double>(across.size()) / (move.latest - move.earliest);
  for (Eigen::Index i = 0; i < 6; ++i) {
    result.step[i] = median_step(across, i);
    result.noise[i] = step_variance(across, i, result.step[i]) / windows;
  }
  return result;
}

/// How far a step leads along the change of a move, in units of the noise.
struct Along {
  double part = 0;    ///< of the change
  double length = 0;  ///< of the step, as a part of the change
  double stddev = INFINITY;
};

/// How far the translation or the rotation of a step leads along the change, from the components of the
/// change that are shown.
Along along(const Move& move, const Vector6d& change, const Vector6d& step, const Vector6d& noise,
            Eigen::Index group, const StepOptions& options) {
  double change2 = 0, step2 = 0, product = 0;
  for (Eigen::Index i = group; i < group + 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!(std::abs(move.change[k]) > options.shown * move.stddev[k])) continue;
    if (!(noise[i] > 0)) return {1, 1, 0};
    change2 += change[i] * change[i] / noise[i];
    step2 += step[i] * step[i] / noise[i];
    product += change[i] * step[i] / noise[i];
  }
  if (!(change2 > 0)) return {};
  return {product / change2, std::sqrt(step2 / change2), 1 / std::sqrt(change2)};
}

constexpr Eigen::Index step_groups[] = {0, 3};  // translation and rotation

StepShown shown_of(const std::optional<LedSteps>& steps, const Move& move, const StepOptions& options) {
  if (!steps) return StepShown::unknown;
  const Vector6d change = steps->part * frame_a_difference(move.before, move.after);
  bool still = false, hidden = false;
  for (const Eigen::Index group : step_groups) {
    const Along here = along(move, change, steps->step, steps->noise, group, options);
    if (!std::isfinite(here.stddev)) continue;
    if (here.part < options.still && here.length <= options.of_change)
      (here.stddev <= options.known ? still : hidden) = true;
    else if (here.stddev <= options.known_step)
      return StepShown::yes;
    else
      hidden = true;
  }
  return still && !hidden ? StepShown::no : StepShown::unknown;
}

/// Whether the step shows at another time: noise that wanders may have misplaced the move.
bool shows_elsewhere(const LedSteps& steps, const Move& move, const StepOptions& options) {
  const Vector6d change = frame_a_difference(move.before, move.after);
  for (const Vector6d& step : steps.beside)
    for (const Eigen::Index group : step_groups)
      if (along(move, change, step, steps.noise, group, options).part >= options.still) return true;
  return false;
}

}  // namespace

StepShown step_across(const Instants& instants, const PoseReading& reading, const Move& move, double begin,
                      const MotionSampleOptions& motions, const StepOptions& options) {
  if (move.kind == MoveKind::creep)
    return shown_of(steps_of_creep(instants, reading, move, begin, motions, options), move, options);
  const std::optional<LedSteps> steps = steps_of_bump(instants, reading, move, begin, 0, motions, options);
  const StepShown at_once = shown_of(steps, move, options);
  if (at_once != StepShown::no) return at_once;
  if (shows_elsewhere(*steps, move, options)) return StepShown::elsewhere;
  // a mount that slid for some seconds
  switch (shown_of(steps_of_bump(instants, reading, move, begin, options.slides, motions, options), move,
                   options)) {
    case StepShown::yes:
      return StepShown::slowly;
    case StepShown::no:
      return StepShown::no;
    default:
      return StepShown::not_at_once;
  }
}

}  // namespace egocal::detail
