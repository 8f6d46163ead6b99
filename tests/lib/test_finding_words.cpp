// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Findings say the same to everybody, each in the reader's own terms.
#include "egocal/diagnosis/finding_words.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"

namespace egocal::test_finding_words {
namespace {

const Terms rig{"lidar", "{b}", "egocal solve A B "};

TEST(FindingWords, MarksAreReplacedOnce) {
  EXPECT_EQ(in_terms("{a} and {b}: {solve}--scale auto, {c} {", rig),
            "lidar and {b}: egocal solve A B --scale auto, {c} {");
  EXPECT_EQ(in_terms("{a} and {b}: {solve}--scale auto", {}), "a and b: --scale auto");
  EXPECT_EQ(in_terms("", rig), "");
}

TEST(FindingWords, MessageAndRemedyAreTheirParts) {
  Finding finding;
  say(finding, {"{a} is late", ": by 1 s.", "Of the first half: ", "{solve}--time-offset auto"});
  EXPECT_EQ(finding.message, "a is late: by 1 s.");
  EXPECT_EQ(finding.remedy, "Of the first half: --time-offset auto");
  EXPECT_EQ(message_in_terms(finding, rig), "lidar is late: by 1 s.");
  EXPECT_EQ(remedy_in_terms(finding, rig), "Of the first half: egocal solve A B --time-offset auto");
}

/// As one that came over the bus.
TEST(FindingWords, AFindingWithoutThemIsSaidAsItIs) {
  Finding finding;
  finding.message = "a is {a}";
  finding.remedy = "none";
  EXPECT_EQ(message_in_terms(finding, rig), "a is {a}");
  EXPECT_EQ(remedy_in_terms(finding, rig), "none");
}

TEST(FindingWords, AnErrorCarriesItsAdviceForOtherCommands) {
  const AdvisedError error("no motion: {solve}--max-gap SECONDS");
  EXPECT_STREQ(error.what(), "no motion: --max-gap SECONDS");
  EXPECT_EQ(error.in_terms(rig), "no motion: egocal solve A B --max-gap SECONDS");
}

/// Otherwise a rig would be told of a and b.
TEST(FindingWords, AFindingAboutAStreamNamesItByTheReadersTerm) {
  int named = 0;
  for (const testing::Mistake& mistake : testing::mistakes()) {
    if (mistake.name != "a inverted" && mistake.name != "order of b" && mistake.name != "b in millimetres" &&
        mistake.name != "clock 0.5 s off" && mistake.name != "x and y of b exchanged")
      continue;
    testing::Streams streams = testing::drive(Terrain::free);
    mistake.make(streams);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* finding = testing::find(calibration, mistake.code);
    ASSERT_NE(finding, nullptr) << mistake.name;
    const std::string message = message_in_terms(*finding, {"lidar", "camera", {}});
    const bool of_a = finding->code.ends_with("_a");
    EXPECT_NE(message.find(of_a ? "lidar" : "camera"), std::string::npos) << message;
    EXPECT_EQ(message.find(" a "), std::string::npos) << message;
    EXPECT_EQ(message.find(" b "), std::string::npos) << message;
    EXPECT_EQ(message_in_terms(*finding, {}), finding->message);
    EXPECT_EQ(remedy_in_terms(*finding, {}), finding->remedy);
    ++named;
  }
  EXPECT_EQ(named, 5);
}

/// An option is copied to the command line, with a full stop if there is one.
TEST(FindingWords, NoRemedyHasAFullStopBehindAnOption) {
  const std::regex stopped("--[-a-z]+( (auto|[A-Z]+|[0-9.e-]+))?\\.( |$)");
  EXPECT_TRUE(std::regex_search("otherwise --invert-b.", stopped));
  int options = 0;
  for (const testing::Mistake& mistake : testing::mistakes()) {
    if (mistake.name != "both inverted" && mistake.name != "scale 1.05" && mistake.name != "clock 0.1 % fast")
      continue;
    testing::Streams streams = testing::drive(Terrain::rough);
    mistake.make(streams);
    for (const Finding& finding : calibrate(streams.a, streams.b).findings) {
      EXPECT_FALSE(std::regex_search(finding.remedy, stopped)) << finding.remedy;
      if (finding.remedy.find("--") != std::string::npos) ++options;
    }
  }
  EXPECT_GE(options, 2);
}

}  // namespace
}  // namespace egocal::test_finding_words
