// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors of which some pairs have no answer.
#include <gmock/gmock.h>

#include <fstream>

#include "rig_command.hpp"

namespace egocal::test_rig_apart_command {
namespace {

using nlohmann::json;
using testing::part_of;
using testing::words_of;

using RigOfFiles = testing::RigCommand;

TEST_F(RigOfFiles, TwoSensorsThatShareNoTimeLeaveTheOthers) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string first = part_of(folder, files[0], "first.tum", 0, 30),
                    last = part_of(folder, files[2], "last.tum", 35, 70);
  const Result result = run("solve --json " + first + " " + files[1] + " " + last);
  ASSERT_EQ(result.code, 0) << result.error;
  const json object = result.object();
  EXPECT_EQ(object["extrinsics"].size(), 2u);
  ASSERT_EQ(object["unsolved"].size(), 1u);
  EXPECT_EQ(object["unsolved"][0]["a"], "first");
  EXPECT_EQ(object["unsolved"][0]["b"], "last");
  EXPECT_NE(object["unsolved"][0]["reason"].get<std::string>().find("first: "), std::string::npos)
      << "sensors by name, not a and b: " << object["unsolved"][0]["reason"];
  EXPECT_EQ(object["joint"]["tree"].size(), 2u);
  // without the one that connects them
  const Result apart = run("solve --json " + first + " " + last + " " + last);
  EXPECT_EQ(apart.code, 3);
  EXPECT_NE(apart.error.find("first"), std::string::npos) << apart.error;
  EXPECT_EQ(apart.object()["joint"]["apart"], json::array({first}));
  // no pair has an answer
  const std::string middle = part_of(folder, files[1], "middle.tum", 31, 34);
  const Result none = run("solve " + first + " " + middle + " " + last);
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.error.find("first, middle: no motion pairs"), std::string::npos) << none.error;
}

// It ended with an error, without the answers of the others.
TEST_F(RigOfFiles, ASensorThatIsFrozenLeavesTheOthers) {
  const std::vector<std::string> files = words_of(rig("drive"));
  for (std::size_t frozen = 0; frozen < 3; ++frozen) {
    std::vector<std::string> three = files;
    three[frozen] = folder.path("frozen.tum");
    std::ifstream moving(files[frozen]);
    std::ofstream still(three[frozen]);
    for (std::string line; std::getline(moving, line);)
      if (!line.starts_with('#')) still << line.substr(0, line.find(' ')) << " 1 2 3 0 0 0 1\n";
    still.close();
    const std::string names = three[0] + " " + three[1] + " " + three[2];
    const Result result = run("solve --json " + names);
    EXPECT_EQ(result.code, 3) << "a sensor has no answer: " << result.error;
    const json object = result.object();
    EXPECT_EQ(object["unsolved"].size(), 2u);
    for (const json& pair : object["unsolved"]) {
      EXPECT_TRUE(pair["a"] == "frozen" || pair["b"] == "frozen") << pair;
      EXPECT_NE(pair["reason"].get<std::string>().find("the poses of frozen are all the same"),
                std::string::npos)
          << pair;
    }
    ASSERT_EQ(object["extrinsics"].size(), 1u);
    EXPECT_EQ(object["extrinsics"][0]["verdict"], "good");
    EXPECT_EQ(object["joint"]["apart"], json::array({"frozen"}));
    EXPECT_EQ(object["joint"]["tree"].size(), 1u);
    const Result offset = run("solve --json --time-offset auto " + names);
    EXPECT_EQ(offset.code, 3) << offset.error;
    EXPECT_EQ(offset.object()["extrinsics"].size(), 1u);
    EXPECT_EQ(offset.object()["joint"]["apart"], json::array({"frozen"}));
    for (const json& pair : offset.object()["unsolved"])
      EXPECT_NE(pair["reason"].get<std::string>().find("the poses of frozen are all the same"),
                std::string::npos)
          << pair;
    const Result printed = run("solve " + names);
    EXPECT_EQ(printed.code, 3);
    EXPECT_NE(printed.out.find("not in it, without an answer that connects them: frozen\n"),
              std::string::npos)
        << printed.out;
    const Result written = run("solve " + names + " --format urdf");
    EXPECT_EQ(written.code, 3);
    EXPECT_EQ(written.out.find("frozen"), std::string::npos);
    EXPECT_NE(written.error.find("not in the tree, as no answer connects them with the others: frozen"),
              std::string::npos)
        << written.error;
  }
}

// The cure was what had been tried: --time-offset auto.
TEST_F(RigOfFiles, AnOffsetThatIsNotFoundIsTheReason) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string other = folder.path("other.tum");  // of another epoch, and too short
  std::ifstream given(part_of(folder, files[2], "short.tum", 0, 3));
  std::ofstream out(other);
  for (std::string line; std::getline(given, line);)
    out << std::to_string(std::stod(line) - 1e6) << line.substr(line.find(' ')) << "\n";
  out.close();
  const Result result = run("solve --json --time-offset auto " + files[0] + " " + files[1] + " " + other);
  EXPECT_EQ(result.code, 3) << result.error;
  const json unsolved = result.object()["unsolved"];
  EXPECT_EQ(unsolved.size(), 2u);
  for (const json& pair : unsolved)
    EXPECT_THAT(pair["reason"].get<std::string>(),
                ::testing::StartsWith("time offset: cannot be estimated, the streams are too short"));
}

}  // namespace
}  // namespace egocal::test_rig_apart_command
