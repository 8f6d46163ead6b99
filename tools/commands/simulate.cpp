// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "commands/simulated_faults.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"
#include "egocal/io/mcap_writer.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/simulation/simulation.hpp"
#include "progress.hpp"

namespace egocal::tools {

namespace {

/// The options as typed.
struct SimulateOptions {
  std::string out, rig_out, terrain = "rough", type = "odometry";
  std::vector<std::string> sensors = {"lidar=1.0,0.0,1.8,1,0,0,0", "camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5"};
  SimulationOptions simulation;
  FaultTexts faults;
};

struct MountedSensor {
  std::string name;
  std::string channel;
  Pose T_vehicle_sensor;
};

MountedSensor mounted(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || !bus::plausible_name(text.substr(0, equals)))
    throw UsageError("--sensor: expected NAME=X,Y,Z,QW,QX,QY,QZ, got '" + text + "'");
  MountedSensor sensor{text.substr(0, equals), "ODOMETRY_", pose("--sensor", text.substr(equals + 1))};
  for (const char c : sensor.name)
    sensor.channel += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return sensor;
}

std::string pose_list(const Pose& T) {
  return fmt::format("[{:.15g}, {:.15g}, {:.15g}, {:.15g}, {:.15g}, {:.15g}, {:.15g}]", T.translation.x(),
                     T.translation.y(), T.translation.z(), T.rotation.w(), T.rotation.x(), T.rotation.y(),
                     T.rotation.z());
}

/// A rig file for the simulated sensors: the first one with every other one, the truth known.
std::string rig_text(const std::vector<MountedSensor>& sensors, const std::string& type) {
  std::string text = "# made by egocal simulate\n";
  for (const MountedSensor& sensor : sensors)
    text += fmt::format("\n[[sensor]]\nname = \"{}\"\nchannel = \"{}\"\ntype = \"{}\"\n", sensor.name,
                        sensor.channel, type == "pose" ? "bot_core.pose_t" : "egocal.odometry_t");
  for (std::size_t i = 1; i < sensors.size(); ++i)
    text +=
        fmt::format("\n[[pair]]\na = \"{}\"\nb = \"{}\"\ntruth = {}  # x, y, z, qw, qx, qy, qz of b in a\n",
                    sensors[0].name, sensors[i].name,
                    pose_list(inverse(sensors[0].T_vehicle_sensor) * sensors[i].T_vehicle_sensor));
  return text;
}

/// A pose on its way into the log: by the time of the drive at which it was sent, whatever its stamp.
struct Sent {
  std::int64_t time_us = 0;
  std::size_t sensor = 0, index = 0;
};

std::vector<Sent> in_order_of_time(const std::vector<Trajectory>& trajectories,
                                   const SimulationOptions& simulation) {
  std::vector<Sent> sent;
  for (std::size_t k = 0; k < trajectories.size(); ++k) {
    const SensorFaults faults = k < simulation.faults.size() ? simulation.faults[k] : SensorFaults{};
    const std::int64_t start_us = trajectories[k].front().time_us;
    const double offset = second_us * faults.clock_offset;
    for (std::size_t i = 0; i < trajectories[k].size(); ++i) {
      const auto elapsed = static_cast<double>(trajectories[k][i].time_us - start_us);
      const double drifted = elapsed * faults.clock_drift / (1 + faults.clock_drift);
      sent.push_back({trajectories[k][i].time_us - std::llround(offset + drifted), k, i});
    }
  }
  std::stable_sort(sent.begin(), sent.end(), [](const Sent& i, const Sent& j) {
    return i.time_us != j.time_us ? i.time_us < j.time_us : i.index < j.index;
  });
  return sent;
}

/// All sensors' poses into one log, in the order of time.
void write_log(const std::string& file, const std::vector<MountedSensor>& sensors,
               const std::vector<Trajectory>& trajectories, const SimulationOptions& simulation,
               const std::string& type) {
  bus::LogWriter log(file);
  Progress progress("writing");
  const std::vector<Sent> sent = in_order_of_time(trajectories, simulation);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const auto& [time_us, k, index] = sent[i];
    const StampedPose& pose = trajectories[k][index];
    if (type == "pose")
      log.write(time_us, sensors[k].channel, bus::encode(bus::to_pose_message(pose)));
    else
      log.write(time_us, sensors[k].channel,
                bus::encode(bus::to_message(pose, static_cast<std::int64_t>(index))));
    progress(static_cast<double>(i + 1) / static_cast<double>(sent.size()));
  }
  log.close();
}

/// The same as a recording of ROS 2: one topic a sensor.
void write_mcap(const std::string& file, const std::vector<MountedSensor>& sensors,
                const std::vector<Trajectory>& trajectories, const SimulationOptions& simulation) {
  McapWriter mcap(file);
  Progress progress("writing");
  const std::vector<Sent> sent = in_order_of_time(trajectories, simulation);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const std::string& name = sensors[sent[i].sensor].name;
    mcap.write_pose("/" + name, name + "_start", trajectories[sent[i].sensor][sent[i].index]);
    progress(static_cast<double>(i + 1) / static_cast<double>(sent.size()));
  }
  mcap.close();
}

std::string trajectory_file(const std::string& directory, const MountedSensor& sensor) {
  return directory + "/" + sensor.name + ".tum";
}

std::string truth_file(const std::string& directory, const MountedSensor& a, const MountedSensor& b) {
  return directory + "/truth_" + a.name + "_" + b.name + ".txt";
}

void write_directory(const std::string& directory, const std::vector<MountedSensor>& sensors,
                     const std::vector<Trajectory>& trajectories) {
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    write_tum(trajectory_file(directory, sensors[k]), trajectories[k]);
    if (k == 0) continue;
    const Pose T = inverse(sensors[0].T_vehicle_sensor) * sensors[k].T_vehicle_sensor;
    write_whole_file(
        truth_file(directory, sensors[0], sensors[k]),
        fmt::format("# tx ty tz qw qx qy qz, pose of {} in {}\n{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} "
                    "{:.17g} {:.17g}\n",
                    sensors[k].name, sensors[0].name, T.translation.x(), T.translation.y(), T.translation.z(),
                    T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()));
  }
}

/// Refuses what would be two streams of one name.
std::vector<MountedSensor> understood(const std::vector<std::string>& texts) {
  std::vector<MountedSensor> sensors;
  for (const std::string& text : texts) {
    MountedSensor sensor = mounted(text);
    for (const MountedSensor& other : sensors)
      if (other.channel == sensor.channel)
        throw UsageError("--sensor: " + other.name + " and " + sensor.name + " would both send on " +
                         sensor.channel + ": expected different names");
    sensors.push_back(std::move(sensor));
  }
  if (sensors.size() < 2) throw UsageError("--sensor: expected at least two");
  return sensors;
}

/// The rig file takes its name when the drive is written, and is known to be writable before. A device takes
/// the text at once: one that refuses it must not leave a drive without its rig.
class WrittenRig {
 public:
  WrittenRig(const std::string& file, const std::string& text) {
    std::error_code none;
    const bool written_as_it_is = !can_be_replaced(file) && !std::filesystem::is_directory(file, none);
    if (file.empty()) return;
    if (written_as_it_is) {
      write_whole_file(file, text);
      return;
    }
    whole_.emplace(file);
    whole_->write(text);
  }
  void commit() {
    if (whole_) whole_->commit();
  }

 private:
  std::optional<WholeFile> whole_;
};

/// A folder that goes where nothing is written into it, if it was not there before.
class NewDirectory {
 public:
  explicit NewDirectory(const std::string& directory) : directory_(directory) {
    if (directory.empty()) return;
    std::error_code error;
    made_ = std::filesystem::create_directories(directory, error);
    if (error) throw error_at(directory, 0, "", "cannot be made: " + error.message());
  }
  ~NewDirectory() {
    std::error_code not_empty;
    if (made_) std::filesystem::remove(directory_, not_empty);
  }
  NewDirectory(const NewDirectory&) = delete;
  NewDirectory& operator=(const NewDirectory&) = delete;

 private:
  std::string directory_;
  bool made_ = false;
};

/// The rig file must not take the name of a file of the drive.
void refuse_same_name(const SimulateOptions& options, const std::vector<MountedSensor>& sensors) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path rig = fs::weakly_canonical(options.rig_out, none);
  for (std::size_t k = 0; k < sensors.size(); ++k)
    for (const std::string& file :
         {trajectory_file(options.out, sensors[k]), truth_file(options.out, sensors[0], sensors[k])})
      if (fs::weakly_canonical(file, none) == rig)
        throw UsageError("--rig-out: " + options.rig_out + " is a file of --out: expected another name");
}

void run_simulate(SimulateOptions options, const cli::App& command) {
  if (command.given("--roughness") && options.terrain != "rough")
    throw UsageError("--roughness: goes with --terrain rough");
  if (command.given("--speed-variation") && options.terrain == "free")
    throw UsageError("--speed-variation: is that of the speed on the ground, not of --terrain free");
  const std::string extension = std::filesystem::path(options.out).extension();
  if (command.given("--type") && extension != ".log" && options.rig_out.empty())
    throw UsageError("--type: is that of the messages of a .log or of --rig-out");
  // a name of a file that would become one of a folder
  for (const char* other : {".bag", ".db3", ".tum", ".txt", ".csv", ".toml", ".json", ".yaml"})
    if (extension == other)
      throw UsageError("--out: expected a file .log or .mcap, or a folder for TUM files, got '" +
                       options.out + "'");
  const std::vector<MountedSensor> sensors = understood(options.sensors);
  SimulationOptions& simulation = options.simulation;
  simulation.terrain = options.terrain == "flat"   ? Terrain::flat
                       : options.terrain == "free" ? Terrain::free
                                                   : Terrain::rough;
  simulation.T_vehicle_sensor.clear();
  for (const MountedSensor& sensor : sensors) simulation.T_vehicle_sensor.push_back(sensor.T_vehicle_sensor);
  std::vector<std::string> names;
  names.reserve(sensors.size());
  for (const MountedSensor& sensor : sensors) names.push_back(sensor.name);
  simulation.faults = understood(options.faults, names, (simulation.poses - 1) / simulation.rate);
  const bool directory = extension != ".mcap" && extension != ".log";
  if (directory && !options.rig_out.empty()) refuse_same_name(options, sensors);
  const std::vector<Trajectory> trajectories = simulate(simulation);
  const NewDirectory made(directory ? options.out : std::string());
  WrittenRig rig(options.rig_out, rig_text(sensors, options.type));
  if (extension == ".mcap")
    write_mcap(options.out, sensors, trajectories, simulation);
  else if (extension == ".log")
    write_log(options.out, sensors, trajectories, simulation, options.type);
  else
    write_directory(options.out, sensors, trajectories);
  rig.commit();
}

}  // namespace

void add_simulate(cli::App program) {
  const auto options = std::make_shared<SimulateOptions>();
  SimulationOptions& simulation = options->simulation;
  cli::App command =
      program.add_subcommand("simulate", "a drive with known truth, as an LCM log, MCAP or TUM files");
  command.add_output("--out", options->out, "a file .log or .mcap, or a directory for TUM files").required();
  command.add_output("--rig-out", options->rig_out, "also writes a rig file for it");
  command
      .add_option("--terrain", options->terrain,
                  "flat (planar motion), rough (a road) or free (6 degrees of freedom)")
      .check(cli::Check::one_of({"flat", "rough", "free"}))
      .show_default();
  command
      .add_option("--sensor", options->sensors,
                  "NAME=X,Y,Z,QW,QX,QY,QZ: its pose on the vehicle; two or more")
      .show_default();
  const auto number = [&](const char* name, auto& value, const char* help, const Range& range) {
    command.add_option(name, value, help).check(cli::Check::range(range.least, range.most)).show_default();
  };
  namespace in = limits::simulation;
  number("--poses", simulation.poses, "of each sensor", in::poses);
  number("--rate", simulation.rate, "poses a second [Hz]", in::rate);
  number("--speed", simulation.speed, "[m/s]", in::speed);
  number("--speed-variation", simulation.speed_variation, "of the speed on the ground, as a part of it",
         in::speed_variation);
  number("--roughness", simulation.roughness, "amplitude of the road's surface [m]", in::roughness);
  number("--noise", simulation.relative_noise, "noise of each motion, as a part of the mean motion",
         in::noise);
  number("--noise-of-motion", simulation.noise_of_motion, "further noise, as a part of each motion itself",
         in::noise);
  number("--noise-rotation", simulation.noise_rotation, "further noise of the rotations [rad]", in::noise);
  number("--noise-translation", simulation.noise_translation, "further noise of the translations [m]",
         in::noise);
  command.add_flag("--random-walk", simulation.random_walk, "noise of consecutive motions is correlated");
  command.add_flag("--heavy-tails", simulation.heavy_tails, "noise with rare large errors (Student, 3)");
  add_fault_options(command, options->faults);
  command.add_option("--seed", simulation.seed, "of path, surface, noise and faults").show_default();
  command
      .add_option("--type", options->type,
                  "of the messages: odometry (egocal.odometry_t) or pose (bot_core.pose_t)")
      .check(cli::Check::one_of({"odometry", "pose"}))
      .show_default();
  command.callback([options, command] { run_simulate(*options, command); });
}

}  // namespace egocal::tools
