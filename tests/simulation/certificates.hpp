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

/// The problems of a life. Checks with arithmetic of 113 bits whether the certificates of their answers are
/// true.
class Certificates {
 public:
  /// A problem that was sent.
  void take_problem(const std::string& channel, bus::Bytes message);
  /// Whether a problem of this session and number was ever sent on the channel.
  bool knows(const std::string& channel, std::int64_t session, std::int64_t seq) const;
  /// What is wrong with the certificate of the answer, one line; empty: nothing, or its problem was sent too
  /// long ago. Answers without a certificate are not checked. About 0.3 ms.
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
