// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// The real program on real files: what it prints, what it refuses and how.
#include <algorithm>
#include <cmath>

#include "commands.hpp"
#include "egocal/io/pairs_file.hpp"
#include "support/random_motion.hpp"

namespace egocal::test_commands {
namespace {

namespace fs = std::filesystem;
using egocal::test::Commands;
using egocal::test::good_line;
using egocal::test::Outcome;
using egocal::test::tum;
using nlohmann::json;
using ::testing::HasSubstr;

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
  for (const char* figure : {"Translation residuals of motions", "Path of sensor a"}) {
    const std::vector<std::string> labels = labels_of(read(path("known.html")), figure);
    EXPECT_GT(labels.size(), 6u);
    EXPECT_EQ(labels_of(read(path("scaled.html")), figure), labels);
  }
  EXPECT_THAT(read(path("scaled.html")), HasSubstr("times the lengths of b, estimated and proven"));
  // the motions were those of the frames in the ground planes: up to 12 m of residual
  ASSERT_EQ(egocal("simulate --terrain flat --poses 400 --noise 0.003 --out " + path("flat")).code, 0);
  ASSERT_EQ(egocal("report " + path("flat/lidar.tum") + " " + path("flat/camera.tum") +
                   " --planar --plane-a 0,0,1,-1.8 --plane-b 0,-1,0,-1.5 --out " + path("flat.html"))
                .code,
            0);
  const std::vector<std::string> metres =
      labels_of(read(path("flat.html")), "Translation residuals of motions");
  const auto unit = std::find(metres.begin(), metres.end(), "[m]");
  ASSERT_GE(unit - metres.begin(), 2);
  EXPECT_LT(std::stod(*(unit - 2)), 0.3) << "the highest tick";
  EXPECT_EQ(egocal("align " + path("scaled/lidar.tum") + " " + path("scaled/camera.tum")).code, 3);
  expect_refusal(egocal("align one"), 2, "expected two trajectory files A and B\n");  // no --pairs
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
  refused(good_line + "1001 0 inf 0 0 0 0 1\n", ":2: field 3 (ty): expected a finite number");
  refused(good_line + "1001 0 0 0 0 0 0 2\n", ":2: quaternion: expected length 1");
  const std::string later = file("later.tum", "9000 0 0 0 0 0 0 1\n9001 1 0 0 0 0 0 1\n9002 2 0 0 0 0 0 1\n");
  expect_refusal(egocal("solve " + good + " " + later), 1, "their times do not overlap: --time-offset auto");
  std::string milliseconds = "time[s],x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < 50; ++i)
    milliseconds += std::to_string(100 * i) + "," + std::to_string(i) + ",0,0,0,0,0,1\n";
  expect_refusal(egocal("solve " + good + " " + file("ms.tum", milliseconds)), 1,
                 "b lasts 1000 times as long: multiply its times if they are in another unit");
}

/// Where there was no answer, there were no warnings either, though they may say why.
TEST_F(Commands, WarningsArePrintedWithoutAnAnswerToo) {
  const std::string good =
      file("good.tum", tum(50, [](int i) { return std::to_string(i) + " 0 0 0 0 0 1"; }));
  std::string unnamed = "Zeit,x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < 50; ++i) unnamed += std::to_string(1000 + 0.1 * i) + ",1,2,3,0,0,0,1\n";
  const std::string other = file("other.csv", unnamed);
  for (const std::string command : {"solve ", "check ", "align "}) {
    const Outcome run = egocal(command + good + " " + other);
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("warning: " + other + ": column 1 (Zeit) increases as times do"));
    EXPECT_THAT(run.err, HasSubstr("10 Hz assumed"));
    EXPECT_THAT(run.err, HasSubstr("no motion pairs"));
  }
  EXPECT_THAT(egocal("solve " + good + " " + other + " " + good).err, HasSubstr("10 Hz assumed"));
}

TEST_F(Commands, InfoIsAsStrictAsTheOthers) {
  const std::string doubled = file("doubled.tum", good_line + good_line + "1000.1 1 0 0 0 0 0 1\n"),
                    lost = file("lost.tum", good_line + "1000.1 nan 0 0 0 0 0 1\n1000.2 1 0 0 0 0 0 1\n");
  expect_refusal(egocal("info --strict " + doubled), 1, "expected increasing times");
  expect_refusal(egocal("info --strict " + lost), 1, "without a usable pose");
  EXPECT_EQ(egocal("info " + lost).code, 0);
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

TEST_F(Commands, BadLogsAndRigsAreRefused) {
  ASSERT_EQ(egocal("simulate --out " + path("d.log") + " --rig-out " + path("d.toml") + " --poses 200").code,
            0);
  expect_refusal(egocal("solve --log " + path("d.log") + " ODOMETRY_LIDAR OTHER"), 1,
                 "OTHER: no such channel in the log; there are: ODOMETRY_CAMERA, ODOMETRY_LIDAR");
  expect_refusal(
      egocal("info " + path("d.log") + ":OTHER"), 1,
      "OTHER: no pose under this name; topics with poses: ODOMETRY_LIDAR (egocal.odometry_t, 200), ");
  expect_refusal(egocal("compare " + path("d.log") + " " + path("d.log")), 1,
                 "d.log: holds several streams, choose one with ");
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
}  // namespace egocal::test_commands
