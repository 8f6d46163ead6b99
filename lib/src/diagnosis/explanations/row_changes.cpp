// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/row_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;
using Changes = std::vector<Vector3d>;

/// What is added to the positions at times between the rows, taken from a pass over all rows: of a long drive
/// the few thousand times are held, never the rows.
class Added {
 public:
  /// times: of the rows, that have two at least; to be asked for at ascending ones.
  explicit Added(const Times& times) : times_(times) {}

  void ask(double time) {
    while (row_ + 2 < times_.size() && times_[row_ + 1] <= time) ++row_;
    const double from = times_[row_], to = times_[row_ + 1];
    asked_.push_back({row_, to > from ? std::clamp((time - from) / (to - from), 0.0, 1.0) : 0});
  }
  /// What is added to a row and to the next one. To be called in order, for all rows but the last.
  void pass(std::size_t row, const Vector3d& here, const Vector3d& next) {
    while (at.size() < asked_.size() && asked_[at.size()].row == row)
      at.push_back(here + asked_[at.size()].way * (next - here));
  }

  Changes at;  ///< of each time asked for

 private:
  struct Asked {
    std::size_t row;
    double way;  ///< part of that to the next row
  };
  Times times_;
  std::size_t row_ = 0;
  std::vector<Asked> asked_;
};

}  // namespace

const Trajectory& rows_of(const Evidence& evidence, Side side) {
  return side == Side::a ? evidence.streams.a : evidence.streams.b;
}

std::vector<Vector3d> changes_of_rows(const Evidence& evidence, Side side, const AddedToRow& added) {
  const Motions& motions = evidence.given.explained.motions;
  const ClockModel clock = side == Side::a ? ClockModel{} : evidence.clock;
  const Times times(rows_of(evidence, side), evidence.streams.a.front().time_us, clock);
  const std::vector<std::size_t> begins = begins_of(evidence.instants, motions);
  const auto span = static_cast<std::size_t>(motions.stride);
  Added begin(times), end(times);
  for (const std::size_t i : begins) {
    begin.ask(evidence.instants.time(i));
    end.ask(evidence.instants.time(i + span));
  }
  Vector3d here = added(0);
  for (std::size_t row = 1; row < times.size(); ++row) {
    const Vector3d next = added(row);
    begin.pass(row - 1, here, next);
    end.pass(row - 1, here, next);
    here = next;
  }
  Changes changes;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const PosePair poses = evidence.instants.at(begins[k]);
    changes.push_back(rotation_of(side == Side::a ? poses.a : poses.b).transpose() *
                      (end.at[k] - begin.at[k]));
  }
  return changes;
}

double best_multiple(const Explained& given, const Changes& changes, Side side) {
  return best_numbers<1>(given, changes, side)[0];
}

double jack_knife(const Explained& given, const Changes& changes, Side side, unsigned most, unsigned fewest) {
  const std::size_t n = changes.size(), blocks = std::min<std::size_t>(most, given.motions.blocks);
  if (blocks < fewest) return INFINITY;
  std::vector<double> without;
  double mean = 0;
  Explained rest = given;
  for (std::size_t k = 0; k < blocks; ++k) {
    rest.fit.weights = given.fit.weights;
    for (std::size_t i = k * n / blocks; i < (k + 1) * n / blocks; ++i) rest.fit.weights[i] = 0;
    without.push_back(best_multiple(rest, changes, side));
    mean += without.back() / static_cast<double>(blocks);
  }
  double sum = 0;
  for (const double x : without) sum += (x - mean) * (x - mean);
  return std::sqrt(sum * static_cast<double>(blocks - 1) / static_cast<double>(blocks));
}

bool is_expected(double fitted, double expected, double stddev, double near, double sigmas,
                 double most_sigmas) {
  const double off = std::abs(fitted - expected);
  return off < near && std::abs(fitted) > sigmas * stddev &&
         off < std::max(most_sigmas * stddev, 0.25 * near);
}

Explained with_changes(const Explained& given, const Changes& changes, Side side,
                       const DiagnosisOptions& options) {
  Explained result{with_added(given.motions, changes, side), {}};
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

double way_in_a_row(const Evidence& evidence, Side side) {
  const Trajectory& rows = rows_of(evidence, side);
  const Motions& motions = evidence.given.explained.motions;
  const double seconds = to_seconds(rows.back().time_us - rows.front().time_us);
  const double of_motion = motions.stride * evidence.instants.period;
  return of_motion > 0 ? motions.translation / of_motion * seconds / static_cast<double>(rows.size() - 1) : 0;
}

}  // namespace egocal::detail
