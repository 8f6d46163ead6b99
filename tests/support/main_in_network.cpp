// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// main() of GoogleTest programs whose processes talk over LCM: in a network namespace of their own.
#include <gtest/gtest.h>

#include "support/network_namespace.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (!::testing::GTEST_FLAG(list_tests) && !egocal::test::enter_network_namespace()) return 1;
  return RUN_ALL_TESTS();
}
