// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace egocal::simulation {

/// Sets the owner of the memory that is allocated until the end of the scope. One thread.
class MemoryOwner {
 public:
  /// 0: memory that several processes share.
  explicit MemoryOwner(std::size_t owner);
  ~MemoryOwner();
  MemoryOwner(const MemoryOwner&) = delete;
  MemoryOwner& operator=(const MemoryOwner&) = delete;

 private:
  std::size_t before_;
};

/// Bytes that were allocated by new for the owner and not freed yet, by anybody. 0 in builds with sanitizers,
/// whose own allocation is not replaced.
std::size_t allocated_bytes(std::size_t owner);

}  // namespace egocal::simulation
