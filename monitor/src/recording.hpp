// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// A recorded session, played into the model in the log's own time.
class Recording {
 public:
  /// speed: times real time; 0: all at once. Throws Error if the file is no log.
  Recording(Model& model, const std::string& file, double speed);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  /// Delivers what is due, and returns the time of the log. A long log is read in slices, so that keys still
  /// work.
  Now advance(std::int64_t mono_us);
  bool at_end() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace egocal::monitor
