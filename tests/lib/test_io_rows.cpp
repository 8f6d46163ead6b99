// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Rows as programs write them: fields that are missing, quoted or empty cost their own row, and move no other
// field.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_rows {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TextRows : public ::testing::Test {
 protected:
  TrajectoryReading read(const std::string& content, const ReadOptions& options = {}) const {
    return read_trajectory_file(folder_.file("rows", content), options);
  }
  std::string refusal(const std::string& content, const ReadOptions& options = {}) const {
    try {
      read(content, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  /// Poses at 0 s, 1 s, ...: at x = 1, 2, ... with y and z ten and a hundred times as large.
  void expect_poses(const TrajectoryReading& reading, std::size_t count, const std::string& what) const {
    ASSERT_EQ(reading.trajectory.size(), count) << what;
    for (const StampedPose& stamped : reading.trajectory) {
      const double i = 1e-6 * static_cast<double>(stamped.time_us);
      const Pose pose = to_pose(stamped.pose);
      EXPECT_LT((pose.translation - (i + 1) * Eigen::Vector3d(1, 10, 100)).norm(), 1e-9) << what;
    }
  }
  /// Four rows with these words in front of x and behind the last field.
  static std::string rows(char separator, const std::string& format, const std::vector<std::string>& words) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
      const std::string word = words[static_cast<std::size_t>(i) % words.size()];
      for (const char c : format) {
        const bool first = text.empty() || text.back() == '\n';
        if (!first) text += separator;
        if (c == 't') text += std::to_string(i);
        if (c == 'x') text += std::to_string(i + 1);
        if (c == 'y') text += std::to_string(10 * (i + 1));
        if (c == 'z') text += std::to_string(100 * (i + 1));
        if (c == '0' || c == '1') text += c;
        if (c == '-') text += word;
      }
      text += '\n';
    }
    return text;
  }
  testing::ScratchFolder folder_;
};

TEST_F(TextRows, RowsWithoutNumbersAreCountedAndSkipped) {
  ReadOptions strict;
  strict.strict = true;
  for (const std::string missing : {"nan", "NaN", "-nan", "-nan(ind)", "None", "null", "NULL", "NA"}) {
    const std::string lost = "5 " + missing + " 0 0 0 0 0 1\n";
    const std::string tum = rows(' ', "txyz0001", {""});
    std::string table = "t,x,y,z,qx,qy,qz,qw\n" + rows(',', "txyz0001", {""}) + lost;
    std::replace(table.end() - static_cast<std::ptrdiff_t>(lost.size()), table.end(), ' ', ',');
    std::string matrix;
    for (int i = 0; i < 4; ++i) {
      const std::string n = std::to_string(i + 1);
      matrix += "1 0 0 " + n + " 0 1 0 " + n + "0 0 0 1 " + n + "00\n";
    }
    for (const std::string& content : {tum + lost, lost + tum, table}) {
      const TrajectoryReading reading = read(content);
      expect_poses(reading, 4, content);
      EXPECT_EQ(reading.losses.refused, 1u) << content;
      EXPECT_THAT(refusal(content, strict), HasSubstr("without a number")) << content;
      EXPECT_THAT(refusal(content, strict), HasSubstr("line ")) << content;
    }
    const std::string gap = missing + " 0 0 0 0 1 0 0 0 0 1 0\n";
    EXPECT_EQ(read(matrix + gap).losses.refused, 1u) << missing;
    EXPECT_THAT(refusal(lost + lost), HasSubstr("holds no pose")) << missing;
  }
  // of a column that is not read it is no loss
  EXPECT_EQ(refusal("t,x,y,z,qx,qy,qz,qw,age\n" + rows(',', "txyz0001-", {"nan"}), strict), "accepted");
  EXPECT_THAT(refusal(rows(' ', "txyz0001", {""}) + "5 nanx 0 0 0 0 0 1\n"), HasSubstr("expected a number"));
}

/// What some trackers write where they are lost. It refused the whole file, and in a bag one message alone.
TEST_F(TextRows, AZeroQuaternionCostsItsRow) {
  const std::string tum = rows(' ', "txyz0001", {""}), lost = "9 1 2 3 0 0 0 0\n";
  for (const std::string& content :
       {tum + lost, lost + tum,
        "t,x,y,z,qx,qy,qz,qw\n" + rows(',', "txyz0001", {""}) + "9,1,2,3,0,0,0,0\n"}) {
    const TrajectoryReading reading = read(content);
    expect_poses(reading, 4, content);
    EXPECT_EQ(reading.losses.refused, 1u) << content;
    EXPECT_THAT(reading.losses.first_refused, HasSubstr(": quaternion: is zero")) << content;
  }
  ReadOptions strict;
  strict.strict = true;
  EXPECT_THAT(refusal(tum + lost, strict), HasSubstr("line 5: quaternion: is zero"));
}

/// The quaternion of a TUM file was read as an angle, without a word.
TEST_F(TextRows, FieldsBehindTheLastNameAreSaidToBeUnread) {
  ReadOptions options;
  options.columns = "t,x,y,z,yaw[deg]";
  EXPECT_THAT(read(rows(' ', "txyz0001", {""}), options).notes,
              Contains(HasSubstr("--columns names 5 of 8 fields in a row")));
  options.columns += ",-,-,-";
  EXPECT_THAT(read(rows(' ', "txyz0001", {""}), options).notes, IsEmpty());
}

TEST_F(TextRows, ACommentMayEndARow) {
  expect_poses(read(rows(' ', "txyz0001-", {"# lost", "#", "# 1 2 3"})), 4, "TUM");
  expect_poses(read("t,x,y,z,qx,qy,qz,qw\n" + rows(',', "txyz0001", {""}) + "4,5,50,500,0,0,0,1 # last\n"), 5,
               "table");
  expect_poses(read("t,frame,x,y,z,qx,qy,qz,qw\n" + rows(',', "t-xyz0001", {"cam#1", "\"cam #1\""})), 4,
               "names");
}

TEST_F(TextRows, AnEmptyFieldBetweenTabsMovesNoOther) {
  const std::string header = "t\tkey\tx\ty\tz\tqx\tqy\tqz\tqw\tid\n", format = "t-xyz0001-";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{""}, {"", "1"}, {"1", "1", "", "1"}, {"a b", ""}}) {
    expect_poses(read(header + rows('\t', format, words)), 4, header + words[0]);
    expect_poses(read("# " + header + rows('\t', format, words)), 4, "comment " + words[0]);
    ReadOptions options;
    options.columns = "t,-,x,y,z,qx,qy,qz,qw,-";
    expect_poses(read(rows('\t', format, words), options), 4, "--columns " + words[0]);
  }
  // names with blanks, and a field that is read
  const TrajectoryReading reading = read("Time [s]\tX [m]\tY [m]\tZ [m]\tqx\tqy\tqz\tqw\n" +
                                         rows('\t', "txyz0001", {""}) + "5\t\t0\t0\t0\t0\t0\t1\n");
  expect_poses(reading, 4, "names with blanks");
  EXPECT_THAT(reading.losses.first_refused, HasSubstr("line 6: an empty field"));
}

TEST_F(TextRows, OtherBlanksMerge) {
  expect_poses(read("0\t1 10 \t 100\t0 0  0\t1\n1 2\t\t20 200\t\t0\t0 0 1\n"), 2, "TUM");
  expect_poses(read("0\t\t1\t\t10\t\t100\t\t0\t\t0\t\t0\t\t1\n1\t\t2\t\t20\t\t200\t\t0\t\t0\t\t0\t\t1\n"), 2,
               "wide");
  expect_poses(read("t\tx\ty\tz\tqx\tqy\tqz\tqw\n" + rows(' ', "txyz0001", {""})), 4, "header alone");
  expect_poses(read("t,\tx,\ty,\tz,\tqx,\tqy,\tqz,\tqw\n0,\t1,\t10,\t100,\t0,\t0,\t0,\t1\n"), 1, "commas");
  // between blanks a missing field cannot be distinguished from those behind it
  EXPECT_THAT(refusal("t key x y z roll pitch yaw id\n0 1 1 10 100 0 0 0 3\n1 2 20 200 0 0 0 3\n"),
              HasSubstr(":3: expected 9 fields, as the header has names, got 8"));
}

TEST_F(TextRows, QuotedTextMayHoldTheSeparator) {
  const std::string header = "t,frame,x,y,z,qx,qy,qz,qw\n";
  expect_poses(
      read(header + rows(',', "t-xyz0001", {"\"odom, map\"", "odom", "\"say \"\"a, b\"\"\"", "\"a"})), 4,
      "commas");
  std::string semicolons = header;
  std::replace(semicolons.begin(), semicolons.end(), ',', ';');
  expect_poses(read(semicolons + rows(';', "t-xyz0001", {"\"odom; map\"", ""})), 4, "semicolons");
}

TEST_F(TextRows, TimesOfAnotherFileMayBeDates) {
  const std::string matrix = "1 0 0 1 0 1 0 10 0 0 1 100\n1 0 0 2 0 1 0 20 0 0 1 200\n";
  ReadOptions options;
  options.times_file =
      folder_.file("timestamps.txt", "1970-01-01 00:00:00.000000000\n1970-01-01 00:00:01.000000400\n");
  expect_poses(read(matrix, options), 2, "KITTI raw");
  options.times_file = folder_.file("timestamps.txt", "0 0\n1 1\n");
  EXPECT_THAT(refusal(matrix, options), HasSubstr(":1: expected one time, got 2 fields"));
}

}  // namespace
}  // namespace egocal::test_io_rows
