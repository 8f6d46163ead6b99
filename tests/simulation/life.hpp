// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace egocal::simulation {

/// Thrown where a process is killed. No exception that anything but the simulation could catch.
struct Killed {};

/// The places at which a process can be killed: whatever it sends or writes. One object a life.
class Life {
 public:
  bool over() const { return over_; }
  void end() { over_ = true; }
  /// Kills at the count-th place from now on, 1 at the next one.
  void kill_at_place(std::int64_t count) { places_left_ = count; }
  /// Whether this is the place. The caller does what a killed process would have done of it, and calls
  /// stop().
  bool ends_here() {
    if (over_ || places_left_ <= 0 || --places_left_ > 0) return false;
    over_ = true;
    return true;
  }
  /// The process goes through its destructors, which cannot throw: it runs on, and nothing of it has an
  /// effect.
  void begin_to_end() { ending_ = true; }
  void stop() const {
    if (!ending_) throw Killed();
  }

 private:
  bool over_ = false, ending_ = false;
  std::int64_t places_left_ = 0;  ///< 0: it is not to be killed
};

}  // namespace egocal::simulation
