// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Plays the processes of a rig towards the monitor: a number of pairs, a number of messages a second, with
// problems of full size. Usage: egocal-monitor-feeder PAIRS HZ SECONDS [hostile]; LCM's default URL or
// LCM_DEFAULT_URL.
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "scene.hpp"

using namespace egocal::monitor::test;

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const int pairs = std::atoi(argv[1]);
  const double hz = std::atof(argv[2]), duration = std::atof(argv[3]);
  const bool hostile = argc > 4 && std::strcmp(argv[4], "hostile") == 0;
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  const auto begin = std::chrono::steady_clock::now();
  const std::string evil = "\x1b[2J\x1b]0;owned\x07\n\t\xff\xfe" + std::string(180, 'W');
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (std::int64_t step = 0; static_cast<double>(step) < duration * hz; ++step) {
    for (int i = 0; i < pairs; ++i) {
      const std::string a = "lidar", b = "camera" + std::to_string(i);
      egocal::problem_t problem = problem_at(a, b, step, hz, 24);
      egocal::calibration_t fast = calibration_at(problem, false);
      if (hostile && i % 2 == 0) {
        problem.sensor_a = fast.sensor_a = evil;
        fast.solver = fast.hint = fast.method = evil;
        fast.pos[step % 3] = step % 2 ? nan : inf;
        fast.quat[0] = nan;
        fast.scaled_gap = step % 3 ? inf : -nan;
        fast.stddev[2] = inf;
        fast.solve_ns = std::numeric_limits<std::int64_t>::min();
        problem.truth_pos[0] = nan;
        if (step % 7 == 0)
          problem.utime = fast.utime = step % 2 ? std::numeric_limits<std::int64_t>::max() : 0;
      }
      lcm.publish("EGOCAL_PROBLEM_" + a + "_" + b, &problem);
      lcm.publish("EGOCAL_CALIBRATION_" + a + "_" + b, &fast);
      if (static_cast<double>(step) < 5 * hz && !hostile) {
        const egocal::calibration_t global = calibration_at(problem, true);
        lcm.publish("EGOCAL_CALIBRATION_" + a + "_" + b, &global);
      }
    }
    if (step % static_cast<std::int64_t>(std::max(1.0, hz)) == 0) {
      for (const char* role : {"player", "pairing", "global", "fast"}) {
        egocal::status_t status = status_of(std::string("egocal-") + role, role, step * pairs);
        if (hostile) status.last_error = status.state = evil;
        lcm.publish("EGOCAL_STATUS", &status);
      }
    }
    std::this_thread::sleep_until(begin +
                                  std::chrono::duration_cast<std::chrono::nanoseconds>(
                                      std::chrono::duration<double>(static_cast<double>(step + 1) / hz)));
  }
  return 0;
}
