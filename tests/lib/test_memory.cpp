// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What looking for mistakes holds beside the poses of a long drive.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include "../support/simulated_drive.hpp"
#include "diagnosis/explanations/turning/turning_scale.hpp"
#include "diagnosis/motions/motions.hpp"
#include "diagnosis/motions/robust_fit.hpp"

namespace {
std::atomic<std::ptrdiff_t> live{0}, most{0};  // [bytes]
}

// not inlined: the compiler would see free() meet operator new and warn
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* p = std::malloc(size);
  if (!p) throw std::bad_alloc();
  live += static_cast<std::ptrdiff_t>(malloc_usable_size(p));
  most = std::max(most.load(), live.load());
  return p;
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return operator new(size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  live -= static_cast<std::ptrdiff_t>(malloc_usable_size(p));
  std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p) noexcept {
  operator delete(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  operator delete(p);
}
[[gnu::noinline]] void operator delete[](void* p, std::size_t) noexcept {
  operator delete(p);
}

namespace egocal {
namespace {

/// The most that turning_scale() holds at one time [bytes].
std::ptrdiff_t held(int poses) {
  const testing::Streams drive = testing::noisy_drive(Terrain::rough, 0.01, poses);
  const DiagnosisOptions options;
  const detail::Instants instants = detail::synchronised(drive.a, drive.b, {}, 1, 1, options.motions);
  constexpr int stride = 8;
  detail::Explained given{detail::motions_of(instants, {}, {}, stride, options.motions.most, options.motions),
                          {}};
  given.fit = detail::robust_fit(given.motions, options.fit);
  const std::ptrdiff_t before = live;
  most = before;
  EXPECT_TRUE(detail::turning_scale(instants, given, options).empty());
  return most - before;
}

/// Of a million poses of each stream the poses are 144 of the 200 MB that are the goal (docs/benchmarks.md).
TEST(Memory, WhatTurnsTooFarIsLookedForWithoutHoldingTheOrientationsOfTheDrive) {
  constexpr int fewer = 50000, more = 100000;
  const std::ptrdiff_t few = held(fewer), many = held(more);
  EXPECT_LT(many - few, more - fewer) << "one byte for each pose more: " << few << ", " << many;
}

}  // namespace
}  // namespace egocal
