// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Calibrates two sensors live: subscribes to their odometry on LCM and prints the answer once a second of
// sensor time.   04_live_over_lcm CHANNEL_A CHANNEL_B
//
// The types are generated from the installed egocal_odometry_t.lcm by lcm-gen. A program that only wants the
// answers subscribes to EGOCAL_CALIBRATION_<a>_<b> instead and lets egocal's processes do the work.
#include <cstdio>
#include <egocal/egocal.hpp>
#include <egocal/odometry_t.hpp>
#include <lcm/lcm-cpp.hpp>

namespace {

struct Stream {
  egocal::Calibrator* calibrator = nullptr;
  egocal::Side side = egocal::Side::a;
  std::int64_t next_print_us = 0;

  void receive(const lcm::ReceiveBuffer*, const std::string&, const egocal::odometry_t* message) {
    const egocal::Pose pose{{message->quat[0], message->quat[1], message->quat[2], message->quat[3]},
                            {message->pos[0], message->pos[1], message->pos[2]}};
    calibrator->add(side, {message->utime, egocal::to_dual_quaternion(pose)});
    if (side == egocal::Side::b || message->utime < next_print_us) return;
    next_print_us = message->utime + 1'000'000;
    if (const auto calibration = calibrator->answer())
      std::printf("%.3f %.3f %.3f m, %s\n", calibration->T_a_b.translation.x(),
                  calibration->T_a_b.translation.y(), calibration->T_a_b.translation.z(),
                  calibration->certificate.optimality == egocal::Optimality::certified ? "optimal (proven)"
                                                                                       : "not proven");
    std::fflush(stdout);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 04_live_over_lcm CHANNEL_A CHANNEL_B\n");
    return 2;
  }
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  egocal::Calibrator calibrator;
  Stream a{&calibrator, egocal::Side::a}, b{&calibrator, egocal::Side::b};
  lcm.subscribe(argv[1], &Stream::receive, &a);
  lcm.subscribe(argv[2], &Stream::receive, &b);
  // ends when nothing was received for five seconds
  while (lcm.handleTimeout(5000) > 0) continue;
  return calibrator.answer() ? 0 : 1;
}
