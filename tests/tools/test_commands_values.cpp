// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Values of the real program's options: what is refused, by which name and with which cure.
#include "commands.hpp"

namespace egocal::test_commands_values {
namespace {

namespace fs = std::filesystem;
using egocal::test::Commands;
using egocal::test::Outcome;
using nlohmann::json;
using ::testing::HasSubstr;

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

TEST_F(Commands, NumbersAreNumbersOfThePeopleWhoTypeThem) {
  const std::string simulate = "simulate --out " + path("never") + " ";
  expect_refusal(egocal(simulate + "--seed -1"), 2, "--seed: expected a whole number from 0 up, got '-1'");
  expect_refusal(egocal(simulate + "--poses 010"), 2, "--poses: expected a whole number, got '010'");
  expect_refusal(egocal(simulate + "--poses 1e3"), 2, "--poses: expected a whole number, got '1e3'");
  expect_refusal(egocal(simulate + "--poses 99999999999"), 2, "of at most 2147483647, got '99999999999'");
  expect_refusal(egocal(simulate + "--poses 1"), 2, "--poses: expected 2 to 10000000, got '1'");
  expect_refusal(egocal(simulate + "--rate 5Hz"), 2, "--rate: expected 0.001 to 100000, got '5Hz'");
  expect_refusal(egocal(simulate + "--terrain rugh"), 2,
                 "--terrain: expected flat, rough or free, got 'rugh'; did you mean rough?");
  expect_refusal(egocal("experiment noise --levels 0.1,x"), 2, "--levels: expected 0 to 10, got 'x'");
  EXPECT_FALSE(fs::exists(path("never")));
}

// "$GOAL" of a shell in which GOAL is not set: there was no goal, without a word
TEST_F(Commands, AnEmptyValueIsNoValue) {
  for (const char* arguments :
       {"solve a b --goal ''", "solve a b --truth ''", "solve '' b", "solve a b --stride ''",
        "solve --rig r --from ''", "info ''", "log create r --from a=b --out ''", "compare --truth ''",
        "simulate --out ''", "listen --lcm-url ''"})
    expect_refusal(egocal(arguments), 2, "expected a value, got ''; is a variable of the shell not set?");
  expect_refusal(egocal("solve a b --goal= --json"), 2, "--goal: expected a value behind '='");
  expect_refusal(program("egocal-monitor", "--once --rig ''"), 2, "--rig: expected a value");
  expect_refusal(program("egocal-pairing", "--rig ''"), 2, "--rig: expected a value");
}

// `simulate --out --poses 30` made a folder named --poses
TEST_F(Commands, AFlagHasNoValue) {
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d")).code, 0);
  const std::string drive = "solve " + path("d/lidar.tum") + " " + path("d/camera.tum");
  for (const char* value : {"3x", "3", "-1", "x"})
    expect_refusal(egocal(drive + " --json=" + value), 2,
                   std::string("--json: expected no value, got '") + value + "'");
  EXPECT_EQ(egocal(drive + " --json=true").out.substr(0, 1), "{");
}

TEST_F(Commands, TheNameOfAnOptionIsNoValue) {
  for (const char* option : {"--help", "--poses"})
    expect_refusal(egocal("simulate --out " + std::string(option)), 2,
                   "--out: expected a value, got the option '" + std::string(option) + "'");
  expect_refusal(egocal("solve a b --truth --json"), 2, "--truth: expected a value, got the option '--json'");
  expect_refusal(egocal("solve a -- --json"), 2, "expected a value, got the option '--json'");
}

TEST_F(Commands, WhatIsMistypedIsNamedWithItsCommand) {
  expect_refusal(egocal("log foo"), 2,
                 "'foo' is no command of egocal log; expected create, info, check, repair");
  expect_refusal(egocal("lgo info x"), 2, "'lgo' is no command of egocal; did you mean log?");
  expect_refusal(egocal("so"), 2, "'so' is no command of egocal; expected solve,");  // no word of two letters
  expect_refusal(egocal("log"), 2, "egocal log: expected a command: create, info, check, repair or export");
  expect_refusal(egocal("log export"), 2, "LOG is required; see egocal log export --help");
  expect_refusal(egocal("experiment noise x"), 2,
                 "'x' is one argument too many; see egocal experiment noise --help");
  expect_refusal(egocal("solve a b --mthod x"), 2,
                 "--mthod is no option of egocal solve; did you mean --method?");
  expect_refusal(egocal("solve a b -x"), 2, "-x is no option of egocal solve; see egocal solve --help");
  expect_refusal(egocal("--versoin"), 2, "--versoin is no option of egocal; did you mean --version?");
  expect_refusal(egocal("solve a b --stride"), 2, "--stride: expected a value; see egocal solve --help");
  expect_refusal(egocal("solve a b --goal 1 --goal 2"), 2, "--goal: is given more than once");
  expect_refusal(egocal("solve a b --planar=maybe"), 2, "--planar: expected no value, got 'maybe'");
  // the hint is about what is wrong, not about another word
  const Outcome both = egocal("solve a b --goal '' --mthod x");
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, ::testing::Not(HasSubstr("did you mean")));
}

TEST_F(Commands, RangesNameTheirOption) {
  const std::string solve = "solve a b ";
  for (const auto& [arguments, said] :
       {std::pair{"--weights 1e300:1", "--weights: expected R:T with R from 0 to 1e12"},
        {"--weights 1:1e300", "--weights: expected R:T with"},
        {"--weights 1", "--weights: expected equal, or R:T of rotation and translation, got '1'"},
        {"--stride 0x10", "--stride: expected a number, got '0x10'"},
        {"--max-gap 1e-9", "--max-gap: expected 0.001 to 3600, got '1e-9'"},
        {"--max-gap 1e5", "--max-gap: expected 0.001 to 3600, got '1e5'"},
        {"--stride 20000", "--stride: expected 1 to 10000, got '20000'"},
        {"--time-offset 5e9", "--time-offset: expected -4102444800 to 4102444800, got '5e9'"},
        {"--scale 0", "--scale: expected 1e-09 to 1000000000, got '0'"},
        {"--rate 1e-300", "--rate: expected at least 0.001, got '1e-300'"},
        {"--weights 1e-300:1e-300", "and T from 1e-12 to 1e12, got '1e-300:1e-300'"},
        {"--nominal 0,0,1e300,1,0,0,0", "--nominal: expected X,Y,Z within 1e9 m"},
        {"--nominal nan,nan,nan", "--nominal: nothing of it is known"},
        {"--nominal 1,2", "--nominal: expected X,Y,Z,QW,QX,QY,QZ or X,Y,Z, nan for what is not known"},
        {"--nominal 0,0,1,1,nan,0,0", "--nominal: give all of the quaternion, or nan for all of it"},
        {"--nominal nan,nan,1 --samples", "--nominal: with --samples all of it is needed"},
        {"--nominal 0,0,1,1,0,0,0 --method analytic", "--nominal: does not go with --method analytic"},
        {"--truth 0,0,1e300,1,0,0,0", "--truth: expected X,Y,Z within 1e9 m"},
        {"--planar --plane-a 0,0,1,1e300 --plane-b 0,0,1,0",
         "--plane-a: expected NX,NY,NZ,D with D within 1e9 m"},
        {"--goal 200deg,1cm", "--goal: expected at most 180deg"},
        {"--out -", "--out: '-' is not taken for standard output: expected the name of a file"},
        {"--frame-a x --frame-b x --json", "--frame-a, --frame-b: expected two names, got 'x' for both"},
        {"--frame-a=-x --frame-b y --json",
         "--frame-a: expected up to 100 letters, digits and _ - . /, no - first"},
        {"--goal 1deg,2km",
         "--goal: expected two accuracies above 0 as 0.1deg,2cm (deg or rad; mm, cm or m)"},
        {"--frame-a 'my lidar' --json", "--frame-a: expected up to 100 letters, digits and _ - . /"}})
    expect_refusal(egocal(solve + arguments), 2, said);
  EXPECT_FALSE(fs::exists("-"));
  expect_refusal(egocal("compare --truth 0,0,0,1,0,0,0"), 2,
                 "--truth: goes with A, which is not given");  // it has its own
  expect_refusal(egocal("experiment noise --out -"), 2, "--out: '-' is not taken for standard output");
}

TEST_F(Commands, ADriveIsSimulatedAsItWasAskedForOrNotAtAll) {
  const std::string out = path("o");
  const std::string at = "=0,0,0,1,0,0,0 ";
  for (const auto& [arguments, said] :
       {std::pair{"--sensor a" + at + "--sensor a" + at, "--sensor: a and a would both send on ODOMETRY_A"},
        {"--sensor cam" + at + "--sensor Cam" + at, "--sensor: cam and Cam would both send on ODOMETRY_CAM"},
        {"--sensor a=0,0,1e300,1,0,0,0 --sensor b" + at, "--sensor: expected X,Y,Z within"},
        {std::string("--rate 0"), "--rate: expected 0.001 to 100000, got '0'"},
        {"--speed 1e300", "--speed: expected -1000 to 1000, got '1e300'"},
        {"--roughness -1", "--roughness: expected 0 to 1000, got '-1'"},
        {"--noise-rotation nan", "--noise-rotation: expected 0 to 1000, got 'nan'"},
        {"--poses 101 --bump lidar=10.1:1,0,0,0,0,0",
         "--bump: expected a time within the drive, 0 to 10 s, got '10.1'"},
        {"--jump lidar=-1:1,0,0,0,0,0", "--jump: expected a time within the drive"},
        {"--creep lidar=5:3:1,0,0,0,0,0", "--creep: expected 5 to"},
        {"--bump lidar=5:1e300,0,0,0,0,0", "--bump: expected -1000 to 1000, got '1e300'"},
        {"--phase lidar=1000", "--phase: expected 0 to 100, got '1000'"},
        {"--drop lidar=1", "--drop: expected 0 to 0.999, got '1'"},
        {"--scale lidar=2 --scale lidar=3", "--scale: is given twice for one sensor"},
        {"--out " + path("drive.bag"), "--out: is given more than once"},
        {"--rig-out " + out + "/lidar.tum", "lidar.tum is a file of --out: expected another name"},
        {"--rig-out " + out + "/./truth_lidar_camera.txt", "is a file of --out: expected another name"}})
    expect_refusal(egocal("simulate --out " + out + " " + arguments), 2, said);
  expect_refusal(egocal("simulate --out " + path("drive.bag")), 2,
                 "--out: expected a file .log or .mcap, or a");
  // no partial output
  for (const std::string& name : {out, path("o.log"), path("o.mcap")}) {
    expect_refusal(egocal("simulate --poses 20 --out " + name + " --rig-out " + path("nodir/x")), 1,
                   "nodir/x: cannot be written: No such file or directory");
    EXPECT_FALSE(fs::exists(name)) << name;
  }
  expect_refusal(egocal("simulate --poses 3 --drop lidar=0.999 --out " + out), 1,
                 "sensor 1 has no pose left");
  expect_refusal(egocal("simulate --poses 10000000 --rate 0.001 --out " + out), 1, "at most 1e9 m");
  EXPECT_EQ(egocal("simulate --poses 20 --out " + out + " --rig-out " + out + "/rig.toml").code, 0);
  EXPECT_TRUE(fs::exists(out + "/rig.toml"));
}

TEST_F(Commands, ASensorIsGivenOnce) {
  const std::string rig = path("rig.toml");
  ASSERT_EQ(egocal("simulate --poses 60 --out " + path("d") + " --rig-out " + rig).code, 0);
  const std::string lidar = path("d/lidar.tum"), twice = " --from lidar=" + lidar + " --from lidar=" + lidar;
  expect_refusal(egocal("solve --rig " + rig + twice), 2,
                 "--from: the sensor lidar is given twice; another drive");
  expect_refusal(egocal("log create " + rig + twice + " --out " + path("x.log")), 2,
                 "--from: the sensor lidar is given twice");
  EXPECT_FALSE(fs::exists(path("x.log")));
  expect_refusal(egocal("solve --rig " + rig + " --from lidar= --from camera=" + lidar), 2,
                 "--from: expected NAME=FILE, got 'lidar='");
}

// It was ignored without a word
TEST_F(Commands, ADriveWithoutMotionsIsNamed) {
  ASSERT_EQ(egocal("simulate --poses 200 --noise 0.001 --out " + path("d")).code, 0);
  const std::string a = path("d/lidar.tum"), b = path("d/camera.tum");
  std::string later = read(b);
  for (std::size_t at = 0; (at = later.find("\n17", at)) != std::string::npos;) later[at + 1] = '2';
  const std::string c = file("later.tum", later);
  // files that are given twice are warned of as well
  const auto expect_last = [](const Outcome& run, const std::string& part) {
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(run.out, "");
    const std::size_t last = run.err.rfind("\negocal: ");
    EXPECT_THAT(run.err.substr(last == std::string::npos ? 0 : last), HasSubstr(part));
  };
  const std::string said = "--append: " + a + ", " + c + ": no motion pairs in this drive; a: 200 poses from";
  expect_last(egocal("solve " + a + " " + b + " --append " + a + " " + c), said);
  const std::string d = file("copy.tum", read(b));
  expect_last(egocal("solve " + a + " " + b + " " + d + " --append " + a + " " + c + " " + b), said);
  expect_last(egocal("solve " + a + " " + c + " --append " + a + " " + b),
              "later.tum: no motion pairs in this drive");
  EXPECT_EQ(egocal("solve " + a + " " + b + " --append " + a + " " + b).code, 0);
}

// Times of a finding are of all drives one after the other: "about 2076.1 s" of drives of 276 and 114 s.
TEST_F(Commands, TimesOfFindingsAreThoseOfADrive) {
  const auto drive = [&](const std::string& name, const std::string& more) {
    EXPECT_EQ(egocal("simulate --terrain free --poses 400 --noise 0.002 --out " + path(name) + more).code, 0);
    return path(name) + "/lidar.tum " + path(name) + "/camera.tum";
  };
  const std::string one = drive("one", " --seed 1");
  const std::string bumped = drive("bumped", " --seed 3 --bump camera=20:0,0,0,0,4,0");
  EXPECT_THAT(egocal("solve " + one + " --append " + bumped).out,
              ::testing::ContainsRegex(" s is (19|20|21)\\.[0-9] s into " + path("bumped/lidar.tum")));
}

TEST_F(Commands, TheCureOfAnOptionIsToLeaveItOut) {
  ASSERT_EQ(egocal("simulate --poses 300 --noise 0.01 --out " + path("d")).code, 0);
  const auto cures = [&](const std::string& options) {
    const Outcome run = egocal("solve --json " + path("d/lidar.tum") + " " + path("d/camera.tum") + options);
    EXPECT_EQ(run.code, 3) << run.err;
    std::string all;
    const json found = json::parse(run.out);
    for (const json& finding : found["findings"]) all += finding["remedy"].get<std::string>() + "\n";
    return all + found["reason"].get<std::string>();
  };
  EXPECT_THAT(cures(" --invert-a"), HasSubstr("leave out --invert-a"));
  EXPECT_THAT(cures(" --invert-b"), HasSubstr("leave out --invert-b"));
  EXPECT_THAT(cures(" --invert-a --invert-b"), HasSubstr("leave out --invert-a and --invert-b"));
  EXPECT_THAT(cures(" --invert-a --invert-b"), HasSubstr("are sensor-to-world already"));
  EXPECT_THAT(cures(" --quaternion-order-b xyzw"), HasSubstr("leave out --quaternion-order-b"));
  EXPECT_THAT(cures(" --quaternion-order-a xyzw --quaternion-order-b xyzw"),
              HasSubstr("leave out --quaternion-order-a and --quaternion-order-b"));
  EXPECT_THAT(cures(" --scale 2"), HasSubstr("leave out --scale\n"));
  EXPECT_THAT(cures(" --scale-b 3"), HasSubstr("leave out --scale-b\n"));
}

TEST_F(Commands, CheckNamesTheOptionsThatItDoesNotUse) {
  ASSERT_EQ(egocal("simulate --poses 200 --out " + path("d")).code, 0);
  EXPECT_THAT(egocal("check " + path("d/lidar.tum") + " " + path("d/camera.tum") + " --rate 5").err,
              HasSubstr("lidar.tum: --rate is not used: the poses have times"));
}
// Listed in the help, and refused each time
TEST_F(Commands, AlignHasOnlyTheOptionsThatItTakes) {
  const std::string help = egocal("align --help").out;
  for (const char* option : {"--pairs", "--samples", "--append", "--eye-to-hand", "--eye-in-hand"}) {
    EXPECT_THAT(help, ::testing::Not(HasSubstr(option)));
    expect_refusal(egocal(std::string("align ") + option), 2, option);
  }
  EXPECT_THAT(help, HasSubstr("--scale-b"));
}

// Bytes of a name made the page no UTF-8, and a mark in one turned the text behind it round.
TEST_F(Commands, AReportIsValidWhateverItsFilesAreCalled) {
  ASSERT_EQ(egocal("simulate --poses 60 --noise 0.01 --out " + path("drive")).code, 0);
  const std::string name = path("<b>\xff \xe2\x80\xaemut.tum"), html = "&lt;b&gt;?  mut.tum";
  std::filesystem::rename(path("drive/lidar.tum"), name);
  egocal("report '" + name + "' " + path("drive/camera.tum") + " --out " + path("page.html"));
  const std::string page = read(path("page.html"));
  EXPECT_THAT(page, HasSubstr("in the frame of " + path(html)));
  EXPECT_THAT(page, HasSubstr("<code>" + path(html) + "</code>"));
  EXPECT_THAT(page, HasSubstr("<meta name='viewport' "));
  EXPECT_EQ(page.find('\xff'), std::string::npos);
  EXPECT_EQ(page.find("\xe2\x80\xae"), std::string::npos);
}

// The numbers of solve were not on the page, and its pictures were of other motions
TEST_F(Commands, AReportStatesTheFitThatSolvePrints) {
  ASSERT_EQ(egocal("simulate --poses 300 --noise 0.01 --out " + path("drive")).code, 0);
  const std::string pair = " " + path("drive/lidar.tum") + " " + path("drive/camera.tum");
  const std::string solve = egocal("solve" + pair).out;
  const std::size_t begin = solve.find("\nfit           ") + 15;
  const std::string fit = solve.substr(begin, solve.find('\n', begin) - begin);
  ASSERT_EQ(egocal("report" + pair + " --out " + path("page.html")).code, 0);
  const std::string page = read(path("page.html"));
  EXPECT_THAT(page, HasSubstr("<p>Fit: " + fit + ".</p>"));
  const std::size_t motion = fit.find("a motion of ") + 12;
  const std::string seconds = fit.substr(motion, fit.find(';') - motion);
  EXPECT_THAT(page, HasSubstr("Rotation residuals of motions of " + seconds));
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The text of a line that solve prints after its label of 14 cells; empty: there is none.
std::string printed(const std::string& text, const std::string& label) {
  const std::string begin = "\n" + label + std::string(14 - label.size(), ' ');
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return "";
  return text.substr(at + begin.size(), text.find('\n', at + 1) - at - begin.size());
}

// The page said "the goal is not reached yet" and nothing of what is missing, how long, and what to drive
TEST_F(Commands, AReportSaysOfTheGoalWhatSolvePrints) {
  ASSERT_EQ(egocal("simulate --poses 300 --noise 0.01 --out " + path("drive")).code, 0);
  const std::string pair = " " + path("drive/lidar.tum") + " " + path("drive/camera.tum");
  const std::string goal = pair + " --goal 0.001deg,0.1mm";
  const std::string solve = egocal("solve" + goal).out;
  ASSERT_EQ(egocal("report" + goal + " --out " + path("page.html")).code, 3);
  const std::string page = read(path("page.html"));
  ASSERT_THAT(printed(solve, "goal"), HasSubstr("missing: "));
  ASSERT_NE(printed(solve, "next"), "");
  EXPECT_THAT(page, HasSubstr("<p>Goal: " + printed(solve, "goal") + ".</p>"));
  EXPECT_THAT(page, HasSubstr("<p>Next: " + printed(solve, "next") + "</p>"));
  ASSERT_EQ(egocal("report" + pair + " --goal 10deg,1m --out " + path("page.html")).code, 0);
  EXPECT_THAT(read(path("page.html")), HasSubstr("<p>Goal: reached.</p>"));
}

// A possible finding looked like a certain one, and its cure was called "Remedy"
TEST_F(Commands, AReportMarksPossibleFindingsAndNamesCures) {
  ASSERT_EQ(egocal("simulate --poses 300 --noise 0.01 --terrain free --out " + path("drive")).code, 0);
  ASSERT_EQ(
      egocal("simulate --poses 300 --noise 0.01 --terrain free --scale camera=2.7 --out " + path("wrong"))
          .code,
      0);
  for (const char* drive : {"drive", "wrong"}) {
    const std::string pair =
        " " + path(std::string(drive) + "/lidar.tum") + " " + path(std::string(drive) + "/camera.tum");
    const json findings = json::parse(egocal("solve --json" + pair).out)["findings"];
    egocal("report" + pair + " --out " + path("page.html"));
    const std::string page = read(path("page.html"));
    EXPECT_THAT(page, ::testing::Not(HasSubstr("Remedy")));
    std::size_t certain = 0;
    for (const json& finding : findings) certain += finding["certain"].get<bool>() ? 1 : 0;
    EXPECT_EQ(count_of(page, "<b>Finding:</b> "), certain);
    EXPECT_EQ(count_of(page, "<b>Possible:</b> "), findings.size() - certain);
    EXPECT_EQ(count_of(page, "<br>Cure: "), findings.size());
  }
}

// Figures without anything in them were drawn
TEST_F(Commands, AReportLeavesOutFiguresThatWouldBeEmpty) {
  ASSERT_EQ(egocal("simulate --poses 4 --out " + path("drive")).code, 0);
  egocal("report " + path("drive/lidar.tum") + " " + path("drive/camera.tum") + " --out " +
         path("page.html"));
  const std::string page = read(path("page.html"));
  EXPECT_LT(count_of(page, "<figure>"), 8u);
  EXPECT_EQ(count_of(page, "No figure of: "), 1u);
  EXPECT_THAT(page, HasSubstr("The drive is too short."));
  for (std::size_t at = page.find("<figure>"); at != std::string::npos; at = page.find("<figure>", at + 1)) {
    const std::string figure = page.substr(at, page.find("</figure>", at) - at);
    EXPECT_GT(count_of(figure, "<polyline") + count_of(figure, "<path") + count_of(figure, "<rect"), 0u);
  }
}

}  // namespace
}  // namespace egocal::test_commands_values
