// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "program/program.hpp"

namespace egocal::services {

/// --state of a process's command line.
inline TextOption state_option(std::string& file) {
  return {"--state", "file from which it continues after it was ended or killed", &file, {}};
}

/// Makes the service, which continues from its Saved state if a file is named. A refused state is reported on
/// standard error, in one line. Throws Error if another process holds the file, or it is no state of this
/// process.
template <class Service, class Saved>
std::shared_ptr<void> with_state(const std::string& program, const std::string& file, bus::Loop& loop,
                                 bus::Heartbeat& heartbeat, const bus::Rig& rig) {
  std::unique_ptr<Saved> saved = file.empty() ? nullptr : std::make_unique<Saved>(file, rig);
  const Saved* const kept = saved.get();
  auto service = std::make_shared<Service>(loop, heartbeat, rig, std::move(saved));
  if (kept && !kept->refused().empty())
    std::fprintf(stderr, "%s: %s\n", program.c_str(), kept->refused().c_str());
  return service;
}

}  // namespace egocal::services
