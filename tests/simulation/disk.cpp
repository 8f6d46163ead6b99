// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/disk.hpp"

#include <utility>

#include "egocal/error.hpp"

namespace egocal::simulation {

class Disk::Medium final : public services::StateMedium {
 public:
  Medium(Disk& disk, std::string name, Life& life, std::uint64_t seed)
      : disk_(disk), name_(std::move(name)), life_(life), random_(seed) {
    disk_.holders_[name_] = &life_;
  }
  ~Medium() override {
    const auto holder = disk_.holders_.find(name_);
    if (holder != disk_.holders_.end() && holder->second == &life_) disk_.holders_.erase(holder);
  }

  const std::string& name() const override { return name_; }

  std::optional<Found> read(const Expected&) override {
    const auto file = disk_.files_.find(name_);
    if (file == disk_.files_.end()) return std::nullopt;
    return Found{file->second->bytes, file->second->written_s, disk_.clock_.wall_us() / 1'000'000};
  }

  void replace(std::span<const std::byte> bytes) override {
    if (life_.over()) return;
    if (life_.ends_here()) return life_.stop();
    refuse_where_full();
    disk_.waited_us_ += disk_.delay_us_;
    open_ = std::make_shared<File>();
    open_->bytes.assign(bytes.begin(), bytes.end());
    open_->synced = bytes.size();
    open_->written_s = disk_.clock_.wall_us() / 1'000'000;
    disk_.files_[name_] = open_;
  }

  void add(std::span<const std::byte> bytes) override {
    if (life_.over()) return;
    const bool killed = life_.ends_here();
    if (disk_.read_only_ && !killed) {
      open_.reset();
      refuse_where_full();
    }
    disk_.waited_us_ += disk_.delay_us_;
    const bool torn = killed || disk_.full_;
    if (torn) bytes = bytes.first(random_.below(bytes.size() + 1));
    open_->bytes.insert(open_->bytes.end(), bytes.begin(), bytes.end());
    open_->written_s = disk_.clock_.wall_us() / 1'000'000;
    if (killed) return life_.stop();
    if (torn) {
      open_.reset();
      refuse_where_full();
    }
  }

  bool in_place() const override {
    const auto file = disk_.files_.find(name_);
    return open_ && file != disk_.files_.end() && file->second == open_;
  }

  std::string keep_aside() override {
    if (disk_.read_only_) refuse_where_full();
    std::string aside = name_ + ".refused";
    for (int n = 2; disk_.files_.contains(aside); ++n) aside = name_ + ".refused-" + std::to_string(n);
    disk_.files_[aside] = disk_.files_.at(name_);
    disk_.files_.erase(name_);
    return aside;
  }

 private:
  void refuse_where_full() const {
    if (disk_.read_only_) throw error_at(name_, 0, "", "cannot be written: Read-only file system");
    if (disk_.full_) throw error_at(name_, 0, "", "cannot be written: No space left on device");
  }

  Disk& disk_;
  std::string name_;
  Life& life_;
  testing::Random random_;
  std::shared_ptr<File> open_;
};

std::unique_ptr<services::StateMedium> Disk::open(const std::string& name, Life& life, std::uint64_t seed) {
  const auto holder = holders_.find(name);
  if (holder != holders_.end() && !holder->second->over())
    throw error_at(name, 0, "", "is the state of another process that is running; each needs its own");
  return std::make_unique<Medium>(*this, name, life, seed);
}

std::shared_ptr<const Disk::File> Disk::find(const std::string& name) const {
  const auto file = files_.find(name);
  return file == files_.end() ? nullptr : file->second;
}

void Disk::power_cut(testing::Random& random) {
  for (auto& [name, file] : files_) {
    const std::size_t unsynced = file->bytes.size() - file->synced;
    file->bytes.resize(file->synced + random.below(unsynced + 1));
  }
  holders_.clear();
}

}  // namespace egocal::simulation
