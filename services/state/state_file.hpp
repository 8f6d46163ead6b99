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

/// The file from which a killed process continues: a snapshot, followed by additions.
///
/// A snapshot replaces the file atomically. Each addition is one write at the end. A process that is killed
/// during that write leaves an incomplete addition, which was not acknowledged to any sender and is ignored.
/// Anything else that fails its checksum is damage.
class StateFile {
 public:
  struct Content {
    std::vector<std::byte> snapshot;
    std::vector<std::vector<std::byte>> additions;
  };

  using Clock = std::function<BootTime()>;

  StateFile(std::unique_ptr<StateMedium> medium, StateIdentity identity, Clock clock = boot_time,
            const StateOptions& options = {});

  /// The content to continue from; empty: there is no file, it is empty, or it is refused (refused()). Throws
  /// Error if the file cannot be read, or is no state of this process; such a file is never changed.
  std::optional<Content> read();
  /// One line: why the content was refused; empty: it was not.
  const std::string& refused() const { return refused_; }
  /// Refuses the content that read() returned: the file is renamed to FILE.refused (or FILE.refused-2, ...).
  /// If the disk does not allow that now, the next snapshot does it first.
  void refuse(const std::string& why);

  /// Replaces the file by a snapshot. Throws Error if the disk refuses it; the old content is then still
  /// there.
  void snapshot(std::span<const std::byte> bytes);
  /// Adds to the snapshot, which must be there. Throws Error likewise.
  void add(std::span<const std::byte> bytes);
  /// Whether the file is in place. False: it was removed while it was in use, and only a snapshot restores
  /// it.
  bool in_place() const { return medium_->in_place(); }
  /// Bytes added since the snapshot.
  std::uint64_t added() const { return added_; }

 private:
  std::unique_ptr<StateMedium> medium_;
  StateIdentity identity_;
  std::string refused_;
  std::string in_the_way_;  ///< why a file was refused that could not be renamed yet; empty: there is none
  Clock clock_;
  StateOptions options_;
  std::uint64_t added_ = 0;
};

}  // namespace egocal::services
