// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The plan of one simulated life, as plain data: drawn from a seed, simplified when it fails, and printed.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "egocal/online/answer.hpp"

namespace egocal::simulation {

/// Faults of each datagram to each listener, independently.
struct NetworkFaults {
  double lost = 0;                      ///< share
  double burst = 0;                     ///< share with which a burst of losses begins
  int burst_length = 0;                 ///< datagrams of a burst
  double duplicated = 0;                ///< share; the copy takes another delay
  double late = 0;                      ///< share that takes late_by longer: what comes after it overtakes it
  std::int64_t late_by_us = 0;          ///< [us]
  double truncated = 0;                 ///< share, cut at any byte
  double flipped = 0;                   ///< share, one bit
  std::int64_t delay_us = 0;            ///< of all [us]
  std::int64_t jitter_us = 0;           ///< uniform, added to it: reorders what is closer together [us]
  std::int64_t buffer_bytes = 212'992;  ///< that a listener's kernel holds; what comes then is dropped

  bool corrupts() const { return truncated > 0 || flipped > 0; }
};

/// Clocks of one host.
struct ClockFaults {
  std::int64_t wall_off_us = 0;  ///< the date is wrong by this from the start [us]
  int drift_ppm = 0;             ///< of both clocks
};

enum class IncidentKind {
  kill,  ///< a process by SIGKILL: at once (amount 0), at its amount-th send or write from then on, or at
         ///< the -amount-th of its next life (amount below 0)
  stop,  ///< SIGSTOP, and SIGCONT after the duration
  end,   ///< SIGTERM; killed at its amount-th send or write while it ends, 0: not
  twin,  ///< a second process of the same name, for the duration; then it ends or is killed
  away,  ///< a host has no route for multicast
  partition,    ///< a host and the others do not hear each other
  clog,         ///< everything to and from a host waits until the end of the duration
  set_date,     ///< a host's date is set by the amount [us]
  disk_full,    ///< a host's disk takes nothing; the write at its beginning is torn
  power_cut,    ///< a host: what was not synced is lost in part, it boots during the duration
  old_version,  ///< a process of another version joins for the duration
  hostile,      ///< amount damaged copies of datagrams that are on the bus, during the duration
  flood,        ///< amount copies of one datagram at once
  swap,     ///< a solver of another method takes the place of one, started before (amount 1) or after its end
  command,  ///< a verb for a process (its number is the target, -1: all), of pair number amount (0: all
            ///< pairs)
  foreign,  ///< amount sound messages of other programs, on their channels and on ours, during the duration
  read_only,  ///< a host's disk refuses every change
  slow_disk,  ///< every write on a host takes the amount [us]
  old_state,  ///< pairing is killed, and finds the state that it had the duration before
};
constexpr int incident_kinds = static_cast<int>(IncidentKind::old_state) + 1;
const char* name(IncidentKind kind);

struct Incident {
  std::int64_t at_us = 0;  ///< from the start of the life [us]
  IncidentKind kind = IncidentKind::kill;
  int target = 0;                ///< a process or a host, by its number
  std::int64_t duration_us = 0;  ///< [us]
  std::int64_t amount = 0;       ///< see IncidentKind
  std::string text = {};         ///< of a command: its verb
};

enum class Input {
  player,  ///< a log, sent again where pairing did not get it
  live,    ///< one process a sensor, which sends everything once
};

/// How the rig file says that motions are to be used.
enum class Estimation {
  plain,      ///< steps of one, equal weights, nothing is rejected: the cheapest
  robust,     ///< steps of one, given weights, outliers are rejected
  automatic,  ///< everything is chosen from the data
};

/// Time that a process takes for each turn; nothing else happens in it meanwhile [us].
struct Burden {
  std::int64_t solvers_us = 0, listeners_us = 0;
};

/// Hosts: 0 has pairing and the input, 1 the solvers, 2 those who listen. With one host all are on 0.
constexpr int most_hosts = 3;

struct Plan {
  std::uint64_t seed = 0;  ///< of the drive, and of everything that is drawn while the life runs

  // what is simulated
  int sensors = 2;                        ///< the first one is paired with each of the others
  double rate_hz = 10;                    ///< of the sensors
  std::int64_t disturbed_us = 6'000'000;  ///< of the drive, with faults
  std::int64_t quiet_us = 6'000'000;      ///< of the drive after them
  bool free_motion = true;                ///< else a road vehicle on rough ground
  double bump_s = 0;  ///< the second sensor's mount is turned and moved at this time of the drive [s]; 0: not
  double scale = 1;   ///< of the second sensor: its lengths must be multiplied by it to be metres
  bool auto_scale = false;  ///< the rig file says scale = "auto" of the second sensor
  double clock_drift = 0;   ///< of the second sensor's stamps [s/s]
  bool numbered = true;     ///< odometry_t; else bot_core.pose_t
  Estimation estimation = Estimation::plain;
  Input input = Input::player;
  double speed = 1;        ///< of the player
  bool state_file = true;  ///< pairing has one
  int hosts = 1;
  Method fast_method = Method::sqp, global_method = Method::dual;
  bool global_always = false;
  bool swaps_methods = true;  ///< a solver that takes the place of another has another method
  Burden burden;
  bool diagnosed = false;  ///< egocal-diagnosis runs as well
  int mistake = 0;         ///< of testing::mistakes(), in the drive of the first pair; 0: none

  // what happens to it
  NetworkFaults network;
  ClockFaults clocks[most_hosts];
  std::vector<Incident> incidents;

  /// The first two sensors measure at the same times, so that nothing is interpolated: every second run in
  /// which a scale is to be found.
  bool measured_together() const { return auto_scale && seed % 2 == 0; }
};

/// Processes of a plan by their numbers: pairing, fast, global, monitor, export, what sends odometry,
/// diagnosis.
int processes(const Plan& plan);
std::string process_name(const Plan& plan, int number);

/// Draws the plan of a seed. Each seed enables its own random subset of the faults (swarm testing), as one
/// fault may hide what another one shows.
Plan draw(std::uint64_t seed);

/// A fault that is on in the plan, and the plan without it.
struct Simpler {
  std::string removed;
  Plan plan;
};
std::vector<Simpler> simpler(const Plan& plan);

/// For people, one line each.
std::string describe(const Plan& plan);
std::string describe(const Plan& plan, const Incident& incident);

}  // namespace egocal::simulation
