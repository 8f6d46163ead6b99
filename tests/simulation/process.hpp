// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "simulation/network.hpp"
#include "simulation/roles.hpp"
#include "supervision/restarts.hpp"

namespace egocal::simulation {

enum class Part { player, odometry, pairing, fast, global, monitor, exporter, diagnosis };

struct ProcessSpec {
  std::string name;
  Part part = Part::pairing;
  int host = 0;
  std::size_t sensor = 0;        ///< of odometry
  Method method = Method::dual;  ///< of a solver
  bool always = false;           ///< of the global solver
  std::string version = "1.0";
  std::string state_file = {};  ///< of pairing; empty: none
  bool supervised = true;       ///< started again when it ends
};

/// What all processes share.
struct Surroundings {
  const Plan& plan;
  const Drive& drive;
  const std::string& log;  ///< file with the drive
  Schedule& schedule;
  std::vector<std::unique_ptr<Host>>& hosts;
  Network& network;
};

/// A process with all its lives.
class Process {
 public:
  struct Ending {
    int exit_code = 0;  ///< -1: killed
    std::string error;
    tools::Restarts::Next next = tools::Restarts::Next::again;
  };

  Process(const Surroundings& surroundings, ProcessSpec spec, int number);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  const ProcessSpec& spec() const { return spec_; }
  ProcessSpec& spec() { return spec_; }
  int number() const { return number_; }
  /// Of its newest life.
  std::uint64_t port() const { return static_cast<std::uint64_t>(number_ * 1000 + lives_); }
  /// Of its memory, see allocated_bytes(); 0 is the world's.
  std::size_t memory_owner() const { return static_cast<std::size_t>(number_) + 1; }
  bool runs() const { return instance_ != nullptr; }
  bool stopped() const { return stopped_; }
  std::int64_t started_us() const { return started_us_; }  ///< the newest life
  std::int64_t lives() const { return lives_; }
  const Watcher* watcher() const;
  const Exporter* exporter() const;

  /// Of the schedule [ns]; Schedule::never: it waits for nothing.
  std::int64_t wake_ns() const { return stopped_ ? Schedule::never : std::max(wake_ns_, busy_until_ns_); }
  void wake() { wake_ns_ = 0; }

  /// Each returns how the life ended, if it did.
  std::optional<Ending> start();
  std::optional<Ending> turn();
  std::optional<Ending> kill();
  std::optional<Ending> end();
  /// Below 0: of the next life.
  void kill_at_place(std::int64_t count);
  void spare_next_life() { kill_next_at_ = 0; }
  void set_stopped(bool stopped) { stopped_ = stopped; }
  /// It is not started again.
  void retire() { retired_ = true; }
  bool retired() const { return retired_; }
  std::chrono::milliseconds pause() const { return restarts_.pause(); }

 private:
  struct Instance;
  Ending over(int exit_code, const std::string& error);
  void make_service();
  std::int64_t burden_us() const;
  std::int64_t waited_ns() const;
  Disk& disk() const;

  const Surroundings& surroundings_;
  ProcessSpec spec_;
  tools::Restarts restarts_;
  int number_;
  std::int64_t lives_ = 0, started_us_ = 0;
  std::int64_t wake_ns_ = Schedule::never;
  std::int64_t busy_until_ns_ = 0, kill_next_at_ = 0;
  bool stopped_ = false, retired_ = false;
  std::unique_ptr<Instance> instance_;
};

}  // namespace egocal::simulation
