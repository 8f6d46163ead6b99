// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What pairing has accumulated outlives the process: to the bit, or it is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/error.hpp"
#include "egocal/simulation/simulation.hpp"
#include "pairing/accumulation_fields.hpp"
#include "pairing/saved_state.hpp"
#include "support/random_motion.hpp"

namespace egocal::services {
namespace {

using ::testing::HasSubstr;

struct Message {
  std::uint16_t channel;
  std::vector<std::byte> bytes;
};

bus::Rig rig(const std::string& type, const std::string& more = "") {
  return bus::parse_rig("[[sensor]]\nname = \"left\"\nchannel = \"L\"\ntype = \"" + type +
                            "\"\n[[sensor]]\nname = \"right\"\nchannel = \"R\"\ntype = \"" + type +
                            "\"\n[[pair]]\na = \"left\"\nb = \"right\"\n" + more,
                        "rig.toml");
}

std::vector<Message> drive(const std::string& type, int poses = 400) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
  const std::vector<Trajectory> trajectories = simulate(options);
  std::vector<Message> messages;
  for (std::size_t i = 0; i < trajectories[0].size(); ++i)
    for (std::uint16_t k = 0; k < 2; ++k) {
      StampedPose pose = trajectories[k][i];
      pose.time_us += 1'600'000'000'000'000;
      messages.push_back({k, type == "bot_core.pose_t"
                                 ? bus::encode(bus::to_pose_message(pose))
                                 : bus::encode(bus::to_message(pose, static_cast<std::int64_t>(i)))});
    }
  return messages;
}

std::vector<std::byte> pair_bits(const Accumulation& accumulation) {
  Writer writer;
  writer(accumulation.pairs().front().state());
  return writer.bytes();
}

class SavedStates : public ::testing::Test {
 protected:
  SavedStates() {
    char name[] = "/tmp/egocal-state-XXXXXX";
    folder = mkdtemp(name);
    file = folder + "/pairing.state";
  }
  ~SavedStates() override { std::filesystem::remove_all(folder); }

  void write_state(const bus::Rig& of, std::size_t messages) {
    const auto all = drive("egocal.odometry_t");
    SavedState saved(file, of);
    Accumulation accumulation = saved.restore();
    for (std::size_t i = 0; i < messages; ++i) {
      const Input input{Input::Kind::message, all[i].channel, all[i].bytes};
      saved.note(input);
      accumulation.apply(input);
      if (i % 16 == 15) saved.save(accumulation);
    }
    saved.save(accumulation);
  }
  std::string content() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(file, std::ios::binary) << bytes; }
  static std::string failure(SavedState& saved) {
    try {
      saved.restore();
      return "none";
    } catch (const Error& error) {
      return error.what();
    }
  }

  std::string folder, file;
};

/// Killed again and again; what was not saved is sent again, with some of what was.
TEST_F(SavedStates, GoOnWithTheSameBits) {
  for (const std::string type : {"egocal.odometry_t", "bot_core.pose_t"}) {
    const bus::Rig config = rig(type);
    const auto messages = drive(type, 300);
    Accumulation undisturbed(config);
    for (const Message& message : messages)
      undisturbed.apply({Input::Kind::message, message.channel, message.bytes});
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      egocal::testing::Random random(seed);
      std::filesystem::remove(file);
      auto saved = std::make_unique<SavedState>(file, config);
      Accumulation accumulation = saved->restore();
      const auto feed = [&](const Input& input) {
        saved->note(input);
        accumulation.apply(input);
      };
      std::size_t on_disk = 0;
      for (std::size_t next = 0; next < messages.size(); ++next) {
        feed({Input::Kind::message, messages[next].channel, messages[next].bytes});
        if (random.uniform() < 0.2) {
          saved->save(accumulation);
          on_disk = next + 1;
        }
        if (random.uniform() < 0.01) saved->snapshot(accumulation), on_disk = next + 1;
        if (random.uniform() > 0.02) continue;
        saved.reset();  // killed: nothing is written at the end
        saved = std::make_unique<SavedState>(file, config);
        accumulation = saved->restore();
        ASSERT_TRUE(saved->restored()) << saved->refused();
        // what came before the new process was received, out of order
        std::size_t first_missing = messages.size();
        for (std::uint16_t k = 0; k < 2; ++k) {
          std::size_t missing = 0;
          for (std::size_t i = 0; i < messages.size(); ++i)
            if (messages[i].channel == k &&
                bus::utime_in(messages[i].bytes) == accumulation.complete_until(k))
              missing = i + 1;
          first_missing = std::min(first_missing, missing);
        }
        EXPECT_LE(first_missing, on_disk);
        for (std::size_t i = first_missing + 5; i < std::min(first_missing + 9, messages.size()); ++i)
          feed({Input::Kind::message, messages[i].channel, messages[i].bytes});
        next = first_missing - 1;
      }
      for (std::uint16_t k = 0; k < 2; ++k) feed({Input::Kind::give_up, k});
      EXPECT_TRUE(pair_bits(accumulation) == pair_bits(undisturbed)) << type << ", seed " << seed;
    }
  }
}

bus::Rig rig_without_scale() {
  return bus::parse_rig(
      "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n"
      "[[sensor]]\nname = \"right\"\nchannel = \"R\"\nscale = \"auto\"\n"
      "[[pair]]\na = \"left\"\nb = \"right\"\n",
      "rig.toml");
}

TEST_F(SavedStates, KeepTheScale) {
  const bus::Rig config = rig_without_scale();
  const auto messages = drive("egocal.odometry_t", 500);
  Accumulation undisturbed(config);
  for (const Message& message : messages)
    undisturbed.apply({Input::Kind::message, message.channel, message.bytes});
  auto saved = std::make_unique<SavedState>(file, config);
  Accumulation accumulation = saved->restore();
  for (std::size_t next = 0; next < messages.size(); ++next) {
    const Input input{Input::Kind::message, messages[next].channel, messages[next].bytes};
    saved->note(input);
    accumulation.apply(input);
    if (next % 101 == 0) saved->snapshot(accumulation);
    saved->save(accumulation);
    if (next % 333 != 332) continue;
    saved.reset();  // killed
    saved = std::make_unique<SavedState>(file, config);
    accumulation = saved->restore();
    ASSERT_TRUE(saved->restored()) << saved->refused();
  }
  const auto scale = undisturbed.pairs()[0].scale_message();
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->scale, 1, 0.01) << "the streams of this drive are in metres";
  const auto restored = accumulation.pairs()[0].scale_message();
  ASSERT_TRUE(restored);
  EXPECT_EQ(bus::encode(*restored), bus::encode(*scale));
  const auto problem = accumulation.pairs()[0].message();
  ASSERT_TRUE(problem);
  EXPECT_EQ(bus::encode(*problem), bus::encode(*undisturbed.pairs()[0].message()));
  EXPECT_EQ(problem->seq, scale->seq);
}

TEST_F(SavedStates, KeepWhatIsPausedAndReset) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 100);
  {
    SavedState saved(file, config);
    Accumulation accumulation = saved.restore();
    for (const Input::Kind kind : {Input::Kind::new_session, Input::Kind::pause}) {
      saved.note({kind, 0});
      accumulation.apply({kind, 0});
    }
    saved.save(accumulation);
  }
  SavedState saved(file, config);
  const Accumulation accumulation = saved.restore();
  EXPECT_TRUE(accumulation.pairs()[0].paused());
  EXPECT_EQ(accumulation.pairs()[0].session(), -1);
}

TEST_F(SavedStates, OfAnotherRigAreRefused) {
  write_state(rig("egocal.odometry_t"), 100);
  SavedState saved(file, rig("egocal.odometry_t", "stride = 7\n"));
  const Accumulation accumulation = saved.restore();
  EXPECT_FALSE(saved.restored());
  EXPECT_EQ(accumulation.pairs()[0].session(), -1);
  EXPECT_THAT(saved.refused(), HasSubstr("another rig or version: it has 'pair left right"));
  EXPECT_TRUE(std::filesystem::exists(file + ".refused"));
}

TEST_F(SavedStates, ThatAreStaleAreRefused) {
  write_state(rig("egocal.odometry_t"), 100);
  const auto two_hours_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(2);
  for (const auto& [what, now] :
       {std::pair{"two hours later", BootTime{boot_time().boot, boot_time().us + 7'200'000'000}},
        std::pair{"after another start", BootTime{"another", 1'000'000}}}) {
    SCOPED_TRACE(what);
    std::filesystem::last_write_time(file, two_hours_ago);
    SavedState saved(file, rig("egocal.odometry_t"), [now = now] { return now; });
    saved.restore();
    EXPECT_FALSE(saved.restored());
    EXPECT_THAT(saved.refused(), HasSubstr("is stale: written 7"));
    // a new one has taken its place
    EXPECT_GT(std::filesystem::file_size(file), 0u);
  }
  EXPECT_TRUE(std::filesystem::exists(file + ".refused"));
  EXPECT_TRUE(std::filesystem::exists(file + ".refused-2")) << "the first one is kept";
}

TEST_F(SavedStates, AClockThatIsSetBetweenDeathAndRestartCostsNothing) {
  for (const auto jump : {std::chrono::hours(5), std::chrono::hours(-5), std::chrono::hours(24 * 365 * 20)}) {
    write_state(rig("egocal.odometry_t"), 100);
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - jump);
    SavedState saved(file, rig("egocal.odometry_t"));
    saved.restore();
    EXPECT_TRUE(saved.restored()) << saved.refused();
    std::filesystem::remove(file);
  }
}

TEST_F(SavedStates, ThatSomebodyTouchedAreNotStale) {
  write_state(rig("egocal.odometry_t"), 100);
  SavedState saved(file, rig("egocal.odometry_t"), [] {
    return BootTime{boot_time().boot, boot_time().us + 7'200'000'000};
  });
  saved.restore();
  EXPECT_TRUE(saved.restored()) << saved.refused();
}

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

TEST_F(SavedStates, ThatAreNoFilesAreRefusedAtOnce) {
  const bus::Rig config = rig("egocal.odometry_t");
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_THROW(SavedState(file, config).restore(), Error);
  std::filesystem::remove(file);
  write("");
  std::filesystem::resize_file(file, std::uintmax_t{3} << 30);  // sparse
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(SavedState(file, config).restore(), Error);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1)) << "it was read";
  EXPECT_EQ(std::filesystem::file_size(file), std::uintmax_t{3} << 30);
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

TEST_F(SavedStates, WithAnyByteDamagedAreRefused) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 40);
  const std::string good = content();
  for (std::size_t at = 24; at < good.size(); at += 137) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    write(bad);
    SavedState saved(file, config);
    saved.restore();
    EXPECT_FALSE(saved.restored()) << "byte " << at;
    EXPECT_THAT(saved.refused(), HasSubstr("is damaged")) << "byte " << at;
  }
}

TEST_F(SavedStates, CutOffAnywhereAreRefusedOrLackTheUnfinishedEnd) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 40);
  const std::string good = content();
  std::size_t refused = 0, restored = 0;
  for (std::size_t size = 7; size < good.size(); size += 113) {
    write(good.substr(0, size));
    SavedState saved(file, config);
    const Accumulation accumulation = saved.restore();
    ++(saved.restored() ? restored : refused);
    if (!saved.restored()) {
      EXPECT_THAT(saved.refused(), HasSubstr("cut off")) << size;
      EXPECT_EQ(restored, 0u) << "a longer one is refused where a shorter one is not: " << size;
    }
  }
  EXPECT_GT(refused, 2u);
  EXPECT_GT(restored, 20u);
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

TEST_F(SavedStates, AnEmptyFileIsAsNone) {
  write("");
  SavedState saved(file, rig("egocal.odometry_t"));
  saved.restore();
  EXPECT_EQ(saved.refused(), "");
  EXPECT_GT(std::filesystem::file_size(file), 0u);
  EXPECT_FALSE(std::filesystem::exists(file + ".refused"));
}

/// Up to version 3 all states began with "egocal-pairing state 3", and their identity began with the process.
TEST_F(SavedStates, OfEarlierBuildsAreRefusedWhereTheyArePairings) {
  const bus::Rig config = rig("egocal.odometry_t");
  const auto of_version_3 = [&](const StateIdentity& identity) {
    StateFile(open_state_medium(file), {"egocal-pairing", identity.text}).snapshot({});
    std::string bytes = content();
    bytes.at(bytes.find('4')) = '3';
    write(bytes);
    return bytes;
  };
  {
    const std::string pairings = of_version_3(state_identity("egocal-pairing", 24, config));
    SavedState saved(file, config);
    saved.restore();
    EXPECT_THAT(saved.refused(), HasSubstr("another version or machine"));
    std::ifstream aside(file + ".refused", std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(aside), {}), pairings);
    std::filesystem::remove(file + ".refused");
  }
  const std::string diagnosis = of_version_3(state_identity("egocal-diagnosis", 1024, config));
  SavedState saved(file, config);
  EXPECT_THAT(failure(saved), HasSubstr("is not a state of egocal-pairing"));
  EXPECT_EQ(content(), diagnosis);
}

TEST_F(SavedStates, BelongToOneProcessAtATime) {
  SavedState first(file, rig("egocal.odometry_t"));
  EXPECT_THROW(SavedState(file, rig("egocal.odometry_t")), Error);
  EXPECT_THROW(SavedState("/nonexistent/state", rig("egocal.odometry_t")), Error);
}

}  // namespace
}  // namespace egocal::services
