// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace egocal::services {

/// A file from which a process that was killed goes on: a snapshot, and behind it what came since then.
///
/// A snapshot takes the place of the file in one step (temporary file, fsync, rename). Each addition is one
/// write behind it; a process that is killed in the middle of one leaves an unfinished last part, which was
/// not acknowledged to anybody and is left out. Everything else that does not fit its checksums is damage.
class StateFile {
 public:
  struct Content {
    std::vector<std::byte> snapshot;
    std::vector<std::vector<std::byte>> additions;
  };

  /// Holds the file for this process alone until the end. Throws Error where that is not possible, or where
  /// the file is there and is something else than a state file. identity: whose state it is, one line each.
  StateFile(std::string file, std::string identity);
  ~StateFile();
  StateFile(const StateFile&) = delete;
  StateFile& operator=(const StateFile&) = delete;

  /// What is there to go on from; empty where there is no file or it is refused.
  std::optional<Content> read();
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return refused_; }
  /// Refuses what read() returned: it is kept aside as FILE.refused.
  void refuse(const std::string& why);

  /// Throws Error where the disk does not take it; the old content is then still there.
  void snapshot(std::span<const std::byte> bytes);
  /// Throws Error likewise. Only after a snapshot.
  void add(std::span<const std::byte> bytes);
  /// Bytes added since the snapshot.
  std::uint64_t added() const { return added_; }

  /// Older files are stale: nobody knows what happened to the sensors meanwhile [s]. By the file's time.
  static constexpr std::int64_t most_age_s = 3600;

 private:
  std::string file_, identity_, refused_;
  int lock_ = -1;
  int out_ = -1;
  std::uint64_t added_ = 0;
};

}  // namespace egocal::services
