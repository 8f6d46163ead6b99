// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/two_dimensions.hpp"

#include <array>
#include <cmath>

#include "diagnosis/streams/turning_axis.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/directions.hpp"

namespace egocal::detail {

namespace {

Finding flat_both(const std::array<bool, 6>& assumed) {
  std::string names;
  for (std::size_t i = 3; i < 6; ++i)
    if (assumed[i]) names += (names.empty() ? "" : ", ") + std::string(direction_names[i]);
  // the axis is none of a's: each angle has a part of what was not measured
  if (assumed[3] && assumed[4] && assumed[5]) names = "the tilt of that axis";
  Finding finding;
  finding.code = "flat_both";
  finding.certain = true;
  say(finding,
      format(
          "Both streams are in two dimensions: each turns about one axis alone. Neither measured %s or the "
          "height: both files assume them.",
          names.c_str()),
      "Measure these otherwise, or take them from the ground planes (--planar --plane-a --plane-b).");
  return finding;
}

}  // namespace

std::optional<Assumed> two_dimensions(const Motions& motions, const TwoDimensionsOptions& options) {
  if (motions.all.size() < options.least) return std::nullopt;
  const TurningAxis a = turning_axis(motions, Side::a), b = turning_axis(motions, Side::b);
  if (a.tilt > options.level || b.tilt > options.level) return std::nullopt;
  if (!(motions.rotation > options.least_turn) ||
      !(turning_difference(motions, a.axis, b.axis) > options.over_level * options.level))
    return std::nullopt;
  Assumed result;
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = std::abs(a.axis[static_cast<Eigen::Index>(i)]);
    result.directions[i] = part > options.across;
    result.directions[3 + i] = part <= options.across;
  }
  result.finding = flat_both(result.directions);
  return result;
}

}  // namespace egocal::detail
