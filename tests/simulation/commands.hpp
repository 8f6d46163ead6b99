// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "egocal/bus/rig.hpp"

namespace egocal::simulation {

/// What people have asked of processes: by name and pair.
class Commands {
 public:
  struct Wish {
    std::int64_t reset_us = -1;    ///< a reset was sent; -1: none since the newest session began
    bool on_its_way = false;       ///< a reset was, when the first session began: another one may follow
    std::int64_t paused_us = -1;   ///< a pause; -1: it runs
    std::int64_t paused_seq = -1;  ///< of pairing: the newest problem some time after the pause
  };

  /// to: a name or "*"; no names of sensors: all pairs.
  void command(std::int64_t now_us, const std::string& to, const std::string& verb, const bus::Rig& rig,
               const std::string& a, const std::string& b);
  /// pair: "<a>_<b>", as channels end.
  Wish& of(const std::string& process, const std::string& pair) { return wishes_[{process, pair}]; }

 private:
  std::map<std::pair<std::string, std::string>, Wish> wishes_;
};

/// Processes that obey commands about pairs, by the names that they have from the start.
inline constexpr const char* commanded_processes[] = {"egocal-pairing", "egocal-fast", "egocal-global"};

}  // namespace egocal::simulation
