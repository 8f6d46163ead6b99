// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

namespace egocal::detail {

/// Work in small pieces, done in the order in which it was added. Work that a piece adds is done right after
/// that piece.
class Schedule {
 public:
  /// cost: about as many poses as the piece looks at.
  void add(std::size_t cost, std::function<void()> piece) { added_.push_back({cost, std::move(piece)}); }

  /// piece(begin, end) on consecutive ranges of n items, each of which costs as much as `cost` poses.
  template <typename Piece>
  void add_range(std::size_t n, Piece piece, std::size_t cost = 1) {
    const std::size_t most = 256 / cost;  // items of a piece: bounds its time, changes no bit
    for (std::size_t begin = 0; begin < n; begin += most) {
      const std::size_t end = std::min(n, begin + most);
      add(cost * (end - begin), [piece, begin, end] { piece(begin, end); });
    }
  }

  /// Does at least one piece, and more as long as they cost no more than `cost` together. True: nothing is
  /// left.
  bool run(std::size_t cost) {
    std::size_t spent = 0;
    while (take_added() && (spent == 0 || spent + pieces_.front().cost <= cost)) {
      const Piece piece = std::move(pieces_.front());
      pieces_.pop_front();
      piece.work();
      spent += std::max<std::size_t>(1, piece.cost);
    }
    return !take_added();
  }

 private:
  bool take_added() {
    pieces_.insert(pieces_.begin(), std::make_move_iterator(added_.begin()),
                   std::make_move_iterator(added_.end()));
    added_.clear();
    return !pieces_.empty();
  }

  struct Piece {
    std::size_t cost;
    std::function<void()> work;
  };
  std::deque<Piece> pieces_;
  std::vector<Piece> added_;
};

}  // namespace egocal::detail
