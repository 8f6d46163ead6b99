// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/log_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>

#include "damaged_log_test.hpp"
#include "egocal/error.hpp"
#include "support/damaged_log.hpp"
#include "support/in_memory_file.hpp"
#include "support/largest_allocation.hpp"

namespace egocal::bus::test_log_file {
namespace {

using test::Accident;
using test::Damage;
using test::DamagedLog;
using test::SmallLog;
using ::testing::HasSubstr;

TEST_F(LogFile, AWholeLogHasNoDamageAndLiblcmReadsIt) {
  const Read result = read(log.bytes);
  EXPECT_EQ(result.events.size(), log.events());
  EXPECT_FALSE(result.damage.any());
  lcm::LogFile theirs(memory.name(), "r");
  for (const Read::Event& mine : result.events) {
    const lcm::LogEvent* event = theirs.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->channel, mine.event.channel);
    EXPECT_EQ(event->timestamp, mine.event.time_us);
    EXPECT_EQ(event->eventnum, mine.event.number);
    EXPECT_EQ(static_cast<std::size_t>(event->datalen), mine.event.data.size());
  }
  EXPECT_EQ(theirs.readNextEvent(), nullptr);
}

TEST_F(LogFile, TenThousandDamagedCopiesCostNoMoreThanWhatWasDamaged) {
  testing::Random random(6);
  test::largest_allocation = 0;
  std::size_t unreadable = 0, wrong_counts = 0, counts = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Damage damage = test::all_damages[static_cast<std::size_t>(i) % std::size(test::all_damages)];
    const DamagedLog damaged = test::damaged(log, damage, random);
    SCOPED_TRACE("copy " + std::to_string(i) + ", kind " + std::to_string(static_cast<int>(damage)));
    Read result;
    try {
      result = read(damaged.bytes);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("there is no event in it"));
      EXPECT_TRUE(damaged.whole.empty());
      ++unreadable;
      continue;
    }
    expect_whole(damaged, result);
    // the numbers tell how many are missing, as long as the last one is there to be compared with
    const bool last_is_whole =
        std::any_of(damaged.whole.begin(), damaged.whole.end(),
                    [&](const auto& whole) { return whole.event + 1 == log.events(); });
    if (last_is_whole) {
      ++counts;
      const std::size_t accounted = result.damage.lost_events + result.events.size();
      EXPECT_LE(accounted, log.events()) << "more lost than there was";
      if (damage == Damage::zeros || damage == Damage::noise || damage == Damage::lengths) {
        EXPECT_EQ(accounted, log.events());
      }
      wrong_counts += accounted != log.events();
    }
    if (HasFailure()) break;
  }
  EXPECT_LT(test::largest_allocation, 1u << 20) << "a length field of a small file asked for much memory";
  // a single event after a piece that was cut out or swapped: nothing bears its number out
  std::printf("%zu copies without an event; fewer lost events counted than there were in %zu of %zu\n",
              unreadable, wrong_counts, counts);
  EXPECT_LE(wrong_counts, counts / 50);
}

TEST_F(LogFile, ANumberDamagedToZeroBeginsNoOtherLog) {
  for (std::size_t event = 1; event + 1 < log.events(); ++event) {
    std::string bytes = log.bytes;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(log.begin[event]) + 4, 8, '\0');
    const Read result = read(bytes);
    EXPECT_EQ(result.events.size(), log.events());
    EXPECT_EQ(result.damage.lost_events, 0u) << event;
  }
  const Read twice = read(log.bytes + log.bytes);
  EXPECT_EQ(twice.events.size(), 2 * log.events());
  EXPECT_EQ(twice.damage.lost_events, 0u);
}

TEST_F(LogFile, NumbersThatAreDamagedAlikeInventNoLostEvents) {
  for (const std::size_t events : {1u, 2u, 5u}) {
    std::string bytes = log.bytes;
    for (std::size_t event = 8; event < 8 + events; ++event) bytes[log.begin[event] + 9] ^= 0x04;
    const Read result = read(bytes);
    EXPECT_EQ(result.events.size(), log.events());
    EXPECT_EQ(result.damage.lost_events, 0u) << events;
    EXPECT_EQ(result.damage.jumps, 2u);
  }
}

TEST_F(LogFile, SeeksByTimeWithoutReadingWhatIsBefore) {
  const std::string long_log = ::testing::TempDir() + "egocal_seek_" + std::to_string(getpid()) + ".log";
  constexpr std::int64_t begin = 1'700'000'000'000'000, step = 10'000;
  {
    bus::LogWriter writer(long_log);
    for (std::int64_t i = 0; i < 60'000; ++i) {
      std::int64_t time = begin + step * i;
      if (i % 1000 == 7) time ^= std::int64_t{1} << 40;  // damaged
      if (i % 2 == 1) time -= 300'000;                   // of another source, a little late
      writer.write(time, "CHANNEL", std::vector<std::byte>(40));
    }
    writer.close();
  }
  bus::LogReader reader(long_log);
  for (const std::int64_t second : {-5, 0, 1, 2, 100, 333, 599, 600, 1000}) {
    const std::int64_t wanted = begin + 1'000'000 * second;
    reader.seek(wanted);
    EXPECT_LE(reader.position(), reader.size());
    const std::uint64_t from = reader.position();
    std::int64_t earlier = 0;
    std::optional<bus::LogEvent> event;
    while ((event = reader.next()) && (event->time_us < wanted || event->time_us > wanted + 1'000'000))
      ++earlier;
    if (second >= 0 && second < 600) {
      EXPECT_LT(earlier, 1500) << "at " << second << " s";
    }
    // nothing of what is wanted is before
    const std::int64_t first = 100 * std::max<std::int64_t>(second, 0);
    EXPECT_LE(from, static_cast<std::uint64_t>(std::min<std::int64_t>(first, 60'000) * (28 + 7 + 40)));
    EXPECT_EQ(reader.damage().regions, 0u);
    EXPECT_EQ(reader.damage().lost_events, 0u);
  }
  std::filesystem::remove(long_log);
}

TEST_F(LogFile, OneLyingLengthCostsOneEvent) {
  for (std::size_t event = 0; event < log.events(); ++event)
    for (const std::size_t field : {20u, 24u})
      for (const std::uint32_t lie :
           {0xffffffffu, 0x80000000u, 0x7fffffffu, 0xffff0000u, 1u << 20, 64u << 20}) {
        const Read result = read(with_field(event, field, lie));
        EXPECT_EQ(result.events.size(), log.events() - 1);
        EXPECT_EQ(result.damage.regions, 1u);
        EXPECT_EQ(result.damage.bytes, size_of(event));
        EXPECT_EQ(result.damage.lost_events, 1u) << event;
        EXPECT_EQ(result.damage.truncated, event + 1 == log.events());
      }
}

TEST_F(LogFile, ALengthThatIsOffByAnyBitNeverPassesForAnEvent) {
  for (std::size_t event = 4; event + 1 < log.events(); ++event)
    for (int bit = 0; bit < 64; ++bit) {
      Accident accident(log);
      accident.piece(0, log.bytes.size());
      accident.flip(log.begin[event] + 20 + static_cast<std::size_t>(bit / 8), bit % 8);
      const DamagedLog damaged = accident.happened();
      const Read result = read(damaged.bytes);
      expect_whole(damaged, result);
      EXPECT_EQ(result.events.size(), log.events() - 1) << event << " bit " << bit;
      EXPECT_EQ(result.damage.bytes, size_of(event));
      EXPECT_EQ(result.damage.lost_events, 1u);
    }
}

TEST_F(LogFile, ACutLogSaysSo) {
  for (std::size_t size = log.begin[1]; size <= log.bytes.size(); ++size) {
    const Read result = read(log.bytes.substr(0, size));
    const std::size_t whole = size == log.bytes.size() ? log.events() : log.event_at(size);
    const std::size_t rest = size - log.begin[whole];
    EXPECT_EQ(result.events.size(), whole);
    EXPECT_EQ(result.damage.bytes, rest);
    EXPECT_EQ(result.damage.truncated, rest > 0);
    EXPECT_EQ(result.damage.lost_events, rest > 0 ? 1u : 0u);
  }
  // and one whose beginning is missing
  for (const std::size_t missing : {std::size_t{5}, log.begin[7], log.begin[7] + 1}) {
    const Read result = read(log.bytes.substr(missing));
    const std::size_t first = missing == log.begin[7] ? 7 : log.event_at(missing) + 1;
    EXPECT_EQ(result.events.size(), log.events() - first);
    EXPECT_EQ(result.damage.lost_events, first);
    EXPECT_TRUE(result.damage.any());
  }
}

TEST_F(LogFile, BlocksInTheWrongOrderOrCutOutAreSeenByTheirNumbers) {
  Accident swapped(log);
  swapped.piece(0, log.begin[10]);
  swapped.piece(log.begin[20], log.begin[25]);
  swapped.piece(log.begin[10], log.begin[20]);
  swapped.piece(log.begin[25], log.bytes.size());
  Read result = read(swapped.happened().bytes);
  EXPECT_EQ(result.events.size(), log.events());
  EXPECT_EQ(result.damage.lost_events, 0u);
  EXPECT_EQ(result.damage.bytes, 0u);
  EXPECT_EQ(result.damage.jumps, 3u);

  Accident cut_out(log);
  cut_out.piece(0, log.begin[10]);
  cut_out.piece(log.begin[20], log.bytes.size());
  result = read(cut_out.happened().bytes);
  EXPECT_EQ(result.events.size(), log.events() - 10);
  EXPECT_EQ(result.damage.lost_events, 10u);
  EXPECT_EQ(result.damage.jumps, 1u);

  // one log after the other is no damage; one with a hole before a whole one is
  EXPECT_FALSE(read(log.bytes + log.bytes).damage.any());
  EXPECT_EQ(read(cut_out.happened().bytes + log.bytes).damage.lost_events, 10u);
}

TEST_F(LogFile, ADamagedNumberIsNoLoss) {
  for (const std::size_t event : {std::size_t{0}, std::size_t{9}, log.events() - 1})
    for (const std::uint32_t lie : {0xffffffffu, 0x7fffffffu, 1u, 0u}) {
      const Read result = read(with_field(event, 4, lie));  // the upper half
      EXPECT_EQ(result.events.size(), log.events());
      EXPECT_EQ(result.damage.lost_events, 0u);
      EXPECT_EQ(result.damage.bytes, 0u);
    }
}

TEST_F(LogFile, BytesThatCameInBetweenCostNothingElse) {
  for (const std::size_t event : {std::size_t{6}, std::size_t{10}, std::size_t{25}}) {
    const std::string bytes =
        log.bytes.substr(0, log.begin[event]) + std::string(100, '?') + log.bytes.substr(log.begin[event]);
    const Read result = read(bytes);
    EXPECT_EQ(result.events.size(), log.events()) << event;
    EXPECT_EQ(result.damage.bytes, 100u);
    EXPECT_EQ(result.damage.lost_events, 0u);
  }
}

/// As it stands in a log.
std::string event_bytes(std::uint64_t number, const std::string& channel, const std::string& data) {
  std::string bytes;
  const auto put = [&](std::uint64_t value, int count) {
    for (int i = count; i > 0; --i) bytes += static_cast<char>(value >> (8 * (i - 1)));
  };
  put(0xEDA1DA01, 4);
  put(number, 8);
  put(1'600'000'000'000'000, 8);
  put(channel.size(), 4);
  put(data.size(), 4);
  return bytes + channel + data;
}

TEST_F(LogFile, AMessageThatHoldsThePieceOfALogIsWhole) {
  const std::string next = event_bytes(1, "INNER", "data");
  for (const std::string& piece : {next + "more", "more" + next + "more", next.substr(0, next.size() - 1),
                                   next.substr(0, test::log_header_size), event_bytes(7, "INNER", "data"),
                                   next + event_bytes(0, "INNER", "data")}) {
    const Read result = read(event_bytes(0, "OUTER", piece));
    ASSERT_EQ(result.events.size(), 1u) << piece;
    EXPECT_EQ(result.events[0].event.channel, "OUTER");
    EXPECT_EQ(result.events[0].event.data.size(), piece.size());
    EXPECT_FALSE(result.damage.any());
  }
  // begun in the name of the channel: what repairing a damaged log made once
  std::string bytes = event_bytes(0, "OUTER" + next.substr(0, 2), next.substr(2) + "more");
  Read result = read(bytes);
  ASSERT_EQ(result.events.size(), 1u);
  EXPECT_FALSE(result.damage.any());

  // in the middle of a log the next event bears the outer one out, whatever it holds
  const std::string both = next + event_bytes(2, "INNER", "data");
  for (const std::string& piece : {next, both, both + "more"}) {
    result = read(event_bytes(0, "OUTER", piece) + event_bytes(1, "OUTER", "data"));
    ASSERT_EQ(result.events.size(), 2u);
    EXPECT_EQ(result.events[0].event.data.size(), piece.size());
    EXPECT_FALSE(result.damage.any());
  }
}

TEST_F(LogFile, WhereTheSameBytesAreTwoLogsTheOneWithMoreEventsIsRead) {
  // These are at the same time the events of a log whose first one has a damaged length, and a message in
  // which another program has sent them.
  const std::string next = event_bytes(1, "CHANNEL", "data"), after = event_bytes(2, "CHANNEL", "data");
  for (const std::string& rest : {next, next + after, next + after + "cut off"}) {
    std::string lying = event_bytes(0, "CHANNEL", "data") + rest;
    lying[27] = static_cast<char>(4 + rest.size());
    ASSERT_EQ(lying, event_bytes(0, "CHANNEL", "data" + rest));
    const Read result = read(lying);
    EXPECT_EQ(result.events.size(), rest == next ? 1u : 2u);
    EXPECT_EQ(result.damage.lost_events, rest.size() > 2 * next.size() ? 2u : 1u);
    for (const Read::Event& event : result.events) EXPECT_EQ(event.event.data.size(), 4u);
  }
}

TEST_F(LogFile, AnEventThatIncludesAnotherOneIsFoundByTheInnerOne) {
  // All as long as each other, as from one sensor: a length off by one bit ends at another event.
  std::string good;
  std::vector<std::size_t> begin;
  for (std::uint64_t i = 0; i < 16; ++i) {
    begin.push_back(good.size());
    good += event_bytes(i, "ODOMETRY", std::string(92, 'x'));
  }
  ASSERT_EQ(begin[1], 128u);
  for (const int bit : {7, 8, 9})
    for (const std::size_t event :
         {std::size_t{0}, std::size_t{5}, std::size_t{15 - (std::size_t{1} << (bit - 7))}}) {
      std::string bytes = good;
      const auto flip = [&](std::size_t which, int k) {
        bytes[begin[which] + 27 - static_cast<std::size_t>(k / 8)] ^= static_cast<char>(1 << (k % 8));
      };
      flip(event, bit);
      EXPECT_EQ(read(bytes).events.size(), 15u) << event << " bit " << bit;
      // and the one after it, which then cannot be read itself but has a number still
      if (bit == 7) continue;
      flip(event + 1, 3);
      const Read result = read(bytes);
      EXPECT_EQ(result.events.size(), 14u) << event << " bit " << bit;
      EXPECT_EQ(result.damage.bytes, 256u);
      EXPECT_EQ(result.damage.lost_events, 2u);
    }
}

TEST_F(LogFile, WhatIsNoLogIsRefusedInOneLine) {
  for (const std::string& bytes : {std::string(), std::string("no log"), std::string(100'000, '\xed'),
                                   log.bytes.substr(1, 100), std::string(28, '\0')})
    EXPECT_THROW(read(bytes), Error);
  EXPECT_THROW(LogReader(folder.string()), Error);
  EXPECT_THROW(LogReader((folder / "none").string()), Error);
}

TEST_F(LogFile, APackedLogIsRefusedWithTheCommandThatUnpacksIt) {
  for (const auto& [begin, command] :
       {std::pair<std::string, std::string>{"\x1f\x8b",
                                            "packed by gzip, and a log is read unpacked: gunzip -k '"},
        {"\x28\xb5\x2f\xfd", "unzstd '"},
        {"BZh9", "bunzip2 -k '"},
        {"\x04\x22\x4d\x18", "unlz4 '"},
        {std::string("\xfd\x37zXZ\0", 6), "unxz -k '"}})
    try {
      read(begin + std::string(1000, 'x'));
      ADD_FAILURE() << command;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(command));
    }
}

TEST_F(LogFile, AWriterLeavesTheWholeFileOrNone) {
  const std::string out = folder / "out.log";
  { LogWriter(out).write(1, "A", {}); }
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_FALSE(std::filesystem::exists(out + ".part"));
  EXPECT_THROW(LogWriter("/dev/null"), Error);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_FALSE(std::filesystem::exists("/dev/null.part"));
  EXPECT_THROW(LogWriter(folder.string()), Error);
  EXPECT_THROW(LogWriter((folder / "no/such.log").string()), Error);

  // a full disk
  test::write_bytes(out, "the old one");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{10'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string said;
  try {
    LogWriter writer(out);
    for (int i = 0; i < 1000; ++i) writer.write(i, "A", std::vector<std::byte>(100));
    writer.close();
  } catch (const Error& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(said, HasSubstr("out.log: cannot be written"));
  EXPECT_EQ(test::read_bytes(out), "the old one");
  EXPECT_FALSE(std::filesystem::exists(out + ".part"));
}

}  // namespace
}  // namespace egocal::bus::test_log_file
