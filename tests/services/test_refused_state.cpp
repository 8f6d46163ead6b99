// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is not, or no longer, what this process would have accumulated is refused.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "saved_states.hpp"

namespace egocal::services::test_refused_state {
namespace {

using ::testing::HasSubstr;

TEST_F(SavedStates, OfAnotherRigAreRefused) {
  write_state(rig("egocal.odometry_t"), 100);
  SavedState saved(file, rig("egocal.odometry_t", "stride = 7\n"));
  const Accumulation accumulation = saved.restore();
  EXPECT_FALSE(saved.restored());
  EXPECT_EQ(accumulation.pairs()[0].session(), -1);
  EXPECT_THAT(saved.refused(), HasSubstr("another rig or version: it has 'pair left right: stride auto', "
                                         "expected 'pair left right: stride 7'"));
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

TEST_F(SavedStates, ThatSomebodyTouchedAreNotStale) {
  write_state(rig("egocal.odometry_t"), 100);
  SavedState saved(file, rig("egocal.odometry_t"), [] {
    return BootTime{boot_time().boot, boot_time().us + 7'200'000'000};
  });
  saved.restore();
  EXPECT_TRUE(saved.restored()) << saved.refused();
}

/// By this process, of files and pipes.
std::int64_t characters_read() {
  std::ifstream io("/proc/self/io");
  for (std::string line; std::getline(io, line);)
    if (line.starts_with("rchar: ")) return std::stoll(line.substr(7));
  throw std::runtime_error("/proc/self/io has no rchar");
}

TEST_F(SavedStates, ThatAreNoFilesAreRefusedAtOnce) {
  const bus::Rig config = rig("egocal.odometry_t");
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_THROW(SavedState(file, config).restore(), Error);
  std::filesystem::remove(file);
  write("");
  std::filesystem::resize_file(file, std::uintmax_t{3} << 30);  // sparse
  const std::int64_t before = characters_read();
  EXPECT_THROW(SavedState(file, config).restore(), Error);
  EXPECT_LT(characters_read() - before, 1'000'000) << "it was read";
  EXPECT_EQ(std::filesystem::file_size(file), std::uintmax_t{3} << 30);
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

}  // namespace
}  // namespace egocal::services::test_refused_state
