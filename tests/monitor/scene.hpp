// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/calibration_t.hpp"
#include "egocal/problem_t.hpp"
#include "egocal/status_t.hpp"

namespace egocal::monitor::test {

// A drive as its messages show it: errors that fall with the square root of the frames, a global solver for
// the first seconds, the fast one throughout.

inline constexpr std::int64_t begin_utime = 1'600'000'000'000'000;  // [us]

/// Of the answers to the problem with this number.
inline Pose extrinsic_at(double n) {
  const double off = 1.0 / std::sqrt(n);
  const double wobble = 1 + 0.3 * std::sin(n * 0.37);
  const double angle = 0.05 * off * wobble;
  // the truth turned by a small angle about x of sensor a
  const double w = std::cos(angle / 2), x = std::sin(angle / 2);
  return {{0.5 * (w + x), 0.5 * (x - w), 0.5 * (w + x), 0.5 * (x - w)},
          {-0.08 + 0.3 * off * wobble, -0.05 - 0.2 * off, -0.27 + 0.4 * off}};
}

/// Motions that this extrinsic fits without error, so that every verification certifies it.
inline std::vector<statistics_t> blocks_for(const Pose& extrinsic, int count) {
  const DualQuaternion T = to_dual_quaternion(extrinsic);
  Problem problem;
  for (int block = 0; block < count; ++block) {
    Statistics statistics;
    for (int i = 0; i < 10; ++i) {
      const double k = 10.0 * block + i;
      const DualQuaternion a = to_dual_quaternion(
          Pose{rotation_exp({0.3 * std::sin(k), 0.3 * std::cos(1.7 * k), 0.3 * std::sin(2.3 * k)}),
               {1 + 0.2 * std::cos(k), 0.3 * std::sin(0.9 * k), 0.1 * std::cos(3.1 * k)}});
      statistics.add(a, conjugate(T) * a * T);
    }
    problem.blocks.push_back(statistics);
  }
  return bus::to_message(problem).blocks;
}

inline problem_t problem_at(const std::string& a, const std::string& b, std::int64_t step, double hz,
                            int blocks = 0) {
  problem_t p{};
  p.session = begin_utime;
  p.utime = begin_utime + static_cast<std::int64_t>(static_cast<double>(step) * 1e6 / hz);
  p.seq = step + 1;
  p.sensor_a = a;
  p.sensor_b = b;
  p.weight_rotation = p.weight_translation = 1;
  p.stride = 1;
  p.choice = "fixed by the rig";
  p.n_blocks = blocks;
  p.blocks = blocks_for(extrinsic_at(static_cast<double>(p.seq)), blocks);
  p.has_prior = 1;
  p.prior_quat[0] = 1;
  p.has_truth = 1;
  const double pos[3] = {-0.08, -0.05, -0.27};
  const double quat[4] = {0.5, -0.5, 0.5, -0.5};
  for (int i = 0; i < 3; ++i) p.truth_pos[i] = pos[i];
  for (int i = 0; i < 4; ++i) p.truth_quat[i] = quat[i];
  p.matched = step + 1;
  p.host = "car";
  return p;
}

/// Of the lidar and the camera, about the answer to the problem with this number.
inline verdict_t verdict_at(const Diagnosis& diagnosis, std::int64_t utime, std::int64_t session,
                            std::int64_t seq) {
  const DualQuaternion judged = to_dual_quaternion(extrinsic_at(static_cast<double>(seq)));
  verdict_t message = bus::to_message(diagnosis, {judged, begin_utime, begin_utime + 1'000'000, 100});
  message.utime = utime;
  message.session = session;
  message.seq = seq;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  message.sender = "egocal-diagnosis";
  return message;
}

inline calibration_t calibration_at(const problem_t& p, bool global) {
  calibration_t c{};
  c.utime = p.utime;
  c.session = p.session;
  c.seq = p.seq;
  c.pairs = p.seq;
  c.sensor_a = p.sensor_a;
  c.sensor_b = p.sensor_b;
  c.solver = global ? "egocal-global" : "egocal-fast";
  c.method = global ? "dual" : "sqp";
  const double n = static_cast<double>(p.seq);
  const double off = 1.0 / std::sqrt(n);
  const double wobble = 1 + 0.3 * std::sin(n * 0.37);
  bus::set_pose(to_dual_quaternion(extrinsic_at(n)), c.pos, c.quat);
  c.cost = 1e-4;
  c.gap = 1e-12;
  c.lower_bound = c.cost - c.gap;
  c.scaled_gap = 0.002 * wobble + (n < 8 && !global ? 30 : 0);
  c.status = n < 8 && !global ? 2 : 0;
  for (int i = 0; i < 6; ++i) {
    c.observable[i] = 1;
    c.stddev[i] = (i < 3 ? 0.1 : 0.01) * off;
  }
  c.fallback = n < 8;
  c.solve_ns = global ? 3100 : 5200;
  c.verify_ns = 1900;
  c.latency_us = 310;
  return c;
}

inline status_t status_of(const std::string& name, const std::string& role, std::int64_t in) {
  status_t s{};
  s.utime = begin_utime;
  s.name = name;
  s.role = role;
  s.host = "car";
  s.pid = 4711;
  s.run = 1;
  s.version = "0.1.0";
  s.state = "running";
  s.n_counters = 2;
  s.counters.resize(2);
  s.counters[0].name = "in";
  s.counters[0].value = in;
  s.counters[1].name = "out";
  s.counters[1].value = in;
  return s;
}

}  // namespace egocal::monitor::test
