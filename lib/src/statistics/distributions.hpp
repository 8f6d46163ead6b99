// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace egocal::detail {

/// 95 % of a normal distribution is within this many standard deviations (mathematics).
inline constexpr double two_sided_95 = 1.96;

/// Probability that a variable with the F distribution of (d1, d2) degrees of freedom exceeds f. 1 for f <= 0
/// or no degrees of freedom; to about 1e-12.
double f_exceeded(double f, double d1, double d2);

/// Probability that Hotelling's T^2 of p dimensions with nu degrees of freedom of its covariance exceeds t2.
double hotelling_exceeded(double t2, double p, double nu);

/// Student's t(0.975) over the normal 1.96: by how much a standard deviation with this many degrees of
/// freedom
/// (> 0) is raised, so that 1.96 of it cover 95 %. The first terms of the expansion in 1 / freedom: to 0.3 %
/// from five degrees on, to 3 % from two; below two it is too small.
double student_factor(double freedom);

}  // namespace egocal::detail
