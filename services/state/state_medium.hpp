// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "egocal/error.hpp"

namespace egocal::services {

/// Tuning of a process's state on disk. Study: tests/services/test_saved_state.cpp, the faulty disks of the
/// simulation.
struct StateOptions {
  /// Older files are stale: the sensors may have been moved meanwhile [s]. See age_s().
  std::int64_t most_age_s = 3600;
  /// A new snapshot is taken when this much was added to the last one [bytes]: inputs that are read again
  /// within a fraction of a second.
  std::uint64_t most_added = 4 << 20;
  /// More of a file is not read [bytes]: a state of the largest rigs has some megabytes.
  std::int64_t largest_state = std::int64_t{256} << 20;
  int most_refused = 100;  ///< files that are kept aside under names of their own
};

/// Where a state is kept: one file, which one process holds until the end. What its bytes mean is
/// StateFile's. A simulation can put any disk behind this interface.
class StateMedium {
 public:
  struct Found {
    std::vector<std::byte> bytes;
    std::int64_t written_s = 0, now_s = 0;  ///< by the clock of the file system [s]
  };

  /// What may be read: a file that begins otherwise is something else, and is never touched.
  struct Expected {
    std::string process;              ///< for messages: whose state it is to be
    std::vector<std::string> begins;  ///< like one of these, as far as it goes
  };

  StateMedium() = default;
  StateMedium(const StateMedium&) = delete;
  StateMedium& operator=(const StateMedium&) = delete;
  virtual ~StateMedium() = default;

  /// The name of the medium, for messages.
  virtual const std::string& name() const = 0;
  /// Reads the content. Empty: there is no file. Throws Error where it cannot be read, or is not what is
  /// expected.
  virtual std::optional<Found> read(const Expected& expected) = 0;
  /// Replaces the content in one step, after a power cut, too. Throws Error where the disk does not take it;
  /// the old content is then still there.
  virtual void replace(std::span<const std::byte> bytes) = 0;
  /// Adds to the content. Only after replace(). Throws Error likewise; a part of the bytes may have been
  /// written then, and only another replace() helps.
  virtual void add(std::span<const std::byte> bytes) = 0;
  /// Whether the content is where it was written. False: nothing has been written yet, or the file was
  /// removed, moved, replaced or cut off since then.
  virtual bool in_place() const = 0;
  /// Renames the file so that it stays; its new name. Throws Error where that is not possible.
  virtual std::string keep_aside() = 0;
};

/// What is said of a file that is something else than a state of this process.
Error not_a_state(const std::string& file, const std::string& process);

/// A medium in the file system, the same by whatever symbolic links the file is named. Throws Error where
/// another process holds it, or it cannot be held.
std::unique_ptr<StateMedium> open_state_medium(const std::string& file, const StateOptions& options = {});

}  // namespace egocal::services
