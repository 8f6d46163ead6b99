// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace egocal::detail {

/// A series on a grid; negative where not known.
using Series = std::vector<double>;

/// Pearson's correlation of two series where both are known.
struct Correlation {
  double value = 0;
  double significance = 0;  ///< in standard deviations of chance, taking every point as independent
  std::ptrdiff_t lag = 0;   ///< grid points by which b was shifted to the right
  double count = 0;         ///< points that are known in both
};

/// Correlation of a and the points [begin, end) of b, shifted by `lag`. Zero if fewer than least_count points
/// are known in both.
Correlation correlation_at(std::span<const double> a, std::span<const double> b, std::size_t begin,
                           std::size_t end, std::ptrdiff_t lag, std::size_t least_count);

/// Finds the most significant correlation over all lags at which the series overlap, in n log n by Fourier
/// transforms. In steps, as one takes as long as n poses: call next() until it returns true, then best().
class LagSearch {
 public:
  LagSearch(Series a, Series b, std::size_t least_count);
  bool next();
  const Correlation& best() const { return best_; }
  /// Significance of every lag, from first_lag() on, to the rounding of the transforms.
  const std::vector<float>& significances() const { return significances_; }
  std::ptrdiff_t first_lag() const { return -static_cast<std::ptrdiff_t>(b_.size()) + 1; }
  std::size_t size() const { return size_; }  ///< of a transform

 private:
  using Complex = std::complex<double>;
  std::vector<Complex> packed(const Series& series, bool squares) const;
  void transform(std::vector<Complex>& values, bool back) const;
  void pick();

  Series a_, b_;
  std::size_t least_count_, size_;
  int step_ = 0;
  std::vector<Complex> roots_;
  std::vector<Complex> spectra_[4];  ///< of a + i known, a^2, b + i known, b^2
  std::vector<Complex> sums_[3];     ///< by lag: (n, sum ab), (sum a, sum b), (sum aa, sum bb)
  Correlation best_;
  std::vector<float> significances_;
};

/// A lag at which a correlation is larger than around it.
struct Peak {
  std::ptrdiff_t lag = 0;
  double significance = 0;
};
/// The peaks of at least this height, in the order of their lags. Between two peaks the significance falls by
/// `depth` and rises again, so noise on a wide peak makes no peaks.
std::vector<Peak> peaks_of(std::span<const float> significances, std::ptrdiff_t first_lag, double least,
                           double depth);

}  // namespace egocal::detail
