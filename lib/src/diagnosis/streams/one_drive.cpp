// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/one_drive.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnosis/words/wording.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Angles of both streams in one part of the drive, [rad]; medians, which outliers do not change.
struct Window {
  double begin = 0, end = 0;  ///< [s]
  double turned = 0;
  double difference = 0;
  std::vector<double> differences;  ///< of all motions

  double misfit() const { return difference / turned; }
};

std::vector<Window> windows_of(const Motions& motions, std::size_t count) {
  std::vector<Window> windows;
  const std::size_t n = motions.all.size();
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t first = w * n / count, last = (w + 1) * n / count;
    if (first == last) return {};
    std::vector<double> turned, difference;
    for (std::size_t i = first; i < last; ++i) {
      turned.push_back(0.5 * (motions.all[i].angle_a + motions.all[i].angle_b));
      difference.push_back(std::abs(motions.all[i].angle_a - motions.all[i].angle_b));
    }
    const double typical = median(difference);
    windows.push_back({motions.all[first].time, motions.all[last - 1].time, median(std::move(turned)),
                       typical, std::move(difference)});
  }
  return windows;
}

/// What separates windows that agree from those that do not, if anything does: the widest step in the order
/// of their misfits.
std::optional<double> limit_of_agreement(const std::vector<Window>& windows, const OneDriveOptions& options) {
  std::vector<double> misfits;
  misfits.reserve(windows.size());
  for (const Window& window : windows) misfits.push_back(std::max(window.misfit(), options.same));
  std::sort(misfits.begin(), misfits.end());
  std::optional<double> limit;
  double widest = options.step;
  for (std::size_t i = 1; i < misfits.size(); ++i) {
    const double agreeing = misfits[i - 1], other = misfits[i];
    if (agreeing > options.agree || other < options.disagree || other < widest * agreeing) continue;
    widest = other / agreeing;
    limit = std::sqrt(agreeing * other);
  }
  return limit;
}

}  // namespace

bool travel_together(const Motions& motions, const OneDriveOptions& options) {
  std::vector<double> of_a, of_b, ratios;
  for (const Motion& motion : motions.all) {
    const double a = motion.t_a.norm(), b = motion.t_b.norm();
    if (!(a > 0 && b > 0)) continue;
    of_a.push_back(std::log(a));
    of_b.push_back(std::log(b));
    ratios.push_back(std::log(b / a));
  }
  if (ratios.size() < options.least) return false;
  const auto scatter = [](const std::vector<double>& values) {
    const double middle = median(values);
    std::vector<double> deviations;
    for (const double value : values) deviations.push_back(std::abs(value - middle));
    return median(std::move(deviations));
  };
  return scatter(ratios) < options.lengths_agree * std::min(scatter(of_a), scatter(of_b));
}

std::vector<Finding> unrelated_part(const Motions& motions, const OneDriveOptions& options) {
  std::vector<Window> windows = windows_of(motions, options.windows);
  std::erase_if(windows, [&](const Window& window) {
    return !(window.turned > options.least_turning * motions.rotation);
  });
  if (windows.size() < 4) return {};
  const std::optional<double> limit = limit_of_agreement(windows, options);
  if (!limit) return {};
  const auto disagrees = [&](const Window& window) { return window.misfit() > *limit; };
  // one run of windows
  const auto first = std::find_if(windows.begin(), windows.end(), disagrees);
  const auto end = std::find_if_not(first, windows.end(), disagrees);
  if (std::find_if(end, windows.end(), disagrees) != windows.end()) return {};
  if (end - first < 2 || static_cast<std::ptrdiff_t>(windows.size()) - (end - first) < 2) return {};
  // noise of one size is a large part of the angle where little is turned
  std::vector<double> other, all_others;
  for (auto window = first; window != end; ++window) {
    other.push_back(window->difference);
    all_others.insert(all_others.end(), window->differences.begin(), window->differences.end());
  }
  double agreeing = 0;
  for (const Window& window : windows)
    if (!disagrees(window)) agreeing = std::max(agreeing, window.difference);
  if (!(median(std::move(other)) > options.step * agreeing)) return {};
  // wrong poses spoil some of the motions; of another drive all are wrong
  const auto agrees = [&](double difference) { return difference <= options.step * agreeing; };
  const auto count = static_cast<double>(std::count_if(all_others.begin(), all_others.end(), agrees));
  if (count > options.most_agreeing * static_cast<double>(all_others.size())) return {};
  const auto last = end - 1;
  Finding finding;
  finding.code = "unrelated";
  finding.certain = true;
  finding.time = first->begin;
  finding.message = format(
      "The two streams do not turn together from %.0f to %.0f s after the start, and do in the rest of the "
      "drive: another recording, a clock that jumped, or an odometry that was lost.",
      first->begin, last->end);
  finding.remedy = "Use the part of the drive where the streams belong together.";
  return {finding};
}

}  // namespace egocal::detail
