// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "egocal/bus/work_thread.hpp"
#include "egocal/io/descriptor.hpp"

namespace egocal::tools {

/// Says once on standard error that data of a pipe or a terminal are waited for, where that takes more than a
/// second of its life. Says nothing of other files.
class PipeNotice {
 public:
  explicit PipeNotice(const std::string& file);
  ~PipeNotice();
  PipeNotice(const PipeNotice&) = delete;
  PipeNotice& operator=(const PipeNotice&) = delete;

 private:
  void wait() const;

  std::string file_;
  Descriptor arrived_;  ///< readable once nothing is waited for any more
  std::function<void()> work_;
  std::unique_ptr<bus::WorkThread> thread_;
};

}  // namespace egocal::tools
