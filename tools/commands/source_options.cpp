// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/source_options.hpp"

namespace egocal::tools {

void add_source_options(CLI::App& command, Source& source) {
  command.add_option("A", source.file_a,
                     "trajectory of sensor a (TUM, KITTI or EuRoC csv); without files: a simulated drive");
  command.add_option("B", source.file_b, "trajectory of sensor b");
  command.add_option("--times-a", source.times_a, "times of A, for a KITTI file");
  command.add_option("--times-b", source.times_b, "times of B, for a KITTI file");
  command.add_option("--truth", source.truth, "X,Y,Z,QW,QX,QY,QZ: pose of sensor b in sensor a [m]");
  command.add_option("--plane-a", source.plane_a,
                     "NX,NY,NZ,D: the ground seen from sensor a, n . x = D, n up [m]");
  command.add_option("--plane-b", source.plane_b, "the ground seen from sensor b");
  command.add_option("--stride", source.stride, "steps of the slower stream in one motion")
      ->capture_default_str();
  command.add_option("--weights", source.weights, "equal, or R:T of rotation and translation")
      ->capture_default_str();
  command.add_option("--time-offset", source.time_offset, "added to the stamps of B [s]")
      ->capture_default_str();
  command.add_option("--poses", source.poses, "of the simulated drive")->capture_default_str();
  command.add_option("--noise", source.noise, "of the simulated drive, relative to the mean motion")
      ->capture_default_str();
  command.add_option("--terrain", source.terrain, "of the simulated drive: flat, rough or free")
      ->capture_default_str();
  command.add_option("--seed", source.seed, "of the simulated drive")->capture_default_str();
}

}  // namespace egocal::tools
