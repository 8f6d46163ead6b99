// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What runs at every step of a drive allocates no memory.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <new>

#include "../support/random_motion.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/sqp.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Eigen calls malloc by itself: where the C library lets us, count what C allocates with, too. Sanitizers
// bring functions of their own.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) {
  ++allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  ++allocations;
  *p = __libc_memalign(alignment, size);
  return *p ? 0 : ENOMEM;
}
}
constexpr long counts_malloc = 1;
#else
constexpr long counts_malloc = 0;
#endif

// not inlined: the compiler would see free() meet operator new and warn
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (!counts_malloc) ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return operator new(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  if (!counts_malloc) ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(step, (size + step - 1) / step * step)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace egocal {
namespace {

using testing::Motion;
using testing::Random;

template <typename Work>
long counted(const Work& work) {
  const long before = allocations;
  work();
  return allocations - before;
}

/// Well and badly conditioned, with and without noise.
template <typename Work>
void expect_none(const Work& work) {
  for (const Motion motion : {Motion::free, Motion::dominant_axis, Motion::planar, Motion::translation}) {
    for (const double noise : {0.0, 1e-6, 0.1}) {
      Random random(1);
      const auto pairs = testing::random_pairs(testing::random_planar_extrinsic(random),
                                               {.motion = motion, .pairs = 30, .noise = noise}, random);
      const Matrix8d Q = testing::cost_of(pairs);
      EXPECT_EQ(counted([&] { work(pairs, Q); }), 0) << static_cast<int>(motion) << ' ' << noise;
    }
  }
}

using Pairs = std::vector<MotionPair>;

TEST(Allocations, AreSeenByThisTest) {
  int* volatile kept = nullptr;  // volatile: unused memory is not even asked for
  EXPECT_EQ(counted([&] { kept = new int(1); }), 1);
  delete kept;
  EXPECT_EQ(counted([&] { kept = static_cast<int*>(Eigen::internal::aligned_malloc(64)); }), counts_malloc);
  Eigen::internal::aligned_free(kept);

  struct alignas(64) Wide {
    double numbers[8];
  };
  Wide* volatile wide = nullptr;
  EXPECT_EQ(counted([&] { wide = new Wide; }), 1);
  delete wide;
  void* volatile raw = nullptr;
  EXPECT_EQ(counted([&] { raw = std::calloc(4, 4); }), counts_malloc);
  EXPECT_EQ(counted([&] { raw = std::realloc(raw, 4096); }), counts_malloc);
  std::free(raw);
  EXPECT_EQ(counted([&] { raw = std::aligned_alloc(64, 64); }), counts_malloc);
  std::free(raw);
  void* aligned = nullptr;
  EXPECT_EQ(counted([&] { EXPECT_EQ(posix_memalign(&aligned, 64, 64), 0); }), counts_malloc);
  std::free(aligned);
}

TEST(Allocations, NoneInTheDualLineSearch) {
  expect_none([](const Pairs&, const Matrix8d& Q) { EXPECT_TRUE(solve_dual(Q).q.vec().allFinite()); });
}
TEST(Allocations, NoneInNewtonsMethod) {
  expect_none([](const Pairs&, const Matrix8d& Q) { EXPECT_TRUE(solve_sqp(Q, {}).q.vec().allFinite()); });
}
TEST(Allocations, NoneInTheClosedForm) {
  expect_none([](const Pairs&, const Matrix8d& Q) { EXPECT_TRUE(solve_planar(Q).q.vec().allFinite()); });
}
TEST(Allocations, NoneInTheInteriorPointMethod) {
  expect_none([](const Pairs&, const Matrix8d& Q) { EXPECT_TRUE(solve_sdp(Q).q.vec().allFinite()); });
}
TEST(Allocations, NoneInVerification) {
  expect_none([](const Pairs&, const Matrix8d& Q) {
    EXPECT_TRUE(std::isfinite(verify(Q, {}).gap));
    EXPECT_TRUE(std::isfinite(verify_planar(Q, {}).gap));
  });
}
TEST(Allocations, NoneInBuildingTheCost) {
  expect_none([](const Pairs& pairs, const Matrix8d& Q) {
    Statistics statistics;
    for (const MotionPair& pair : pairs) statistics.add(pair);
    EXPECT_LE((cost_matrix(statistics) - Q).norm(), 1e-9);
  });
}

}  // namespace
}  // namespace egocal
