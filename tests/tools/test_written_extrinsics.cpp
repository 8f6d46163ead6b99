// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What is reported to somebody who writes an extrinsic for another program and reads nothing else.
#include "commands.hpp"

namespace egocal::test_written_extrinsics {
namespace {

using egocal::test::Commands;
using egocal::test::Outcome;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* formats[] = {"yaml",   "json",     "ros",     "ros-launch", "urdf",
                                   "kalibr", "autoware", "lio-sam", "opencv",     "matrix"};

class WrittenExtrinsics : public Commands {
 protected:
  /// The lidar and the camera of a simulated drive, to be solved.
  std::string drive(const std::string& name, const std::string& options) {
    const Outcome run = egocal("simulate --out " + path(name) + " " + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return path(name + "/lidar.tum") + " " + path(name + "/camera.tum") + " ";
  }
};

// The height was a number like any other, with an empty standard error
TEST_F(WrittenExtrinsics, ADirectionThatIsNotObservableIsNamedInEveryFormat) {
  const std::string flat = drive("flat", "--terrain flat --noise 0.01 --poses 400");
  for (const std::string format : formats) {
    SCOPED_TRACE(format);
    const Outcome printed = egocal("solve " + flat + "--format " + format);
    EXPECT_EQ(printed.code, 0);
    EXPECT_THAT(printed.err, AllOf(StartsWith("egocal: incomplete: Not known to"),
                                   HasSubstr("\negocal: NOT OBSERVABLE, not a measurement: z\n")));
    EXPECT_THAT(printed.out, AnyOf(HasSubstr("NOT OBSERVABLE, not a measurement: z"),
                                   HasSubstr("\"not_observable\": [\"z\"]")));
    const std::size_t verdict = printed.out.find("incomplete");
    ASSERT_NE(verdict, std::string::npos);
    EXPECT_LT(verdict, printed.out.find("certified"));
    const Outcome written = egocal("solve " + flat + "--format " + format + " --out " + path("answer"));
    EXPECT_EQ(written.err, printed.err);
    EXPECT_EQ(read(path("answer")), printed.out);
  }
  // beside the numbers, in the text and on the page
  const std::string text = egocal("solve " + flat).out;
  EXPECT_LT(text.find("\n  NOT OBSERVABLE, not a measurement: z\n"), text.find("T_b_a")) << text;
  egocal("report " + flat + "--out " + path("page.html"));
  EXPECT_THAT(read(path("page.html")), HasSubstr("<b>NOT OBSERVABLE, not a measurement: z</b>"));
  const Outcome nominal = egocal("solve " + flat + "--format urdf --nominal 0,0,1.25,1,0,0,0");
  EXPECT_THAT(nominal.err, HasSubstr("NOT OBSERVABLE, from the nominal value: z\n"));
  EXPECT_THAT(nominal.out, HasSubstr("NOT OBSERVABLE, from the nominal value: z; "));
  const json answer = json::parse(egocal("solve " + flat + "--format json").out);
  EXPECT_EQ(answer["verdict"], "incomplete");
  EXPECT_THAT(answer["reason"].get<std::string>(), StartsWith("Not known to"));
}

TEST_F(WrittenExtrinsics, AVerdictThatIsNotGoodAndAMissedGoalAreOnStandardError) {
  const std::string files = drive("drive", "--noise 0.01 --poses 400"), one = path("drive/lidar.tum");
  EXPECT_EQ(egocal("solve " + files + "--format urdf").err, "");
  EXPECT_THAT(egocal("solve " + files + "--format urdf").out, HasSubstr("<!-- verdict good: "));
  const Outcome twice = egocal("solve " + one + " " + one + " --format ros");
  EXPECT_THAT(twice.err, StartsWith("egocal: doubtful: "));
  EXPECT_THAT(twice.out, HasSubstr("\n# verdict doubtful: "));
  const Outcome missed = egocal("solve " + files + "--format urdf --goal 0.0001deg,0.001mm");
  EXPECT_EQ(missed.code, 3);
  EXPECT_THAT(missed.err, HasSubstr("Goal: missing"));
  EXPECT_EQ(std::count(missed.err.begin(), missed.err.end(), '\n'), 1) << missed.err;
  const std::string wrong = drive("wrong", "--noise 0.01 --poses 400 --clock-offset camera=0.3");
  const Outcome contradictory = egocal("solve " + wrong + "--out " + path("wrong.yaml"));
  EXPECT_EQ(contradictory.code, 3);
  EXPECT_THAT(contradictory.err, AllOf(StartsWith("egocal: contradictory: "), HasSubstr("Do not use")));
  EXPECT_THAT(read(path("wrong.yaml")), HasSubstr("\n# DO NOT USE, the motions contradict each other; "));
  // a choice of outliers that is proven was all that some read
  EXPECT_THAT(egocal("solve " + wrong).out, AllOf(HasSubstr("with this one the answer is contradictory"),
                                                  Not(HasSubstr("outliers      proven"))));
}

// A number was printed, and only a "-" beside it
TEST_F(WrittenExtrinsics, TheTableOfARigHasNoNumberForWhatIsUnknown) {
  const std::string files =
      drive("rig",
            "--terrain flat --noise 0.01 --poses 400 --sensor lidar=0,0,1.8,1,0,0,0 --sensor "
            "camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5 --sensor radar=2,0,0.5,1,0,0,0") +
      path("rig/radar.tum");
  const Outcome table = egocal("solve " + files);
  EXPECT_THAT(table.out,
              ::testing::ContainsRegex("lidar -> camera +-?[0-9]+[.][0-9]+ +-?[0-9]+[.][0-9]+ +unknown "));
  const Outcome tree = egocal("solve " + files + " --format urdf");
  EXPECT_THAT(tree.out, HasSubstr("NOT OBSERVABLE, not a measurement: z"));
  EXPECT_THAT(tree.err, HasSubstr("egocal: lidar -> camera: NOT OBSERVABLE, not a measurement: z\n"));
}

TEST_F(WrittenExtrinsics, AScaleThatWasFoundGoesWithIt) {
  const std::string files = drive("mono", "--noise 0.01 --poses 1200 --scale camera=2.7");
  const Outcome run = egocal("solve " + files + "--scale-b auto --frame-b front --format urdf");
  EXPECT_THAT(run.out, HasSubstr("; lengths of front multiplied by 2."));
  EXPECT_THAT(run.err, HasSubstr("egocal: the lengths of front, multiplied by 2."));
  EXPECT_THAT(egocal("solve " + files + "--scale-b auto --out " + path("a.yaml")).err, HasSubstr("lengths"));
  EXPECT_THAT(read(path("a.yaml")), HasSubstr("scale:  #"));
}

// The file behind standard output was replaced
TEST_F(WrittenExtrinsics, StandardOutputByItsNameIsWrittenBehindWhatIsThere) {
  const std::string files = drive("drive", "--noise 0.01 --poses 200");
  const std::string log = file("log", "keep\n");
  const std::string command = egocal::paths::bin_dir() + "/egocal solve " + files;
  ASSERT_EQ(std::system((command + "--format ros >" + path("alone")).c_str()), 0);
  ASSERT_EQ(std::system((command + ">" + path("report")).c_str()), 0);
  ASSERT_EQ(std::system((command + "--format ros --out /dev/stdout >>" + log).c_str()), 0);
  const std::string text = read(log), alone = read(path("alone"));
  EXPECT_EQ(text.substr(0, 5 + alone.size()), "keep\n" + alone);
  EXPECT_THAT(text.substr(5 + alone.size()), StartsWith("verdict "));
  // not appended to, but with one place to write at
  ASSERT_EQ(std::system((command + "--format ros --out /dev/fd/1 >" + log).c_str()), 0);
  const std::string both = read(log);
  EXPECT_EQ(both.substr(0, alone.size()), alone);
  EXPECT_THAT(both.substr(alone.size()), AllOf(StartsWith("verdict "), HasSubstr("uncertainty ")));
}

// It was evidence again: the standard deviations shrank
TEST_F(WrittenExtrinsics, TheSameRecordingIsNoFurtherDrive) {
  const std::string files = drive("drive", "--noise 0.01 --poses 400");
  const std::string other = drive("other", "--noise 0.01 --poses 400 --seed 7");
  const auto appended = [&](const std::string& more) { return solved(files + "--append " + more); };
  const json once = solved(files), again = appended(files), two = appended(other + " " + files);
  EXPECT_EQ(again["stddev"], once["stddev"]);
  EXPECT_EQ(again["pairs"], once["pairs"]);
  ASSERT_EQ(again["notes"].size(), 1u);
  EXPECT_THAT(again["notes"][0].get<std::string>(), HasSubstr("the same recording as "));
  EXPECT_EQ(two["notes"].size(), 1u);
  EXPECT_EQ(appended(other)["notes"].size(), 0u);
  EXPECT_EQ(appended(other)["pairs"], two["pairs"]);
  // a part of it
  std::string half = read(path("drive/lidar.tum"));
  half = half.substr(0, half.find('\n', half.size() / 2) + 1);
  const std::string part = file("half.tum", half) + " " + path("drive/camera.tum") + " ";
  EXPECT_THAT(appended(part)["notes"].dump(), HasSubstr("the same recording as "));
  EXPECT_THAT(solved(part + "--append " + files)["notes"].dump(),
              AllOf(HasSubstr("% of its poses are those of "), HasSubstr("count twice")));
}

TEST_F(WrittenExtrinsics, CheckAdvisesACommandThatHasTheOption) {
  const std::string off = drive("off", "--noise 0.01 --poses 400 --clock-offset camera=0.3");
  EXPECT_THAT(egocal("check " + off).out, HasSubstr("cure: egocal solve A B --time-offset auto\n"));
  const json checked = json::parse(egocal("check --json " + off).out);
  EXPECT_EQ(checked["findings"][0]["remedy"], "egocal solve A B --time-offset auto");
  EXPECT_THAT(egocal("solve " + off).out, HasSubstr("cure: --time-offset auto\n"));
  ASSERT_EQ(
      egocal("simulate --noise 0.01 --poses 400 --clock-offset camera=0.3 --out " + path("off.log")).code, 0);
  EXPECT_THAT(egocal("check ODOMETRY_LIDAR ODOMETRY_CAMERA --log " + path("off.log")).out,
              HasSubstr("cure: egocal solve A B --log LOG --time-offset auto\n"));
  std::string late;
  for (int i = 0; i < 100; ++i) late += std::to_string(9e8 + i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  const Outcome never = egocal("check " + path("off/lidar.tum") + " " + file("late.tum", late));
  EXPECT_EQ(never.code, 1);
  EXPECT_THAT(never.err,
              AllOf(HasSubstr("egocal solve A B --time-offset auto"), Not(HasSubstr("solve A B egocal"))));
}

TEST_F(WrittenExtrinsics, TimesOfOneFileAloneAreNamedWhereTheOtherHasItsOwn) {
  std::string kitti, times;
  for (int i = 0; i < 50; ++i) {
    kitti += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
    times += std::to_string(1000 + 0.1 * i) + "\n";
  }
  const std::string moving = drive("drive", "--poses 50"), lidar = path("drive/lidar.tum");
  const std::string b = file("b.txt", kitti), stamps = file("times.txt", times);
  const Outcome common = egocal("solve " + lidar + " " + b + " --times " + stamps);
  EXPECT_EQ(common.code, 1);
  EXPECT_THAT(common.err, HasSubstr("; --times-a or --times-b gives the times of one file alone"));
  EXPECT_THAT(egocal("solve " + lidar + " " + lidar + " --times-b " + stamps).err,
              Not(HasSubstr("--times-a")));
}

}  // namespace
}  // namespace egocal::test_written_extrinsics
