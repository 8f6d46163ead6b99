// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// The real program on real files: what it prints, what it refuses and how.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "egocal/io/pairs_file.hpp"
#include "support/paths.hpp"
#include "support/random_motion.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Commands : public ::testing::Test {
 protected:
  Commands() : directory_(fs::temp_directory_path() / ("egocal_commands_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
  }
  ~Commands() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return path(name);
  }
  static std::string read(const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  Outcome program(const std::string& name, const std::string& arguments) const {
    const std::string command =
        egocal::paths::bin_dir() + "/" + name + " " + arguments + " >" + path("out") + " 2>" + path("err");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path("out")), read(path("err"))};
  }
  Outcome egocal(const std::string& arguments) const { return program("egocal", arguments); }
  json solved(const std::string& arguments) const {
    const Outcome run = egocal("solve --json " + arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return json::parse(run.out);
  }
  /// One line that says it, nothing on standard output.
  static void expect_refusal(const Outcome& run, int code, const std::string& part) {
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(part));
  }

 private:
  fs::path directory_;
};

std::string tum(int poses, const std::function<std::string(int)>& pose) {
  std::string text;
  for (int i = 0; i < poses; ++i) text += std::to_string(1000 + 0.1 * i) + " " + pose(i) + "\n";
  return text;
}

const std::string good_line = "1000.0 0 0 0 0 0 0 1\n";

/// Small motions, a fifth of them damaged by many times their size, in a file without times.
TEST_F(Commands, MotionPairsFromAFileAreJudgedToo) {
  using namespace egocal;
  egocal::testing::Random random(1);
  const Pose T{rotation_exp({0.4, -1.1, 0.7}), {0.5, -2, 1.2}};
  auto pairs = egocal::testing::random_pairs(
      to_dual_quaternion(T), {.pairs = 500, .rotation = 0.05, .translation = 0.3, .noise = 0.01}, random);
  int spoilt = 0;
  for (std::size_t i = 0; i < pairs.size(); i += 5, ++spoilt)
    pairs[i].b = canonical_sign(normalized(pairs[i].b * egocal::testing::normal_displacement(random, 2, 2)));
  write_pairs(path("pairs.txt"), pairs);
  std::ostringstream truth;
  truth.precision(17);
  truth << " --truth " << T.translation.x() << "," << T.translation.y() << "," << T.translation.z() << ","
        << T.rotation.w() << "," << T.rotation.x() << "," << T.rotation.y() << "," << T.rotation.z();
  const json result = solved("--pairs " + path("pairs.txt") + truth.str());
  EXPECT_LT(result["error_rotation_deg"], 0.1);
  EXPECT_LT(result["error_translation_m"], 0.01);
  EXPECT_NEAR(result["rejected"]["screw congruence"].get<double>(), spoilt, 2);
  const Outcome text = egocal("solve --pairs " + path("pairs.txt"));
  EXPECT_THAT(text.out, HasSubstr("rejected: screw congruence"));
  EXPECT_EQ(solved("--weights equal --pairs " + path("pairs.txt"))["pairs"], 500);
}

TEST_F(Commands, SolveSaysEverythingThatOthersRelyOn) {
  ASSERT_EQ(egocal("simulate --out " + path("d") + " --poses 300 --noise 0").code, 0);
  const json answer =
      solved(path("d/lidar.tum") + " " + path("d/camera.tum") + " --truth 0.5,0.2,-0.3,0.5,-0.5,0.5,-0.5");
  for (const char* key :
       {"translation", "rotation_wxyz", "pairs", "cost", "lower_bound", "gap", "certified", "observable",
        "stddev", "method", "solve_us", "error_translation_m", "error_rotation_deg"})
    EXPECT_TRUE(answer.contains(key)) << key;
  EXPECT_EQ(answer["observable"].size(), 6u);
  EXPECT_EQ(answer["stddev"].size(), 6u);
  EXPECT_TRUE(answer["certified"]);
  EXPECT_LT(answer["error_translation_m"], 1e-9);
  EXPECT_LT(answer["error_rotation_deg"], 1e-7);
}

TEST_F(Commands, LogDirectoryAndPairsGiveTheSameAnswer) {
  const std::string drive = " --poses 400 --noise 0.01 --seed 3";
  ASSERT_EQ(egocal("simulate --out " + path("d.log") + " --rig-out " + path("d.toml") + drive).code, 0);
  ASSERT_EQ(egocal("simulate --out " + path("d") + drive).code, 0);
  ASSERT_EQ(egocal("log create " + path("d.toml") + " --from lidar=" + path("d/lidar.tum") +
                   " --from camera=" + path("d/camera.tum") + " --out " + path("e.log"))
                .code,
            0);
  const json from_log = solved("--log " + path("d.log") + " ODOMETRY_LIDAR ODOMETRY_CAMERA");
  const json from_files = solved(path("d/lidar.tum") + " " + path("d/camera.tum"));
  const json from_created = solved("--log " + path("e.log") + " ODOMETRY_LIDAR ODOMETRY_CAMERA");
  for (const json& other : {from_files, from_created})
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(other["translation"][i].get<double>(), from_log["translation"][i].get<double>(), 1e-9);
  EXPECT_EQ(from_files["pairs"], from_log["pairs"]);
}

TEST_F(Commands, EveryMethodAnswers) {
  ASSERT_EQ(egocal("simulate --out " + path("d") + " --terrain free --poses 300 --noise 0.001").code, 0);
  for (const char* method :
       {"global", "fast", "dual", "sdp", "sqp", "slsqp", "analytic", "matrix", "local"}) {
    const json answer = solved(path("d/lidar.tum") + " " + path("d/camera.tum") + " --method " + method +
                               " --truth 0.5,0.2,-0.3,0.5,-0.5,0.5,-0.5");
    EXPECT_LT(answer["error_rotation_deg"], 0.5) << method;
    EXPECT_LT(answer["error_translation_m"], 0.1) << method;
  }
}

/// The labels of a figure's axes.
std::vector<std::string> labels_of(const std::string& page, const std::string& title) {
  std::vector<std::string> labels;
  std::size_t at = page.find(title);
  const std::size_t end = page.find("</svg>", at);
  for (at = page.find("</text>", at); at < end; at = page.find("</text>", at + 1))
    labels.push_back(page.substr(page.rfind('>', at) + 1, at - page.rfind('>', at) - 1));
  return labels;
}

// The figures showed the streams as they were read, and the baselines solved them: 8 m of residual
TEST_F(Commands, ReportAndBaselinesUseTheStreamsAsTheyAreSolved) {
  const std::string drive = " --terrain free --poses 400 --noise 0.003 --out ";
  ASSERT_EQ(egocal("simulate" + drive + path("known")).code, 0);
  ASSERT_EQ(egocal("simulate --scale camera=4" + drive + path("scaled")).code, 0);
  const std::string known = path("known/lidar.tum") + " " + path("known/camera.tum");
  const std::string scaled = path("scaled/lidar.tum") + " " + path("scaled/camera.tum") + " --scale-b auto";
  EXPECT_THAT(egocal("report " + known + " --out " + path("known.html")).out, HasSubstr("good"));
  EXPECT_THAT(egocal("report " + scaled + " --out " + path("scaled.html")).out, HasSubstr("good"));
  for (const char* figure : {"Translation residual of each motion", "Path of sensor a"}) {
    const std::vector<std::string> labels = labels_of(read(path("known.html")), figure);
    EXPECT_GT(labels.size(), 6u);
    EXPECT_EQ(labels_of(read(path("scaled.html")), figure), labels);
  }
  EXPECT_THAT(read(path("scaled.html")), HasSubstr("times the lengths of b, estimated and proven"));
  EXPECT_EQ(egocal("align " + path("scaled/lidar.tum") + " " + path("scaled/camera.tum")).code, 3);
  const Outcome aligned = egocal("align --json " + scaled);
  EXPECT_EQ(aligned.code, 0);
  EXPECT_LT(json::parse(aligned.out)["rms_translation_m"].get<double>(), 1);
  const json answer = solved(scaled), baseline = solved(scaled + " --method analytic");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(baseline["translation"][i].get<double>(), answer["translation"][i].get<double>(), 0.05);
}

TEST_F(Commands, WhatTheMotionsDoNotShowIsNotInvented) {
  const auto observable = [this](const std::string& text) {
    const std::string name = file("same.tum", text);
    const json answer = solved(name + " " + name);
    EXPECT_NE(answer["hint"], "");
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(answer["stddev"][i].is_null(), !answer["observable"][i].get<bool>());
    return answer["observable"].dump();
  };
  EXPECT_EQ(observable(tum(100, [](int) { return "0 0 0 0 0 0 1"; })),
            "[false,false,false,false,false,false]");
  EXPECT_EQ(observable(tum(100,
                           [](int i) {
                             return std::to_string(i) + " " + std::to_string(3 * std::sin(0.3 * i)) + " " +
                                    std::to_string(2 * std::cos(0.2 * i)) + " 0 0 0 1";
                           })),
            "[false,false,false,true,true,true]");
  EXPECT_EQ(observable(tum(100,
                           [](int i) {
                             const double half = 0.5 * std::sin(0.1 * i);
                             std::ostringstream text;
                             text.precision(17);
                             text << i << " " << 5 * std::sin(0.2 * i) << " 0 0 0 " << std::sin(half) << " "
                                  << std::cos(half);
                             return text.str();
                           })),
            "[true,true,false,true,true,true]");
}

TEST_F(Commands, BadTrajectoriesAreRefused) {
  const std::string good =
      file("good.tum", tum(50, [](int i) { return std::to_string(i) + " 0 0 0 0 0 1"; }));
  const auto refused = [&](const std::string& content, const std::string& part) {
    const std::string bad = file("bad.tum", content);
    expect_refusal(egocal("solve " + good + " " + bad), 1, "bad.tum" + part);
  };
  expect_refusal(egocal("solve " + good + " " + path("none.tum")), 1, "none.tum: cannot be opened");
  expect_refusal(egocal("solve --rig " + path("none.toml") + " --from a=" + good), 1,
                 "none.toml: cannot be read as a rig file: No such file");
  expect_refusal(egocal("solve --pairs " + path("none.txt")), 1,
                 "none.txt: cannot be opened for reading: No such");
  refused("", ": holds no data");
  refused(good_line + "1001 0 0 x1 0 0 0 1\n", ":2: field 4 (tz): expected a number, got 'x1'");
  refused(good_line + "1001 0 nan 0 0 0 0 1\n", ":2: field 3 (ty): expected a finite number");
  refused(good_line + "1001 0 0 0 0 0 0 0\n", ":2: quaternion: is zero");
  const std::string later = file("later.tum", "9000 0 0 0 0 0 0 1\n9001 1 0 0 0 0 0 1\n9002 2 0 0 0 0 0 1\n");
  expect_refusal(egocal("solve " + good + " " + later), 1, "their times do not overlap: --time-offset auto");
  std::string milliseconds = "time[s],x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < 50; ++i)
    milliseconds += std::to_string(100 * i) + "," + std::to_string(i) + ",0,0,0,0,0,1\n";
  expect_refusal(egocal("solve " + good + " " + file("ms.tum", milliseconds)), 1,
                 "b lasts 1e+03 times as long: multiply its times if they are in another unit");
}

TEST_F(Commands, AFileThatIsReadIsNeverWritten) {
  const std::string drive = path("drive.mcap"), log = path("drive.log"), rig = path("rig.toml");
  ASSERT_EQ(egocal("simulate --poses 50 --out " + drive).code, 0);
  ASSERT_EQ(egocal("simulate --poses 50 --out " + log + " --rig-out " + rig).code, 0);
  const std::string pair = drive + ":/lidar " + drive + ":/camera ", link = path("link");
  fs::create_symlink(drive, link);
  const auto refused = [&](const std::string& arguments, const std::string& input) {
    SCOPED_TRACE(arguments);
    const std::string before = read(input);
    ASSERT_FALSE(before.empty());
    expect_refusal(egocal(arguments), 2, ": give the output another name");
    EXPECT_TRUE(read(input) == before);
  };
  refused("solve " + pair + "--out " + drive, drive);
  refused("solve " + pair + "--format urdf --out " + link, drive);
  refused("solve " + pair + "--out " + path("./drive.mcap"), drive);
  refused("report " + pair + "--out " + drive, drive);
  refused("align " + pair + "--out " + drive, drive);
  refused("log export " + log + " --mcap " + log, log);
  refused("log create " + rig + " --from lidar=" + drive + ":/lidar --from camera=" + drive +
              ":/camera --out " + drive,
          drive);
  refused("export --log " + log + " --out " + log, log);
  refused("solve --rig " + rig + " --from lidar=" + drive + ":/lidar --from camera=" + drive +
              ":/camera --format urdf --out " + rig,
          rig);
  refused("simulate --out " + path("one.log") + " --rig-out " + path("one.log"), log);
  // a repair in place is what was asked for
  EXPECT_EQ(egocal("log repair " + log + " --out " + log).code, 0);
  // a word of an option may also be the name of a file
  file("urdf", "an answer of yesterday");
  EXPECT_EQ(egocal("solve " + pair + "--format urdf --out " + path("urdf")).code, 0);
}

TEST_F(Commands, OutputThatCannotBeWrittenIsAFailure) {
  const std::string drive = path("drive.mcap"), report = path("report.html");
  ASSERT_EQ(egocal("simulate --poses 60 --out " + drive).code, 0);
  const std::string pair = " " + drive + ":/lidar " + drive + ":/camera";
  const auto with_output = [&](const std::string& arguments, const std::string& before,
                               const std::string& output) {
    const std::string command =
        before + egocal::paths::bin_dir() + "/egocal " + arguments + output + " 2>" + path("err");
    const int status = std::system(command.c_str());
    return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, "", read(path("err"))};
  };
  for (const char* command : {"solve", "check", "align", "info"}) {
    SCOPED_TRACE(command);
    const std::string arguments = command + (command == std::string("info") ? " " + drive : pair);
    expect_refusal(with_output(arguments, "", " >/dev/full"), 1,
                   "standard output: cannot be written: No space");
    expect_refusal(with_output(arguments, "", " >&-"), 1, "standard output: cannot be written");
  }
  // a limit on the size of files
  expect_refusal(with_output("report" + pair + " --out " + report, "ulimit -f 8; ", " >/dev/null"), 1,
                 "report.html: ");
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(path("")))
    left += entry.path().filename().string().rfind("report", 0) == 0 ? 1 : 0;
  EXPECT_EQ(left, 0u);
}

TEST_F(Commands, AClockThatIsRightToTensOfMicrosecondsIsRight) {
  // without noise the motions fit better at one that is off by less than the estimate's standard deviation
  const std::string drive = path("drive.mcap");
  for (const char* seed : {"3", "4", "5", "6"}) {
    ASSERT_EQ(
        egocal(std::string("simulate --terrain free --poses 300 --seed ") + seed + " --out " + drive).code,
        0);
    const json found = solved(drive + ":/lidar " + drive + ":/camera --time-offset auto");
    EXPECT_EQ(found["verdict"], "good") << found["findings"];
  }
}

TEST_F(Commands, WrongUsageIsRefusedWithTwo) {
  const std::string good = file("good.tum", good_line);
  for (const char* arguments :
       {"", "solve", "nonsense", "solve a", "solve a b --method best", "solve a b --weights 1",
        "solve a b --stride 0", "solve a b --planar", "solve a b --truth 1,2,3",
        "solve a b --planar --plane-a 0,0,2,1 --plane-b 0,0,1,1", "simulate", "log", "up"})
    expect_refusal(egocal(arguments), 2, "egocal");
  for (const char* name : {"egocal", "egocal-player", "egocal-pairing", "egocal-fast", "egocal-global",
                           "egocal-diagnosis", "egocal-monitor"}) {
    EXPECT_EQ(program(name, "--help").code, 0) << name;
    EXPECT_THAT(program(name, "--version").out, HasSubstr("egocal")) << name;
  }
}

// The one that lost was dropped silently
TEST_F(Commands, OutputsThatContradictEachOtherAreRefused) {
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d")).code, 0);
  const std::string solve = "solve " + path("d/lidar.tum") + " " + path("d/camera.tum") + " --json --format ";
  expect_refusal(egocal(solve + "yaml"), 2, "--format: takes the place of --json");
  expect_refusal(egocal(solve + "yaml --rig " + path("none.toml")), 2, "--format: takes the place of --json");
  const Outcome both = egocal(solve + "yaml --out " + path("mount.yaml"));
  EXPECT_TRUE(json::parse(both.out)["certified"]);
  EXPECT_THAT(read(path("mount.yaml")), HasSubstr("translation"));
  expect_refusal(egocal("up none.toml --monitor --follow"), 2, " excludes --");
  expect_refusal(egocal("compare --json --csv"), 2, " excludes --");
  expect_refusal(egocal("compare --csv --latex"), 2, " excludes --");
  expect_refusal(program("egocal-monitor", "--once --json --size 100x30"), 2, " excludes --");
  expect_refusal(program("egocal-monitor", "--once --follow"), 2, " excludes --");
}

TEST_F(Commands, ValuesOutOfRangeAreRefusedWhetherTheyAreUsedOrNot) {
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d")).code, 0);
  const std::string drive = " " + path("d/lidar.tum") + " " + path("d/camera.tum") + " ";
  for (const char* rate : {"0", "-3", "nan", "inf", "1e7", "x"}) {
    for (const std::string& command : {"solve" + drive, "check" + drive, "report --out r.html" + drive,
                                       "align" + drive, "info " + path("d/lidar.tum") + " "})
      expect_refusal(egocal(command + "--rate " + rate), 2,
                     "--rate: expected a number above 0, at most 1000000, got");
  }
  for (const char* arguments :
       {"compare --noise nan", "compare a b --time-offset nan", "compare --poses 0",
        "experiment noise --levels nan", "experiment noise --levels 0.1,-1",
        "experiment noise --roughness -1", "experiment online --frames 0",
        "experiment online --t-no-fail nan", "export --rig r --timeout inf", "listen --seconds inf",
        "listen --seconds nan", "up rig.toml --log l --speed nan", "solve a b --max-gap 0"})
    expect_refusal(egocal(arguments), 2, "egocal: ");
}

TEST_F(Commands, OptionsWithoutAnEffectAreRefusedOrNamed) {
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d")).code, 0);
  const std::string drive = " " + path("d/lidar.tum") + " " + path("d/camera.tum") + " ";
  const Outcome rate = egocal("solve" + drive + "--rate 5");
  EXPECT_EQ(rate.code, 0);
  EXPECT_THAT(rate.err, HasSubstr("lidar.tum: --rate is not used: the poses have times"));
  EXPECT_THAT(egocal("info " + path("d/lidar.tum") + " --rate 5").out, HasSubstr("--rate is not used"));
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d.mcap")).code, 0);
  const std::string bag = " " + path("d.mcap") + ":/lidar " + path("d.mcap") + ":/camera ";
  const Outcome of_bag = egocal("solve" + bag + "--times none --columns t,x --rate 5");
  for (const char* option : {"--times is not", "--columns is not", "--rate is not"})
    EXPECT_THAT(of_bag.err, HasSubstr(option));
  EXPECT_EQ(egocal("solve" + bag).err, "");
  for (const char* arguments :
       {"solve --pairs p --rate 5", "solve --pairs p --stride 2", "solve --pairs p --time-offset 1",
        "solve --pairs p --max-gap 2", "solve --log l A B --columns t,x", "check --log l A B --rate 5",
        "solve a b c --samples", "solve a b --samples --max-gap 2", "solve a b --frame-a x",
        "solve a b c --frame-b x --json", "solve --log l A B C --rate 5"})
    expect_refusal(egocal(arguments), 2, "go");
  for (const char* arguments :
       {"compare a b --poses 10", "compare a b --noise 0.1", "compare a b --terrain flat",
        "compare a b --seed 2", "compare --times-a t", "compare --stride 2", "compare --time-offset 1",
        "export --log l --timeout 1", "export --log l --lcm-url u", "up rig.toml --speed 2",
        "simulate --out never --terrain flat --roughness 1",
        "simulate --out never --terrain free --speed-variation 0.1", "simulate --out never --type pose"})
    expect_refusal(egocal(arguments), 2, "egocal: ");
  EXPECT_FALSE(fs::exists("never"));
}

TEST_F(Commands, BadLogsAndRigsAreRefused) {
  ASSERT_EQ(egocal("simulate --out " + path("d.log") + " --rig-out " + path("d.toml") + " --poses 200").code,
            0);
  expect_refusal(egocal("solve --log " + path("d.log") + " ODOMETRY_LIDAR OTHER"), 1,
                 "OTHER: no such channel in the log; there are: ODOMETRY_CAMERA, ODOMETRY_LIDAR");
  expect_refusal(egocal("solve --log " + file("text.log", "this is no log at all") + " A B"), 1,
                 "is not an LCM log");
  expect_refusal(egocal("log info " + path("none.log")), 1, "none.log: cannot be opened");

  std::string misspelt = read(path("d.toml"));
  misspelt.replace(misspelt.find("channel"), 7, "chanel_");
  const std::string rig = file("misspelt.toml", misspelt);
  expect_refusal(egocal("up " + rig), 1, "misspelt.toml:");
  expect_refusal(program("egocal-pairing", "--rig " + rig), 1, "chanel_");

  // cut in the middle of an event, and a damaged one in the middle: the rest is used, the loss is named
  std::string log = read(path("d.log"));
  log.resize(log.size() - 20);
  log[log.size() / 2] = 'X';
  log[log.size() / 2 + 130] = 'X';
  const std::string cut = file("cut.log", log);
  const Outcome check = egocal("log check " + cut);
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.err, HasSubstr("cut off at the end"));
  EXPECT_GT(solved("--log " + cut + " ODOMETRY_LIDAR ODOMETRY_CAMERA --stride 1")["pairs"], 150);
  ASSERT_EQ(egocal("log repair " + cut + " --out " + path("repaired.log")).code, 0);
  EXPECT_EQ(egocal("log check " + path("repaired.log")).code, 0);
}

TEST_F(Commands, NothingHalfWrittenIsLeft) {
  expect_refusal(egocal("simulate --out " + path("no/such/place.log")), 1, "cannot be written");
  ASSERT_EQ(egocal("simulate --out " + path("d.log") + " --rig-out " + path("d.toml") + " --poses 20").code,
            0);
  const std::string bad = file("bad.tum", good_line + "1001 0 0\n");
  expect_refusal(egocal("log create " + path("d.toml") + " --from lidar=" + bad + " --from camera=" + bad +
                        " --out " + path("never.log")),
                 1, "bad.tum:2");
  EXPECT_FALSE(fs::exists(path("never.log")));
  EXPECT_FALSE(fs::exists(path("never.log.part")));
}

TEST_F(Commands, RealDrivesGiveWhatTheyShould) {
  if (!fs::exists(egocal::paths::data_dir()))
    GTEST_SKIP() << "the folder of real drives " << egocal::paths::data_dir() << " is not here";
  const std::string kitti =
      egocal::paths::data_dir() + "/kitti_07/velodyne_pylidar.tum " + egocal::paths::data_dir() +
      "/kitti_07/cam0_orbslam2.tum --truth 0.333504767535,-0.00479610810717,-0.0755785517707,"
      "0.499924473812,-0.499145921532,0.504084765332,-0.496817289214 --weights equal ";
  const json spatial = solved(kitti);
  EXPECT_EQ(spatial["pairs"], 1100);
  EXPECT_NEAR(spatial["error_rotation_deg"], 0.278, 0.0006);
  EXPECT_NEAR(spatial["error_translation_m"], 0.1902, 0.0001);
  const json planar =
      solved(kitti +
             "--planar --plane-a -1.220921993720055186e-02,2.798845739362088372e-03,9.999215476281387849e-01,"
             "-1.779603641715662210 --plane-b -6.613857662736873089e-03,-9.998207740635888241e-01,"
             "-1.773912730951216279e-02,-1.684677553916568593");
  EXPECT_NEAR(planar["error_rotation_deg"], 0.262, 0.0006);
  EXPECT_NEAR(planar["error_translation_m"], 0.1434, 0.0001);
  const json euroc =
      solved(egocal::paths::data_dir() + "/euroc_v2_01/body_gt.tum " + egocal::paths::data_dir() +
             "/euroc_v2_01/body_vio.tum --truth 0,0,0,1,0,0,0 --weights equal");
  EXPECT_NEAR(euroc["error_rotation_deg"], 0.184, 0.001);
  EXPECT_NEAR(euroc["error_translation_m"], 0.0185, 0.0001);
}

}  // namespace
