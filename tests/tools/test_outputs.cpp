// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What the real program writes: whole or not at all, never over what it reads.
#include "commands.hpp"

namespace egocal::test_outputs {
namespace {

namespace fs = std::filesystem;
using egocal::test::Commands;
using egocal::test::good_line;
using egocal::test::Outcome;
using nlohmann::json;
using ::testing::HasSubstr;

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
    // longer than what is held back: "cannot write to file"
    expect_refusal(with_output(arguments + " --json", "", " >/dev/full"), 1,
                   "standard output: cannot be written: No space");
  }
  // a limit on the size of files
  expect_refusal(with_output("report" + pair + " --out " + report, "ulimit -f 8; ", " >/dev/null"), 1,
                 "report.html: ");
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(path("")))
    left += entry.path().filename().string().rfind("report", 0) == 0 ? 1 : 0;
  EXPECT_EQ(left, 0u);
  // the drive was left without its rig
  expect_refusal(egocal("simulate --poses 60 --out " + path("left.log") + " --rig-out /dev/full"), 1,
                 "/dev/full");
  EXPECT_FALSE(fs::exists(path("left.log")));
}

// It was "std::bad_alloc".
TEST_F(Commands, MemoryThatRunsOutIsNamed) {
  const std::string limited = "(ulimit -v 200000; exec " + egocal::paths::bin_dir() +
                              "/egocal simulate --poses 3000000 --out " + path("big.log") + ") 2>" +
                              path("err");
  const int status = std::system(limited.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_EQ(read(path("err")), "egocal: not enough memory\n");
  EXPECT_FALSE(fs::exists(path("big.log")));
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
  expect_refusal(egocal("up none.toml --monitor --follow"), 2,
                 "--monitor, --follow: exclude each other: give one of them");
  expect_refusal(egocal("compare --json --csv"), 2, "--json, --csv: exclude each other: give one of them");
  expect_refusal(egocal("compare --csv --latex"), 2, "exclude each other: give one of them");
  expect_refusal(program("egocal-monitor", "--once --json --size 100x30"), 2,
                 "exclude each other: give one of them");
  expect_refusal(program("egocal-monitor", "--once --follow"), 2, "exclude each other: give one of them");
}

// Losses were dropped silently, and LCM logs were no trajectories
TEST_F(Commands, CompareSaysWhatItReadAsSolveDoes) {
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d")).code, 0);
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d.log")).code, 0);
  std::string rows = read(path("d/lidar.tum"));
  const std::string cut = file("cut.tum", rows.substr(0, rows.size() - 20));
  const std::string others = " " + path("d.log") + ":ODOMETRY_CAMERA --repeats 1";
  const Outcome table = egocal("compare " + cut + others);
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.err, HasSubstr("egocal: warning: " + cut + ": "));
  const json object = json::parse(egocal("compare " + cut + others + " --json 2>/dev/null").out);
  ASSERT_EQ(object["notes"].size(), 1u);
  EXPECT_THAT(object["notes"][0].get<std::string>(), HasSubstr(cut));
}

TEST_F(Commands, ALogWithoutASensorOfTheRigIsMadeWithAWarning) {
  ASSERT_EQ(egocal("simulate --poses 20 --out " + path("d") + " --rig-out " + path("d.toml")).code, 0);
  const std::string create = "log create " + path("d.toml") + " --out " + path("c.log");
  const std::string lidar = " --from lidar=" + path("d/lidar.tum");
  const Outcome half = egocal(create + lidar);
  EXPECT_EQ(half.code, 0);
  EXPECT_EQ(
      half.err,
      "egocal: warning: no --from of the sensor camera: its channel ODOMETRY_CAMERA is not in the log\n");
  EXPECT_EQ(egocal(create + lidar + " --from camera=" + path("d/camera.tum")).err, "");
}

// The player waited for 17 minutes without a word.
TEST_F(Commands, ALogOfSensorsThatShareNoTimeIsMadeWithAWarning) {
  ASSERT_EQ(egocal("simulate --poses 20 --out " + path("d") + " --rig-out " + path("d.toml")).code, 0);
  std::istringstream rows(read(path("d/camera.tum")));
  std::ostringstream later;
  later.precision(17);
  for (std::string row; std::getline(rows, row);) {
    if (row.empty() || row[0] == '#') continue;
    const std::size_t end = row.find(' ');
    later << std::stod(row.substr(0, end)) + 1000 << row.substr(end) << '\n';
  }
  const Outcome apart = egocal("log create " + path("d.toml") + " --out " + path("c.log") + " --from lidar=" +
                               path("d/lidar.tum") + " --from camera=" + file("later.tum", later.str()));
  EXPECT_EQ(apart.code, 0);
  EXPECT_THAT(apart.err, HasSubstr("egocal: warning: lidar and camera share no time: 998.1 s lie between"));
}

TEST_F(Commands, WhatGoesTogetherIsNamed) {
  expect_refusal(egocal("compare --stride 2"), 2,
                 "--stride: goes with A, which is not given; see egocal compare --help");
  expect_refusal(egocal("tell egocal-player seek"), 2, "tell: seek: expected a number from 0 up, got ''");
  expect_refusal(egocal("compare a.tum"), 2, "A: goes with B, which is not given");
  expect_refusal(egocal("compare a.tum b.tum --poses 5"), 2, "A, --poses: exclude each other");
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

}  // namespace
}  // namespace egocal::test_outputs
