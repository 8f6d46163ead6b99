// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "state/state_age.hpp"
#include "state/state_identity.hpp"
#include "state/state_medium.hpp"

namespace egocal::services {

/// A file from which a process that was killed continues: a snapshot, and behind it what came since then.
///
/// A snapshot takes the place of the file in one step. Each addition is one write behind it; a
/// process that is killed in the middle of one leaves an unfinished last part, which was not acknowledged to
/// any sender and is not used. Everything else that does not fit its checksums is damage.
class StateFile {
 public:
  struct Content {
    std::vector<std::byte> snapshot;
    std::vector<std::vector<std::byte>> additions;
  };

  using Clock = std::function<BootTime()>;

  StateFile(std::unique_ptr<StateMedium> medium, StateIdentity identity, Clock clock = boot_time,
            const StateOptions& options = {});

  /// What is there to continue from; empty where there is no file, or an empty one, or it is refused. Throws
  /// Error where the file cannot be read, or is something else than a state of this process: that is never
  /// touched. An empty file is as none: nothing in it could be kept.
  std::optional<Content> read();
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return refused_; }
  /// Refuses what read() returned: it is kept aside as FILE.refused (or FILE.refused-2, ...). Where the disk
  /// does not allow that now, the next snapshot does it first.
  void refuse(const std::string& why);

  /// Throws Error where the disk does not take it; the old content is then still there.
  void snapshot(std::span<const std::byte> bytes);
  /// Throws Error likewise. Only after a snapshot.
  void add(std::span<const std::byte> bytes);
  /// False: the file was removed while it was in use; only a snapshot helps.
  bool in_place() const { return medium_->in_place(); }
  /// Bytes added since the snapshot.
  std::uint64_t added() const { return added_; }

 private:
  std::unique_ptr<StateMedium> medium_;
  StateIdentity identity_;
  std::string refused_;
  std::string in_the_way_;  ///< why a file is refused that could not be kept aside yet; empty: there is none
  Clock clock_;
  StateOptions options_;
  std::uint64_t added_ = 0;
};

}  // namespace egocal::services
