// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bodies without a direction of travel, and bodies that do not travel at all.
#include <gtest/gtest.h>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/turning_bodies.hpp"
#include "egocal/calibrate.hpp"

namespace egocal {
namespace {

using testing::find;

// Its inverse goes along an arc about the origin: always the same way, as a car does.
TEST(TumblingBody, HasNoDirectionOfTravel) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const double drift : {0.05, 1.0}) {
      testing::Tumbling options;
      options.seed = seed;
      options.drift = drift;
      options.distance = seed % 3 == 0 ? 100 : 10;
      const testing::Streams streams = testing::tumbling(options);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
      for (const Finding& finding : calibration.findings)
        EXPECT_FALSE(finding.certain) << seed << ": " << finding.message;
    }
}

TEST(TumblingBody, IsNoVehicleThatWasReadInversely) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const testing::Streams streams = testing::drive(terrain, seed);
      const Calibration calibration = calibrate(testing::inverted(streams.a), testing::inverted(streams.b));
      const Finding* both = find(calibration, "inverted_both");
      ASSERT_NE(both, nullptr) << seed << ": " << calibration.reason;
      EXPECT_TRUE(both->certain) << seed;
    }
}

}  // namespace
}  // namespace egocal
