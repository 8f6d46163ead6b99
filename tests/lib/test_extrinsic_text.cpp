// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <limits>

#include "egocal/error.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal {
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
}  // namespace egocal
