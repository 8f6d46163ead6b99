// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Replaces operator new and delete of a program. Include it in only one file of the program.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <new>

namespace egocal::test {
inline std::size_t largest_allocation = 0;
inline void* allocate(std::size_t size) {
  largest_allocation = std::max(largest_allocation, size);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
}  // namespace egocal::test

void* operator new(std::size_t size) {
  return egocal::test::allocate(size);
}
void* operator new[](std::size_t size) {
  return egocal::test::allocate(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
