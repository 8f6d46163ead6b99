// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/motions.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <utility>

#include "arguments.hpp"
#include "egocal/error.hpp"
#include "egocal/io/misplaced_times.hpp"
#include "egocal/io/pairs_file.hpp"
#include "offline/common/beside.hpp"
#include "offline/reading/log_trajectory.hpp"
#include "offline/reading/trajectory_source.hpp"

namespace egocal::tools {

namespace {

/// Whether a file can be read beside another one, and is long enough to be worth a thread. Two pipes may be
/// one.
bool is_long_file(const std::string& name) {
  constexpr std::uintmax_t least = 1 << 20;  // [bytes], read in some milliseconds
  std::error_code none;
  const std::filesystem::path file = parse_recording_name(name).file;
  return std::filesystem::is_regular_file(file, none) && std::filesystem::file_size(file, none) >= least;
}

/// Whether one file of times was given for both streams.
bool has_common_times(const MotionSource& source) {
  return !source.reading_a.times_file.empty() && source.reading_a.times_file == source.reading_b.times_file;
}

Motions read_both(const MotionSource& source) {
  Motions motions;
  std::vector<std::string> warnings_b;
  const auto read_a = [&] {
    motions.a = read_noting(source.a, source.reading_a, motions.warnings, &motions.a_has_scale);
  };
  const auto read_b = [&] {
    motions.b = read_noting(source.b, source.reading_b, warnings_b, &motions.b_has_scale);
  };
  const bool are_long = is_long_file(source.a) && is_long_file(source.b);
  with_times_of_both(source, [&] { (are_long ? at_the_same_time : one_after_the_other)(read_a, read_b); });
  motions.warnings.insert(motions.warnings.end(), warnings_b.begin(), warnings_b.end());
  return motions;
}

}  // namespace

void with_times_of_both(const MotionSource& source, const std::function<void()>& read) {
  try {
    read();
  } catch (const MisplacedTimes& error) {
    if (!has_common_times(source)) throw;
    throw Error(std::string(error.what()) + "; --times-a or --times-b gives the times of one file alone");
  }
}

Motions read_motions(const MotionSource& source) {
  Motions motions;
  if (!source.pairs.empty()) {
    motions.pairs = read_pairs(source.pairs);
    return motions;
  }
  if (source.log.empty()) return read_both(source);
  LogTrajectory a, b;
  (is_long_file(source.log) ? at_the_same_time : one_after_the_other)(
      [&] { a = read_log_trajectory(source.log, source.a); },
      [&] { b = read_log_trajectory(source.log, source.b); });
  motions.a = std::move(a.poses);
  motions.b = std::move(b.poses);
  // damage is of both
  for (std::string* warning : {&a.not_used, &b.not_used, &a.times, &b.times, &a.damage})
    if (!warning->empty()) motions.warnings.push_back(std::move(*warning));
  return motions;
}

Drives append_drives(const SolveRequest& request, Motions& motions) {
  Drives drives({&motions.a, &motions.b}, {request.source.a, request.source.b});
  if (request.append.empty()) return drives;
  if (!request.source.pairs.empty()) throw UsageError("--append: goes with two trajectories");
  if (request.append.size() % 2 != 0) throw UsageError("--append: expected a file for A and one for B");
  // columns and rate are those of the first drive; a file of times belongs to one drive
  ReadOptions a = request.source.reading_a, b = request.source.reading_b;
  a.times_file.clear();
  b.times_file.clear();
  for (std::size_t i = 0; i < request.append.size(); i += 2) {
    const std::string &name_a = request.append[i], &name_b = request.append[i + 1];
    drives.append({read_noting(name_a, a, motions.warnings), read_noting(name_b, b, motions.warnings)},
                  {name_a, name_b}, motions.warnings);
  }
  return drives;
}

}  // namespace egocal::tools
