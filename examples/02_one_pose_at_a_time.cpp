// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// The answer while the vehicle drives: one pose at a time, in bounded memory. The poses are simulated here.
#include <cstdio>
#include <egocal/egocal.hpp>
#include <egocal/simulation/simulation.hpp>

int main() {
  egocal::SimulationOptions drive;
  drive.poses = 1001;
  drive.relative_noise = 0.01;
  drive.T_vehicle_sensor = {egocal::Pose{}, {egocal::rotation_exp({0.1, 0.2, 0.3}), {1.0, 0.5, 0.2}}};
  const auto streams = egocal::simulate(drive);

  egocal::Calibrator calibrator;
  for (std::size_t i = 0; i < streams[0].size(); ++i) {
    calibrator.add(egocal::Side::a, streams[0][i]);
    calibrator.add(egocal::Side::b, streams[1][i]);
    if (i % 200 != 0) continue;
    const auto calibration = calibrator.answer();
    if (!calibration) continue;  // no motion yet
    const egocal::Pose& T = calibration->T_a_b;
    std::printf("%4zu poses: %7.4f %7.4f %7.4f m, x +- %.4f m, %s\n", i + 1, T.translation.x(),
                T.translation.y(), T.translation.z(), calibration->observability.stddev[0],
                calibration->certificate.optimality == egocal::Optimality::certified ? "optimal (proven)"
                                                                                     : "not proven");
  }
  calibrator.finish();

  const auto calibration = calibrator.answer();
  if (!calibration) return 1;
  const egocal::ExtrinsicError error = egocal::extrinsic_error(
      egocal::to_dual_quaternion(drive.T_vehicle_sensor[1]), egocal::to_dual_quaternion(calibration->T_a_b));
  std::printf("error against the truth: %.4f m, %.5f rad\n", error.translation, error.rotation);
  return error.translation < 0.1 ? 0 : 1;
}
