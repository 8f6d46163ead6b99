// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "../support/random_motion.hpp"
#include "egocal/error.hpp"
#include "egocal/io/pairs_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal::test_io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Io : public ::testing::Test {
 protected:
  Io() : directory_(fs::temp_directory_path() / ("egocal_io_" + std::to_string(::getpid()))) {
    fs::create_directories(directory_);
  }
  ~Io() override { fs::remove_all(directory_); }

  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return path(name);
  }
  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  /// One line, naming the file, and what is expected in it.
  void expect_error(const std::string& content, const std::string& part,
                    const std::string& times = "") const {
    const std::string name = file("bad", content);
    try {
      read_trajectory(name, times);
      FAIL() << "accepted: " << content;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(part)) << content;
      EXPECT_THAT(error.what(), HasSubstr(path("")));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }

 private:
  fs::path directory_;
};

TEST_F(Io, ReadsTum) {
  const Trajectory trajectory = read_trajectory(
      file("a.tum",
           "# comment\n\n1317375625.661736 1 2 3 0 0 0 1\r\n1317375625.7617365 4 5 6 0.5 0.5 0.5 -0.5\n"));
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].time_us, 1317375625661736);
  EXPECT_EQ(trajectory[1].time_us, 1317375625761737);  // half a microsecond rounds up
  const Pose pose = to_pose(trajectory[1].pose);
  EXPECT_LT((pose.translation - Eigen::Vector3d(4, 5, 6)).norm(), 1e-14);
  EXPECT_LT((pose.rotation.coeffs() - Eigen::Vector4d(-0.5, -0.5, -0.5, 0.5)).norm(), 1e-14);  // x y z w
}

TEST_F(Io, ReadsTheSameNumbersWhateverIsBetweenThem) {
  const std::string plain = "0.042966448121465314 -2.5e-3 3 0.5 0.5 0.5 -0.5";
  const Trajectory expected = read_trajectory(file("a.tum", "10.5 " + plain + "\n11.5 " + plain + "\n"));
  for (const std::string row : {"\t0.042966448121465314\t-2.5e-3\t3\t0.5\t0.5\t0.5\t-0.5",
                                "  0.042966448121465314   -2.5e-3 3 .5 .5 .5 -.5  ",
                                " +0.042966448121465314 -2.5e-3 +3 0.5 0.5 0.5 -0.5",
                                " 0.042966448121465314 -2.5e-3\t3 0.5 0.5 0.5 -0.5\t"}) {
    const Trajectory found = read_trajectory(file("b.tum", "10.5" + row + "\n  11.5" + row + "\r\n"));
    ASSERT_EQ(found.size(), expected.size()) << row;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].time_us, expected[i].time_us) << row;
      EXPECT_EQ(found[i].pose.vec(), expected[i].pose.vec()) << row;
    }
  }
  for (const std::string wrong : {"inf", "1e999", "1x", "x", "0x1"})
    expect_error("10.5 " + plain + "\n11.5 1 " + wrong + " 3 0 0 0 1\n", "(ty)");
}

TEST_F(Io, ReadsEurocWithItsOwnOrderAndNanoseconds) {
  const Trajectory trajectory =
      read_trajectory(file("a.csv",
                           "#timestamp [ns],x,y,z,qw,qx,qy,qz,vx\n1413393213480760576,1,2,3,0,1,0,0,9\n"
                           "1413393213485760400, 1, 2, 3, 0, 1, 0, 0, 9\n"));
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].time_us, 1413393213480761);
  EXPECT_EQ(trajectory[1].time_us, 1413393213485760);
  EXPECT_NEAR(std::abs(to_pose(trajectory[0].pose).rotation.x()), 1, 1e-15);
}

TEST_F(Io, ReadsKittiWithTimes) {
  const std::string times = file("times", "0\n1.5e-1\n");
  const Trajectory trajectory =
      read_trajectory(file("a.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n"), times);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[1].time_us, 150000);
  EXPECT_LT((to_pose(trajectory[1].pose) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(4, 6, 6)).norm(),
            1e-14);
}

TEST_F(Io, TumSurvivesARoundTrip) {
  testing::Random random(1);
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i)
    trajectory.push_back({1'700'000'000'000'000 + 33'333 * i, testing::random_extrinsic(random)});
  write_tum(path("b.tum"), trajectory);
  const Trajectory again = read_trajectory(path("b.tum"));
  ASSERT_EQ(again.size(), trajectory.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].time_us, trajectory[i].time_us);
    EXPECT_LT((again[i].pose.vec() - trajectory[i].pose.vec()).norm(), 1e-14);
  }
}

TEST_F(Io, LinesMayEndAsThoseOfOldMacs) {
  std::string text = "# comment\r";
  const std::string zeros(70, '0');
  for (int i = 0; i < 50'000; ++i) text += std::to_string(100 + i) + " 1." + zeros + " 2 3 0 0 0 1\r";
  ASSERT_GT(text.size(), std::size_t{4} << 20) << "more than is looked through for the end of a line";
  const Trajectory found = read_trajectory(file("b.tum", text));
  ASSERT_EQ(found.size(), 50'000u);
  EXPECT_EQ(found.back().time_us, 50'099'000'000);
  expect_error("1 0 0 0 0 0 0 1\r2 0 0 zero 0 0 0 1\r", ":2: field 4 (tz): expected a number, got 'zero'");
}

// They held "no data": the header and the rows were one line, a comment.
TEST_F(Io, AHeaderMayBeAboveRowsThatEndAsThoseOfOldMacs) {
  const std::string rows = "1 1 2 3 0 0 0 1\r2 4 5 6 0 0 0 1\r3 7 8 9 0 0 0 1\r";
  for (const char* header :
       {"# comment\n", "time tx ty tz qx qy qz qw\n", "# comment\r\n", "# one\r# two\n"}) {
    const Trajectory found = read_trajectory(file("b.tum", header + rows));
    ASSERT_EQ(found.size(), 3u) << header;
    EXPECT_EQ(found.back().time_us, 3'000'000);
    EXPECT_EQ(to_pose(found.back().pose).translation.z(), 9);
  }
  expect_error("# comment\n1 0 0 0 0 0 0 1\r2 0 0 zero 0 0 0 1\r", ":3: field 4 (tz): expected a number");
}

TEST_F(Io, BadTrajectoriesGetOneClearLine) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  expect_error("", "holds no data");
  expect_error("# only a comment\n\n", "holds no data");
  expect_error(good + "2 0 0 zero 0 0 0 1\n", ":2: field 4 (tz): expected a number, got 'zero'");
  expect_error(good + "2 0 0 1e400 0 0 0 1\n", ":2: field 4 (tz)");
  expect_error(good + "2 0 0 1.0x 0 0 0 1\n", "got '1.0x'");
  expect_error(good + "2 -inf 0 0 0 0 0 1\n", ":2: field 2 (tx): expected a finite number");
  expect_error(good + "2 0 inf 0 0 0 0 1\n", ":2: field 3 (ty)");
  expect_error(
      "2 0 0 0 0 0 0 0\n",
      "holds no pose that can be read; 1 without a usable pose skipped (first: line 1: quaternion: is zero)");
  expect_error(good + "2 0 0 0 0 0 0 2\n", ":2: quaternion: expected length 1");
  expect_error(good + "2 0 0 0 0 0 1\n", ":2: expected 8 fields");
  expect_error(good + "x 0 0 0 0 0 0 1\n", ":2: time: expected a number, got 'x'");
  expect_error(good + "2 0 0 1e300 0 0 0 1\n", ":2: position: expected less than 1e9 m");
  expect_error(good + "2 0 0 +-1 0 0 0 1\n", ":2: field 4 (tz): expected a number, got '+-1'");
  expect_error(good + "2 0 0 \x1b[2J" + std::string(5000, 'x') + " 0 0 0 1\n", "got '?[2Jxxxxx");
  expect_error("1 0 0 1e300 0 1 0 2 0 0 1 3\n", "position: expected less", file("t0", "0\n"));
  expect_error("1e300 0 0 1 0 1 0 2 0 0 1 3\n", "not a rotation", file("t0", "0\n"));
  expect_error("1 2 3\n", ":1: expected 8 fields");
  expect_error("99999999999999999999 0 0 0 0 0 0 1\n", "out of range");
  expect_error("1,0,0,0,0,0\n", ":1: expected at least 8 fields");
  expect_error("1 0 0 1 0 2 0 2 0 0 1 3\n", "not a rotation", file("t1", "0\n"));
  expect_error("1 0 0 1 0 1 0 2 0 0 1 3\n", "expected 1 times", file("t2", "0\n1\n"));
  expect_error(good, "its poses have times of their own", file("t3", "0\n"));
  EXPECT_THROW(read_trajectory(path("missing")), Error);
}

// As docs/formats.md says, and as the note on an assumed rate offers.
TEST_F(Io, AFileOfTimesSuitsAllPosesWithoutTimes) {
  const std::string times = file("times", "5\n5.5\n");
  for (const std::string poses :
       {"1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 1 0 1 0 2 0 0 1 4\n", "1 2 3 0 0 0 1\n1 2 4 0 0 0 1\n",
        "0 1 0 0 1 0 1 0 2 0 0 1 3\n1 1 0 0 1 0 1 0 2 0 0 1 4\n",
        "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n1 0 0 1 0 1 0 2 0 0 1 4 0 0 0 1\n"}) {
    const Trajectory trajectory = read_trajectory(file("poses", poses), times);
    ASSERT_EQ(trajectory.size(), 2u) << poses;
    EXPECT_EQ(trajectory[0].time_us, 5'000'000) << poses;
    EXPECT_EQ(trajectory[1].time_us, 5'500'000) << poses;
    EXPECT_EQ(to_pose(trajectory[1].pose).translation.z(), 4) << poses;
  }
}

TEST_F(Io, PairsSurviveARoundTripAndBadOnesDoNot) {
  testing::Random random(2);
  const auto pairs =
      testing::random_pairs(testing::random_extrinsic(random), {.pairs = 10, .noise = 0.1}, random);
  write_pairs(path("pairs"), pairs);
  const std::vector<MotionPair> again = read_pairs(path("pairs"));
  ASSERT_EQ(again.size(), pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_LT((again[i].a.vec() - canonical_sign(pairs[i].a).vec()).norm(), 1e-14);
    EXPECT_LT((again[i].b.vec() - canonical_sign(pairs[i].b).vec()).norm(), 1e-14);
  }
  const auto rejects = [this](const std::string& content, const std::string& part) {
    try {
      read_pairs(file("bad_pairs", content));
      FAIL() << content;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  };
  rejects("1 0 0 0 0 0 0 0 1 0 0 0 0 0 0\n", ":1: expected 16 fields");
  rejects("1 0 0 0 0 0 0 0 1 0 0 0 0 0 0 q\n", "field 16 (b dz)");
  rejects("2 0 0 0 0 0 0 0 1 0 0 0 0 0 0 0\n", "a: the real part");
  rejects("1 0 0 0 0 1e300 0 0 1 0 0 0 0 0 0 0\n", "a: expected less than 1e9 m");
  rejects("1 0 0 0 0 0 0 0 1 0 0 0 1 0 0 0\n", "b: real and dual part are not orthogonal");
}

TEST_F(Io, FilesAreWholeOrAbsent) {
  EXPECT_THROW(write_whole_file(path("no_such_directory/file"), "x"), Error);
  write_whole_file(path("whole"), "first");
  write_whole_file(path("whole"), "second");
  std::ifstream stream(path("whole"));
  std::string text;
  std::getline(stream, text);
  EXPECT_EQ(text, "second");
  write_whole_file("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_whole_file("/dev/full", "does not fit"), Error);
  EXPECT_THROW(write_whole_file(path(""), "a folder"), Error);
}

}  // namespace
}  // namespace egocal::test_io
