// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What supervised processes write, and where: small scripts under the supervisor.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "egocal/error.hpp"
#include "supervised.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::test_supervision_outputs {
namespace {

using test::lines;
using test::read;
using test::runs;
using test::send_signal;
using test::Supervision;
using test::until;
using ::testing::HasSubstr;
using tools::Program;

// Where several users write, such as /tmp, a folder of that name may be somebody else's.
TEST_F(Supervision, APrivateFolderBelongsToThisUserAlone) {
  tools::require_private_folder(path("new"));
  tools::require_private_folder(path("new"));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(path("new")).permissions(), perms::owner_all);
  std::filesystem::create_directory(path("open"));
  std::filesystem::permissions(path("open"), perms::all);
  std::filesystem::create_directory_symlink(path("new"), path("link"));
  std::ofstream(path("file")) << "";
  for (const char* name : {"open", "link", "file"})
    EXPECT_THROW(tools::require_private_folder(path(name)), Error) << name;
  EXPECT_THROW(tools::require_private_folder(path("none/new")), Error);
}

TEST_F(Supervision, AnOutputFolderThatIsGoneEndsNothing) {
  options.output_dir = path("out");
  std::filesystem::create_directories(path("out"));
  start({waiting("one"), waiting("two")});
  process("two");
  std::filesystem::remove_all(path("out"));
  send_signal(process("one"), SIGKILL);
  process("one", 2);
  EXPECT_TRUE(std::filesystem::exists(path("out/one.out"))) << "it is made again";
  // a name that cannot be written: by root, too
  std::filesystem::remove(path("out/one.out"));
  std::filesystem::create_directories(path("out/one.out"));
  send_signal(process("one", 2), SIGKILL);
  EXPECT_TRUE(runs(process("one", 3)));
  EXPECT_TRUE(runs(process("two")));
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
  EXPECT_THAT(read(path("said")), HasSubstr("one.out: cannot be written"));
}

TEST_F(Supervision, LinesOfOthersAreReported) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
  options.lines = ends[0];
  start({waiting("one")});
  process("one");
  ASSERT_EQ(write(ends[1], "first\nsec", 9), 9);
  EXPECT_TRUE(until([&] { return lines(path("said")).size() == 1; }));
  ASSERT_EQ(write(ends[1], "ond\n", 4), 4);
  EXPECT_TRUE(until([&] { return lines(path("said")).size() == 2; }));
  EXPECT_EQ(lines(path("said")), (std::vector<std::string>{"egocal up: first", "egocal up: second"}));
  close(ends[1]);
  close(ends[0]);
  send_signal(pid, SIGTERM);
  EXPECT_EQ(ended(), 0);
}

TEST_F(Supervision, OutputsAreKeptApartAndBounded) {
  std::ofstream(path("talker.out")) << std::string(10'000'001, 'x');
  Program talker = script("talker", "echo to standard output; echo and to the other >&2; exit 0");
  talker.ends_all = true;
  start({waiting("one"), talker});
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(std::filesystem::file_size(path("talker.out.old")), 10'000'001u);
  const auto text = lines(path("talker.out"));
  ASSERT_EQ(text.size(), 3u);
  EXPECT_THAT(text[0], HasSubstr("-- started 2"));
  EXPECT_EQ(text[1], "to standard output");
  EXPECT_EQ(text[2], "and to the other");
  EXPECT_EQ(tools::last_line(path("talker.out")), "and to the other");
  EXPECT_EQ(tools::last_line(path("one.out")), "");
  EXPECT_EQ(tools::last_line(path("none.out")), "");
}

TEST_F(Supervision, AnOutputThatCannotBeWrittenIsReportedBeforeAnythingStarts) {
  std::filesystem::create_directories(path("two.out"));
  start({waiting("one"), waiting("two")});
  EXPECT_EQ(ended(), 97);
  EXPECT_THAT(read(path("said")), HasSubstr("two.out: cannot be written"));
  EXPECT_FALSE(std::filesystem::exists(path("one.pids")));
}

TEST_F(Supervision, WithTheMonitorOnTheScreenNothingElseIsWrittenThere) {
  options.quiet = true;
  Program monitor = waiting("monitor");
  monitor.foreground = true;
  start({monitor,
         script("bad", "echo x >>$F/starts; echo why >&2; [ $(wc -l <$F/starts) -lt 3 ]; exit $((1 + $?))")});
  EXPECT_EQ(ended(), 1);
  const auto said = lines(path("said"));
  ASSERT_EQ(said.size(), 1u) << "only the last words, when the screen is free again";
  EXPECT_THAT(said[0], HasSubstr("bad cannot be started (exit code 2: why)"));
  EXPECT_THAT(read(path("up.out")), HasSubstr("bad ended (exit code 1: why), starting it again"));
}

}  // namespace
}  // namespace egocal::test_supervision_outputs
