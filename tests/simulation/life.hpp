// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace egocal::simulation {

/// Thrown at the point where a process is killed. No type that any handler outside the simulation catches.
struct Killed {};

/// Counts the places at which a process can be killed: all that it sends or writes. One object a life.
class Life {
 public:
  bool over() const { return over_; }
  void end() { over_ = true; }
  /// Kills at the count-th place from now on, 1 at the next one.
  void kill_at_place(std::int64_t count) { places_left_ = count; }
  /// Whether the process is killed at this place. The caller then does the part of the work that the killed
  /// process had done, and calls stop().
  bool ends_here() {
    if (over_ || places_left_ <= 0 || --places_left_ > 0) return false;
    over_ = true;
    return true;
  }
  /// The process runs through its destructors, which cannot throw, without any effect.
  void begin_to_end() { ending_ = true; }
  void stop() const {
    if (!ending_) throw Killed();
  }

 private:
  bool over_ = false, ending_ = false;
  std::int64_t places_left_ = 0;  ///< 0: it is not to be killed
};

}  // namespace egocal::simulation
