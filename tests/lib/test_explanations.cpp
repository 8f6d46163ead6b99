// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Every mistake of the catalogue is named on drives of several kinds, with the answer it should have been.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_explanations {
namespace {

using testing::drive;
using testing::find;

class NamedMistake : public ::testing::TestWithParam<std::string> {
 protected:
  static testing::Mistake mistake() {
    for (testing::Mistake& one : testing::mistakes())
      if (one.name == GetParam()) return one;
    throw Error("no such mistake: " + GetParam());
  }
};

TEST_P(NamedMistake, OnAFreeDriveWithTheRightAnswer) {
  testing::Streams streams = drive(Terrain::free);
  mistake().make(streams);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, mistake().code);
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
  EXPECT_FALSE(finding->remedy.empty());
  ASSERT_TRUE(finding->T_a_b);
  if (mistake().code == "mount_moved") return;
  const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b));
  EXPECT_LT(error.rotation, 0.01);
  EXPECT_LT(error.translation, 0.1);
}

TEST_P(NamedMistake, OnARoad) {
  testing::Streams streams = drive(Terrain::rough, 2);
  mistake().make(streams);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, mistake().code), nullptr) << calibration.reason;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, NamedMistake,
                         ::testing::Values("a inverted", "b inverted", "order of a", "order of b",
                                           "order of both", "scale 0.37", "scale 1.05",
                                           "scale of b 1.15 from the middle on", "b in millimetres",
                                           "a in millimetres", "clock 0.5 s off", "x and y of b exchanged",
                                           "x and y of a exchanged", "rotations of b inverse",
                                           "b knocked in the middle", "b turned round in the middle",
                                           "b turned aside early", "b turned aside late"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(Explanations, CleanDrivesHaveNoCertainFinding) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free}) {
    const testing::Streams streams = drive(terrain, 3);
    for (const Finding& finding : calibrate(streams.a, streams.b).findings)
      EXPECT_FALSE(finding.certain) << finding.code << ": " << finding.message;
  }
}

TEST(Explanations, UnrelatedStreamsAreCalledThat) {
  const testing::Streams one = drive(Terrain::free, 1), other = drive(Terrain::free, 9);
  const Calibration calibration = calibrate(one.a, other.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  EXPECT_NE(find(calibration, "unrelated"), nullptr);
}

/// On roads one extrinsic explains a part of any two drives: most of each motion is straight ahead.
TEST(Explanations, TwoDrivesOnRoadsAreUnrelated) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const testing::Streams one = drive(terrain, seed), other = drive(terrain, seed + 20);
      const Calibration calibration = calibrate(one.a, other.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
      EXPECT_NE(find(calibration, "unrelated"), nullptr) << seed << ": " << calibration.reason;
    }
}

TEST(Explanations, APartOfAnotherDriveIsFoundAtItsTime) {
  testing::Streams streams = drive(Terrain::free, 1);
  const testing::Streams other = drive(Terrain::free, 9);
  const std::size_t half = streams.b.size() / 2;
  const DualQuaternion start = streams.b[half].pose * conjugate(other.b[half].pose);
  for (std::size_t i = half; i < streams.b.size(); ++i)
    streams.b[i].pose = canonical_sign(normalized(start * other.b[i].pose));
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
  const Finding* finding = find(calibration, "unrelated");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  ASSERT_TRUE(finding->time);
  EXPECT_NEAR(*finding->time, 30, 8);
}

TEST(Explanations, AreDeterministic) {
  testing::Streams streams = drive(Terrain::rough);
  streams.b = testing::late(streams.b, 0.2);
  const Calibration one = calibrate(streams.a, streams.b), two = calibrate(streams.a, streams.b);
  ASSERT_EQ(one.findings.size(), two.findings.size());
  for (std::size_t i = 0; i < one.findings.size(); ++i) {
    EXPECT_EQ(one.findings[i].message, two.findings[i].message);
    EXPECT_EQ(one.findings[i].improvement, two.findings[i].improvement);
  }
}

}  // namespace
}  // namespace egocal::test_explanations
