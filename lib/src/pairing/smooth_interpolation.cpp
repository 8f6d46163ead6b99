// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/smooth_interpolation.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace egocal::detail {

namespace {

constexpr std::size_t most_poses = SynchroniserOptions::most_smooth_poses;
constexpr std::size_t polynomials = 4;  ///< a constant, a line, a parabola, a cubic
constexpr double nugget = 1e-6;         ///< poses of nearly one time would have no solution

using Values = std::array<double, most_poses>;

/// The value at count / 2 of the sorted values, found by counting smaller ones, which is fast for so few.
double median_of(const Values& values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t smaller = 0, equal = 0;
    for (std::size_t k = 0; k < count; ++k) {
      smaller += values[k] < values[i] ? 1 : 0;
      equal += values[k] == values[i] ? 1 : 0;
    }
    if (smaller <= count / 2 && count / 2 < smaller + equal) return values[i];
  }
  return values[count / 2];
}

/// Distances of the poses from the instant, in typical periods. Empty: the periods are too uneven.
std::optional<Values> places_of(std::span<const StampedPose> poses, double part,
                                const SynchroniserOptions& options) {
  const std::size_t n = poses.size(), before = n / 2 - 1;
  Values periods{}, places{};
  for (std::size_t i = 1; i < n; ++i)
    periods[i - 1] = static_cast<double>(poses[i].time_us - poses[i - 1].time_us);
  const double period = median_of(periods, n - 1);
  const auto [shortest, longest] =
      std::minmax_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(n - 1));
  if (!(*longest <= options.most_uneven * period && *shortest * options.most_uneven >= period &&
        periods[before] <= options.most_uneven_here * period))
    return std::nullopt;
  for (std::size_t i = 0; i < n; ++i)
    places[i] =
        (static_cast<double>(poses[i].time_us - poses[before].time_us) - part * periods[before]) / period;
  return places;
}

/// Weights of the values at n places for the value at 0: the first n of [K F; F' 0]^-1 [k; f], which add up
/// to one. K is positive definite and F has full rank, so L D L' of the whole needs no exchange of rows. What
/// is known of a column is taken off all that follows at once: the numbers of a column do not wait for each
/// other. n comes as a constant where it can, which makes the loops short.
[[gnu::always_inline]] inline Values kriging_weights_of(const Values& places, std::size_t n,
                                                        double correlation_length) {
  constexpr std::size_t largest = most_poses + polynomials;
  const std::size_t size = n + polynomials;
  const double half = 0.5 * static_cast<double>(n);
  const double falls = -0.5 / (correlation_length * correlation_length);
  const auto correlation = [falls](double distance) { return std::exp(falls * distance * distance); };
  double L[largest][largest];  // column by column
  double D[largest], x[largest], inverse[largest], scaled[largest];
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) L[k][i] = correlation(places[i] - places[k]);
    D[i] = 1 + nugget;
    x[i] = correlation(places[i]);
    double power = 1;
    for (std::size_t p = n; p < size; ++p, power *= places[i] / half) L[i][p] = power;
  }
  for (std::size_t p = n; p < size; ++p) {
    for (std::size_t k = n; k < p; ++k) L[k][p] = 0;
    D[p] = 0;
    x[p] = p == n ? 1 : 0;
  }
  for (std::size_t j = 0; j < size; ++j) {
    inverse[j] = 1 / D[j];
    for (std::size_t i = j + 1; i < size; ++i) {
      scaled[i] = L[j][i];
      L[j][i] = scaled[i] * inverse[j];
      D[i] -= scaled[i] * L[j][i];
      x[i] -= L[j][i] * x[j];
    }
    for (std::size_t k = j + 1; k < size; ++k)
      for (std::size_t i = k + 1; i < size; ++i) L[k][i] -= scaled[i] * L[j][k];
  }
  for (std::size_t i = size; i-- > 0;) {
    x[i] *= inverse[i];
    for (std::size_t k = i + 1; k < size; ++k) x[i] -= L[i][k] * x[k];
  }
  Values weights{};
  std::copy_n(x, n, weights.begin());
  return weights;
}

Values kriging_weights(const Values& places, std::size_t n, double correlation_length) {
  constexpr std::size_t usual = SynchroniserOptions{}.smooth_poses;
  return n == usual ? kriging_weights_of(places, usual, correlation_length)
                    : kriging_weights_of(places, n, correlation_length);
}

/// A pose as seen from the one before the instant: twice the vector part of the rotation, which is its angle
/// about its axis for small ones and needs no trigonometry; the position in the axes of the world [m].
struct Seen {
  Eigen::Vector3d turned, moved;
};
using SeenPoses = std::array<Seen, most_poses>;

Eigen::Vector3d position(const DualQuaternion& pose) {
  return 2 * quaternion_product(pose.dual, quaternion_conjugate(pose.real)).tail<3>();
}

SeenPoses seen_from(std::span<const StampedPose> poses, const QuaternionVector& rotation,
                    const Eigen::Vector3d& origin) {
  SeenPoses seen;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const QuaternionVector turned = quaternion_product(rotation, poses[i].pose.real);
    seen[i] = {(turned[0] < 0 ? -2 : 2) * turned.tail<3>(), position(poses[i].pose) - origin};
  }
  return seen;
}

/// Whether each pose is about where its neighbours predict it, in typical steps.
bool is_smooth(const SeenPoses& seen, const Values& places, std::size_t n,
               const SynchroniserOptions& options) {
  Values lengths{}, angles{};
  for (std::size_t i = 1; i < n; ++i) {
    lengths[i - 1] = (seen[i].moved - seen[i - 1].moved).norm();
    angles[i - 1] = (seen[i].turned - seen[i - 1].turned).norm();
    if (lengths[i - 1] == 0 && angles[i - 1] == 0) return false;
  }
  const double longest = options.most_rough * median_of(lengths, n - 1),
               largest = options.most_rough * median_of(angles, n - 1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double part = (places[i] - places[i - 1]) / (places[i + 1] - places[i - 1]);
    const auto off = [&](Eigen::Vector3d Seen::*value) {
      const Eigen::Vector3d &from = seen[i - 1].*value, &to = seen[i + 1].*value;
      return (seen[i].*value - from - part * (to - from)).norm();
    };
    if (off(&Seen::moved) > longest || off(&Seen::turned) > largest) return false;
  }
  return true;
}

}  // namespace

std::optional<DualQuaternion> interpolate_smoothly(std::span<const StampedPose> poses, double part,
                                                   const SynchroniserOptions& options) {
  const std::optional<Values> places = places_of(poses, part, options);
  if (!places) return std::nullopt;
  const std::size_t n = poses.size();
  const DualQuaternion& from = poses[n / 2 - 1].pose;
  const Eigen::Vector3d origin = position(from);
  const SeenPoses seen = seen_from(poses, quaternion_conjugate(from.real), origin);
  if (!is_smooth(seen, *places, n, options)) return std::nullopt;
  const Values weights = kriging_weights(*places, n, options.correlation_length);
  Seen here{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < n; ++i) {
    here.turned += 0.5 * weights[i] * seen[i].turned;
    here.moved += weights[i] * seen[i].moved;
  }
  const double squares = here.turned.squaredNorm();
  if (!(squares < 1)) return std::nullopt;
  QuaternionVector turned;
  turned << std::sqrt(1 - squares), here.turned;
  DualQuaternion pose;
  pose.real = quaternion_product(from.real, turned);
  QuaternionVector moved;
  moved << 0, origin + here.moved;
  pose.dual = 0.5 * quaternion_product(moved, pose.real);
  return normalized(pose);
}

}  // namespace egocal::detail
