// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Everything that a user of the library needs: read two trajectories, call calibrate(), look at the
/// Calibration. examples/ holds complete programs.

#include "egocal/calibrate.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/io/pairs_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/version.hpp"
