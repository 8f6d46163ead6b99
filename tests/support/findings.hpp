// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives whose verdict is looked at, and the findings of one.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// A minute with 1 % noise.
inline Streams drive(Terrain terrain, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 601;
  options.relative_noise = 0.01;
  options.seed = seed;
  return simulated_drive(options);
}

/// The finding of a code, or null.
inline const Finding* find(const Calibration& calibration, const std::string& code) {
  for (const Finding& finding : calibration.findings)
    if (finding.code == code) return &finding;
  return nullptr;
}

/// The finding of a code, which must be there and certain.
inline Finding certain_finding(const Calibration& calibration, const std::string& code) {
  const Finding* finding = find(calibration, code);
  EXPECT_NE(finding, nullptr) << code << ": " << calibration.reason;
  if (finding == nullptr) return {};
  EXPECT_TRUE(finding->certain) << finding->message;
  return *finding;
}

/// Expects that the answer of the finding is the right one, within the limits [rad, m], and that the one as
/// given is called contradictory.
inline void expect_cured(const Streams& right, const Calibration& calibration, const Finding& finding,
                         double rotation, double translation) {
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  ASSERT_TRUE(finding.T_a_b);
  const ExtrinsicError error = extrinsic_error(right.T, to_dual_quaternion(*finding.T_a_b));
  EXPECT_LT(error.rotation, rotation) << finding.message;
  EXPECT_LT(error.translation, translation) << finding.message;
}

}  // namespace egocal::testing
