// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <limits>

#include "egocal/error.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::test_extrinsic_text {
namespace {

using ::testing::HasSubstr;

std::vector<ExtrinsicFormat> all_formats() {
  std::vector<ExtrinsicFormat> formats;
  for (const std::string& name : extrinsic_format_names())
    formats.push_back(*extrinsic_format_from_name(name));
  return formats;
}
const std::vector<ExtrinsicFormat> formats = all_formats();

NamedExtrinsic example() {
  NamedExtrinsic extrinsic;
  extrinsic.parent = "lidar";
  extrinsic.child = "camera";
  extrinsic.T_parent_child = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.125, -0.25, 2.0}};
  extrinsic.certified = true;
  extrinsic.pairs = 1234;
  return extrinsic;
}

TEST(ExtrinsicText, EveryFormatNamesFramesAndQuaternionOrder) {
  for (const ExtrinsicFormat format : formats) {
    const std::string text = extrinsic_text(example(), format);
    EXPECT_THAT(text, HasSubstr("lidar")) << to_string(format);
    EXPECT_THAT(text, HasSubstr("camera")) << to_string(format);
    EXPECT_EQ(extrinsic_format_from_name(to_string(format)), format);
  }
  EXPECT_FALSE(extrinsic_format_from_name("xml"));
  EXPECT_THAT(extrinsic_text(example(), ExtrinsicFormat::ros), HasSubstr("0.125 -0.25 2"));
  EXPECT_THAT(extrinsic_text(example(), ExtrinsicFormat::urdf), HasSubstr("xyz=\"0.125 -0.25 2\""));
}

TEST(ExtrinsicText, WhatShouldNotBeUsedIsSaidInEveryFormat) {
  NamedExtrinsic extrinsic = example();
  extrinsic.usable = false;
  for (const ExtrinsicFormat format : formats)
    EXPECT_THAT(
        extrinsic_text(extrinsic, format),
        ::testing::AnyOf(HasSubstr("DO NOT USE"), HasSubstr("usable: false"), HasSubstr("\"usable\": false")))
        << to_string(format);
}

NamedExtrinsic of_a_flat_drive() {
  NamedExtrinsic extrinsic = example();
  extrinsic.verdict = "incomplete";
  extrinsic.reason = "Not known to 1 deg and 60 cm yet: z. Drive over a \"kerb\" --often--.";
  extrinsic.backing.emplace();
  (*extrinsic.backing)[2] = Backing::none;
  return extrinsic;
}

std::string plain_yaml_and_json(std::string text) {
  for (std::size_t at; (at = text.find("\\\"")) != std::string::npos;) text.erase(at, 1);
  for (std::size_t at; (at = text.find("- -")) != std::string::npos;) text.erase(at + 1, 1);
  return text;
}

// A reader of the file saw "certified globally optimal" and a number for the height, and nothing else.
TEST(ExtrinsicText, EveryFormatStatesTheVerdictAndWhatIsNotObservableBeforeTheCertificate) {
  for (const ExtrinsicFormat format : formats) {
    const std::string text = plain_yaml_and_json(extrinsic_text(of_a_flat_drive(), format));
    SCOPED_TRACE(text);
    const std::size_t verdict = text.find("incomplete"), certified = text.find("certified");
    ASSERT_NE(verdict, std::string::npos);
    EXPECT_LT(verdict, certified);
    EXPECT_THAT(text, HasSubstr("Not known to 1 deg and 60 cm yet: z. Drive over a \"kerb\" --often--"));
    EXPECT_THAT(text, ::testing::AnyOf(HasSubstr("NOT OBSERVABLE, not a measurement: z"),
                                       HasSubstr("\"not_observable\": [\"z\"]")));
  }
  for (const ExtrinsicFormat format : {ExtrinsicFormat::kalibr, ExtrinsicFormat::opencv})
    EXPECT_THAT(extrinsic_text(of_a_flat_drive(), format),
                HasSubstr("z, in the axes of lidar: several of these numbers hold a part of it"));
}

TEST(ExtrinsicText, WhatTheNumbersRestOnIsNamed) {
  NamedExtrinsic extrinsic = example();
  const auto words = [&] { return extrinsic_text(extrinsic, ExtrinsicFormat::ros); };
  EXPECT_THAT(words(), HasSubstr("# not judged: no verdict; certified globally optimal"));
  extrinsic.reason = "The answer has moved.";
  EXPECT_THAT(words(), HasSubstr("# not judged: The answer has moved; certified globally optimal"));
  extrinsic.reason.clear();
  EXPECT_EQ(not_shown_in_words(extrinsic), "");
  extrinsic.stddev = {1, 1, std::numeric_limits<double>::infinity(), 1, 1, 1};
  EXPECT_EQ(not_shown_in_words(extrinsic), "NOT OBSERVABLE, not a measurement: z");
  extrinsic.backing = {Backing::none,    Backing::motions, Backing::nominal,
                       Backing::nominal, Backing::planes,  Backing::motions};
  EXPECT_EQ(not_shown_in_words(extrinsic),
            "NOT OBSERVABLE, not a measurement: x; NOT OBSERVABLE, from the nominal value: z roll; from the "
            "ground planes: pitch");
  EXPECT_THAT(words(), HasSubstr("; " + not_shown_in_words(extrinsic) + "; certified globally optimal"));
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::yaml),
              HasSubstr("\nnot_observable: [\"x\", \"z\", \"roll\"]  #"));
  extrinsic.scale = NamedScale{"camera", 2.5, std::numeric_limits<double>::infinity(), true};
  EXPECT_THAT(words(), HasSubstr("; lengths of camera multiplied by 2.5, which is NOT OBSERVABLE\n"));
  extrinsic.verdict = "doubtful";
  extrinsic.reason = "One line.\nAnd \"another\".";
  EXPECT_THAT(words(), HasSubstr("# verdict doubtful: One line. And \"another\"; NOT OBSERVABLE"));
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::json),
              HasSubstr("\"reason\": \"One line.\\u000aAnd \\\"another\\\".\""));
}

/// Points of the parent taken to the child: as kalibr's and OpenCV's transforms do, and the others do
/// inverted.
TEST(ExtrinsicText, DirectionsAreThoseOfEachProgram) {
  NamedExtrinsic extrinsic = example();
  extrinsic.T_parent_child = {Eigen::Quaterniond(std::sqrt(0.5), 0, 0, std::sqrt(0.5)),
                              {1, 2, 3}};  // 90 deg yaw
  // R' t = (2, -1, 3)
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::opencv),
              ::testing::ContainsRegex("T: [^T]*data: . -(2|1.9)"));
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::lio_sam), HasSubstr("extrinsicTrans: [1, 2, 3]"));
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::autoware),
              HasSubstr("    x: 1\n    y: 2\n    z: 3\n"));
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::matrix), HasSubstr(" 3\n0 0 0 1\n"));
}

TEST(ExtrinsicText, RosTakesTheScalarLast) {
  NamedExtrinsic extrinsic = example();
  extrinsic.T_parent_child.rotation = Eigen::Quaterniond(0.8, 0.6, 0, 0);
  const std::string text = extrinsic_text(extrinsic, ExtrinsicFormat::ros);
  const std::size_t x = text.find("0.6"), w = text.find("0.8");
  ASSERT_NE(x, std::string::npos);
  ASSERT_NE(w, std::string::npos);
  EXPECT_LT(x, w);
}

TEST(ExtrinsicText, KalibrHasTheInverse) {
  // T_cam_imu takes points of the imu (our parent) to the camera (our child): the inverse of T_parent_child
  NamedExtrinsic extrinsic = example();
  extrinsic.T_parent_child = {Eigen::Quaterniond::Identity(), {1, 2, 3}};
  EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::kalibr), HasSubstr("-1"));
}

TEST(ExtrinsicText, NamesOfFramesStayNamesInYaml) {
  NamedExtrinsic extrinsic = example();
  for (const char* word :
       {"yes", "No", "null", "TRUE", "off", "y", "1.0", "12", "1e5", ".inf", "0x1f", "2026-11-24"}) {
    extrinsic.parent = word;
    const std::string quoted = "\"" + std::string(word) + "\"";
    EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::yaml), HasSubstr("\nparent: " + quoted + "\n"));
    EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::autoware), HasSubstr("\n" + quoted + ":\n"));
  }
  for (const char* word : {"lidar", "yes_1", "base_link", "/odom", "n1", "e5"}) {
    extrinsic.parent = word;
    EXPECT_THAT(extrinsic_text(extrinsic, ExtrinsicFormat::yaml),
                HasSubstr("\nparent: " + std::string(word) + "\n"));
  }
}

TEST(ExtrinsicText, ParentAndChildAreTwoFrames) {
  NamedExtrinsic extrinsic = example();
  extrinsic.child = extrinsic.parent;
  for (const ExtrinsicFormat format : formats) EXPECT_THROW(extrinsic_text(extrinsic, format), Error);
  extrinsic.parent = "front lidar";
  extrinsic.child = "front_lidar";
  EXPECT_THROW(extrinsic_text(extrinsic, ExtrinsicFormat::urdf), Error);
  EXPECT_TRUE(is_frame_name("drive/front-lidar_1.2"));
  for (const char* name : {"", "-x", "my lidar", "a:b", "caf\xc3\xa9", "a\nb"})
    EXPECT_FALSE(is_frame_name(name)) << name;
}

TEST(ExtrinsicText, NobodyMountsASensorAtNan) {
  NamedExtrinsic extrinsic = example();
  extrinsic.T_parent_child.translation.y() = std::numeric_limits<double>::quiet_NaN();
  for (const ExtrinsicFormat format : formats) EXPECT_THROW(extrinsic_text(extrinsic, format), Error);
}

}  // namespace
}  // namespace egocal::test_extrinsic_text
