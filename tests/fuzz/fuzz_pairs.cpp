// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A text through the reader of motion pairs.
#include <cmath>

#include "egocal/error.hpp"
#include "egocal/io/pairs_file.hpp"
#include "require.hpp"
#include "support/in_memory_file.hpp"

using namespace egocal;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::InMemoryFile input;
  input.set(data, size);
  try {
    const std::vector<MotionPair> pairs = read_pairs(input.name());
    require(!pairs.empty(), "a file of pairs has a pair");
    for (const MotionPair& pair : pairs)
      for (const DualQuaternion* q : {&pair.a, &pair.b}) {
        require(q->vec().allFinite(), "motions are finite");
        require(std::abs(q->real.norm() - 1) < 1e-9, "quaternions are of unit length");
        require(std::abs(q->real.dot(q->dual)) <= 1e-9 * (1 + q->dual.norm()),
                "real and dual part are orthogonal");
        require(q->real[0] >= 0, "of q and -q the one with w >= 0");
      }
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
