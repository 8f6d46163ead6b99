// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions where the positions of one stream change by what its rows say: a number times what each row adds.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// The poses of one stream as its file has them.
const Trajectory& rows_of(const Evidence& evidence, Side side);

/// What is added to the position of a row, in the stream's world [m]. Called for all rows, in order.
using AddedToRow = std::function<Eigen::Vector3d(std::size_t row)>;

/// What each motion as given changes by, in the frame of its begin [m], of a stream of two rows at least.
std::vector<Eigen::Vector3d> changes_of_rows(const Evidence& evidence, Side side, const AddedToRow& added);

/// The multiple of these changes that suits the motions best.
double best_multiple(const Explained& given, const std::vector<Eigen::Vector3d>& changes, Side side);

/// Its standard deviation, where parts of the drive are omitted in turn, at most `most` of them; infinite
/// where the drive has fewer than `fewest`.
double jack_knife(const Explained& given, const std::vector<Eigen::Vector3d>& changes, Side side,
                  unsigned most, unsigned fewest);

/// Whether a fitted number is the expected one, and not none: less than `near` from it, more than `sigmas` of
/// its standard deviations from zero, and at most `most_sigmas` of them, or a quarter of `near`, from what is
/// expected.
bool is_expected(double fitted, double expected, double stddev, double near, double sigmas,
                 double most_sigmas);

/// The motions changed once, and what explains them.
Explained with_changes(const Explained& given, const std::vector<Eigen::Vector3d>& changes, Side side,
                       const DiagnosisOptions& options);

/// The way in the usual row of a stream [m].
double way_in_a_row(const Evidence& evidence, Side side);

}  // namespace egocal::detail
