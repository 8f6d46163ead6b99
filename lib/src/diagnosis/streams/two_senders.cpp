// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/two_senders.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t most_rows = 100;  ///< that are looked at from each one, for time

/// A row that is far from its neighbours, which are close to each other. Positions in the world of the stream
/// [m].
struct Aside {
  std::size_t row = 0;
  Eigen::Vector3d here, middle;  ///< of the row; between its neighbours
  Eigen::Vector3d off() const { return here - middle; }
};

std::vector<Eigen::Vector3d> positions_of(const Trajectory& trajectory, std::size_t most) {
  const std::size_t n = std::min(trajectory.size(), most), begin = (trajectory.size() - n) / 2;
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(n);
  for (std::size_t i = begin; i < begin + n; ++i)
    positions.push_back(to_pose(trajectory[i].pose).translation);
  return positions;
}

std::vector<Aside> rows_aside(const std::vector<Eigen::Vector3d>& positions, double times) {
  std::vector<Aside> rows;
  for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
    const Eigen::Vector3d& before = positions[i - 1];
    const Eigen::Vector3d& after = positions[i + 1];
    const Aside row{i, positions[i], 0.5 * (before + after)};
    if (row.off().norm() > times * (after - before).norm() && row.off().norm() > 0) rows.push_back(row);
  }
  return rows;
}

/// How rows aside follow each other.
struct Following {
  std::size_t pairs = 0, going_on = 0;
  double travel_aside = 0, travel_beside = 0;  ///< [m]
};

Following following(const std::vector<Aside>& rows, double most_change) {
  Following result;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    // where rows alternate, each is aside for the other path: the last row of its own is two rows back
    const bool alternate = rows[k - 1].row + 1 == rows[k].row;
    if (alternate && k < 2) continue;
    const std::size_t last = alternate ? k - 2 : k - 1;
    const Aside &now = rows[k], &then = rows[last];
    ++result.pairs;
    if ((now.off() - then.off()).norm() > most_change * now.off().norm()) continue;
    ++result.going_on;
    result.travel_aside += (now.here - then.here).norm();
    result.travel_beside += (now.middle - then.middle).norm();
  }
  return result;
}

double median_off(const std::vector<Aside>& rows) {
  std::vector<double> lengths;
  lengths.reserve(rows.size());
  for (const Aside& row : rows) lengths.push_back(row.off().norm());
  return median(std::move(lengths));
}

/// Median of how far a stream gets within the time, or within one row where that is longer [m].
double travel_within(const Trajectory& trajectory, double time_us, std::size_t most) {
  const std::size_t n = trajectory.size(), each = std::max<std::size_t>(1, n / most);
  std::vector<double> lengths;
  for (std::size_t i = 0; i + 1 < n; i += each) {
    const Eigen::Vector3d here = to_pose(trajectory[i].pose).translation;
    double farthest = 0;
    for (std::size_t k = i + 1; k < std::min(n, i + most_rows); ++k) {
      farthest = std::max(farthest, (to_pose(trajectory[k].pose).translation - here).norm());
      if (static_cast<double>(trajectory[k].time_us - trajectory[i].time_us) >= time_us) break;
    }
    lengths.push_back(farthest);
  }
  return median(std::move(lengths));
}

Finding worded_two_senders(Side side, double distance, double share, double noise, bool metres) {
  const char which = side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("mixed_frames_") + which;
  finding.certain = true;
  finding.improvement = std::pow(std::max(noise, 1e-9), -2);
  say(finding, format("The poses of %s are of two odometries in turn", mark(which)),
      format("Give the poses of one publisher as %s.", mark(which)),
      format(": %.2g %% of the rows jump to another path and back, by %s, and both paths go on.", 100 * share,
             length_in_words(distance, metres).c_str()));
  return finding;
}

}  // namespace

std::optional<Finding> two_senders(Side side, const Trajectory& own, const Trajectory& other, bool metres,
                                   const TwoSendersOptions& options) {
  if (own.size() < options.least || other.size() < options.least) return std::nullopt;
  const std::vector<Eigen::Vector3d> positions = positions_of(own, options.most);
  const std::vector<Aside> rows = rows_aside(positions, options.aside);
  const auto count = static_cast<double>(rows.size());
  const double share = count / static_cast<double>(positions.size());
  if (rows.size() < options.least || share < options.least_share) return std::nullopt;
  const Following follow = following(rows, options.most_change);
  const auto going_on = static_cast<double>(follow.going_on);
  if (going_on < options.least_going_on * static_cast<double>(follow.pairs) ||
      follow.going_on + 1 < options.least / 2 ||
      !(follow.travel_aside > options.least_travel * follow.travel_beside))
    return std::nullopt;
  const double distance = median_off(rows);
  const double two_rows =
      2 * static_cast<double>(own.back().time_us - own.front().time_us) / static_cast<double>(own.size() - 1);
  const double travelled = travel_within(other, two_rows, options.most);
  if (!(distance > options.beyond_other * travelled)) return std::nullopt;
  // of two paths, no more than half of the rows are of the one with fewer
  return worded_two_senders(side, distance, std::min(share, 0.5), travelled / distance, metres);
}

}  // namespace egocal::detail
