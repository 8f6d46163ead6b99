// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/clock.hpp"
#include "simulation/life.hpp"
#include "state/state_medium.hpp"
#include "support/random_motion.hpp"

namespace egocal::simulation {

/// The disk of a host, with a kernel in front of it: what was written but not synced is lost at a power cut,
/// from some place on.
class Disk {
 public:
  explicit Disk(const bus::Clock& clock) : clock_(clock) {}

  /// Throws Error where another living process holds the file.
  std::unique_ptr<services::StateMedium> open(const std::string& name, Life& life, std::uint64_t seed);

  void set_full(bool full) { full_ = full; }
  bool full() const { return full_; }
  void set_read_only(bool read_only) { read_only_ = read_only; }
  /// Of every write from now on [us].
  void set_delay_us(std::int64_t delay_us) { delay_us_ = delay_us; }
  /// What the writes since the last call of the next one have taken [us].
  std::int64_t waited_us() const { return waited_us_; }
  std::int64_t take_waited_us() { return std::exchange(waited_us_, 0); }
  void power_cut(testing::Random& random);

  struct File {
    std::vector<std::byte> bytes;
    std::size_t synced = 0;
    std::int64_t written_s = 0;
  };
  /// Null: none.
  std::shared_ptr<const File> find(const std::string& name) const;
  std::size_t files() const { return files_.size(); }
  /// Puts content of another time back.
  void restore(const std::string& name, const File& file) { files_[name] = std::make_shared<File>(file); }

 private:
  class Medium;
  const bus::Clock& clock_;
  std::map<std::string, std::shared_ptr<File>> files_;
  std::map<std::string, const Life*> holders_;
  bool full_ = false, read_only_ = false;
  std::int64_t delay_us_ = 0, waited_us_ = 0;
};

}  // namespace egocal::simulation
