// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "certificate/reach.hpp"
#include "egocal/certificate/certificate.hpp"

namespace egocal::detail {

/// One answer to one quadratic problem: 3-D in all eight variables, planar in q1, q4, q6, q7. Q symmetric, v
/// a unit dual quaternion, lengths in a unit near length_scale().
template <int N>
struct Subject {
  Square<N> Q;
  Column<N> v;
  Sizes sizes;            ///< of the whole 8 x 8 matrix: entries of other variables may have cancelled
  double orthogonal = 0;  ///< lambda_2, proposed
};

/// A lower bound that holds with this multiplier.
struct ProvenBound {
  double bound = 0;
  double orthogonal = 0;
};

/// The first proposal of a bound for an answer of this cost.
inline double first_proposal(double cost, double rounding) {
  return cost - 0.25 * rounding;
}

/// Cost, bound, gap, reach and verdict; lengths stay in the subject's unit. The multiplier is a proposal:
/// whatever it is, the bound is proven. known: proven already, with the subject's multiplier.
template <int N>
Certificate assess(const Subject<N>& subject, const CertificateOptions& options,
                   const std::optional<ProvenBound>& known = std::nullopt);

/// The same with a bound that was proven otherwise.
template <int N>
void set_bound(const Subject<N>& subject, const ProvenBound& proven, const CertificateOptions& options,
               Certificate& certificate);

extern template Certificate assess<8>(const Subject<8>&, const CertificateOptions&,
                                      const std::optional<ProvenBound>&);
extern template Certificate assess<4>(const Subject<4>&, const CertificateOptions&,
                                      const std::optional<ProvenBound>&);
extern template void set_bound<8>(const Subject<8>&, const ProvenBound&, const CertificateOptions&,
                                  Certificate&);

/// The largest of a few proposals below `cost` that can be proven with this multiplier and lift.
template <int N>
std::optional<ProvenBound> best_bound(const Square<N>& Q, double cost, double rounding, double orthogonal,
                                      double lift) {
  for (const double step : {0.25, 0.9, 16.0, 256.0, 4096.0, 65536.0}) {
    const double bound = step == 0.25 ? first_proposal(cost, rounding) : cost - step * rounding;
    if (proven_bound<N>(Q, bound, orthogonal, lift)) return ProvenBound{bound, orthogonal};
  }
  return std::nullopt;
}

}  // namespace egocal::detail
