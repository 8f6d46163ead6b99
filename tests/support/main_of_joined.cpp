// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The program of several files of tests (cmake/JoinedTests.cmake): runs those of the files named.
//   PROGRAM test_a.cpp test_b.cpp
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

#ifdef EGOCAL_TESTS_IN_NETWORK
#include "support/network_namespace.hpp"
#endif

namespace {

std::string filter_of(const std::string& file) {
  std::string filter;
  const ::testing::UnitTest& all = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const ::testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const ::testing::TestInfo& test = *suite.GetTestInfo(k);
      if (std::filesystem::path(test.file()).filename() == file)
        filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleMock(&argc, argv);
  std::string filter;
  for (int i = 1; i < argc; ++i) {
    const std::string of_file = filter_of(argv[i]);
    if (of_file.empty()) {
      std::fprintf(stderr, "%s: no test in '%s'\n", argv[0], argv[i]);
      return 1;
    }
    filter += of_file;
  }
  if (filter.empty()) {
    std::fprintf(stderr, "%s: expected files of tests\n", argv[0]);
    return 1;
  }
#ifdef EGOCAL_TESTS_IN_NETWORK
  if (!GTEST_FLAG_GET(list_tests) && !egocal::test::enter_network_namespace()) return 1;
#endif
  GTEST_FLAG_SET(filter, filter);
  return RUN_ALL_TESTS();
}
