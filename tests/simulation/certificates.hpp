// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/bytes.hpp"
#include "egocal/calibration_t.hpp"

namespace egocal::simulation {

/// The problems of a life, and whether arithmetic of 113 bits agrees with the certificates of the answers to
/// them.
class Certificates {
 public:
  /// A problem that was sent.
  void take_problem(const std::string& channel, bus::Bytes message);
  /// Whether a problem of this session and number was ever sent on the channel.
  bool knows(const std::string& channel, std::int64_t session, std::int64_t seq) const;
  /// Why the answer is not what it claims, one line; empty: no objection, or its problem was sent too long
  /// ago. What claims no certificate is not looked at. About 0.3 ms.
  std::string objection(const std::string& channel, const calibration_t& answer);
  /// Answers that were looked at.
  std::int64_t checked() const { return checked_; }

 private:
  static constexpr std::size_t most_kept = 16;  ///< a channel; answers come within a few problems
  std::map<std::string, std::deque<std::vector<std::byte>>> problems_;
  std::map<std::string, std::set<std::pair<std::int64_t, std::int64_t>>> numbers_;
  std::int64_t checked_ = 0;
};

}  // namespace egocal::simulation
