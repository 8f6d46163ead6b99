// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "problem/tangent.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

/// Variances by omitting blocks of unequal length m of n pairs (delete-m_j jack-knife, Busing et al. 1999).
class VarianceByBlocks {
 public:
  explicit VarianceByBlocks(double pairs) : pairs_(pairs) {}
  /// difference: estimate without the block minus estimate with all.
  void leave_out(double block_pairs, const Vector6d& difference) {
    const double h = pairs_ / block_pairs;
    const Vector6d pseudo = -(h - 1) * difference;  // pseudo value minus the estimate with all
    count_ += 1;
    sum_ += pseudo / h;
    squares_ += pseudo.cwiseAbs2() / (h - 1);
    cross_ += pseudo / (h - 1);
    weights_ += 1 / (h - 1);
  }
  double count() const { return count_; }
  /// Mean of (pseudo - mean)^2 / (h - 1).
  Vector6d spread() const {
    return (squares_ - 2 * sum_.cwiseProduct(cross_) + sum_.cwiseAbs2() * weights_) / count_;
  }
  /// The variance with Student's factor: 1.96 of its roots cover 95 % whatever the number of blocks.
  Vector6d variance() const {
    const double student = student_factor(count_ - 1);
    return student * student * spread();
  }

 private:
  double pairs_, count_ = 0, weights_ = 0;
  Vector6d sum_ = Vector6d::Zero(), squares_ = Vector6d::Zero(), cross_ = Vector6d::Zero();
};

/// VarianceByBlocks, with what few blocks hold and what neighbours share.
class Jackknife {
 public:
  /// Largest lag of the correlations that count, in blocks. Each further lag adds chance; with three instead
  /// of four, noise on poses and on motions in drives of 20 motions is covered to 90.5 instead of 91.5 %
  /// (docs/intervals.md).
  static constexpr std::size_t most_lag = 4;

  explicit Jackknife(double pairs) : by_blocks_(pairs) {}
  /// difference: estimate without the block minus estimate with all. information: what part of what is known
  /// of each direction the block holds, up to a common factor. parts: the difference in other coordinates, of
  /// which the correlations are. The more independent they are, the less of the correlations is chance.
  void leave_out(double block_pairs, const Vector6d& difference, const Vector6d& information,
                 const Vector6d& parts) {
    by_blocks_.leave_out(block_pairs, difference);
    information_ += information;
    information_squares_ += information.cwiseAbs2();
    neighbours_.add(parts);
    changes_.add(difference);
  }
  double count() const { return by_blocks_.count(); }
  Vector6d spread() const { return by_blocks_.spread(); }
  Vector6d variance() const { return by_blocks_.variance(); }
  /// How many equal blocks are as concentrated, see concentration(): the mean over the directions about which
  /// the blocks hold information. m below.
  double mean_equal_blocks(double least) const {
    double sum = 0, directions = 0;
    for (int i = 0; i < 6; ++i) {
      if (!(information_squares_[i] > 0)) continue;
      sum += equal_blocks(i, least);
      directions += 1;
    }
    return directions > 0 ? sum / directions : count();
  }
  /// Lag-one correlation of errors that last, from that of what omitting a block changes: the mean over the
  /// parts that change at all. shared: what neighbours correlate by where no error lasts, which is taken off.
  /// In m equal blocks, seen from their own mean, a correlation of r is found as r - (1 + 3 r) / m on average
  /// (Kendall 1954). This is undone, its part 3 r / m only for errors that last. If it were undone for what
  /// is shared as well, noise on the motions of one sensor and the poses of the other would have r = 0.37,
  /// not 0.18, in 100 motions, as m is less than the number of blocks that touch (docs/intervals.md, "Noise
  /// that lasts").
  double correlation_of_neighbours(double shared, double m) const {
    return mean_over_parts([&](int i) { return lasting(neighbours_.correlation(i, 1), shared, m); });
  }
  /// The same of what changes in one direction; empty where nothing does.
  std::optional<double> correlation_in_direction(int direction, double shared, double m) const {
    return lasting(changes_.correlation(direction, 1), shared, m);
  }
  /// Standard error by chance of correlation_of_neighbours() where that is r: one of m blocks has
  /// sqrt((1 - r^2) / m) (Bartlett 1946), and the parts are independent.
  double error_of_correlation(double r, double m) const {
    return std::sqrt(1 - r * r) * error_of_independent(m) / part_found(m);
  }
  /// Sum of the correlations of blocks up to most_lag apart, averaged over the parts. The mean of the blocks
  /// takes about 1 / m from each, which is corrected.
  double sum_of_correlations(double m) const {
    return mean_over_parts([&](int i) -> std::optional<double> {
      double sum = 0;
      for (std::size_t lag = 1; lag <= most_lag && neighbours_.count > lag + 2; ++lag) {
        const std::optional<double> found = neighbours_.correlation(i, lag);
        if (!found) return std::nullopt;
        sum += *found + 1 / m;
      }
      return sum;
    });
  }
  /// Standard error by chance of sum_of_correlations(), where nothing correlates.
  double error_of_sum(double m) const {
    return std::sqrt(static_cast<double>(most_lag)) * error_of_independent(m);
  }
  /// Factor of the standard deviations where few of the n blocks hold all that is known of a direction (one
  /// turn in the drive): m = (sum of c)^2 / sum of c^2 equal blocks are as concentrated. The factor is
  /// Student's for about m degrees of freedom (Satterthwaite 1946), times the root of the ratio of (m - 1) /
  /// m to (n - 1) / n, the part by which the jack-knife over m overestimates. One where all blocks hold
  /// alike.
  Vector6d concentration(double least_equal_blocks) const {
    Vector6d factor;
    for (int i = 0; i < 6; ++i) {
      const double m = equal_blocks(i, least_equal_blocks);
      factor[i] = student_factor(m - m / count()) / student_factor(count() - 1) *
                  std::sqrt((m - 1) / m * count() / (count() - 1));
    }
    return factor;
  }

 private:
  /// How many equal blocks are as concentrated in a direction.
  double equal_blocks(int direction, double least) const {
    const double squares = information_squares_[direction], sum = information_[direction];
    return std::clamp(squares > 0 ? sum * sum / squares : count(), least, count());
  }

  /// Standard error of the mean over the parts of a correlation at one lag, where nothing correlates.
  double error_of_independent(double m) const {
    double parts = 0;
    for (int i = 0; i < 6; ++i) parts += neighbours_.changes(i);
    return 1 / std::sqrt(m * std::max(1.0, parts));
  }

  /// What is found of r in m blocks as seen from their own mean: with six blocks half of it.
  static double part_found(double m) { return std::max(0.5, 1 - 3 / m); }

  /// See correlation_of_neighbours().
  static std::optional<double> lasting(std::optional<double> found, double shared, double m) {
    if (found) found = (*found + 1 / m - shared) / ((1 - shared) * part_found(m));
    return found;
  }

  /// of_part: empty where it does not count.
  template <typename Value>
  static double mean_over_parts(const Value& of_part) {
    double sum = 0, parts = 0;
    for (int i = 0; i < 6; ++i) {
      const std::optional<double> value = of_part(i);
      if (!value) continue;
      sum += *value;
      parts += 1;
    }
    return parts > 0 ? sum / parts : 0;
  }

  /// Sums of parts and of products of those that are up to `most` blocks apart.
  template <std::size_t most>
  struct Neighbours {
    std::size_t count = 0;
    std::array<Vector6d, most> last;   ///< number k at place k % most
    std::array<Vector6d, most> first;  ///< the sums of the first 1, 2, ...
    std::array<Vector6d, most> products;
    Vector6d sum = Vector6d::Zero(), squares = Vector6d::Zero();

    Neighbours() {
      for (auto* vectors : {&last, &first, &products}) vectors->fill(Vector6d::Zero());
    }
    void add(const Vector6d& parts) {
      sum += parts;
      squares += parts.cwiseAbs2();
      if (count < most) first[count] = sum;
      for (std::size_t lag = 1; lag <= std::min<std::size_t>(count, most); ++lag)
        products[lag - 1] += last[(count - lag) % most].cwiseProduct(parts);
      last[count % most] = parts;
      ++count;
    }
    double variance(int part) const {
      return squares[part] - sum[part] * sum[part] / static_cast<double>(count);
    }
    /// Whether omitting blocks changes this part; false where a block cannot be omitted.
    bool changes(int part) const { return variance(part) > 0 && std::isfinite(variance(part)); }
    /// Correlation at this lag; there must be more blocks than it. Empty: nothing changes, or a block cannot
    /// be omitted.
    std::optional<double> correlation(int part, std::size_t lag) const {
      const double blocks = static_cast<double>(count), pairs = static_cast<double>(count - lag);
      if (!changes(part)) return std::nullopt;
      const double total = sum[part], mean = total / blocks;
      double of_last = 0;
      for (std::size_t k = 1; k <= lag; ++k) of_last += last[(count - k) % most][part];
      const double of_pairs = 2 * total - first[lag - 1][part] - of_last;
      return (products[lag - 1][part] - mean * of_pairs + pairs * mean * mean) / variance(part);
    }
  };

  VarianceByBlocks by_blocks_;
  Vector6d information_ = Vector6d::Zero(), information_squares_ = Vector6d::Zero();
  Neighbours<most_lag> neighbours_;
  Neighbours<1> changes_;
};

}  // namespace egocal::detail
