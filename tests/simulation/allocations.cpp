// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Replaces operator new of the whole program: each block has its size and its owner in front of it.
#include "simulation/allocations.hpp"

#include <array>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define EGOCAL_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define EGOCAL_SANITIZED
#endif
#endif

namespace {

/// Numbers beyond share the last place.
constexpr std::size_t most_owners = 64;
std::array<std::size_t, most_owners> bytes_of{};
std::size_t current_owner = 0;

}  // namespace

namespace egocal::simulation {

MemoryOwner::MemoryOwner(std::size_t owner) : before_(current_owner) {
  current_owner = owner < most_owners ? owner : most_owners - 1;
}

MemoryOwner::~MemoryOwner() {
  current_owner = before_;
}

std::size_t allocated_bytes(std::size_t owner) {
  return bytes_of[owner < most_owners ? owner : most_owners - 1];
}

}  // namespace egocal::simulation

#ifndef EGOCAL_SANITIZED

namespace {

struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Header {
  std::size_t size, owner;
};

}  // namespace

void* operator new(std::size_t size) {
  auto* const header = static_cast<Header*>(std::malloc(sizeof(Header) + size));
  if (!header) throw std::bad_alloc();
  *header = {size, current_owner};
  bytes_of[current_owner] += size;
  return header + 1;
}

void operator delete(void* memory) noexcept {
  if (!memory) return;
  Header* const header = static_cast<Header*>(memory) - 1;
  bytes_of[header->owner] -= header->size;
  std::free(header);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

#endif
