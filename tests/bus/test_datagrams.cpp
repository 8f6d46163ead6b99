// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "egocal/bus/datagrams.hpp"

namespace egocal::bus::test_datagrams {
namespace {

using Data = std::vector<std::byte>;

Data numbered(std::size_t size) {
  Data data(size);
  for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::byte>(i * 131 >> 3);
  return data;
}

std::vector<Data> datagrams(const std::string& channel, const Data& data, std::uint32_t number = 7) {
  std::vector<Data> all;
  EXPECT_TRUE(for_each_datagram(channel, data, number, [&](const Datagram& datagram) {
    Data one(datagram.header().begin(), datagram.header().end());
    one.insert(one.end(), datagram.payload.begin(), datagram.payload.end());
    all.push_back(one);
    return true;
  }));
  return all;
}

void put32(Data& datagram, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) datagram[at + i] = static_cast<std::byte>(value >> (24 - 8 * i) & 0xff);
}

bool any(std::string_view) {
  return true;
}

TEST(Datagrams, WholeMessagesComeBackAsTheyWere) {
  for (const std::size_t size : {0UL, 1UL, 500UL, 65496UL, 65497UL, 65498UL, 200'000UL, 1'000'000UL}) {
    const Data data = numbered(size);
    Reassembly reassembly;
    std::optional<Reassembly::Message> message;
    const std::vector<Data> all = datagrams("AB", data);
    for (const Data& datagram : all) {
      EXPECT_FALSE(message) << "complete before its last datagram";
      EXPECT_LE(datagram.size(), 65507U) << "more than a UDP datagram holds";
      message = reassembly.take(datagram, 1, any);
    }
    ASSERT_TRUE(message) << size;
    EXPECT_EQ(message->channel, "AB");
    EXPECT_EQ(Data(message->bytes.begin(), message->bytes.end()), data);
    EXPECT_EQ(reassembly.held(), 0U);
    EXPECT_EQ(reassembly.malformed() + reassembly.incomplete(), 0);
  }
}

TEST(Datagrams, FragmentsMayComeInAnyOrderAfterTheFirstAndTwice) {
  const Data data = numbered(300'000);
  std::vector<Data> parts = datagrams("AB", data);
  std::swap(parts[1], parts[3]);
  parts.insert(parts.begin() + 2, parts[1]);
  Reassembly reassembly;
  std::optional<Reassembly::Message> message;
  for (const Data& part : parts) message = reassembly.take(part, 1, any);
  ASSERT_TRUE(message);
  EXPECT_EQ(Data(message->bytes.begin(), message->bytes.end()), data);
}

TEST(Datagrams, SendersDoNotMix) {
  const Data x = numbered(100'000), y(100'000, std::byte{9});
  const std::vector<Data> from_x = datagrams("AB", x), from_y = datagrams("AB", y);
  Reassembly reassembly;
  EXPECT_FALSE(reassembly.take(from_x[0], 1, any));
  EXPECT_FALSE(reassembly.take(from_y[0], 2, any));
  const auto message = reassembly.take(from_x[1], 1, any);
  ASSERT_TRUE(message);
  EXPECT_EQ(Data(message->bytes.begin(), message->bytes.end()), x);
}

// liblcm 1.3.1 and 1.5.2 add offset and size in 32 bits and write where the sum points to.
TEST(Datagrams, FragmentOffsetsNearTwoToThe32AreRefused) {
  std::vector<Data> parts = datagrams("AB", numbered(100'000));
  put32(parts[1], 12, 0xFFFFFF00U);
  Reassembly reassembly;
  EXPECT_FALSE(reassembly.take(parts[0], 1, any));
  EXPECT_FALSE(reassembly.take(parts[1], 1, any));
  EXPECT_EQ(reassembly.malformed(), 1);
}

TEST(Datagrams, FragmentsThatLeaveHolesAreNoMessage) {
  std::vector<Data> parts = datagrams("AB", numbered(190'000));
  put32(parts[1], 12, 5);  // over the first one
  Reassembly reassembly;
  for (const Data& part : parts) EXPECT_FALSE(reassembly.take(part, 1, any));
  EXPECT_EQ(reassembly.held(), 0U);
}

TEST(Datagrams, OnlyWantedChannelsTakeMemory) {
  Reassembly reassembly;
  const auto wanted = [](std::string_view channel) { return channel == "WANTED"; };
  for (const Data& part : datagrams("OTHER", numbered(500'000)))
    EXPECT_FALSE(reassembly.take(part, 1, wanted));
  EXPECT_EQ(reassembly.held(), 0U);
  EXPECT_FALSE(reassembly.take(datagrams("OTHER", numbered(10))[0], 1, wanted));
  const Data good = datagrams("WANTED", numbered(10))[0];
  EXPECT_TRUE(reassembly.take(good, 1, wanted));
}

TEST(Datagrams, MemoryStaysBoundedWhateverSendersClaim) {
  const ReassemblyOptions options;
  Reassembly reassembly(options);
  for (std::uint64_t sender = 0; sender < 500; ++sender) {
    Data first = datagrams("AB", numbered(100'000))[0];
    put32(first, 8,
          static_cast<std::uint32_t>(sender % 2 ? options.max_message - 100 : options.max_message + 1));
    reassembly.take(first, sender, any);
    EXPECT_LE(reassembly.held(), options.max_total);
  }
  EXPECT_GE(reassembly.incomplete(), 450);
}

TEST(Datagrams, AnyBytesAreTaken) {
  std::mt19937 random(5);
  const std::vector<Data> good = datagrams("AB", numbered(70'000));
  Reassembly reassembly;
  for (int i = 0; i < 50'000; ++i) {
    const Data& original = good[random() % good.size()];
    Data damaged(original.begin(), original.begin() + 80);
    damaged.resize(random() % 80);
    for (int k = random() % 4; k > 0 && !damaged.empty(); --k)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    reassembly.take(damaged, random() % 100, any);
    ASSERT_LE(reassembly.held(), ReassemblyOptions{}.max_total);
  }
  EXPECT_GT(reassembly.malformed(), 0);
}

TEST(Datagrams, WhatDoesNotFitIsNotSent) {
  const auto never = [](const Datagram&) { return ADD_FAILURE(), true; };
  EXPECT_FALSE(for_each_datagram(std::string(64, 'x'), numbered(1), 0, never));
  EXPECT_FALSE(for_each_datagram("", numbered(1), 0, never));
  EXPECT_FALSE(for_each_datagram(std::string("a\0b", 3), numbered(1), 0, never));
}

}  // namespace
}  // namespace egocal::bus::test_datagrams
