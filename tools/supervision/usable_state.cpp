// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/usable_state.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "state/state_file.hpp"

namespace egocal::tools {

namespace {

/// What is there is read and stays as it is.
class LookedAt final : public services::StateMedium {
 public:
  explicit LookedAt(std::unique_ptr<StateMedium> medium) : medium_(std::move(medium)) {}

  const std::string& name() const override { return medium_->name(); }
  std::optional<Found> read(const Expected& expected) override { return medium_->read(expected); }
  void replace(std::span<const std::byte>) override {}
  void add(std::span<const std::byte>) override {}
  bool in_place() const override { return medium_->in_place(); }
  std::string keep_aside() override { return medium_->name(); }

 private:
  std::unique_ptr<StateMedium> medium_;
};

/// A lock file that was not there before goes again.
class LockFile {
 public:
  explicit LockFile(std::string file) : file_(std::move(file)) {
    std::error_code none;
    was_there_ = std::filesystem::symlink_status(file_, none).type() != std::filesystem::file_type::not_found;
  }
  ~LockFile() {
    std::error_code none;
    if (!was_there_) std::filesystem::remove(file_, none);
  }
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

 private:
  std::string file_;
  bool was_there_ = false;
};

}  // namespace

void require_usable_state(const std::string& file, const std::string& process) {
  const LockFile lock(without_links(file) + ".lock");
  services::StateFile state(std::make_unique<LookedAt>(services::open_state_medium(file)), {process, {}});
  state.read();
}

}  // namespace egocal::tools
