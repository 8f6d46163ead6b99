// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Folders of rosbag2: each part is read or counted, packed or not, and a database that is cut off gives what
// it has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "../support/bag_writer.hpp"
#include "../support/file_content.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_bag_folders {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::MessageEncoder;
using testing::WrittenMessage;

constexpr std::size_t poses = 240;

/// Fails where the name is read with --strict, and returns why it is not.
std::string refused_strictly(const std::string& name) {
  ReadOptions strict;
  strict.strict = true;
  try {
    read_trajectory_file(name, strict);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << name;
  return {};
}

/// TMPDIR as long as it exists.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    if (const char* const before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", folder_.path("").c_str(), 1);
  }
  ~TemporaryFolder() { before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR"); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  bool empty() const { return std::filesystem::is_empty(folder_.path("")); }

 private:
  testing::ScratchFolder folder_;
  std::optional<std::string> before_;
};

class BagFolders : public ::testing::Test {
 protected:
  BagFolders() {
    testing::Random random(1);
    for (std::size_t i = 0; i < poses; ++i)
      trajectory_.push_back({1'700'000'000'000'000 + 100'000 * static_cast<std::int64_t>(i),
                             testing::random_extrinsic(random)});
    messages_ = testing::as_messages(trajectory_, "/odom", "nav_msgs/Odometry", MessageEncoder::Kind::cdr);
  }

  std::vector<WrittenMessage> part(std::size_t first, std::size_t last) const {
    return {messages_.begin() + static_cast<std::ptrdiff_t>(first),
            messages_.begin() + static_cast<std::ptrdiff_t>(last)};
  }
  void metadata(const std::vector<std::string>& names, const std::string& mode = "") const {
    std::string text = "rosbag2_bagfile_information:\n  version: 5\n  message_count: 240\n";
    if (!mode.empty()) text += "  compression_format: zstd\n  compression_mode: " + mode + "\n";
    text += "  relative_file_paths:\n";
    for (const std::string& name : names) text += "    - " + name + "\n";
    folder_.file("metadata.yaml", text + "  files: []\n");
  }
  std::string name() const { return folder_.path("") + ":/odom"; }
  void expect_all(const std::string& from) const {
    const TrajectoryReading reading = read_trajectory_file(from);
    ASSERT_EQ(reading.trajectory.size(), poses) << from;
    EXPECT_FALSE(reading.losses.any()) << losses_in_words(reading.losses);
    for (std::size_t i = 0; i < poses; ++i) EXPECT_EQ(reading.trajectory[i].time_us, trajectory_[i].time_us);
  }

  testing::ScratchFolder folder_;
  Trajectory trajectory_;
  std::vector<WrittenMessage> messages_;
};

TEST_F(BagFolders, APartThatCannotBeReadIsCountedAndRefusedUnderStrict) {
  for (const std::string kind : {".db3", ".mcap"}) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < 4; ++i) {
      names.push_back("d_" + std::to_string(i) + kind);
      if (kind == ".db3")
        testing::write_db3(folder_.path(names.back()), part(60 * i, 60 * i + 60));
      else
        folder_.file(names.back(), testing::mcap_file(part(60 * i, 60 * i + 60), {}));
    }
    metadata(names);
    expect_all(name());
    const std::string whole = testing::content_of(folder_.path(names[1]));
    const std::string destroyed = std::string(16, '\0') + whole.substr(16);
    for (const std::string& damaged : {destroyed, std::string()}) {
      folder_.file(names[1], damaged);
      const TrajectoryReading reading = read_trajectory_file(name());
      EXPECT_EQ(reading.trajectory.size(), 180u) << kind;
      EXPECT_EQ(reading.losses.parts, 1u);
      EXPECT_THAT(reading.notes, Contains(HasSubstr("1 part of the bag cannot be read")));
      EXPECT_THAT(refused_strictly(name()), HasSubstr(names[1]));
    }
    std::filesystem::remove(folder_.path(names[1]));
    EXPECT_THAT(refused_strictly(name()), HasSubstr(names[1] + ": is named by metadata.yaml and not there"));
    std::filesystem::remove(folder_.path(names[2]));
    EXPECT_EQ(read_trajectory_file(name()).losses.parts, 2u);
    for (const std::string& gone : names) std::filesystem::remove(folder_.path(gone));
    EXPECT_THROW(read_trajectory_file(name()), Error);
  }
}

/// The length of a name is its number's only where the names are otherwise alike.
TEST_F(BagFolders, WithoutMetadataPartsComeInTheOrderOfTheirNames) {
  const std::vector<std::string> names{"autumn_day_9.db3", "autumn_day_10.db3", "b_0.db3", "winter.db3"};
  for (std::size_t i = 0; i < names.size(); ++i)
    testing::write_db3(folder_.path(names[i]), part(60 * i, 60 * i + 60));
  expect_all(name());
  EXPECT_EQ(read_trajectory_file(name()).out_of_order, 0u);
}

TEST_F(BagFolders, ABagThatTheMetadataDoesNotNameIsNoPart) {
  testing::write_db3(folder_.path("run_10.db3"), part(0, 240));
  testing::write_db3(folder_.path("10.db3"), part(0, 50));
  metadata({"\"folder/run_10.db3\""});
  const TrajectoryReading reading = read_trajectory_file(name());
  EXPECT_EQ(reading.trajectory.size(), poses);
  EXPECT_EQ(reading.duplicates, 0u);
  EXPECT_THAT(reading.notes, Contains(HasSubstr("10.db3 is in the folder and not in metadata.yaml")));
  folder_.file("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths: [run_10.db3]\n");
  EXPECT_EQ(read_trajectory_file(name()).duplicates, 0u);
}

TEST_F(BagFolders, TheMetadataStandsForItsFolder) {
  testing::write_db3(folder_.path("d_0.db3"), messages_);
  metadata({"d_0.db3"});
  expect_all(folder_.path("metadata.yaml") + ":/odom");
}

TEST_F(BagFolders, MessagesThatArePackedOneByOneAreUnpacked) {
  std::vector<WrittenMessage> packed = messages_;
  for (WrittenMessage& message : packed) message.data = testing::packed("zstd", message.data);
  testing::write_db3(folder_.path("d_0.db3"), packed);
  metadata({"d_0.db3"}, "MESSAGE");
  expect_all(name());
  expect_all(folder_.path("d_0.db3") + ":/odom");
  expect_all(folder_.file("d_0.mcap", testing::mcap_file(packed, {})) + ":/odom");
  packed[7].data.resize(packed[7].data.size() / 2);
  const TrajectoryReading reading =
      read_trajectory_file(folder_.file("d_0.mcap", testing::mcap_file(packed, {})));
  EXPECT_EQ(reading.trajectory.size(), poses - 1);
  EXPECT_THAT(reading.losses.first_refused, HasSubstr("is packed and damaged"));
}

TEST_F(BagFolders, APackedDatabaseIsUnpackedAndLeavesNothingBehind) {
  const TemporaryFolder temporary;
  testing::write_db3(folder_.path("d_0.db3"), messages_);
  const std::string plain = testing::content_of(folder_.path("d_0.db3"));
  const std::string packed = testing::packed("zstd", plain);
  folder_.file("d_0.db3.zstd", packed);
  metadata({"d_0.db3.zstd"}, "FILE");
  std::filesystem::remove(folder_.path("d_0.db3"));
  expect_all(name());
  expect_all(folder_.path("d_0.db3.zstd"));
  // cut off: what has been unpacked is there, and the rest is counted
  folder_.file("d_0.db3.zstd", packed.substr(0, packed.size() * 9 / 10));
  EXPECT_TRUE(read_trajectory_file(name()).losses.truncated);
  // `unzstd` keeps both files: the unpacked one is read
  folder_.file("d_0.db3", plain);
  expect_all(name());
  EXPECT_TRUE(temporary.empty());
}

TEST_F(BagFolders, OfADatabaseThatIsCutOffTheRestIsRead) {
  testing::write_db3(folder_.path("d.db3"), messages_);
  const std::string whole = testing::content_of(folder_.path("d.db3"));
  for (const double kept : {0.3, 0.5, 0.9}) {
    const auto size = static_cast<std::size_t>(kept * static_cast<double>(whole.size()));
    const std::string file = folder_.file("cut.db3", whole.substr(0, size));
    const TrajectoryReading reading = read_trajectory_file(file);
    EXPECT_GT(static_cast<double>(reading.trajectory.size()), (kept - 0.1) * poses) << kept;
    EXPECT_LT(reading.trajectory.size(), poses);
    EXPECT_TRUE(reading.losses.truncated);
    EXPECT_GE(reading.losses.regions, 1u);
    EXPECT_LE(reading.losses.regions, 2u);  // a page in the middle may refer to the missing end
    EXPECT_EQ(reading.losses.bytes, whole.size() - size);
    EXPECT_THAT(refused_strictly(file), HasSubstr("the end is cut off"));
  }
}

TEST_F(BagFolders, ADamagedPageCostsItsOwnRows) {
  testing::write_db3(folder_.path("d.db3"), messages_, 4096);
  std::string damaged = testing::content_of(folder_.path("d.db3"));
  damaged.replace(damaged.size() / 2 / 4096 * 4096, 4096, std::string(4096, '\0'));
  const TrajectoryReading reading = read_trajectory_file(folder_.file("d.db3", damaged));
  EXPECT_EQ(reading.losses.regions, 1u);
  EXPECT_GE(reading.trajectory.size(), poses - 6);  // a page holds five messages of 730 bytes
  EXPECT_LT(reading.trajectory.size(), poses);
}

TEST_F(BagFolders, ABagOfAnOldFormatIsNoTextFile) {
  for (const char* begin : {"#ROSRECORD V1.2\n", "#ROSBAG V1.1\n", "#ROSLOG V1.1\n"}) try {
      read_trajectory_file(folder_.file("old.bag", begin + std::string(200, '1')));
      ADD_FAILURE() << begin;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("rosbag fix"));
    }
}

}  // namespace
}  // namespace egocal::test_io_bag_folders
