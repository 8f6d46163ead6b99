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
#include <set>

#include "support/file_content.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test_json_keys {
namespace {

using nlohmann::json;
using testing::content_of;
using Keys = std::set<std::string>;

/// The texts between backquotes.
std::vector<std::string> quoted_in(const std::string& line) {
  std::vector<std::string> texts;
  for (std::size_t at = line.find('`'); at != std::string::npos;) {
    const std::size_t end = line.find('`', at + 1);
    if (end == std::string::npos) break;
    texts.push_back(line.substr(at + 1, end - at - 1));
    at = line.find('`', end + 1);
  }
  return texts;
}

/// Keys by command: a heading names its commands before the colon, a row of a table its keys in the first
/// cell.
std::map<std::string, Keys> documented() {
  std::istringstream page(content_of(paths::source_dir() + "/docs/json.md"));
  std::map<std::string, Keys> keys;
  std::vector<std::string> commands;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) commands = quoted_in(line.substr(0, line.find(':')));
    if (line.rfind("| `", 0) != 0) continue;
    for (const std::string& key : quoted_in(line.substr(0, line.find('|', 1))))
      for (const std::string& command : commands) keys[command].insert(key);
  }
  return keys;
}

/// "fit.tenths[].begin_s" for every value; lists of plain values have the name of the list.
void collect(const json& value, const std::string& path, Keys& keys) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [key, below] : value.items())
      collect(below, path.empty() ? key : path + "." + key, keys);
  } else if (value.is_array() && !value.empty() && value[0].is_object()) {
    for (const json& element : value) collect(element, path + "[]", keys);
  } else if (!value.is_array() || value.empty() || !path.ends_with("[]")) {
    keys.insert(path);
  }
}

bool covers(const std::string& documented_key, const std::string& key) {
  if (documented_key == key || documented_key.rfind(key + "[].", 0) == 0) return true;  // the latter: empty
  if (!documented_key.ends_with(".*")) return false;
  const std::string parent = documented_key.substr(0, documented_key.size() - 2);
  return key == parent || key.rfind(parent + ".", 0) == 0;
}

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
  void compare(const std::string& command) {
    const Keys known = documented()[command];
    EXPECT_FALSE(known.empty()) << command;
    for (const std::string& key : printed[command]) {
      bool found = false;
      for (const std::string& entry : known) found = found || covers(entry, key);
      EXPECT_TRUE(found) << "egocal " << command << " --json prints '" << key
                         << "', docs/json.md does not list it";
    }
    for (const std::string& entry : known) {
      bool found = false;
      for (const std::string& key : printed[command]) found = found || covers(entry, key);
      EXPECT_TRUE(found) << "docs/json.md lists '" << entry << "', egocal " << command
                         << " --json never printed it";
    }
  }

  testing::ScratchFolder folder;
  std::map<std::string, Keys> printed;
  json last;
};

TEST_F(JsonKeys, OfSolveAreThoseOfThePage) {
  simulate("drive", "--poses 400 --noise 0.01");
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
