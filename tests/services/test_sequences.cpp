// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the fuzzers of sequences do, on random input and without clang: require() ends the program.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "fuzz/try_sequence.hpp"

namespace egocal::test_sequences {
namespace {

template <class Try>
void on_random_input(int sequences, std::size_t length, Try attempt) {
  std::mt19937_64 random(11);
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < sequences; ++i) {
    bytes.resize(random() % length);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    attempt(bytes.data(), bytes.size());
  }
}

TEST(Sequences, OfPosesLoseNothingInAStream) {
  on_random_input(20'000, 2000, fuzz::try_stream);
}

TEST(Sequences, OfMessagesLeavePairingAsItWouldBeRestored) {
  on_random_input(300, 4000, fuzz::try_pairing);
}

}  // namespace
}  // namespace egocal::test_sequences
