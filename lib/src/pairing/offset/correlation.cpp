// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/correlation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace egocal::detail {

namespace {

/// Sums over the points that are known in both.
struct Sums {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
};

/// least: variances (times n) below these are rounding.
Correlation correlation_of(const Sums& s, std::ptrdiff_t lag, std::size_t least_count, double least_a = 0,
                           double least_b = 0) {
  if (s.n < static_cast<double>(std::max<std::size_t>(4, least_count))) return {0, 0, lag, s.n};
  const double va = s.aa - s.a * s.a / s.n, vb = s.bb - s.b * s.b / s.n;
  // the rounding left by numbers that cancel is no variance
  if (!(va > 1e-9 * s.aa && vb > 1e-9 * s.bb && va > least_a && vb > least_b)) return {0, 0, lag, s.n};
  const double r = std::clamp((s.ab - s.a * s.b / s.n) / std::sqrt(va * vb), -0.9999999, 0.9999999);
  return {r, std::atanh(r) * std::sqrt(s.n - 3), lag, s.n};
}

}  // namespace

Correlation correlation_at(std::span<const double> a, std::span<const double> b, std::size_t begin,
                           std::size_t end, std::ptrdiff_t lag, std::size_t least_count) {
  Sums sums;
  const auto size_a = static_cast<std::ptrdiff_t>(a.size());
  for (std::size_t j = begin; j < end; ++j) {
    const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(j) + lag;
    if (i < 0 || i >= size_a) continue;
    const double x = a[static_cast<std::size_t>(i)], y = b[j];
    if (x < 0 || y < 0) continue;
    sums.n += 1;
    sums.a += x;
    sums.b += y;
    sums.aa += x * x;
    sums.bb += y * y;
    sums.ab += x * y;
  }
  return correlation_of(sums, lag, least_count);
}

LagSearch::LagSearch(Series a, Series b, std::size_t least_count)
    : a_(std::move(a)),
      b_(std::move(b)),
      least_count_(least_count),
      size_(std::bit_ceil(std::max<std::size_t>(2, a_.size() + b_.size()))) {
  roots_.reserve(size_ / 2);
  for (std::size_t k = 0; k < size_ / 2; ++k)
    roots_.push_back(
        std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(size_)));
}

/// Packs two real series into one complex one: the values and whether they are known, or the squares.
std::vector<LagSearch::Complex> LagSearch::packed(const Series& series, bool squares) const {
  std::vector<Complex> values(size_);
  for (std::size_t i = 0; i < series.size(); ++i)
    if (series[i] >= 0) values[i] = squares ? Complex(series[i] * series[i]) : Complex(series[i], 1);
  return values;
}

/// Fourier transform in place, radix 2. back: the inverse one, without the division by the size.
void LagSearch::transform(std::vector<Complex>& values, bool back) const {
  for (std::size_t i = 1, j = 0; i < size_; ++i) {
    std::size_t bit = size_ >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(values[i], values[j]);
  }
  for (std::size_t length = 2; length <= size_; length *= 2) {
    const std::size_t half = length / 2, stride = size_ / length;
    for (std::size_t begin = 0; begin < size_; begin += length)
      for (std::size_t k = 0; k < half; ++k) {
        const Complex root = roots_[k * stride];
        const double re = root.real(), im = back ? -root.imag() : root.imag();
        Complex& low = values[begin + k];
        Complex& high = values[begin + k + half];
        const Complex turned(high.real() * re - high.imag() * im, high.real() * im + high.imag() * re);
        high = low - turned;
        low += turned;
      }
  }
}

bool LagSearch::next() {
  const int step = step_++;
  if (step < 4) {
    spectra_[step] = packed(step < 2 ? a_ : b_, step % 2 == 1);
    transform(spectra_[step], false);
    return false;
  }
  if (step < 7) {
    // the spectra of two real series that were transformed as one
    const auto values = [this](const std::vector<Complex>& f, std::size_t k) {
      return 0.5 * (f[k] + std::conj(f[(size_ - k) % size_]));
    };
    const auto known = [this](const std::vector<Complex>& f, std::size_t k) {
      return Complex(0, -0.5) * (f[k] - std::conj(f[(size_ - k) % size_]));
    };
    std::vector<Complex>& sums = sums_[step - 4];
    sums.resize(size_);
    constexpr Complex i(0, 1);
    for (std::size_t k = 0; k < size_; ++k) {
      const Complex a = values(spectra_[0], k), in_a = known(spectra_[0], k);
      const Complex b = std::conj(values(spectra_[2], k)), in_b = std::conj(known(spectra_[2], k));
      if (step == 4) sums[k] = in_a * in_b + i * (a * b);
      if (step == 5) sums[k] = a * in_b + i * (in_a * b);
      if (step == 6) sums[k] = spectra_[1][k] * in_b + i * (in_a * std::conj(spectra_[3][k]));
    }
    transform(sums, true);
    return false;
  }
  pick();
  return true;
}

void LagSearch::pick() {
  const double scale = 1.0 / static_cast<double>(size_);
  const auto rounding = [](const Series& series) {
    double energy = 0;
    for (const double value : series) energy += value > 0 ? value * value : 0;
    return 1e-9 * energy;
  };
  const double least_a = rounding(a_), least_b = rounding(b_);
  const auto end = static_cast<std::ptrdiff_t>(a_.size());
  significances_.reserve(a_.size() + b_.size());
  for (std::ptrdiff_t lag = first_lag(); lag < end; ++lag) {
    const std::size_t k = lag < 0 ? size_ - static_cast<std::size_t>(-lag) : static_cast<std::size_t>(lag);
    const Sums sums{std::round(scale * sums_[0][k].real()),
                    scale * sums_[1][k].real(),
                    scale * sums_[1][k].imag(),
                    scale * sums_[2][k].real(),
                    scale * sums_[2][k].imag(),
                    scale * sums_[0][k].imag()};
    const Correlation here = correlation_of(sums, lag, least_count_, least_a, least_b);
    significances_.push_back(static_cast<float>(here.significance));
    if (here.significance > best_.significance) best_ = here;
  }
  // rounding of the transforms is gone from the winner
  best_ = correlation_at(a_, b_, 0, b_.size(), best_.lag, least_count_);
}

std::vector<Peak> peaks_of(std::span<const float> significances, std::ptrdiff_t first_lag, double least,
                           double depth) {
  std::vector<Peak> peaks;
  bool rises = true;
  std::size_t top = 0, bottom = 0;
  const auto take = [&] {
    if (!significances.empty() && significances[top] >= least && significances[top] > 0)
      peaks.push_back({first_lag + static_cast<std::ptrdiff_t>(top), significances[top]});
  };
  for (std::size_t i = 0; i < significances.size(); ++i) {
    const double here = significances[i];
    if (rises && here > significances[top]) top = i;
    if (!rises && here < significances[bottom]) bottom = i;
    if (rises && here < significances[top] - depth) {
      take();
      rises = false;
      bottom = i;
    } else if (!rises && here > significances[bottom] + depth) {
      rises = true;
      top = i;
    }
  }
  if (rises) take();
  return peaks;
}

}  // namespace egocal::detail
