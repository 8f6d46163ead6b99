// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace egocal::detail {

/// Probability that a variable with the F distribution of (d1, d2) degrees of freedom exceeds f. 1 for f <= 0
/// or no degrees of freedom; to about 1e-12.
double f_exceeded(double f, double d1, double d2);

/// Probability that Hotelling's T^2 of p dimensions with nu degrees of freedom of its covariance exceeds t2.
double hotelling_exceeded(double t2, double p, double nu);

}  // namespace egocal::detail
