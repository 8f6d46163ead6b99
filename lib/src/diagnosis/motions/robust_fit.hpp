// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How well one extrinsic explains motions, and whether one explanation fits better than another.
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"

namespace egocal::detail {

/// Rotation angle [rad] and length [m] by which R_a T and T R_b differ.
struct Residual {
  double rotation = 0;
  double translation = 0;
};

struct RobustFit {
  DualQuaternion T;             ///< extrinsic
  std::vector<double> squares;  ///< per motion: squared residual in units of the typical motion
  std::vector<double> weights;  ///< per motion: 1 for inliers, towards 0 for outliers
  double typical = 0;           ///< median of the squares, over the motion rather than over time
};

Residual residual_at(const Motion& motion, const Pose& T);

/// Squares and typical of a given extrinsic; weights all one.
RobustFit evaluated(const Motions& motions, const DualQuaternion& T);
/// Residual that the better third of the motion keeps below, as a part of the typical motion. A fifth of
/// wrong poses in each stream affects up to two thirds of the motions; what contradicts, contradicts
/// everywhere.
double misfit(const Motions& motions, const RobustFit& fit);
/// Residual that the better half of the motion keeps below, otherwise as misfit(): of motions that contradict
/// in one direction alone, a third may fit.
double median_misfit(const Motions& motions, const RobustFit& fit);
/// The extrinsic by iteratively reweighted global solves of (18).
RobustFit robust_fit(const Motions& motions, const RobustFitOptions& options = {});

/// The extrinsic as by robust_fit(), with two rounds and without weights: a first look.
RobustFit quick_fit(const Motions& motions, const RobustFitOptions& options = {});

/// An explanation's motions with the extrinsic that suits them best.
struct Explained {
  Motions motions;
  RobustFit fit;
};

/// Explanation y against x of the same drive.
struct Comparison {
  double gain =
      0;  ///< mean of log(square of x / square of y), above a floor of noise: > 0 where y fits better
  double sigmas = 0;  ///< of Wilcoxon's signed-rank test over consecutive blocks of the drive; > 0 for y
  double most = 0;    ///< the most sigmas that this number of blocks can show
  double ratio = 1;   ///< of the mean squares of inliers, x / y
};
Comparison compare(const Explained& x, const Explained& y);

/// Mean of log(squared residual of the translation of y / of x) [m^2]: > 0 where x fits better in metres,
/// however long its motions are. The same motions, under two readings; 0 where they are not.
double loss_in_metres(const Explained& x, const Explained& y);

/// The value below which `part` of the total weight lies.
double weighted_quantile(std::vector<std::pair<double, double>> values_weights, double part);
double weighted_median(std::vector<std::pair<double, double>> values_weights);

}  // namespace egocal::detail
