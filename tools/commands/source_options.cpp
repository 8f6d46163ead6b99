// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/source_options.hpp"

#include <map>
#include <utility>

#include "arguments.hpp"
#include "offline/reading/trajectory_source.hpp"
#include "warnings.hpp"

namespace egocal::tools {

void add_source_options(cli::App command, Source& source) {
  source.read = read_any_trajectory;
  cli::Option a =
      command.add_option("A", source.file_a,
                         "trajectory of sensor a, or several drives A1,A2; without files: a simulated drive");
  cli::Option b = command.add_option("B", source.file_b, "trajectory of sensor b, or B1,B2");
  a.needs(b);
  command.add_option("--times-a", source.reading_a.times_file, "times of A, if its poses have none").needs(a);
  command.add_option("--times-b", source.reading_b.times_file, "times of B, if its poses have none").needs(a);
  const auto text = [&](const char* name, const char* help, auto&& take) {
    return command.add_option_function(name, std::forward<decltype(take)>(take), help);
  };
  text("--truth", "X,Y,Z,QW,QX,QY,QZ: pose of sensor b in sensor a [m]", [&source](const std::string& value) {
    source.truth = pose("--truth", value);
  }).needs(a);  // that of the simulated drive is known
  cli::Option plane_a =
      text("--plane-a", "NX,NY,NZ,D: the ground seen from sensor a, n . x = D, n up [m]",
           [&source](const std::string& value) { source.plane_a = plane("--plane-a", value); });
  cli::Option plane_b =
      text("--plane-b", "the ground seen from sensor b",
           [&source](const std::string& value) { source.plane_b = plane("--plane-b", value); });
  plane_a.needs(plane_b);
  plane_b.needs(plane_a);
  text("--weights", "equal, or R:T of rotation and translation (default: equal)",
       [&source](const std::string& value) {
         if (value != "equal") source.balance = balance("--weights", value);
       });
  command.add_option("--stride", source.stride, "steps of the slower stream in one motion")
      .show_default()
      .check(cli::Check::range(limits::stride.least, limits::stride.most))
      .needs(a);
  command.add_option("--time-offset", source.time_offset, "added to the stamps of B [s]")
      .show_default()
      .check(cli::Check::range(limits::time_offset.least, limits::time_offset.most))
      .needs(a);
  command.add_option("--poses", source.poses, "of the simulated drive")
      .show_default()
      .check(cli::Check::range(3, limits::simulation::poses.most))
      .excludes(a);
  command.add_option("--noise", source.noise, "of the simulated drive, relative to the mean motion")
      .show_default()
      .check(cli::Check::range(0.0, 10.0))
      .excludes(a);
  text("--terrain", "of the simulated drive: flat, rough or free (default: rough)",
       [&source](const std::string& value) {
         const std::map<std::string, Terrain> terrains{
             {"flat", Terrain::flat}, {"rough", Terrain::rough}, {"free", Terrain::free}};
         const auto found = terrains.find(value);
         if (found == terrains.end())
           throw UsageError("--terrain: expected flat, rough or free, got '" + value + "'");
         source.terrain = found->second;
       })
      .excludes(a);
  command.add_option("--seed", source.seed, "of the simulated drive").show_default().excludes(a);
}

DataSet load_warning(const Source& source) {
  DataSet data = load(source);
  print_warnings(data.notes);
  return data;
}

}  // namespace egocal::tools
