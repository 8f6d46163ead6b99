// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "egocal/io/recording.hpp"

namespace egocal::tools {

/// Whether the file begins like an LCM log.
bool is_lcm_log(const std::string& file);

/// An LCM log as a recording: one stream a channel.
class LcmRecording : public Recording {
 public:
  explicit LcmRecording(std::string file) : Recording(std::move(file)) {}

  std::string format() const override { return "LCM log"; }
  void read(const std::string& topic, const TakePose& take) override;

 private:
  std::size_t stream_of(const std::string& channel);
  std::map<std::string, std::size_t> channels_;
};

}  // namespace egocal::tools
