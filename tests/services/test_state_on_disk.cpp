// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whatever a disk, other processes and users do to the file of a state, calibration goes on.
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <utility>

#include "saved_states.hpp"

namespace egocal::services::test_state_on_disk {
namespace {

using ::testing::HasSubstr;

TEST_F(SavedStates, ADiskThatTakesNothingEndsNothing) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 100);
  std::filesystem::remove(file + ".lock");
  // as a full disk does: no file can become larger than nothing
  const auto limit_files = [](rlim_t most) {
    const rlimit limit{most, RLIM_INFINITY};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  {
    limit_files(0);
    SavedState saved(file, config);
    Accumulation accumulation = saved.restore();
    EXPECT_TRUE(saved.restored()) << saved.refused();
    EXPECT_THAT(saved.not_saved(), HasSubstr("cannot be written: File too large"));
    EXPECT_THROW(saved.save(accumulation), Error);
    limit_files(RLIM_INFINITY);
    saved.save(accumulation);
  }
  std::signal(SIGXFSZ, handler);
  SavedState saved(file, config);
  saved.restore();
  EXPECT_TRUE(saved.restored()) << saved.refused();
  EXPECT_EQ(saved.not_saved(), "");
}

/// A file system that becomes read-only.
class ReadOnlyForNow : public StateMedium {
 public:
  ReadOnlyForNow(const std::string& file, const bool& read_only)
      : medium_(open_state_medium(file)), read_only_(read_only) {}
  const std::string& name() const override { return medium_->name(); }
  std::optional<Found> read(const Expected& expected) override { return medium_->read(expected); }
  void replace(std::span<const std::byte> bytes) override { allowed(), medium_->replace(bytes); }
  void add(std::span<const std::byte> bytes) override { allowed(), medium_->add(bytes); }
  bool in_place() const override { return medium_->in_place(); }
  std::string keep_aside() override { return allowed(), medium_->keep_aside(); }

 private:
  void allowed() const {
    if (read_only_) throw Error("cannot be written: Read-only file system");
  }
  std::unique_ptr<StateMedium> medium_;
  const bool& read_only_;
};

TEST_F(SavedStates, ARefusedOneThatCannotBeKeptAsideEndsNothingAndIsNotOverwritten) {
  const bus::Rig config = rig("egocal.odometry_t"), other = rig("egocal.odometry_t", "stride = 3\n");
  write_state(config, 100);
  const std::string before = content();
  bool read_only = true;
  SavedState saved(std::make_unique<ReadOnlyForNow>(file, read_only), other, boot_time);
  Accumulation accumulation = saved.restore();
  EXPECT_FALSE(saved.restored());
  EXPECT_THAT(saved.refused(), HasSubstr("it stays there: cannot be written: Read-only file system"));
  EXPECT_THAT(saved.not_saved(), HasSubstr("Read-only file system"));
  EXPECT_THROW(saved.save(accumulation), Error);
  EXPECT_EQ(content(), before);
  read_only = false;
  saved.save(accumulation);
  EXPECT_THAT(saved.refused(), HasSubstr("it is kept as"));
  EXPECT_NE(content(), before);
  std::ifstream aside(file + ".refused", std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(aside), {}), before);
}

// By people who tidy up, make copies, or rotate what they take for logs.
TEST_F(SavedStates, WhateverIsDoneToTheFileWhileRunningCostsNothing) {
  const bus::Rig config = rig("egocal.odometry_t");
  const auto messages = drive("egocal.odometry_t", 50);
  const std::string place = folder + "/place", state = place + "/state", copy = folder + "/copy";
  using std::filesystem::rename;
  const std::pair<const char*, std::function<void()>> deeds[] = {
      {"the folder is removed", [&] { std::filesystem::remove_all(place); }},
      {"the folder is moved", [&] { rename(place, folder + "/other"); }},
      {"the file is moved", [&] { rename(state, copy); }},
      {"a copy takes its place", [&] { std::filesystem::copy_file(state, copy), rename(copy, state); }},
      {"the file is emptied", [&] { std::filesystem::resize_file(state, 0); }},
      {"the file is cut off",
       [&] { std::filesystem::resize_file(state, file_size(std::filesystem::path(state)) - 1); }}};
  for (const auto& [what, deed] : deeds) {
    for (const std::string& left : {place, folder + "/other", copy}) std::filesystem::remove_all(left);
    std::filesystem::create_directories(place);
    auto saved = std::make_unique<SavedState>(state, config);
    Accumulation accumulation = saved->restore();
    for (const Message& message : messages) {
      const Input input{Input::Kind::message, message.channel, message.bytes};
      saved->note(input);
      accumulation.apply(input);
      if (&message == &messages[60]) deed();
      saved->save(accumulation);
    }
    saved.reset();
    SavedState again(state, config);
    const Accumulation restored = again.restore();
    EXPECT_TRUE(again.restored()) << what << ": " << again.refused();
    EXPECT_EQ(restored.pairs()[0].state().seq, accumulation.pairs()[0].state().seq) << what;
  }
}

TEST_F(SavedStates, ReachedByALinkAreLockedOnceAndStayWhereTheyAre) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 100);
  std::filesystem::create_symlink("pairing.state", folder + "/link");
  {
    SavedState saved(folder + "/link", config);
    EXPECT_THROW(SavedState(file, config), Error);
    saved.restore();
    EXPECT_TRUE(saved.restored());
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder + "/link"));
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST_F(SavedStates, WithoutTheirLockFileAreNotWrittenByTwo) {
  const bus::Rig config = rig("egocal.odometry_t");
  SavedState first(file, config);
  const Accumulation accumulation = first.restore();
  std::filesystem::remove(file + ".lock");
  first.snapshot(accumulation);
  EXPECT_THROW(SavedState(file, config), Error) << "the first one has it again";
  std::filesystem::remove(file + ".lock");
  SavedState second(file, config);
  second.restore();
  EXPECT_THROW(first.snapshot(accumulation), Error);
}

TEST_F(SavedStates, LeaveNoTemporaryFilesBehind) {
  const std::string left = file + ".4711-0.part";
  std::ofstream(left) << "of a process that was killed";
  write_state(rig("egocal.odometry_t"), 100);
  EXPECT_FALSE(std::filesystem::exists(left));
}

TEST_F(SavedStates, AreNeverWrittenOverWhatIsSomethingElse) {
  for (const std::string text : {"[[sensor]]\nname = \"left\"\nchannel = \"L\"\n", "hello\n", "\n", "e-mail",
                                 "egocal-diagnosis state 4l\n", "egocal-diagnosis st"}) {
    write(text);
    SavedState saved(file, rig("egocal.odometry_t"));
    EXPECT_EQ(failure(saved), file + ": is not a state of egocal-pairing; expected one, or no file") << text;
    EXPECT_EQ(content(), text);
    EXPECT_FALSE(std::filesystem::exists(file + ".refused"));
  }
}

TEST_F(SavedStates, BelongToOneProcessAtATime) {
  SavedState first(file, rig("egocal.odometry_t"));
  EXPECT_THROW(SavedState(file, rig("egocal.odometry_t")), Error);
  EXPECT_THROW(SavedState("/nonexistent/state", rig("egocal.odometry_t")), Error);
}

}  // namespace
}  // namespace egocal::services::test_state_on_disk
