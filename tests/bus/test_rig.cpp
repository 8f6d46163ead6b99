// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::bus::test_rig {
namespace {

const std::string sensors = R"([[sensor]]
name = "lidar"
channel = "ODO_L"
plane = [0, 0, 1, -1.7]
[[sensor]]
name = "camera"
channel = "ODO_C"
type = "bot_core.pose_t"
plane = [0, -1, 0, -1.6]
)";
const std::string pair = R"([[pair]]
a = "lidar"
b = "camera"
)";

std::string error_of(const std::string& text) {
  try {
    parse_rig(text, "my.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Rig, WholeExample) {
  const Rig rig = parse_rig(sensors + pair + R"(mode = "planar"
truth = [0.1, 0.2, 0.3, 1, 0, 0, 0]
nominal = [0, 0, 0, 0, 0, 0, 1]
stride = 3
weights = [1, 0.1]
time_offset = -0.25
[bus]
url = "udpm://239.1.2.3:7700?ttl=1"
[pairing]
max_gap = 0.3
reorder_window = 0.1
[solver]
t_no_fail = 2
heartbeat_timeout = 4
)",
                            "my.toml");
  ASSERT_EQ(rig.sensors.size(), 2u);
  EXPECT_EQ(rig.sensors[0].type, OdometryType::odometry);
  EXPECT_EQ(rig.sensors[1].type, OdometryType::pose);
  EXPECT_EQ(rig.sensors[1].plane->normal, Eigen::Vector3d(0, -1, 0));
  ASSERT_EQ(rig.pairs.size(), 1u);
  EXPECT_EQ(rig.pairs[0].mode, Mode::planar);
  EXPECT_EQ(rig.pairs[0].truth->translation, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(rig.pairs[0].nominal->rotation.z(), 1);
  EXPECT_EQ(rig.pairs[0].stride, 3);
  EXPECT_EQ(rig.pairs[0].balance->translation, 0.1);
  EXPECT_EQ(rig.pairs[0].time_offset, -0.25);
  EXPECT_EQ(rig.lcm_url, "udpm://239.1.2.3:7700?ttl=1");
  EXPECT_EQ(rig.max_gap, 0.3);
  EXPECT_EQ(rig.reorder_window, 0.1);
  EXPECT_EQ(rig.t_no_fail, 2);
  EXPECT_EQ(rig.heartbeat_timeout, 4);
}

TEST(Rig, DefaultsAreAutomatic) {
  const Rig rig = parse_rig(sensors + pair, "my.toml");
  EXPECT_FALSE(rig.pairs[0].stride);
  EXPECT_FALSE(rig.pairs[0].balance);
  EXPECT_EQ(rig.pairs[0].time_offset, 0.0);
  EXPECT_EQ(rig.pairs[0].mode, Mode::spatial);
}

TEST(Rig, ItsPairsDoWhatTakesLongAtDifferentTimes) {
  const std::string radar = "[[sensor]]\nname = \"radar\"\nchannel = \"R\"\n";
  const Rig rig = parse_rig(sensors + radar + pair + "[[pair]]\na = \"lidar\"\nb = \"radar\"\n", "my.toml");
  const PairingOptions first = drive_options(rig, rig.pairs[0]), second = drive_options(rig, rig.pairs[1]);
  EXPECT_EQ(first.accumulator.choice_phase, 0);
  EXPECT_EQ(first.clock.phase, 0);
  EXPECT_EQ(second.accumulator.choice_phase, 0.5);
  EXPECT_EQ(second.clock.phase, 0.5);
}

TEST(Rig, ScaleAndWhatFollowsAMove) {
  const Rig rig = parse_rig(
      "[[sensor]]\nname = \"lidar\"\nchannel = \"L\"\n[[sensor]]\nname = \"camera\"\nchannel = "
      "\"C\"\nscale = 2.7\n" +
          pair + "on_move = \"restart\"\n",
      "my.toml");
  EXPECT_EQ(rig.sensors[0].scale, 1);
  EXPECT_EQ(rig.sensors[1].scale, 2.7);
  EXPECT_EQ(rig.pairs[0].on_move, OnMove::restart);
  EXPECT_EQ(parse_rig(sensors + pair, "my.toml").pairs[0].on_move, OnMove::report);
}

TEST(Rig, AScaleCanBeLookedFor) {
  const std::string lidar = "[[sensor]]\nname = \"lidar\"\nchannel = \"L\"\n",
                    camera = "[[sensor]]\nname = \"camera\"\nchannel = \"C\"\nscale = \"auto\"\n";
  const Rig rig = parse_rig(lidar + camera + pair, "my.toml");
  EXPECT_FALSE(rig.sensors[0].find_scale);
  EXPECT_TRUE(rig.sensors[1].find_scale);
  EXPECT_EQ(unscaled_side(rig, rig.pairs[0]), Side::b);
  const Rig known = parse_rig(sensors + pair, "my.toml");
  EXPECT_FALSE(unscaled_side(known, known.pairs[0]));
  EXPECT_NO_THROW(parse_rig(lidar + camera + pair + "stride = \"auto\"\n", "my.toml"));
  for (const std::string& text :
       {lidar + "scale = \"auto\"\n" + camera + pair, lidar + camera + pair + "stride = 3\n",
        lidar + "scale = \"maybe\"\n" + pair})
    EXPECT_THROW(parse_rig(text, "my.toml"), Error) << text;
}

TEST(Rig, AGoalIsStatedAsTextOrAsNumbers) {
  for (const std::string goal :
       {"goal = \"0.1deg,2cm\"\n", "goal = { rotation_deg = 0.1, translation_m = 0.02 }\n"}) {
    const Rig rig = parse_rig(sensors + pair + goal + "platform = \"drone\"\n", "my.toml");
    ASSERT_TRUE(rig.pairs[0].goal) << goal;
    EXPECT_NEAR(rig.pairs[0].goal->rotation, 0.1 * std::numbers::pi / 180, 1e-12);
    EXPECT_NEAR(rig.pairs[0].goal->translation, 0.02, 1e-12);
    EXPECT_EQ(rig.pairs[0].goal->platform, Platform::drone);
    EXPECT_EQ(rig.pairs[0].platform, Platform::drone);
  }
  EXPECT_FALSE(parse_rig(sensors + pair, "my.toml").pairs[0].goal);
}

TEST(Rig, ErrorsNameFileLineAndKey) {
  const struct {
    std::string text, file_and_line, key;
  } cases[] = {
      {sensors + pair + "strid = 1\n", "my.toml:13", "strid"},
      {sensors + pair + "stride = 0\n", "my.toml:13", "stride"},
      {sensors + pair + "stride = \"fast\"\n", "my.toml:13", "stride"},
      {sensors + pair + "mode = \"flat\"\n", "my.toml:13", "mode"},
      {sensors + pair + "mode = 3\n", "my.toml:13", "mode"},
      {sensors + pair + "truth = [0, 0, 0, 0, 0, 0, 0]\n", "my.toml:13", "truth"},
      {sensors + pair + "truth = [0, 0, 0]\n", "my.toml:13", "truth"},
      {sensors + pair + "truth = [0, 0, nan, 1, 0, 0, 0]\n", "my.toml:13", "truth"},
      {sensors + pair + "weights = [0, 0]\n", "my.toml:13", "weights"},
      {sensors + pair + "weights = \"same\"\n", "my.toml:13", "weights"},
      {sensors + pair + "time_offset = \"maybe\"\n", "my.toml:13", "time_offset"},
      {sensors + pair + "platform = \"boat\"\n", "my.toml:13", "platform"},
      {sensors + pair + "on_move = \"stop\"\n", "my.toml:13", "on_move"},
      {"[[sensor]]\nname = \"a\"\nchannel = \"c\"\nscale = 0\n", "my.toml:4", "scale"},
      {sensors + pair + "goal = 3\n", "my.toml:13", "goal"},
      {sensors + pair + "goal = \"0.1,2\"\n", "my.toml:13", "goal"},
      {sensors + pair + "goal = \"0deg,2cm\"\n", "my.toml:13", "goal"},
      {sensors + pair + "goal = { rotation_deg = 0.1 }\n", "my.toml:13", "goal.translation_m"},
      {sensors + pair + "goal = { rotation_deg = 0.1, translation_m = -1 }\n", "my.toml:13", "translation_m"},
      {sensors + pair + "goal = { rotation = 0.1, translation_m = 1 }\n", "my.toml:13", "rotation"},
      {sensors + pair + pair, "my.toml:15", "b"},
      {sensors + "[[pair]]\na = \"lidar\"\nb = \"radar\"\n", "my.toml:12", "b"},
      {sensors + "[[pair]]\na = \"lidar\"\nb = \"lidar\"\n", "my.toml:12", "b"},
      {sensors + "[[pair]]\na = \"lidar\"\n", "my.toml:10", "b"},
      {sensors, "my.toml", "pair"},
      {pair, "my.toml", "sensor"},
      {sensors + sensors + pair, "my.toml:11", "name"},
      {sensors + pair + "[solver]\nt_no_fail = -1\n", "my.toml:14", "t_no_fail"},
      {sensors + pair + "[sovler]\n", "my.toml:13", "sovler"},
      {sensors + pair + "[bus]\nurl = 3\n", "my.toml:14", "url"},
      {sensors + pair + "[bus]\nurl = \"file:///tmp/x?mode=w\"\n", "my.toml:14", "url"},
      {sensors + pair + "[bus]\nurl = \"memq://\"\n", "my.toml:14", "url"},
      {"[[sensor]]\nname = \"a b\"\n", "my.toml:2", "name"},
      {"[[sensor]]\nname = \"a\"\nchannel = \"EGOCAL_STATUS\"\n", "my.toml:3", "channel"},
      {"[[sensor]]\nname = \"a\"\nchannel = \".*\"\n", "my.toml:3", "channel"},
      {"[[sensor]]\nname = \"a\"\nchannel = \"c\"\nplane = [0, 0, 2, 0]\n", "my.toml:4", "plane"},
      {"[[sensor]\n", "my.toml:1", ""},
      {"", "my.toml", "sensor"},
  };
  for (const auto& c : cases) {
    const std::string message = error_of(c.text);
    EXPECT_THAT(message, ::testing::StartsWith(c.file_and_line)) << c.text;
    EXPECT_THAT(message, ::testing::HasSubstr(c.key)) << c.text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

/// A rig of this many sensors with all of their pairs.
std::string all_pairs_of(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += "[[sensor]]\nname = \"s" + std::to_string(i) + "\"\nchannel = \"C" + std::to_string(i) + "\"\n";
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      text += "[[pair]]\na = \"s" + std::to_string(a) + "\"\nb = \"s" + std::to_string(b) + "\"\n";
  return text;
}

TEST(Rig, AllPairsOfTwentySensorsAreTakenAndMoreThanListenersKeepAreRefused) {
  EXPECT_EQ(parse_rig(all_pairs_of(20), "my.toml").pairs.size(), 190u);
  const std::string message = error_of(all_pairs_of(24));
  EXPECT_THAT(message, ::testing::HasSubstr("at most 256 pairs")) << message;
  EXPECT_THAT(message, ::testing::StartsWith("my.toml:"));
}

TEST(Rig, MissingFile) {
  EXPECT_THROW(read_rig("/nonexistent/rig.toml"), Error);
}

TEST(Rig, FoldersAreNamedAsSuch) {
  try {
    read_rig("/tmp");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("/tmp: is a folder"));
  }
}

// "filesystem error: status: Too many levels of symbolic links [a.toml]"
TEST(Rig, ALinkToItselfIsAFileThatCannotBeRead) {
  const testing::ScratchFolder folder;
  const std::string file = folder.path("a.toml");
  std::filesystem::create_symlink(file, file);
  try {
    read_rig(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith(file + ": cannot be read as a rig file: "));
  }
}

// toml++ ends with a crash at a dotted key of some 50,000 parts.
TEST(Rig, HostileSizesAreRefusedInOneLine) {
  std::string dotted = "a";
  for (int i = 0; i < 200'000; ++i) dotted += ".a";
  const std::string nested(100'000, '[');
  // what one line may not hold, on many
  std::string inner = "{ a";
  for (int i = 0; i < 990; ++i) inner += ".a";
  std::string deep = "x = ";
  for (int i = 0; i < 120; ++i) deep += "[\n" + inner + " = ";
  deep += "1";
  for (int i = 0; i < 120; ++i) deep += " }\n]";
  const std::string large = sensors + pair + "# " + std::string(2 << 20, 'x') + "\n";
  for (const std::string& text : {dotted + " = 1\n", sensors + dotted + " = 1\n", "[" + dotted + "]\n",
                                  "a = " + nested, "a = " + std::string(100'000, '{'), deep, large}) {
    const std::string message = error_of(text);
    EXPECT_THAT(message, ::testing::StartsWith("my.toml")) << text.substr(0, 100);
    EXPECT_LT(message.size(), 1000U);
  }
}

}  // namespace
}  // namespace egocal::bus::test_rig
