// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/diagnosed_pair.hpp"
#include "diagnosis/diagnosing_options.hpp"
#include "diagnosis/memory.hpp"
#include "diagnosis/saved_memory.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/pairing/stream.hpp"
#include "program/commands.hpp"

namespace egocal::services {

/// egocal-diagnosis: from the poses of the sensors and the problems to verdict_t. Judges the certified
/// optimum of the newest problem, which it computes itself, so it needs and trusts no solver process. It
/// judges the poses that it has received; a saved memory adds those of an earlier process.
class Diagnosing {
 public:
  Diagnosing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig,
             std::unique_ptr<SavedMemory> saved = nullptr, const DiagnosingOptions& options = {});
  ~Diagnosing();
  Diagnosing(const Diagnosing&) = delete;
  Diagnosing& operator=(const Diagnosing&) = delete;

 private:
  struct Sensor {
    bus::Sensor config;
    Stream stream;
    std::int64_t in = 0;
  };

  void take(std::size_t sensor, const bus::Arrival& arrival);
  void take_problems();
  void look();
  void restore(Memory memory);
  void save();
  Memory memory() const;
  void judge(DiagnosedPair& pair);
  void restart_after_move(DiagnosedPair& pair);
  void repeat();
  void obey(Verb verb, const command_t& command);
  void report();
  std::string error() const;
  void count();

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  bus::Rig rig_;
  DiagnosingOptions options_;
  std::vector<Sensor> sensors_;
  std::vector<std::unique_ptr<DiagnosedPair>> pairs_;
  std::unique_ptr<SavedMemory> saved_;  ///< empty: no state is kept
  std::int64_t save_mono_us_ = 0;       ///< not before
  std::int64_t saved_poses_ = -1;       ///< received when the last state was written
  std::string save_error_;
  std::size_t turn_ = 0;                 ///< the pair that is judged next where several wait
  std::int64_t not_before_mono_us_ = 0;  ///< see DiagnosingOptions::share
  bool hurried_ = false;                 ///< the last diagnosis did not wait until then
};

}  // namespace egocal::services
