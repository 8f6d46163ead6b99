// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/io/extrinsic_tree.hpp"

namespace egocal::test_extrinsic_tree {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Where the sensors of a rig are on the vehicle.
const std::map<std::string, Pose> mounted{
    {"lidar", {rotation_exp({0.1, 0.2, 0.3}), {1, 2, 3}}},
    {"front", {rotation_exp({-1.2, 0.4, 0.1}), {0, 0.5, 1}}},
    {"rear", {rotation_exp({0.3, -0.2, 2.5}), {-2, 0, 1}}},
    {"gnss", {rotation_exp({0, 0, 0.2}), {0, 0, 2}}},
};

NamedExtrinsic pair(const std::string& a, const std::string& b, double stddev, bool certified = true) {
  NamedExtrinsic extrinsic;
  extrinsic.parent = a;
  extrinsic.child = b;
  extrinsic.T_parent_child = inverse(mounted.at(a)) * mounted.at(b);
  extrinsic.certified = certified;
  extrinsic.stddev = {stddev, stddev, stddev, 0.001, 0.001, 0.001};
  return extrinsic;
}

TEST(ExtrinsicTree, EverySensorHasOneParentAndItsPlace) {
  const ExtrinsicTree tree =
      extrinsic_tree({pair("lidar", "front", 0.01), pair("rear", "front", 0.01), pair("gnss", "rear", 0.02)});
  EXPECT_EQ(tree.root, "lidar");
  ASSERT_EQ(tree.edges.size(), 3u);
  EXPECT_TRUE(tree.unused.empty());
  std::map<std::string, Pose> at{{"lidar", Pose{}}};
  for (const NamedExtrinsic& edge : tree.edges) {
    ASSERT_TRUE(at.contains(edge.parent)) << "a child before its parent: " << edge.child;
    EXPECT_FALSE(at.contains(edge.child));
    at[edge.child] = at[edge.parent] * edge.T_parent_child;
  }
  for (const auto& [name, place] : at) {
    const Pose wanted = inverse(mounted.at("lidar")) * mounted.at(name);
    EXPECT_LT((place.translation - wanted.translation).norm(), 1e-12) << name;
    EXPECT_LT(Eigen::Quaterniond(place.rotation).angularDistance(Eigen::Quaterniond(wanted.rotation)), 1e-7)
        << name;
  }
  // the pair rear, front was turned round: standard deviations were in the frame of rear
  EXPECT_TRUE(tree.edges[0].stddev);
  EXPECT_FALSE(tree.edges[1].stddev);
}

// With the standard deviations went what is not known at all
TEST(ExtrinsicTree, APairThatIsTurnedRoundKeepsWhatIsNotObservable) {
  NamedExtrinsic blind = pair("rear", "lidar", 0.01);
  (*blind.stddev)[2] = std::numeric_limits<double>::infinity();
  const ExtrinsicTree tree = extrinsic_tree({blind}, "lidar");
  ASSERT_EQ(tree.edges.size(), 1u);
  ASSERT_EQ(tree.edges[0].parent, "lidar");
  EXPECT_THAT(extrinsic_tree_text(tree, ExtrinsicFormat::urdf),
              HasSubstr("NOT OBSERVABLE, not a measurement: z, in the axes of rear: several of these"));
  EXPECT_THAT(extrinsic_tree_text(tree, ExtrinsicFormat::json),
              HasSubstr("\"not_observable\": [\"z\"],\n  \"not_observable_frame\": \"rear\""));
}

TEST(ExtrinsicTree, OfALoopTheLeastCertainPairIsNotUsed) {
  const NamedExtrinsic poor = pair("front", "rear", 0.5), unproven = pair("lidar", "rear", 0.001, false);
  const ExtrinsicTree by_stddev =
      extrinsic_tree({poor, pair("lidar", "front", 0.01), pair("lidar", "rear", 0.02)}, "lidar");
  ASSERT_EQ(by_stddev.unused.size(), 1u);
  EXPECT_EQ(by_stddev.unused[0].parent, "front");
  // a direction that nothing shows: its place is not known, whatever the other two are
  NamedExtrinsic blind = pair("lidar", "front", 0.01);
  (*blind.stddev)[2] = std::numeric_limits<double>::infinity();
  for (const auto& order : {std::vector{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
    const NamedExtrinsic pairs[] = {blind, poor, pair("lidar", "rear", 0.02)};
    std::vector<NamedExtrinsic> given;
    for (const int i : order) given.push_back(pairs[i]);
    const ExtrinsicTree by_sight = extrinsic_tree(given, "lidar");
    ASSERT_EQ(by_sight.unused.size(), 1u);
    EXPECT_EQ(std::set({by_sight.unused[0].parent, by_sight.unused[0].child}),
              std::set<std::string>({"lidar", "front"}));
  }
  const ExtrinsicTree by_proof = extrinsic_tree({unproven, pair("lidar", "front", 0.01), poor});
  ASSERT_EQ(by_proof.unused.size(), 1u);
  EXPECT_FALSE(by_proof.unused[0].certified);
}

TEST(ExtrinsicTree, NamesASensorThatCannotBeReached) {
  try {
    extrinsic_tree({pair("lidar", "front", 0.01), pair("rear", "gnss", 0.01)});
    FAIL() << "two trees taken for one";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("rear"));
  }
  EXPECT_THROW(extrinsic_tree({}), Error);
  EXPECT_THROW(extrinsic_tree({pair("lidar", "front", 0.01)}, "radar"), Error);
}

TEST(ExtrinsicTree, IsWrittenAsOneRobotOneLaunchFileOneList) {
  const ExtrinsicTree tree = extrinsic_tree({pair("lidar", "front", 0.01), pair("lidar", "rear", 0.01)});
  const std::string robot = extrinsic_tree_text(tree, ExtrinsicFormat::urdf);
  for (const char* part : {"<robot name=\"sensors\">", "<link name=\"lidar\"/>", "<link name=\"rear\"/>",
                           "<joint name=\"lidar_to_rear\"", "</robot>"})
    EXPECT_THAT(robot, HasSubstr(part));
  const std::string launch = extrinsic_tree_text(tree, ExtrinsicFormat::ros_launch);
  EXPECT_EQ(launch.find("<launch>"), launch.rfind("<launch>"));
  EXPECT_THAT(launch, HasSubstr("lidar_to_rear"));
  EXPECT_THAT(extrinsic_tree_text(tree, ExtrinsicFormat::json), HasSubstr("\"edges\": ["));
  EXPECT_THAT(extrinsic_tree_text(tree, ExtrinsicFormat::yaml), HasSubstr("\n---\n"));
  EXPECT_THAT(extrinsic_tree_text(tree, ExtrinsicFormat::ros), Not(HasSubstr("---")));
  EXPECT_THROW(extrinsic_tree_text(tree, ExtrinsicFormat::matrix), Error);
}

TEST(ExtrinsicTree, TwoSensorsAreNotOneFrame) {
  NamedExtrinsic front = pair("lidar", "front", 0.01), rear = pair("lidar", "rear", 0.01);
  front.child = "drive.mcap:/camera";
  rear.child = "drive.mcap_/camera";
  try {
    extrinsic_tree_text(extrinsic_tree({front, rear}), ExtrinsicFormat::urdf);
    ADD_FAILURE() << "both became one";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("would both be the frame drive.mcap_/camera: rename one"));
  }
}

}  // namespace
}  // namespace egocal::test_extrinsic_tree
