// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/stretch_test.hpp"

#include <algorithm>
#include <cmath>

#include "moves/segment_test.hpp"

namespace egocal::detail {

namespace {

std::size_t part_of(std::size_t blocks, double part) {
  return static_cast<std::size_t>(std::ceil(part * static_cast<double>(blocks)));
}

/// About an axis across two or three of the frame's no component needs to be large. Noise of three
/// components makes a length of 1.6 standard deviations, hence one more than for a component.
bool turned_enough(const TestedDrive& drive, const FoundChange& found) {
  const Eigen::Vector3d turned = found.test.change.tail<3>();
  const double angle = turned.norm();
  if (!(angle > 0)) return false;
  const Eigen::Vector3d axis = turned / angle;
  const double variance = axis.dot(found.test.covariance.bottomRightCorner<3, 3>() * axis);
  return angle - 3 * std::sqrt(std::max(0.0, variance)) >= drive.options.least_rotation;
}

bool large_enough(const TestedDrive& drive, const FoundChange& found) {
  const Eigen::Index shifts = drive.problem.mode == Mode::planar ? 2 : 3;
  const Parameters& x = found.test.change;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double shown = std::abs(x[i]) - 2 * std::sqrt(std::max(0.0, found.test.covariance(i, i)));
    const double least =
        i < shifts ? drive.options.least_translation / found.stretch.length : drive.options.least_rotation;
    if (shown >= least) return true;
  }
  return drive.problem.mode == Mode::spatial && turned_enough(drive, found);
}

}  // namespace

std::size_t least_side(std::size_t blocks, const MovesOptions& options) {
  return std::max({std::size_t{1}, options.least_side_blocks, part_of(blocks, options.least_side)});
}

std::size_t StretchTest::blocks_in(std::size_t from, std::size_t to) const {
  const auto of = [&](std::size_t pairs) {
    return (to - from) / std::max<std::size_t>({1, pairs, 3 * drive_.overlap});
  };
  const std::size_t count = of(drive_.options.block_pairs);
  if (count >= drive_.options.least_blocks) return std::min(drive_.options.most_blocks, count);
  return std::min(drive_.options.least_blocks, of(drive_.options.least_block_pairs));
}

double StretchTest::false_alarms(std::size_t block_pairs) const {
  return drive_.options.false_alarms *
         (block_pairs < drive_.options.block_pairs ? drive_.options.of_short_blocks : 1);
}

std::optional<FoundChange> StretchTest::best(std::size_t from, std::size_t to) {
  const std::size_t count = blocks_in(from, to);
  if (count < drive_.options.least_blocks) return std::nullopt;
  FoundChange found;
  found.from = from;
  found.to = to;
  found.stretch =
      linearise(drive_.pairs.subspan(from, to - from), drive_.problem, count, drive_.options.test);
  if (found.stretch.blocks.empty()) return std::nullopt;
  found.test = test_change(found.stretch.blocks, least_side(count, drive_.options), drive_.options.test);
  if (found.test.split == 0) return std::nullopt;
  chance_ = std::min({chance_, found.test.false_alarm, 2 * found.test.even_false_alarm});
  const double alarms = false_alarms((to - from) / count);
  found.creep = found.test.even && found.test.even_false_alarm <= 0.5 * alarms;
  if (found.creep) {
    found.test.false_alarm = 2 * found.test.even_false_alarm;
    found.test.change = found.test.end - found.test.begin;
    found.test.covariance = found.test.even_covariance;
  }
  if (!(found.test.false_alarm <= alarms) || !large_enough(drive_, found)) return std::nullopt;
  found.at = from + found.stretch.begin[found.test.split];
  return found;
}

std::optional<std::array<FoundChange, 2>> StretchTest::best_two(std::size_t from, std::size_t to) {
  const std::size_t count = blocks_in(from, to);
  if (count < drive_.options.least_blocks) return std::nullopt;
  FoundChange found;
  found.stretch =
      linearise(drive_.pairs.subspan(from, to - from), drive_.problem, count, drive_.options.test);
  if (found.stretch.blocks.empty()) return std::nullopt;
  const std::size_t side = least_side(count, drive_.options);
  const SegmentTest test =
      test_segment(found.stretch.blocks, side,
                   std::max(2 * side, part_of(count, drive_.options.least_displaced)), drive_.options.test);
  if (test.part.to == 0) return std::nullopt;
  found.test.split = test.part.from;
  found.test.false_alarm = std::min(1.0, test.chance / drive_.options.of_falling_back);
  found.test.correlation = test.correlation;
  found.test.change = test.change;
  found.test.covariance = test.covariance;
  found.of_two = true;
  chance_ = std::min(chance_, found.test.false_alarm);
  const bool fell_back =
      test.chance_of_rest > drive_.options.confirmation || test.rest_by_change <= drive_.options.most_left;
  if (!(found.test.false_alarm <= false_alarms((to - from) / count)) || !large_enough(drive_, found) ||
      !(test.chance_of_halves <= drive_.options.confirmation) || !fell_back)
    return std::nullopt;
  std::array<FoundChange, 2> two = {found, found};
  two[0].from = from;
  two[0].at = two[1].from = from + found.stretch.begin[test.part.from];
  two[0].to = two[1].at = from + found.stretch.begin[test.part.to];
  two[1].to = to;
  two[1].test.change = -test.change;
  return two;
}

Shown StretchTest::shown_in_longer_blocks(const FoundChange& found) const {
  double correlation = found.test.correlation, chance = found.test.false_alarm;
  for (std::size_t count = blocks_in(found.from, found.to) / 2;
       correlation > drive_.options.most_correlation && count >= drive_.options.least_blocks; count /= 2) {
    const Linearised stretch = linearise(drive_.pairs.subspan(found.from, found.to - found.from),
                                         drive_.problem, count, drive_.options.test);
    if (stretch.blocks.empty()) return Shown::no;
    const auto split = std::lower_bound(stretch.begin.begin(), stretch.begin.end(), found.at - found.from) -
                       stretch.begin.begin();
    const ChangeAt longer = test_change_at(stretch.blocks, static_cast<std::size_t>(split),
                                           least_side(count, drive_.options), drive_.options.test);
    if (!(longer.chance <= drive_.options.false_alarms)) return Shown::no;
    correlation = longer.correlation;
    chance = longer.chance;
  }
  return correlation <= drive_.options.most_correlation ||
                 chance <= drive_.options.false_alarms * drive_.options.of_short_blocks
             ? Shown::clearly
             : Shown::perhaps;
}

}  // namespace egocal::detail
