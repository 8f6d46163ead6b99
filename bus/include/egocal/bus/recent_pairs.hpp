// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "egocal/bus/check.hpp"

namespace egocal::bus {

/// Pairs that a rig may have, and that a listener remembers at once: a limit on memory.
inline constexpr std::size_t max_pairs = 256;

/// One value of type T for each pair that a listener heard. A forger can invent any number of names, so the
/// number of pairs is bounded: a new pair replaces the one that was not touched for longest, which returns
/// with its next message.
template <class T>
class RecentPairs {
 public:
  /// The value of this pair, which becomes the most recent one; a new T if the pair was not known.
  T& touch(const std::string& a, const std::string& b) {
    Key key{a, b};
    if (pairs_.size() >= max_pairs && !pairs_.contains(key))
      pairs_.erase(std::min_element(pairs_.begin(), pairs_.end(), [](const auto& x, const auto& y) {
        return x.second.touched < y.second.touched;
      }));
    Entry& entry = pairs_[std::move(key)];
    EGOCAL_CHECK(pairs_.size() <= max_pairs, "the number of pairs that are remembered is bounded");
    entry.touched = ++touches_;
    return entry.value;
  }
  /// Null: nothing is remembered of this pair.
  const T* find(const std::string& a, const std::string& b) const {
    const auto entry = pairs_.find({a, b});
    return entry == pairs_.end() ? nullptr : &entry->second.value;
  }
  T* find(const std::string& a, const std::string& b) {
    return const_cast<T*>(std::as_const(*this).find(a, b));
  }

 private:
  using Key = std::pair<std::string, std::string>;
  struct Entry {
    T value;
    std::uint64_t touched = 0;
  };
  std::map<Key, Entry> pairs_;
  std::uint64_t touches_ = 0;
};

}  // namespace egocal::bus
