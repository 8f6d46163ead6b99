// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/written_digits.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/reading.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

double Digits::step(double size) const {
  const double by_decimals = decimals > 0 ? std::pow(10, -decimals) : 0;
  const double by_digits =
      significant > 0 && size > 0 ? std::pow(10, std::floor(std::log10(size)) + 1 - significant) : 0;
  return std::max(by_decimals, by_digits);
}

namespace {

/// Whether a number is a multiple of the step, to the rounding of doubles of this size.
bool is_multiple(double number, double step, double size) {
  const double multiple = number / step;
  const double tolerance = 1e-6 + 4e-15 * size / step;
  return tolerance < 0.01 && std::abs(multiple - std::round(multiple)) < tolerance;
}

/// Positions, as they come.
struct Coordinates {
  const Trajectory& trajectory;

  bool written_with(std::size_t i, const Digits& digits) const {
    const Eigen::Vector3d p = position_of(trajectory[i].pose);
    const double size = p.cwiseAbs().maxCoeff();
    return std::all_of(p.begin(), p.end(), [&](double x) {
      const double step = digits.step(std::abs(x));
      return !(step > 0) || is_multiple(x, step, size);
    });
  }
  double largest_telling(std::size_t i, const Digits&) const {
    return position_of(trajectory[i].pose).cwiseAbs().maxCoeff();
  }
};

/// Quaternions. Those of a file were not quite of unit length; they are up to a factor near one, by which the
/// largest component is such a number.
struct Components {
  const Trajectory& trajectory;

  bool written_with(std::size_t i, const Digits& digits) const {
    const QuaternionVector& q = trajectory[i].pose.real;
    const double largest = q.cwiseAbs().maxCoeff(), step = digits.step(largest);
    if (!(step > 0)) return true;
    for (int more = -2; more <= 2; ++more) {
      const double factor = (std::round(largest / step) + more) * step / largest;
      if (std::all_of(q.begin(), q.end(), [&](double x) {
            const double number = factor * x, of_this = digits.step(std::abs(number));
            return std::abs(x) < 1e-15 || is_multiple(number, of_this, 1);
          }))
        return true;
    }
    return false;
  }
  /// One has a single digit however many were written: so has the scalar part of all small rotations.
  double largest_telling(std::size_t i, const Digits& digits) const {
    double largest = 0;
    for (const double x : trajectory[i].pose.real.cwiseAbs())
      if (x < 1 - 0.5 * std::pow(10, -digits.decimals)) largest = std::max(largest, x);
    return largest;
  }
};

/// Elements of the rotation matrices that quaternions were made from, as sums and differences of two. That is
/// done by the scalar part where it is large, and by the largest of the others elsewhere; the matrices were
/// not quite orthonormal, and the quaternions are up to a factor near one, as above.
struct Elements {
  const Trajectory& trajectory;

  bool written_with(std::size_t i, const Digits& digits) const {
    const QuaternionVector& q = trajectory[i].pose.real;  // w x y z
    const double step = digits.step(1);
    Eigen::Index by = 0;
    if (4 * q[0] * q[0] <= 1) {
      q.tail<3>().cwiseAbs().maxCoeff(&by);
      ++by;
    }
    const QuaternionVector products = 4 * q[by] * q;
    for (int more = -4; more <= 4; ++more) {  // steps: one of each of three elements, and one of the others
      const double factor = (std::round(products[by] / step) + more) * step / products[by];
      if (std::all_of(products.begin(), products.end(),
                      [&](double x) { return is_multiple(factor * x, step, 1); }))
        return true;
    }
    return false;
  }
};

std::size_t distance_of_looks(std::size_t poses, const WrittenDigitsOptions& options) {
  return std::max<std::size_t>(1, poses / options.looked_at);
}

std::size_t most_others(std::size_t poses, const WrittenDigitsOptions& options) {
  return static_cast<std::size_t>(options.most_others *
                                  static_cast<double>(std::min(poses, options.looked_at)));
}

template <typename Numbers>
bool all_have(const Digits& digits, const Numbers& numbers, const WrittenDigitsOptions& options) {
  const std::size_t n = numbers.trajectory.size(), each = distance_of_looks(n, options);
  std::size_t looked = 0, others = 0;
  for (std::size_t i = 0; i < n; i += each, ++looked)
    if (!numbers.written_with(i, digits) && ++others > most_others(n, options)) return false;
  return looked >= options.fewest;
}

/// Whether the significant digits say more than the decimals do: some numbers have room for more digits and
/// do not use it. 0.004 says nothing, as three decimals leave it one digit.
template <typename Numbers>
bool tell_more_than_decimals(const Digits& digits, const Numbers& numbers,
                             const WrittenDigitsOptions& options) {
  if (digits.decimals == 0) return true;
  const double more_digits = std::pow(10, digits.significant - digits.decimals);
  const std::size_t n = numbers.trajectory.size(), each = distance_of_looks(n, options);
  std::size_t telling = 0;
  for (std::size_t i = 0; i < n; i += each)
    if (numbers.largest_telling(i, digits) > more_digits * (1 - 1e-6)) ++telling;
  return telling > 2 * most_others(n, options);  // of the others, which have more digits, and of these
}

template <typename Numbers>
int decimals_of(const Numbers& numbers, const WrittenDigitsOptions& options) {
  for (int count = 1; count <= options.most_digits; ++count)
    if (all_have({count, 0}, numbers, options)) return count;
  return 0;
}

template <typename Numbers>
Digits digits_of(const Numbers& numbers, const WrittenDigitsOptions& options) {
  Digits result{decimals_of(numbers, options), 0};
  for (int count = 1; count <= options.most_digits && result.significant == 0; ++count)
    if (all_have({0, count}, numbers, options)) result.significant = count;
  if (!tell_more_than_decimals(result, numbers, options)) result.significant = 0;
  return result;
}

}  // namespace

Written written(const Trajectory& trajectory, const WrittenDigitsOptions& options) {
  return {digits_of(Coordinates{trajectory}, options), digits_of(Components{trajectory}, options)};
}

Digits digits_of_matrices(const Trajectory& trajectory, const WrittenDigitsOptions& options) {
  // decimals alone: each is a sum of two elements, which may have digits of other sizes
  return {decimals_of(Elements{trajectory}, options), 0};
}

}  // namespace egocal::detail
