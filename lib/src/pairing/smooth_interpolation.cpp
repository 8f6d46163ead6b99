// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/smooth_interpolation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

namespace {

constexpr auto most = static_cast<int>(SynchroniserOptions::most_smooth_poses);
constexpr int polynomials = 4;  ///< a constant, a line, a parabola, a cubic

using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, most, 1>;

template <typename Values>
double middle_of(Values& values, std::size_t count) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), nth, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *nth;
}

/// How far the poses are from the instant, in typical periods. Empty where the periods are too uneven.
std::optional<Weights> places(std::span<const StampedPose> poses, double part,
                              const SynchroniserOptions& options) {
  const std::size_t n = poses.size(), before = n / 2 - 1;
  std::array<double, most> periods{};
  double longest = 0;
  for (std::size_t i = 1; i < n; ++i) {
    periods[i - 1] = static_cast<double>(poses[i].time_us - poses[i - 1].time_us);
    longest = std::max(longest, periods[i - 1]);
  }
  const double here = part * periods[before];
  const double period = middle_of(periods, n - 1);
  if (!(longest <= options.most_uneven * period)) return std::nullopt;
  Weights result(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i)
    result[static_cast<Eigen::Index>(i)] =
        (static_cast<double>(poses[i].time_us - poses[before].time_us) - here) / period;
  return result;
}

/// Weights of values at these places for the value at 0. They add up to one.
Weights kriging_weights(const Weights& places, double correlation_length) {
  const Eigen::Index n = places.size();
  const auto correlation = [&](double distance) {
    const double x = distance / correlation_length;
    return std::exp(-0.5 * x * x);
  };
  const double half = 0.5 * static_cast<double>(n);
  using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, most + polynomials,
                               most + polynomials>;
  using Side = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, most + polynomials, 1>;
  System system = System::Zero(n + polynomials, n + polynomials);
  Side side = Side::Zero(n + polynomials);
  for (Eigen::Index i = 0; i < n; ++i) {
    system(i, i) = 1 + 1e-6;  // without it equal places would have no solution
    for (Eigen::Index k = 0; k < i; ++k) system(i, k) = system(k, i) = correlation(places[i] - places[k]);
    double power = 1;
    for (Eigen::Index p = n; p < n + polynomials; ++p, power *= places[i] / half)
      system(i, p) = system(p, i) = power;
    side[i] = correlation(places[i]);
  }
  side[n] = 1;
  return Weights(system.partialPivLu().solve(side).head(n));
}

/// Seen from the pose before the instant.
using Seen = std::array<Pose, static_cast<std::size_t>(most)>;

/// Whether each pose is about where its neighbours are, in typical steps.
bool is_smooth(std::span<const StampedPose> poses, const Seen& seen, const SynchroniserOptions& options) {
  const std::size_t n = poses.size();
  std::array<double, most> lengths{}, angles{};
  std::array<Eigen::Vector3d, static_cast<std::size_t>(most)> turned;
  for (std::size_t i = 0; i < n; ++i) turned[i] = rotation_log(seen[i].rotation);
  for (std::size_t i = 1; i < n; ++i) {
    lengths[i - 1] = (seen[i].translation - seen[i - 1].translation).norm();
    angles[i - 1] = (turned[i] - turned[i - 1]).norm();
    if (lengths[i - 1] == 0 && angles[i - 1] == 0) return false;
  }
  const double length = middle_of(lengths, n - 1), angle = middle_of(angles, n - 1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double part = static_cast<double>(poses[i].time_us - poses[i - 1].time_us) /
                        static_cast<double>(poses[i + 1].time_us - poses[i - 1].time_us);
    const auto off = [part](const Eigen::Vector3d& from, const Eigen::Vector3d& at,
                            const Eigen::Vector3d& to) { return (at - from - part * (to - from)).norm(); };
    if (off(seen[i - 1].translation, seen[i].translation, seen[i + 1].translation) >
            options.most_rough * length ||
        off(turned[i - 1], turned[i], turned[i + 1]) > options.most_rough * angle)
      return false;
  }
  return true;
}

}  // namespace

std::optional<DualQuaternion> interpolate_smoothly(std::span<const StampedPose> poses, double part,
                                                   const SynchroniserOptions& options) {
  const std::optional<Weights> at = places(poses, part, options);
  if (!at) return std::nullopt;
  const std::size_t n = poses.size();
  const DualQuaternion& from = poses[n / 2 - 1].pose;
  Seen seen;
  for (std::size_t i = 0; i < n; ++i) {
    seen[i] = to_pose(conjugate(from) * poses[i].pose);
  }
  if (!is_smooth(poses, seen, options)) return std::nullopt;
  const Weights weights = kriging_weights(*at, options.correlation_length);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero(), moved = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    turned += weight * rotation_log(seen[i].rotation);
    moved += weight * seen[i].translation;
  }
  return normalized(from * to_dual_quaternion({rotation_exp(turned), moved}));
}

}  // namespace egocal::detail
