// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Random numbers of simulations and experiments: the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace egocal {

/// SplitMix64 and Box-Muller: the standard's distributions give other numbers in every library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// n > 0, and far below 2^64, or small numbers would be drawn more often.
  std::uint64_t below(std::uint64_t n) { return bits() % n; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  /// sigma: the standard deviation of each component.
  Eigen::Vector3d normal3(double sigma = 1) {
    const double x = normal(), y = normal(), z = normal();
    return sigma * Eigen::Vector3d(x, y, z);
  }
  Eigen::Vector3d direction() { return normal3().normalized(); }

 private:
  std::uint64_t state_;
};

}  // namespace egocal
