// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether the newest problem of a pair is the last one of a log. No clock and no processes here.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "answers/answers.hpp"

namespace egocal::tools {

/// Pairing sends its newest problem of a pair again each second. A problem that comes again unchanged is the
/// last one of all that pairing had read before it sent the problem again.
class LastMotions {
 public:
  void hear(const problem_t& problem);
  /// The log has ended just now, or pairing has read more of it: what came before shows nothing.
  void clear() { last_.clear(); }
  bool known(const PairName& pair) const { return last_.contains(pair); }

 private:
  using Number = std::pair<std::int64_t, std::int64_t>;                   ///< session, sequence number
  static constexpr std::size_t most_pairs = bus::AnswerCheck::max_pairs;  // a limit on memory
  std::map<PairName, Number> newest_;
  std::set<PairName> last_;
};

}  // namespace egocal::tools
