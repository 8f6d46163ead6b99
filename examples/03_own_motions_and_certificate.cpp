// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// The parts below calibrate(): motions of your own, the 36 numbers that hold them, a solver, and a proof for
// any extrinsic, whichever program proposed it.
#include <cstdio>
#include <egocal/egocal.hpp>

namespace {

/// The motions of two sensors on one body; T_a_b is what the calibration must find.
egocal::MotionPair motion_pair(const egocal::Pose& motion_a, const egocal::Pose& T_a_b) {
  egocal::MotionPair pair;
  pair.a = egocal::to_dual_quaternion(motion_a);
  pair.b = egocal::to_dual_quaternion(egocal::inverse(T_a_b) * motion_a * T_a_b);
  return pair;
}

}  // namespace

int main() {
  const egocal::Pose T_a_b{egocal::rotation_exp({0.0, 0.0, 1.5}), {0.5, -0.2, 1.0}};
  egocal::Statistics statistics;  // grows with the drive in time, not in memory
  for (const double turn : {0.1, -0.2, 0.3}) {
    statistics.add(motion_pair({egocal::rotation_exp({turn, 0.0, 0.1}), {1.0, 0.0, 0.0}}, T_a_b));
    statistics.add(motion_pair({egocal::rotation_exp({0.0, turn, 0.2}), {0.8, 0.1, 0.0}}, T_a_b));
  }
  const egocal::Matrix8d Q = egocal::cost_matrix(statistics);  // (16)

  const egocal::Solution best = egocal::solve_dual(Q);  // the global minimum of (18)
  const egocal::Certificate proof = egocal::verify(Q, best.q);
  std::printf("found:    cost %.3g, %s\n", proof.cost,
              proof.optimality == egocal::Optimality::certified ? "optimal (proven)" : "not proven");

  // a hand-measured mount: is it as good? The bound says how far it is from the optimum at most.
  const egocal::Pose measured{T_a_b.rotation, T_a_b.translation + Eigen::Vector3d(0.05, 0.0, 0.0)};
  const egocal::Certificate of_measured = egocal::verify(Q, egocal::to_dual_quaternion(measured));
  std::printf(
      "measured: cost %.3g, %s\n", of_measured.cost,
      of_measured.optimality == egocal::Optimality::certified ? "optimal (proven)" : "a better one exists");
  const bool as_expected = proof.optimality == egocal::Optimality::certified &&
                           of_measured.optimality != egocal::Optimality::certified;
  return as_expected ? 0 : 1;
}
