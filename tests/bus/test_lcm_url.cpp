// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "egocal/bus/lcm_url.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::bus::test_lcm_url {
namespace {

std::string refused(const std::string& url) {
  try {
    parse_lcm_url(url);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(LcmUrl, ReadsWhatLcmWrites) {
  const LcmUrl url = parse_lcm_url("udpm://239.1.2.3:7700?ttl=1&recv_buf_size=100000");
  EXPECT_EQ(url.group, "239.1.2.3");
  EXPECT_EQ(url.port, 7700);
  EXPECT_EQ(url.ttl, 1);
  EXPECT_EQ(url.receive_buffer, 100000);
  EXPECT_EQ(parse_lcm_url("udpm://").group, "239.255.76.67");
  EXPECT_EQ(parse_lcm_url("udpm://:7701").port, 7701);
  EXPECT_EQ(parse_lcm_url("udpm://239.1.2.3").port, 7667);
  EXPECT_TRUE(parse_lcm_url("memq://").memory);
}

TEST(LcmUrl, RefusesEverythingElseInOneLine) {
  for (const char* url :
       {"", "nonsense", "file:///tmp/x?mode=w", "tcpq://localhost", "udpm://not.an.address:1",
        "udpm://10.0.0.1:7667", "udpm://239.1.2.3:0", "udpm://239.1.2.3:70000", "udpm://239.1.2.3:7667x",
        "udpm://239.1.2.3?ttl=256", "udpm://239.1.2.3?ttl=", "udpm://239.1.2.3?tll=1", "memq://x"}) {
    const std::string message = refused(url);
    EXPECT_NE(message, "") << url;
    EXPECT_EQ(message.find('\n'), std::string::npos) << url;
  }
}

TEST(LcmUrl, FilesAreNeverTouched) {
  const testing::ScratchFolder folder;
  const std::string file = folder.file("victim", "keep me");
  EXPECT_THROW(Loop("file://" + file + "?mode=w"), Error);
  EXPECT_EQ(std::filesystem::file_size(file), 7U);
}

}  // namespace
}  // namespace egocal::bus::test_lcm_url
