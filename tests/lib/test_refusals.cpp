// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What calibrate() says where it refuses streams.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"

namespace egocal::test_refusals {
namespace {

/// Every step-th pose from the first one on.
Trajectory every(const Trajectory& poses, std::size_t first, std::size_t step) {
  Trajectory result;
  for (std::size_t i = first; i < poses.size(); i += step) result.push_back(poses[i]);
  return result;
}

std::string refusal(const Trajectory& a, const Trajectory& b, double max_gap) {
  CalibrationOptions options;
  options.pairing.max_gap = max_gap;
  try {
    calibrate(a, b, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Refusals, StreamsThatAreTooSlowAreToldOfTheLongestGap) {
  const testing::Streams data =
      testing::simulated_drive({.terrain = Terrain::free, .poses = 1200, .rate = 10, .seed = 3});
  const Trajectory a = every(data.a, 0, 10), b = every(data.b, 4, 20);
  const std::string said = refusal(a, b, 0.5);
  EXPECT_NE(said.find("the median time between poses is 1 s in a and 2 s in b, but nothing is interpolated "
                      "over more than 0.5 s: --max-gap SECONDS allows more"),
            std::string::npos)
      << said;
  EXPECT_EQ(refusal(a, b, 2.5), "");
  // slow streams of the same stamps are not interpolated
  EXPECT_EQ(refusal(a, every(data.b, 0, 10), 0.5), "");
  // other times are another cause
  Trajectory later = b;
  for (StampedPose& pose : later) pose.time_us += 1'000'000'000;
  EXPECT_EQ(refusal(a, later, 0.5).find("--max-gap"), std::string::npos);
}

// A few instants have both poses by chance, too few to judge: a longer drive has no more of them.
TEST(Refusals, StreamsThatAreTooSlowButForAFewPosesAreToldOfTheLongestGap) {
  const testing::Streams data =
      testing::simulated_drive({.terrain = Terrain::free, .poses = 1200, .rate = 10, .seed = 3});
  const Trajectory a = every(data.a, 0, 10);
  Trajectory b;
  for (std::size_t i = 0; i < a.size(); ++i) b.push_back(data.b[10 * i + (i % 30 < 2 ? 0 : 4)]);
  const Calibration calibration = calibrate(a, b);
  const Finding* finding = testing::find(calibration, "too_little_motion");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
  EXPECT_NE(finding->remedy.find("--max-gap SECONDS allows more"), std::string::npos) << finding->remedy;
  EXPECT_NE(calibration.reason.find("--max-gap"), std::string::npos) << calibration.reason;
  CalibrationOptions cured;
  cured.pairing.max_gap = 2.5;
  EXPECT_EQ(testing::find(calibrate(a, b, cured), "too_little_motion"), nullptr);
}

// A filter that publishes at 10 Hz what comes once a second.
TEST(Refusals, AStreamThatRepeatsItsPosesIsToldSoAndWhatToDo) {
  const testing::Streams data =
      testing::simulated_drive({.terrain = Terrain::free, .poses = 600, .rate = 10, .seed = 3});
  Trajectory held = data.b;
  for (std::size_t i = 0; i < held.size(); ++i) held[i].pose = data.b[i - i % 10].pose;
  const std::string said = refusal(data.a, held, 0.5);
  EXPECT_NE(said.find("; b repeats its poses: of its 600 only 60 differ from the one before, one every 1 s. "
                      "Keep the first of each and leave out its repeats"),
            std::string::npos)
      << said;
  EXPECT_NE(refusal(held, data.a, 0.5).find("; a repeats its poses"), std::string::npos);
  EXPECT_EQ(refusal(data.a, every(held, 0, 10), 0.5), "") << "what it says helps";
  for (StampedPose& pose : held) pose.pose = held.front().pose;
  EXPECT_NE(refusal(data.a, held, 0.5).find("; the poses of b are all the same while the other sensor moves"),
            std::string::npos)
      << refusal(data.a, held, 0.5);
}

}  // namespace
}  // namespace egocal::test_refusals
