// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Packed files (gzip, zstd, bzip2, lz4): what is cut off, damaged, or has another checksum is three things.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdio>
#include <memory>
#include <string>

#include "../support/bag_writer.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/packing.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_packed {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t poses = 4000;  // more than is unpacked at once

std::string tum() {
  testing::Random random(1);
  std::string text;
  for (std::size_t i = 0; i < poses; ++i) {
    const Pose pose = to_pose(testing::random_extrinsic(random));
    char line[200];
    std::snprintf(line, sizeof line, "%zu.5 %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", 1'700'000'000 + i,
                  pose.translation.x(), pose.translation.y(), pose.translation.z(), pose.rotation.x(),
                  pose.rotation.y(), pose.rotation.z(), pose.rotation.w());
    text += line;
  }
  return text;
}

/// With a checksum of the whole at the end.
std::string packed(const std::string& kind, const std::string& plain) {
  if (kind == "bz2") return testing::packed("bz2", plain);
  std::string out(plain.size() + 1000, '\0');
  if (kind == "gz") {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
    stream.avail_in = static_cast<unsigned int>(plain.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<unsigned int>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
  } else if (kind == "zst") {
    ZSTD_CCtx* const context = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
    out.resize(ZSTD_compress2(context, out.data(), out.size(), plain.data(), plain.size()));
    ZSTD_freeCCtx(context);
  } else {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    out.resize(LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), &preferences));
  }
  return out;
}

class Packed : public ::testing::Test {
 protected:
  TrajectoryReading read(const std::string& content) const {
    return read_trajectory_file(folder_.file("file", content));
  }
  std::string refusal(const std::string& content) const {
    try {
      read(content);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }
  testing::ScratchFolder folder_;
  std::string plain_ = tum(), packed_gz_ = packed("gz", plain_);
};

TEST_F(Packed, AWrongChecksumIsNamedAsOneAndNotAsAnEndThatIsCutOff) {
  for (const std::string kind : {"gz", "zst", "lz4"}) {
    std::string file = packed(kind, plain_);
    // of gzip's eight bytes the first four are the sum
    file[file.size() - (kind == "gz" ? 8 : 1)] ^= 0x55;
    const TrajectoryReading reading = read(file);
    EXPECT_EQ(reading.trajectory.size(), poses) << kind;
    EXPECT_TRUE(reading.losses.checksum) << kind;
    EXPECT_FALSE(reading.losses.truncated) << kind;
    EXPECT_EQ(reading.losses.regions, 0u) << kind;
    EXPECT_THAT(reading.notes, Contains(AllOf(HasSubstr("checksum"), HasSubstr("copy the file again"),
                                              Not(HasSubstr("cut off")))))
        << kind;
  }
}

TEST_F(Packed, AnEndThatIsCutOffIsNamedAsOne) {
  for (const std::string kind : {"gz", "zst", "lz4"}) {
    const std::string file = packed(kind, plain_);
    for (const std::size_t kept : {file.size() - 1, file.size() / 2}) {
      const TrajectoryReading reading = read(file.substr(0, kept));
      EXPECT_GT(reading.trajectory.size(), poses / 4) << kind;
      EXPECT_TRUE(reading.losses.truncated) << kind;
      EXPECT_FALSE(reading.losses.checksum) << kind;
    }
  }
}

TEST_F(Packed, DamageInTheMiddleIsARegionThatIsCounted) {
  for (const std::string kind : {"zst", "bz2"}) {  // of gzip rubbish may come out before the damage is seen
    std::string file = packed(kind, plain_);
    for (std::size_t i = file.size() / 2; i < file.size() / 2 + 200; ++i) file[i] = '\xa5';
    const TrajectoryReading reading = read(file);
    EXPECT_LT(reading.trajectory.size(), poses) << kind;
    EXPECT_GT(reading.trajectory.size(), poses / 10) << kind;
    EXPECT_GE(reading.losses.regions, 1u) << kind;
    EXPECT_GT(reading.losses.bytes, 0u) << kind;
    EXPECT_FALSE(reading.losses.checksum) << kind;
  }
}

// A row that rubbish had been unpacked to was to blame, and a user looked into what had written it.
TEST_F(Packed, RubbishThatIsUnpackedIsBlamedOnTheDamageAndNotOnItsLine) {
  std::size_t refused = 0;
  for (std::size_t i = 2000; i < packed_gz_.size(); i += 4001) {
    std::string file = packed_gz_;
    file[i] ^= 0x10;
    const std::string why = refusal(file);
    if (why == "none") continue;
    ++refused;
    EXPECT_THAT(why, HasSubstr("file: what is packed by gzip is damaged: copy the file again (as unpacked, "))
        << i;
  }
  EXPECT_GT(refused, 3u);
}

TEST_F(Packed, AWrongRowOfAFileThatIsNotDamagedIsNamedByItsLine) {
  const std::size_t third = plain_.find('\n', plain_.find('\n') + 1) + 1;
  const std::string wrong =
      plain_.substr(0, third) + "1700000002.5 0 0 zero 0 0 0 1\n" + plain_.substr(third);
  for (const std::string kind : {"gz", "zst", "bz2", "lz4"})
    EXPECT_THAT(refusal(packed(kind, wrong)), HasSubstr("file:3: field 4 (tz): expected a number")) << kind;
  const std::string images =
      "# Image list with two lines of data per image:\n1 1 0 0 0 1 2 3 1 image.png\n\n";
  for (const std::string kind : {"gz", "lz4"}) {
    std::string file = packed(kind, images);
    EXPECT_THAT(refusal(file), HasSubstr("file:2: NAME: expected a time")) << kind;
    file[file.size() - (kind == "gz" ? 8 : 1)] ^= 0x55;
    EXPECT_THAT(refusal(file),
                AllOf(HasSubstr("is damaged: copy the file again (as unpacked, line 2: NAME: ")))
        << kind;
  }
}

// "holds no data" sent a user looking for what had written an empty file.
TEST_F(Packed, WhatIsDamagedOrCutOffBeforeItsFirstRowIsRefusedForThat) {
  for (const std::string kind : {"gz", "zst", "bz2", "lz4"}) {
    std::string file = packed(kind, plain_);
    const std::string beginning = file.substr(0, 18);
    for (std::size_t i = 12; i < file.size(); ++i) file[i] = '\xa5';
    EXPECT_THAT(refusal(file), AllOf(HasSubstr("holds no data: what is packed by"), HasSubstr("is damaged")))
        << kind;
    EXPECT_THAT(refusal(beginning),
                AllOf(HasSubstr("holds no data: what is packed by"), HasSubstr("is cut off")))
        << kind;
  }
}

TEST_F(Packed, LossesAreThoseOfEachTimeItIsRead) {
  std::string file = packed("gz", plain_.substr(0, 1000));
  file[file.size() - 8] ^= 0x55;
  const std::unique_ptr<Recording> recording = open_recording(folder_.file("file", file));
  for (int time = 0; time < 3; ++time) {
    recording->read("", [](std::size_t, const StampedPose&) {});
    EXPECT_TRUE(recording->losses().checksum) << time;
  }
}

TEST_F(Packed, FilesThatWereJoinedAreReadToTheEnd) {
  const std::size_t half = plain_.find('\n', plain_.size() / 2) + 1;
  for (const std::string kind : {"gz", "zst", "bz2", "lz4"}) {
    const TrajectoryReading reading =
        read(packed(kind, plain_.substr(0, half)) + packed(kind, plain_.substr(half)));
    EXPECT_EQ(reading.trajectory.size(), poses) << kind;
    EXPECT_FALSE(reading.losses.any()) << kind;
  }
}

// As egocal's log reader says it: whatever reads such a file first, people learn what to do.
TEST_F(Packed, ALogOfLcmIsRefusedWithTheCommandThatUnpacksIt) {
  const std::string log = std::string("\xed\xa1\xda\x01", 4) + std::string(100, '\0');
  const std::string file = folder_.path("file"), whole = ", and a log is read unpacked: ";
  for (const auto& [kind, said] : {std::pair<std::string, std::string>{"gz", "gzip" + whole + "gunzip -k '"},
                                   {"zst", "zstd" + whole + "unzstd '"},
                                   {"bz2", "bzip2" + whole + "bunzip2 -k '"},
                                   {"lz4", "lz4" + whole + "unlz4 '"}})
    EXPECT_EQ(refusal(packed(kind, log)), file + ": is packed by " + said + file + "'");
  EXPECT_THAT(refusal(log), HasSubstr("is an LCM log: the commands of egocal read it, the library does not"));
}

TEST_F(Packed, WhatIsNotUnpackedOnTheWayIsRefusedWithTheCommandToo) {
  const std::string file = folder_.path("file");
  EXPECT_EQ(refusal(std::string("\xfd\x37zXZ\0", 6) + std::string(100, '\0')),
            file + ": is packed by xz, unpack it first: unxz -k '" + file + "'");
  EXPECT_EQ(refusal(packed("gz", packed("gz", plain_))),
            file + ": is packed by gzip, unpack it first: gunzip -k '" + file + "'");
  EXPECT_EQ(unpacking_command({"gzip", "gunzip -k"}, "it's"), "gunzip -k 'it'\\''s'");
}

}  // namespace
}  // namespace egocal::test_io_packed
