// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// docs/json.md against what the commands print: no key is missing there, and none is listed that never
// appears.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "json_keys.hpp"
#include "support/file_content.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test_json_keys {
namespace {

using nlohmann::json;
using test::collect;
using test::Keys;
using testing::content_of;

class JsonKeys : public ::testing::Test {
 protected:
  /// Runs egocal with --json; codes 0 and 3 come with an object.
  void run(const std::string& command, const std::string& arguments) {
    const std::string out = folder.path("out");
    const int status = std::system((paths::bin_dir() + "/egocal " + command + " --json " + arguments + " >" +
                                    out + " 2>" + folder.path("err"))
                                       .c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    ASSERT_TRUE(code == 0 || code == 3)
        << command << " " << arguments << ": " << code << content_of(folder.path("err"));
    const json object = json::parse(content_of(out));
    collect(object, "", printed[command]);
    last = object;
  }
  void simulate(const std::string& name, const std::string& options) {
    ASSERT_EQ(std::system((paths::bin_dir() + "/egocal simulate --out " + folder.path(name) + " " + options +
                           " >/dev/null")
                              .c_str()),
              0);
  }
  std::string files(const std::string& name) const {
    return folder.path(name) + "/lidar.tum " + folder.path(name) + "/camera.tum";
  }
  void compare(const std::string& command) { test::compare_with_page(command, printed[command]); }

  testing::ScratchFolder folder;
  std::map<std::string, Keys> printed;
  json last;
};

TEST_F(JsonKeys, OfSolveAreThoseOfThePage) {
  simulate("drive", "--poses 400 --noise 0.01");
  simulate("later", "--poses 400 --noise 0.01 --seed 2 --clock-offset camera=0.2");
  simulate("bumped", "--poses 1200 --terrain free --bump camera=60:0,0,0,0,0,5");
  simulate("scaled", "--poses 600 --terrain free --scale camera=4");
  const std::string drive = files("drive");
  run("solve", drive + " --goal 0.1deg,2cm --truth 0.5,0.2,-0.3,0.5,-0.5,0.5,-0.5 --frame-a lidar");
  EXPECT_EQ(last["schema"], 1);
  EXPECT_EQ(last["frames"]["parent"], "lidar");
  EXPECT_EQ(last["matrix"].size(), 4u);
  EXPECT_EQ(last["files"][0]["role"], "a");
  EXPECT_EQ(last["settings"]["stride"], "auto");
  EXPECT_NE(last["command"].get<std::string>().find("egocal solve"), std::string::npos);
  run("solve", drive + " --stride 2 --weights 1:0.1 --time-offset auto");
  run("solve", drive + " --append " + files("later") + " --time-offset auto");
  EXPECT_EQ(last["time_offsets"].size(), 2u);
  simulate("flat", "--poses 400 --noise 0.01 --terrain flat");
  run("solve", files("flat") + " --nominal 0.5,0.2,-0.3,0.5,-0.5,0.5,-0.5");
  EXPECT_EQ(last["from_nominal"], json({"z"}));
  EXPECT_NEAR(last["translation"][2].get<double>(), -0.3, 0.02);
  run("solve", files("scaled") + " --scale-b auto");
  run("solve", files("scaled") + " --scale-b 4");
  simulate("drifting",
           "--poses 1200 --terrain free --noise 0.01 --scale camera=4 --scale-drift camera=0.002");
  run("solve", files("drifting") + " --scale-b auto");
  for (const std::string& wrong : {drive + " --invert-b", files("bumped"), files("scaled")})
    run("solve", wrong);
  simulate("arm", "--poses 40 --rate 1 --terrain free");
  run("solve", files("arm") + " --samples");
  compare("solve");
}

TEST_F(JsonKeys, OfARigAreThoseOfThePage) {
  const std::string third =
      " --sensor lidar=1,0,1.8,1,0,0,0 --sensor camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5 "
      "--sensor radar=2,0,0.5,1,0,0,0";
  simulate("bumped", "--poses 800 --terrain free --noise 0.01 --bump camera=40:0,0,0,0,0,3" + third);
  simulate("late", "--poses 800 --terrain free --noise 0.01 --clock-offset radar=0.1" + third);
  for (const std::string name : {"bumped", "late"}) {
    run("solve", files(name) + " " + folder.path(name) + "/radar.tum");
    printed["solve A B C"].merge(printed["solve"]);
    printed.erase("solve");
  }
  const std::string toml = folder.path("rig.toml");
  std::ofstream rig(toml);
  for (const std::string name : {"lidar", "camera"})
    rig << "[[sensor]]\nname = \"" << name << "\"\nchannel = \"" << name << "\"\n";
  rig << "[[pair]]\na = \"lidar\"\nb = \"camera\"\ngoal = \"0.0001deg,0.001cm\"\n"
      << "truth = [1.5, 0.2, -0.3, 0.5, -0.5, 0.5, -0.5]\n";
  rig.close();
  run("solve", "--rig " + toml + " --from lidar=" + folder.path("late") +
                   "/lidar.tum --from camera=" + folder.path("late") + "/camera.tum");
  printed["solve A B C"].merge(printed["solve"]);
  printed.erase("solve");
  printed["solve A B C"].insert("extrinsics[].goal.seconds_left");  // where more of the drive would help
  // listed once, for all commands
  for (const std::string& key : Keys(printed["solve A B C"]))
    if (key.rfind("files[]", 0) == 0 || key.rfind("settings", 0) == 0 || key == "notes")
      printed["solve A B C"].erase(key);
  compare("solve A B C");
}

TEST_F(JsonKeys, OfTheOtherCommandsAreThoseOfThePage) {
  simulate("drive", "--poses 200 --noise 0.01");
  simulate("drive.log", "--poses 200");
  run("info", files("drive").substr(0, files("drive").find(' ')));
  run("info", folder.path("drive.log"));
  ASSERT_EQ(std::system((paths::bin_dir() + "/egocal log export " + folder.path("drive.log") + " --mcap " +
                         folder.path("drive.mcap") + " >/dev/null")
                            .c_str()),
            0);
  run("info", folder.path("drive.mcap"));
  run("align", files("drive"));
  run("align", files("drive") + " --weights 1:0.01");
  run("compare", files("drive") + " --repeats 1 --truth 0.5,0.2,-0.3,0.5,-0.5,0.5,-0.5");
  run("log info", folder.path("drive.log"));
  printed["info"].insert("streams[].static");  // no program of ours writes static transforms
  for (const char* command : {"info", "align", "compare", "log info"}) compare(command);
}

/// What is written for other programs, of two sensors and of a tree.
TEST_F(JsonKeys, OfAWrittenExtrinsicAreThoseOfThePage) {
  simulate("scaled", "--poses 600 --terrain free --scale camera=4");
  const auto written = [&](const std::string& arguments) {
    const std::string out = folder.path("out");
    EXPECT_EQ(std::system((paths::bin_dir() + "/egocal solve " + arguments + " --format json >" + out +
                           " 2>" + folder.path("err"))
                              .c_str()),
              0);
    return json::parse(content_of(out));
  };
  const json one = written(files("scaled") + " --scale-b auto");
  collect(one, "", printed["--format json"]);
  compare("--format json");
  EXPECT_FALSE(one["scale"]["metres"]);
  simulate("rig",
           "--poses 400 --terrain free --noise 0.01 --sensor lidar=1,0,1.8,1,0,0,0 --sensor "
           "camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5 --sensor radar=2,0,0.5,1,0,0,0");
  const json tree = written(files("rig") + " " + folder.path("rig") + "/radar.tum");
  EXPECT_EQ(tree.size(), 2u);
  EXPECT_EQ(tree["root"], "lidar");
  EXPECT_EQ(tree["edges"].size(), 2u);
  EXPECT_TRUE(tree["edges"][0].contains("T_parent_child"));
}

TEST_F(JsonKeys, OfCheckAreThoseOfThePage) {
  simulate("bumped", "--poses 1200 --terrain free --bump camera=60:0,0,0,0,0,5");
  simulate("scaled", "--poses 600 --terrain free --scale camera=4");
  run("check", files("bumped"));
  run("check", files("scaled"));
  // both settings of `weights` and `--pairs` are of solve alone
  printed["check"].insert({"settings.weights.rotation", "settings.weights.translation"});
  compare("check");
}

}  // namespace
}  // namespace egocal::test_json_keys
