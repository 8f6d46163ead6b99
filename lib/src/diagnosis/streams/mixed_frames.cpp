// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/mixed_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "diagnosis/streams/mixed_frames_jumps.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Median of a rotation [rad] and of a translation [m].
struct Typical {
  double rotation = 0, translation = 0;
};

double angle_of(const Pose& pose) {
  return rotation_angle(to_dual_quaternion(pose));
}

Typical of(const Pose& pose) {
  return {angle_of(pose), pose.translation.norm()};
}

/// The half of the poses that is of two frames.
using Half = double Typical::*;

struct Scatter {
  double of_residuals = 0, of_parts = 0;
};

class Patterns {
 public:
  Patterns(const Instants& instants, const MixedFramesOptions& options)
      : instants_(instants), each_(std::max<std::size_t>(1, instants.size() / options.most)) {
    // begins that meet every phase of a pattern of two to six
    while (std::gcd(each_, std::size_t{60}) != 1) ++each_;
  }

  /// Residual at the answer of motions over `span` instants.
  Typical residual(std::size_t span, const Pose& T_a_b) const {
    return typical_of(span, [&](std::size_t i) { return of(left(i, span, T_a_b)); });
  }
  /// Size of the motions of one stream over `span` instants.
  Typical size(Side side, std::size_t span) const {
    return typical_of(span, [&](std::size_t i) { return of(motion(side, i, span)); });
  }
  /// Difference between a single step and the one `later` instants after it.
  Typical change(Side side, std::size_t later) const {
    return typical_of(later + 1, [&](std::size_t i) {
      const Pose here = motion(side, i, 1), there = motion(side, i + later, 1);
      return Typical{angle_of(inverse(here) * there), (there.translation - here.translation).norm()};
    });
  }
  /// Scatter of the residuals of single steps, in metres or radians, and divided by the size of the motion
  /// over `span` instants: the median deviation from the median, divided by the median.
  Scatter scatter(Side side, std::size_t span, const Pose& T_a_b, Half half) const {
    std::vector<double> residuals, parts;
    for (std::size_t i = 0; i + std::max<std::size_t>(span, 1) < instants_.size(); i += each_) {
      residuals.push_back(of(left(i, 1, T_a_b)).*half);
      parts.push_back(residuals.back() / std::max(of(motion(side, i, span)).*half, 1e-12));
    }
    return {relative_deviation(std::move(residuals)), relative_deviation(std::move(parts))};
  }
  /// Residual of single steps perpendicular to the motion of b over `span` instants [m].
  double across(std::size_t span, const Pose& T_a_b) const {
    std::vector<double> lengths;
    for (std::size_t i = 0; i + span < instants_.size(); i += each_) {
      const Eigen::Vector3d way = motion(Side::b, i, span).translation.normalized(),
                            residual = left(i, 1, T_a_b).translation;
      lengths.push_back((residual - way.dot(residual) * way).norm());
    }
    return median(std::move(lengths));
  }

 private:
  /// Medians over the begins that have `reach` instants after them.
  template <typename Measure>
  Typical typical_of(std::size_t reach, const Measure& measure) const {
    std::vector<double> rotations, translations;
    for (std::size_t i = 0; i + reach < instants_.size(); i += each_) {
      const Typical here = measure(i);
      rotations.push_back(here.rotation);
      translations.push_back(here.translation);
    }
    return {median(std::move(rotations)), median(std::move(translations))};
  }
  Pose left(std::size_t i, std::size_t span, const Pose& T_a_b) const {
    return inverse(motion(Side::a, i, span) * T_a_b) * (T_a_b * motion(Side::b, i, span));
  }
  Pose motion(Side side, std::size_t begin, std::size_t span) const {
    return inverse(pose(side, begin)) * pose(side, begin + span);
  }
  Pose pose(Side side, std::size_t i) const {
    const PosePair both = instants_.at(i);
    return to_pose(side == Side::a ? both.a : both.b);
  }

  const Instants& instants_;
  std::size_t each_;
};

struct Pattern {
  std::size_t length = 0;  ///< [instants]
  double single = 0, longer = 0;
};

/// The length whose motions leave least, where single steps leave far more.
std::optional<Pattern> pattern_of(const Patterns& patterns, const std::vector<Typical>& residuals, Half half,
                                  const MixedFramesOptions& options) {
  const auto least =
      std::min_element(residuals.begin() + 1, residuals.end(),
                       [half](const Typical& x, const Typical& y) { return x.*half < y.*half; });
  const Pattern pattern{static_cast<std::size_t>(least - residuals.begin()) + 1, residuals.front().*half,
                        (*least).*half};
  const double moved =
      std::max(patterns.size(Side::a, options.longest).*half, patterns.size(Side::b, options.longest).*half);
  if (!(pattern.single > options.times * pattern.longer) || !(pattern.single > options.least_part * moved))
    return std::nullopt;
  return pattern;
}

Finding worded(const OtherFrame& frame, bool metres) {
  const char which = frame.side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("mixed_frames_") + which;
  finding.certain = frame.certain;
  finding.improvement = std::pow(std::max(frame.noise, 1e-9), -2);
  say(finding, format("The poses of %s are of two frames", mark(which)),
      format(
          "Give the poses of one frame, of one publisher, as %s; or fasten it, where its mount can rattle by "
          "that much.",
          mark(which)),
      format(": %.2g %% of them are of another one than the rest, %s and %.2g deg from it.",
             100 * frame.share, length_in_words(frame.distance, metres).c_str(),
             degrees_per_radian * frame.angle));
  return finding;
}

Finding worded(Side side, Half half, const Pattern& pattern, bool certain, bool metres) {
  const char which = side == Side::a ? 'a' : 'b';
  const auto words = [&](double value) {
    return half == &Typical::rotation ? format("%.3g deg", degrees_per_radian * value)
                                      : length_in_words(value, metres);
  };
  Finding finding;
  finding.code = std::string("mixed_frames_") + which;
  finding.certain = certain;
  finding.improvement = std::pow(pattern.single / std::max(pattern.longer, 1e-9 * pattern.single), 2);
  say(finding, format("The poses of %s are of two frames in turn", mark(which)),
      format("Give the poses of one frame, of one publisher, as %s.", mark(which)),
      format(": single steps contradict the answer by %s, motions of %zu poses by %s.",
             words(pattern.single).c_str(), pattern.length, words(pattern.longer).c_str()));
  return finding;
}

}  // namespace

std::optional<Finding> mixed_frames(const Instants& instants, const Pose& T_a_b, bool metres,
                                    const MixedFramesOptions& options) {
  if (instants.size() < options.least + options.longest) return std::nullopt;
  if (const std::optional<OtherFrame> frame = jumps_between_frames(instants, T_a_b))
    return worded(*frame, metres);
  const Patterns patterns(instants, options);
  std::vector<Typical> residuals;
  for (std::size_t span = 1; span <= options.longest; ++span)
    residuals.push_back(patterns.residual(span, T_a_b));
  std::optional<Finding> possible;
  for (const Half half : {&Typical::translation, &Typical::rotation}) {
    const std::optional<Pattern> pattern = pattern_of(patterns, residuals, half, options);
    if (!pattern) continue;
    const auto alternating = [&](Side side) {
      return patterns.change(side, 1).*half / std::max(patterns.change(side, pattern->length).*half, 1e-12);
    };
    const Side side = alternating(Side::a) > alternating(Side::b) ? Side::a : Side::b;
    // stamps that alternate, and values that are held, leave a part of the way
    const Scatter scatter = patterns.scatter(side, pattern->length, T_a_b, half);
    if (scatter.of_residuals > std::min(options.most_scatter, scatter.of_parts)) continue;
    const bool across_the_way =
        half == &Typical::translation &&
        patterns.across(pattern->length, T_a_b) >
            std::max(options.times * pattern->longer, options.across * pattern->single);
    const bool certain = across_the_way || options.clearly_constant * scatter.of_residuals < scatter.of_parts;
    Finding finding = worded(side, half, *pattern, certain, metres);
    if (certain) return finding;
    if (!possible) possible = std::move(finding);
  }
  return possible;
}

}  // namespace egocal::detail
