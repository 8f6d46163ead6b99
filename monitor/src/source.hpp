// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "egocal/bus/rig.hpp"
#include "egocal/monitor/model.hpp"
#include "feed.hpp"
#include "program.hpp"
#include "recording.hpp"

namespace egocal::monitor {

/// Messages from the bus or from a log, behind one face.
class Source {
 public:
  /// Throws Error where the log is none, or the bus cannot be listened to.
  Source(Model& model, const ProgramOptions& options, const std::string& url,
         const std::vector<bus::Sensor>& sensors);
  bool live() const { return feed_ != nullptr; }
  bool at_end() const { return recording_ && recording_->at_end(); }
  const std::string& name() const { return name_; }
  std::string network_error() const { return feed_ ? feed_->network_error() : std::string(); }
  /// What is said where nothing was received.
  std::string nothing_in_words() const;

  /// wait() also returns when one of these is readable.
  void watch(std::vector<int> fds);
  /// Waits at most this long [ms]. Live messages are handed to the model at once.
  void wait(int milliseconds);
  /// Delivers what is due of a log, and returns the time of the model.
  Now advance();
  /// Sends a command. Returns the reason why it could not be sent; empty: it was sent.
  std::string send(const command_t& command);

 private:
  std::unique_ptr<Feed> feed_;
  std::unique_ptr<Recording> recording_;
  std::string name_;
  std::vector<int> fds_;
};

}  // namespace egocal::monitor
