// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Writing files: whole or not at all, and the same text in every locale.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>

#include "../support/file_content.hpp"
#include "../support/random_motion.hpp"
#include "egocal/error.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/io/mcap_writer.hpp"
#include "egocal/io/pairs_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal::test_writing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Writing : public ::testing::Test {
 protected:
  Writing() : folder(fs::temp_directory_path() / ("egocal_writing_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~Writing() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  /// Temporary files in the folder.
  std::ptrdiff_t temporaries() const {
    return std::count_if(
        fs::directory_iterator(folder), fs::directory_iterator(),
        [](const fs::directory_entry& entry) { return entry.path().extension() == ".part"; });
  }

  bool has_unnamed_files() const {
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (fd >= 0) ::close(fd);
    return fd >= 0;
  }

  fs::path folder;
};

// Ctrl-C in a long export left gigabytes.
TEST_F(Writing, AKilledProcessLeavesNothing) {
  const pid_t child = ::fork();
  if (child == 0) {
    WholeFile whole(path("whole"));
    whole.write(std::string(1 << 20, 'x'));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(fs::exists(path("whole")));
  EXPECT_EQ(temporaries(), has_unnamed_files() ? 0 : 1);
}

TEST_F(Writing, AFileIsReplacedOnlyWhenItIsComplete) {
  write_whole_file(path("whole"), "first");
  fs::permissions(path("whole"), fs::perms::owner_all);
  fs::create_symlink("whole", path("link"));
  {
    WholeFile one(path("whole")), two(path("link"));
    one.write("of one, never completed");
    two.write("second");
    EXPECT_EQ(testing::content_of(path("whole")), "first");
    EXPECT_EQ(temporaries(), has_unnamed_files() ? 0 : 2);
    two.commit();
    two.commit();
    EXPECT_THROW(two.write("more"), Error);
  }
  EXPECT_EQ(testing::content_of(path("whole")), "second");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(fs::status(path("whole")).permissions(), fs::perms::owner_all);
  EXPECT_EQ(temporaries(), 0);
  EXPECT_THROW(WholeFile("/dev/null"), Error);

  write_whole_file(path("whole.4711-0.part"), "of a process that was killed");
  remove_temporaries(path("whole"));
  EXPECT_EQ(temporaries(), 0);
  EXPECT_EQ(testing::content_of(path("whole")), "second");
}

// The file behind it was replaced, with all that was in it
TEST_F(Writing, AFileThatIsOpenAlreadyIsWrittenAtItsEnd) {
  const int file = open(path("log").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  ASSERT_GE(file, 0);
  ASSERT_EQ(write(file, "keep ", 5), 5);
  const std::string number = std::to_string(file);
  fs::create_symlink("/dev/fd/" + number, path("link"));
  for (const std::string& name : {"/dev/fd/" + number, "/proc/self/fd/" + number,
                                  "/proc/" + std::to_string(::getpid()) + "/fd/" + number, path("link")}) {
    EXPECT_FALSE(can_be_replaced(name)) << name;
    EXPECT_THROW(WholeFile{name}, Error) << name;
    write_whole_file(name, "x ");
  }
  ASSERT_EQ(write(file, "end", 3), 3);
  close(file);
  EXPECT_EQ(testing::content_of(path("log")), "keep x x x x end");
  EXPECT_TRUE(can_be_replaced(path("log")));
  EXPECT_TRUE(can_be_replaced(path("new")));
  EXPECT_FALSE(can_be_replaced("/dev/null"));
  EXPECT_THROW(write_whole_file("/dev/fd/987", "x"), Error);
}

// Not by its name: what is printed after it would be written over it
TEST_F(Writing, WhatIsPrintedBesideItIsKept) {
  const int file = open(path("log").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  ASSERT_GE(file, 0);
  ASSERT_EQ(write(file, "before ", 7), 7);
  write_whole_file("/dev/fd/" + std::to_string(file), "whole ");
  ASSERT_EQ(write(file, "after", 5), 5);
  close(file);
  EXPECT_EQ(testing::content_of(path("log")), "before whole after");
}

TEST_F(Writing, AProgramsLocaleChangesNothing) {
  // a locale of our own making: only the decimal comma of de_DE and others
  std::ofstream(path("source"))
      << "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n";
  const std::string command = "localedef -c -i " + path("source") + " " + path("comma") + " 2>/dev/null";
  std::ignore = std::system(command.c_str());  // it warns of the other categories
  setenv("LOCPATH", path("").c_str(), 1);
  ASSERT_TRUE(std::setlocale(LC_NUMERIC, "comma")) << "localedef (package libc-bin) made no locale";
  char number[8];
  std::snprintf(number, sizeof number, "%.1f", 0.5);
  ASSERT_STREQ(number, "0,5") << "this locale tests nothing";

  testing::Random random(3);
  Trajectory trajectory;
  for (std::int64_t i = 0; i < 3; ++i)
    trajectory.push_back({1'700'000'000'000'001 + 100'000 * i, testing::random_extrinsic(random)});
  write_tum(path("tum"), trajectory);
  const auto pairs = testing::random_pairs(testing::random_extrinsic(random), {.pairs = 3}, random);
  write_pairs(path("pairs"), pairs);
  const std::string extrinsic = extrinsic_text(
      {"a", "b", Pose{rotation_exp({0.1, 0.2, 0.3}), {0.5, 1.5, 2.5}}, true, 7, {}}, ExtrinsicFormat::urdf);
  const Trajectory read = read_trajectory(path("tum"));
  EXPECT_EQ(read_pairs(path("pairs")).size(), 3u);
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_THAT(testing::content_of(path("tum")), ::testing::Not(HasSubstr(",")));
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].time_us, trajectory[i].time_us);
  EXPECT_THAT(extrinsic, HasSubstr("xyz=\"0.5 1.5 2.5\""));
}

TEST_F(Writing, AnMcapFileLeavesFilesOfOthersAlone) {
  write_whole_file(path("x.mcap.part"), "of somebody else");
  {
    McapWriter never_closed(path("x.mcap"));
    never_closed.write_pose("/lidar", "lidar_start", {1, {}});
  }
  EXPECT_FALSE(fs::exists(path("x.mcap")));
  McapWriter writer(path("x.mcap"));
  writer.write_pose("/lidar", "lidar_start", {1, {}});
  writer.close();
  EXPECT_TRUE(fs::exists(path("x.mcap")));
  EXPECT_EQ(testing::content_of(path("x.mcap.part")), "of somebody else");
  EXPECT_EQ(temporaries(), 1);
}

/// Ids of channels have 16 bits: one more would be written to the first topic.
TEST_F(Writing, AnMcapFileHoldsNoMoreChannelsThanItsFormatCounts) {
  McapWriter writer(path("x.mcap"));
  for (int i = 1; i < 65536; ++i) writer.write_pose("/" + std::to_string(i), "start", {i, {}});
  writer.write_pose("/1", "start", {65536, {}});
  EXPECT_THROW(
      try {
        writer.write_pose("/65536", "start", {65537, {}});
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("65535 channels"));
        throw;
      },
      Error);
}

// The state of the diagnosis has the name of pairing's with more behind it, and pairing removed what was
// being written of it.
TEST_F(Writing, OnlyTemporariesOfThisNameAreRemoved) {
  for (const char* name : {"state.17-0.part", "state.17-1000.part", "state.diagnosis.17-0.part", "state.part",
                           "state.notes.part", "state.17.part", "state.-1.part", "states.17-0.part"})
    std::ofstream(path(name)) << name;
  remove_temporaries(path("state"));
  EXPECT_FALSE(fs::exists(path("state.17-0.part")));
  EXPECT_FALSE(fs::exists(path("state.17-1000.part")));
  EXPECT_EQ(temporaries(), 6);
}

TEST_F(Writing, ANewFileNeverReplacesOne) {
  EXPECT_TRUE(write_new_file(path("new"), "first"));
  EXPECT_FALSE(write_new_file(path("new"), "second"));
  EXPECT_EQ(testing::content_of(path("new")), "first");
  fs::create_symlink(path("nowhere"), path("link"));
  EXPECT_FALSE(write_new_file(path("link"), "through a link"));
  EXPECT_FALSE(fs::exists(path("nowhere")));
  EXPECT_THROW(write_new_file(path("no_folder/new"), "nowhere"), Error);
  EXPECT_EQ(temporaries(), 0);
}

TEST_F(Writing, FilesThatCannotBeReadLeaveNothingOpen) {
  const auto open_files = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  std::ofstream(path("broken.mcap.zst"), std::ios::binary) << std::string("\x28\xb5\x2f\xfd", 4) << "broken";
  const auto before = open_files();
  for (int i = 0; i < 10; ++i) {
    EXPECT_THROW(read_trajectory(folder.string()), Error);
    EXPECT_THROW(read_trajectory(path("broken.mcap.zst")), Error);
  }
  EXPECT_EQ(open_files(), before);
}

}  // namespace
}  // namespace egocal::test_writing
