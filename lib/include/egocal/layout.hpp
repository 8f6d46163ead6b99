// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

// Every bound here is proven for IEEE 754 arithmetic as written. Flags that let a compiler assume that NaN
// does not occur, or that regroup sums, void the proofs: wrong answers would be certified. Such flags in a
// user's own program do so too, as they also change how the processor treats the smallest numbers.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error \
    "egocal: compile without -ffast-math, -Ofast and their parts: under them a wrong answer would be certified"
#endif

// pkg-config states no standard, which is the choice of a program: C++20 or newer.
#if defined(__cplusplus) && __cplusplus <= 201703L
#error "egocal needs C++20: compile with -std=c++20 $(pkg-config --cflags egocal)"
#endif

// Public types have one memory layout whatever the flags of their user: their Eigen members are unaligned
// (Eigen::DontAlign), so -mavx or -march=native changes nothing. Flags that do change a layout
// (-D_GLIBCXX_DEBUG, -fpack-struct, another version of the headers) end in an undefined reference that names
// the type, instead of wrong answers.
namespace egocal::detail {

/// Defined by the library for its own size and alignment of T only.
template <class T, std::size_t size, std::size_t alignment>
struct Layout {
  static const char same_as_in_the_library;
};

}  // namespace egocal::detail

/// Makes every file that includes the type refer to the library's layout of it. Behind the type's definition,
/// in namespace egocal.
#define EGOCAL_SAME_LAYOUT(Type)                                                \
  namespace detail {                                                            \
  template <>                                                                   \
  const char Layout<Type, sizeof(Type), alignof(Type)>::same_as_in_the_library; \
  [[gnu::used]] static const char* const layout_of_##Type =                     \
      &Layout<Type, sizeof(Type), alignof(Type)>::same_as_in_the_library;       \
  }
