// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Two trajectory files in, the extrinsic out.   01_two_trajectories A B
#include <cmath>
#include <cstdio>
#include <egocal/egocal.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 01_two_trajectories TRAJECTORY_A TRAJECTORY_B\n");
    return 2;
  }
  try {
    const egocal::Trajectory a = egocal::read_trajectory(argv[1]);
    const egocal::Trajectory b = egocal::read_trajectory(argv[2]);
    const egocal::Calibration calibration = egocal::calibrate(a, b);

    const egocal::Pose& T = calibration.T_a_b;  // pose of sensor b in sensor a
    std::printf("translation [m]        %.4f %.4f %.4f\n", T.translation.x(), T.translation.y(),
                T.translation.z());
    std::printf("quaternion w x y z     %.6f %.6f %.6f %.6f\n", T.rotation.w(), T.rotation.x(),
                T.rotation.y(), T.rotation.z());

    // optimality is one thing, uncertainty another
    const bool optimal = calibration.certificate.optimality == egocal::Optimality::certified;
    std::printf("optimality             %s\n", optimal ? "proven" : "not proven");
    const char* directions[] = {"x", "y", "z", "roll", "pitch", "yaw"};
    for (std::size_t i = 0; i < 6; ++i) {
      if (!calibration.observability.observable[i])
        std::printf("%-22s not observable: the number above is not a measurement\n", directions[i]);
      else
        std::printf("%-22s +- %.5f %s\n", directions[i], calibration.observability.stddev[i],
                    i < 3 ? "m" : "rad");
    }
    if (!calibration.observability.hint.empty()) std::printf("%s\n", calibration.observability.hint.c_str());
    return 0;
  } catch (const egocal::Error& error) {
    std::fprintf(stderr, "01_two_trajectories: %s\n", error.what());
    return 1;
  }
}
